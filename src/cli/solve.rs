//! `ik-arm solve`: arm poses as JSON Lines. Each line is solved by itself, unless its twist
//! reference is transport.

use std::fs::File;
use std::io::{self, BufRead, BufReader, BufWriter, Read, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use serde::Serialize;

use super::open;
use super::report::CommandError;
use crate::io::{LineError, solve_line};

const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

#[derive(clap::Args)]
#[command(after_help = r#"Each line in is an object; only "hand" (relative to root) is required:
  {"hand":[250,120,60],"upper":200,"lower":300,"root":[0,0,0],"twist_deg":0,
   "reference":"up","softness":0,"max_stretch":1,"min_elbow_angle_deg":0}
reference, the direction that the twist is measured from:
  "up"              up, as far as the hand's direction lets it
  {"pole":[x,y,z]}  towards a point, relative to root
  "stereographic"   from a stereographic map of all directions but -x
  "transport"       as stereographic in the first line, then transported from line to line; a bad
                    line changes nothing, and a line with another reference restarts it
softness (0 to less than 1) slows the hand before its limits; max_stretch (1 or more) lengthens the
limbs instead; min_elbow_angle_deg (0 to less than 180) keeps the elbow open.
Each line out is a pose, with elbow and hand in the world:
  {"reach":"reached|too_far|too_close","elbow":[x,y,z],"hand":[x,y,z],"distance":D,
   "theta_z_deg":…,"theta_y_deg":…,"theta_e_deg":…,"along":…,"out":…,
   "reference_gain":…,"elbow_angle_deg":…}
distance is from the shoulder to that hand. reference_gain is the largest ratio of the elbow's turn
to the turn of the hand's direction; it is null where that has no bound.
A bad line gives {"line":N,"error":"…"} in its place; the exit code is then 1."#)]
pub struct SolveArgs {
    /// File with one JSON object per line; - reads standard input
    #[arg(value_name = "FILE", default_value = "-")]
    file: PathBuf,
}

/// Returns the exit code of the command: a failure if a line is invalid.
pub fn run(args: &SolveArgs) -> Result<ExitCode, CommandError> {
    let invalid = solve_lines(LineReader::open(&args.file)?, io::stdout().lock())?;
    Ok(if invalid == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Solves every line and returns the number of invalid lines.
fn solve_lines(mut input: LineReader, output: impl Write) -> Result<u64, CommandError> {
    let mut output = BufWriter::new(output);
    let mut previous = None;
    let mut invalid = 0;
    loop {
        // The next read may block, and the program that writes the lines may wait for the answers.
        if !input.has_line() {
            output.flush()?;
        }
        let Some(line) = input.next_line()? else { return Ok(invalid) };
        if line.is_blank() {
            continue;
        }
        match solve_line(line.content, &mut previous) {
            Ok(answer) => write_line(&mut output, &answer)?,
            Err(error) => {
                invalid += 1;
                let line = InvalidLine { line: line.number, error: error.message() };
                write_line(&mut output, &line)?;
            }
        }
    }
}

/// Answer to an invalid line.
#[derive(Serialize)]
struct InvalidLine {
    line: u64,
    error: String,
}

fn write_line(output: &mut impl Write, value: &impl Serialize) -> io::Result<()> {
    serde_json::to_writer(&mut *output, value)?;
    output.write_all(b"\n")
}

/// Reader of the input's lines.
struct LineReader {
    name: String,
    reader: BufReader<Box<dyn Read>>,
    /// The most recently read line with its line ending. The buffer is reused to avoid allocations.
    line: Vec<u8>,
    number: u64,
}

impl LineReader {
    fn open(path: &Path) -> Result<Self, CommandError> {
        let name = open::name(path);
        let input: Box<dyn Read> = if path == Path::new(open::STANDARD_INPUT) {
            Box::new(io::stdin().lock())
        } else {
            match File::open(path) {
                Ok(file) => Box::new(file),
                Err(error) => return Err(CommandError::System { doing: "open", name, error }),
            }
        };
        let reader = BufReader::with_capacity(LineError::MAX_LENGTH, input);
        Ok(Self { name, reader, line: Vec::new(), number: 0 })
    }

    /// True if the next line is buffered as a whole.
    fn has_line(&self) -> bool {
        self.reader.buffer().contains(&b'\n')
    }

    fn next_line(&mut self) -> Result<Option<InputLine<'_>>, CommandError> {
        let is_read = self.read_line().map_err(|error| {
            let name = self.name.clone();
            CommandError::System { doing: "read", name, error }
        })?;
        if !is_read {
            return Ok(None);
        }
        self.number += 1;
        Ok(Some(InputLine::new(self.number, &self.line)))
    }

    /// Reads one line. Returns false at the end of the input. Of a line that is too long, keeps
    /// only the start.
    fn read_line(&mut self) -> io::Result<bool> {
        let longest = LineError::MAX_LENGTH + b"\r\n".len();
        self.line.clear();
        let read = (&mut self.reader).take(longest as u64).read_until(b'\n', &mut self.line)?;
        if read == longest && !self.line.ends_with(b"\n") {
            self.reader.skip_until(b'\n')?;
        }
        Ok(read > 0)
    }
}

/// A line of the input, without its line ending and without a byte order mark.
struct InputLine<'a> {
    number: u64,
    content: &'a [u8],
}

impl<'a> InputLine<'a> {
    fn new(number: u64, read: &'a [u8]) -> Self {
        let line = read.strip_suffix(b"\n").unwrap_or(read);
        let content = line.strip_suffix(b"\r").unwrap_or(line);
        let mark = if number == 1 { BYTE_ORDER_MARK } else { b"" };
        Self { number, content: content.strip_prefix(mark).unwrap_or(content) }
    }

    fn is_blank(&self) -> bool {
        self.content.len() <= LineError::MAX_LENGTH && self.content.trim_ascii().is_empty()
    }
}
