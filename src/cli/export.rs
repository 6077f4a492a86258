//! `ik-arm export`: a file's motion or pictures, for other programs.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::ValueEnum;
use clap::builder::PossibleValue;

use super::argument::{ViewName, frame_rate, size, time};
use super::open::{self, InputArgs};
use super::report::{CommandError, say};
use super::time_limit::{TimeLimit, TimeLimitArgs};
use crate::document::{Document, Theme};
use crate::export::{ExportError, ExportFormat, ExportOptions, export};
use crate::io::{BvhUnit, ExportOption, dotted};
use crate::kinematics::skin::Skinning;

/// The command's line in the list of commands.
pub fn about() -> String {
    let extensions: Vec<_> = ExportFormat::extensions().iter().map(dotted).collect();
    format!("Export a file's motion, mesh or pictures: {}", extensions.join(", "))
}

fn after_help() -> String {
    let kinds = ExportFormat::all().map(|format| format.kind);
    let rows = open::help_rows(kinds.map(|kind| (kind.label.to_owned(), kind.help)));
    format!(
        "The extension of OUT selects the format:\n{rows}\
         Frames run from the start of the file's timeline to its end. A file without motion has one frame.\n\
         Whatever the format cannot hold is listed on stderr. Ctrl+C cancels: no file is written, and the\n\
         exit code is 130."
    )
}

#[derive(clap::Args)]
#[command(
    after_help = after_help(),
    mut_arg("file", |file| file.help(open::input_help("File to export")))
)]
pub struct ExportArgs {
    /// File to write
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    #[command(flatten)]
    input: InputArgs,
    /// Frames per second [default: the timeline's]
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = frame_rate)]
    fps: Option<f64>,
    /// Picture width and height in pixels, each 1 to 8192 [default: 1280x800]
    #[arg(long, value_name = "WxH", value_parser = size)]
    size: Option<(u32, u32)>,
    /// Colours of a picture [default: dark]
    #[arg(long, value_enum)]
    theme: Option<Theme>,
    /// Camera that frames the whole motion from this side, for pictures [default: the file's
    /// camera]
    #[arg(long, value_enum)]
    view: Option<ViewName>,
    /// Time of a single picture or mesh in seconds [default: the timeline's start]
    #[arg(long, value_name = "S", allow_hyphen_values = true, value_parser = time)]
    time: Option<f64>,
    /// Length unit of .bvh; scene writes the file's numbers unchanged [default: cm]
    #[arg(long, value_enum)]
    unit: Option<BvhUnit>,
    /// How the joints of .obj are blended: linear, dual-quaternion or spread-twist [default: the
    /// file's]
    #[arg(long, value_name = "WAY")]
    skinning: Option<Skinning>,
    #[command(flatten)]
    time_limit: TimeLimitArgs,
}

impl ValueEnum for BvhUnit {
    fn value_variants<'a>() -> &'a [Self] {
        &[Self::Centimetres, Self::Metres, Self::Scene]
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(match self {
            Self::Centimetres => "cm",
            Self::Metres => "m",
            Self::Scene => "scene",
        }))
    }
}

pub fn run(args: &ExportArgs) -> Result<(), CommandError> {
    // Checks the arguments first, so that no file is read if one of them does not apply.
    let format = ExportFormat::of(&args.output).map_err(ExportError::from)?;
    args.check(format)?;
    let limit = args.time_limit.start_long(&args.input.file);
    let mut document = args.input.open()?.document;
    let options = args.options();
    if let Some(view) = args.view {
        document.camera = view.framing(&document, options.size);
    }
    write(&args.input, &document, &args.output, &options, &limit)
}

/// Writes the document of an input to a file, and prints what the file cannot hold.
pub fn write(
    input: &InputArgs,
    document: &Document,
    output: &Path,
    options: &ExportOptions,
    limit: &Arc<TimeLimit>,
) -> Result<(), CommandError> {
    let name = input.name();
    match limit.run(async |progress| export(document, output, options, progress).await)? {
        Ok(notes) => {
            notes.iter().for_each(|note| say(&format_args!("{name}: {note}")));
            Ok(())
        }
        Err(ExportError::Cancelled(_)) => {
            Err(CommandError::Cancelled { output: output.to_owned() })
        }
        Err(error) if error.is_about_output() => Err(error.into()),
        Err(error) => Err(CommandError::of_file(name, error)),
    }
}

impl ExportArgs {
    /// Refuses arguments that do not apply to the format.
    fn check(&self, format: ExportFormat) -> Result<(), CommandError> {
        for (is_given, option, argument) in [
            (self.fps.is_some(), ExportOption::FrameRate, "--fps"),
            (self.size.is_some(), ExportOption::Picture, "--size"),
            (self.theme.is_some(), ExportOption::Picture, "--theme"),
            (self.view.is_some(), ExportOption::Picture, "--view"),
            (self.time.is_some(), ExportOption::Time, "--time"),
            (self.unit.is_some(), ExportOption::Unit, "--unit"),
            (self.skinning.is_some(), ExportOption::Skinning, "--skinning"),
        ] {
            if is_given && !format.takes(option) {
                return Err(CommandError::Usage(format!(
                    "{argument} does not apply to this format: see ik-arm export --help"
                )));
            }
        }
        Ok(())
    }

    fn options(&self) -> ExportOptions {
        let defaults = ExportOptions::default();
        ExportOptions {
            fps: self.fps,
            size: self.size.unwrap_or(defaults.size),
            theme: self.theme.unwrap_or(defaults.theme),
            time: self.time,
            unit: self.unit.unwrap_or(defaults.unit),
            skinning: self.skinning,
        }
    }
}
