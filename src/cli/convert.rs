//! `ik-arm convert`: a file of another program as a document, or in another format.

use std::path::PathBuf;
use std::process::ExitCode;

use thiserror::Error;

use super::argument::FrameRateArgument;
use super::export::{UnitName, named};
use super::open;
use super::open_args::OpenArgs;
use super::progress_bar::run_with_bar;
use super::report::{INTERRUPTED, USAGE, fail, say};
use super::time_limit::TimeLimitArgs;
use crate::export::{ExportError, ExportOptions, export};
use crate::io::{ExportOption, FileFormat, OpenError, SaveError, dotted, enumerated, save};

/// The command's line in the list of commands.
pub fn about() -> String {
    let written = FileFormat::convertible().map(|format| {
        if format.is_document() {
            "a document (.json)".to_owned()
        } else {
            dotted(&format.extension())
        }
    });
    format!("Convert a file to {}", enumerated(&written.collect::<Vec<_>>(), "or"))
}

/// The extensions that OUT can have.
fn extensions() -> String {
    let extensions: Vec<_> =
        FileFormat::convertible().map(|format| dotted(&format.extension())).collect();
    enumerated(&extensions, "or")
}

fn after_help() -> String {
    let row = |format: FileFormat| (dotted(&format.extension()), format.holds);
    let rows = open::help_rows(FileFormat::convertible().map(row));
    format!(
        "The extension of OUT chooses the format:\n{rows}\
         What the format cannot hold is listed on stderr. ik-arm export also writes tables, meshes and pictures."
    )
}

#[derive(clap::Args)]
#[command(after_help = after_help())]
pub struct ConvertArgs {
    #[arg(help = open::input_help("File to convert"), value_name = "FILE")]
    file: PathBuf,
    #[arg(help = format!("File to write: {}", extensions()), short, long, value_name = "OUT")]
    output: PathBuf,
    #[command(flatten)]
    open: OpenArgs,
    /// Frames per second of .glb and .bvh [default: the timeline's]
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    fps: Option<FrameRateArgument>,
    /// Length unit of .bvh; scene writes the file's numbers unchanged [default: cm]
    #[arg(long, value_enum)]
    unit: Option<UnitName>,
    #[command(flatten)]
    time_limit: TimeLimitArgs,
}

/// Reasons why no file is written.
#[derive(Debug, Error)]
enum ConvertError {
    #[error(transparent)]
    Open(#[from] OpenError),
    #[error("{file}: {error}")]
    Save { file: String, error: SaveError },
    #[error(transparent)]
    Output(ExportError),
    #[error("{file}: {error}")]
    Input { file: String, error: ExportError },
    #[error("Ctrl+C cannot be handled: {0}")]
    Interrupt(#[from] ctrlc::Error),
    #[error("OUT must end in {}, got {got}; ik-arm export writes other formats", extensions())]
    Extension { got: String },
    #[error("{0} does not apply to this format")]
    Argument(&'static str),
}

pub fn run(args: &ConvertArgs) -> ExitCode {
    match args.convert() {
        Ok(notes) => {
            notes.iter().for_each(|note| say(note));
            ExitCode::SUCCESS
        }
        Err(ConvertError::Output(ExportError::Cancelled(cancelled))) => {
            say(&format_args!("{cancelled}; {} is not written", args.output.display()));
            ExitCode::from(INTERRUPTED)
        }
        Err(error @ (ConvertError::Extension { .. } | ConvertError::Argument(_))) => {
            say(&error);
            ExitCode::from(USAGE)
        }
        Err(error) => fail(&error),
    }
}

impl ConvertArgs {
    fn convert(&self) -> Result<Vec<String>, ConvertError> {
        let output = self.output()?;
        for (is_given, option, argument) in [
            (self.fps.is_some(), ExportOption::FrameRate, "--fps"),
            (self.unit.is_some(), ExportOption::Unit, "--unit"),
        ] {
            if is_given && !output.takes(option) {
                return Err(ConvertError::Argument(argument));
            }
        }
        let limit = self.time_limit.start_long(&self.file);
        let document = open::open(&self.file, &self.open.options())?.document;
        if output.is_document() {
            save(&document, &self.output)
                .map_err(|error| ConvertError::Save { file: open::name(&self.file), error })?;
            return Ok(Vec::new());
        }
        let options = ExportOptions {
            fps: self.fps.map(|FrameRateArgument(rate)| rate),
            unit: self.unit.map(UnitName::into).unwrap_or_default(),
            ..ExportOptions::default()
        };
        let write = |progress: &_| export(&document, &self.output, &options, progress);
        let exported = run_with_bar(&limit, write)?;
        named(&self.file, exported).map_err(|(file, error)| {
            if error.is_about_output() {
                ConvertError::Output(error)
            } else {
                ConvertError::Input { file, error }
            }
        })
    }

    /// The format of the output.
    fn output(&self) -> Result<FileFormat, ConvertError> {
        let mut formats = FileFormat::convertible();
        let output = formats.find(|format| format.is_written_to(&self.output));
        output.ok_or_else(|| ConvertError::Extension { got: self.output.display().to_string() })
    }
}
