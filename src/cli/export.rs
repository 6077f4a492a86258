//! `ik-arm export`: a file's motion or pictures, for other programs.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::ValueEnum;
use thiserror::Error;

use super::argument::{FrameRateArgument, SizeArgument, ThemeName, TimeArgument};
use super::open;
use super::open_args::OpenArgs;
use super::progress_bar::run_with_bar;
use super::report::{INTERRUPTED, USAGE, fail, say};
use super::time_limit::TimeLimitArgs;
use super::view_name::ViewName;
use crate::document::Document;
use crate::export::{ExportError, ExportFormat, ExportOptions, export};
use crate::io::{BvhUnit, ExportOption, OpenError, Progress, dotted};
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
#[command(after_help = after_help())]
pub struct ExportArgs {
    #[arg(help = open::input_help("File to export"), value_name = "FILE")]
    file: PathBuf,
    /// File to write
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    #[command(flatten)]
    open: OpenArgs,
    /// Frames per second [default: the timeline's]
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    fps: Option<FrameRateArgument>,
    /// Picture width and height in pixels, each 1 to 8192 [default: 1280x800]
    #[arg(long, value_name = "WxH")]
    size: Option<SizeArgument>,
    /// Colours of a picture [default: dark]
    #[arg(long, value_enum)]
    theme: Option<ThemeName>,
    /// Camera that frames the whole motion from this side, for pictures [default: the file's
    /// camera]
    #[arg(long, value_enum)]
    view: Option<ViewName>,
    /// Time of a single picture or mesh in seconds [default: the timeline's start]
    #[arg(long, value_name = "S", allow_hyphen_values = true)]
    time: Option<TimeArgument>,
    /// Length unit of .bvh; scene writes the file's numbers unchanged [default: cm]
    #[arg(long, value_enum)]
    unit: Option<UnitName>,
    /// How the joints of .obj are blended: linear, dual-quaternion or spread-twist [default: the
    /// file's]
    #[arg(long, value_name = "WAY")]
    skinning: Option<Skinning>,
    #[command(flatten)]
    time_limit: TimeLimitArgs,
}

#[derive(Clone, Copy, ValueEnum)]
pub enum UnitName {
    Cm,
    M,
    Scene,
}

/// Reasons why no file is written.
#[derive(Debug, Error)]
enum ExportCommandError {
    #[error(transparent)]
    Open(#[from] OpenError),
    #[error("{0} does not apply to this format: see ik-arm export --help")]
    Argument(&'static str),
    #[error("cannot handle Ctrl+C: {0}")]
    Signal(#[from] ctrlc::Error),
    #[error(transparent)]
    Output(ExportError),
    #[error("{file}: {error}")]
    Input { file: String, error: ExportError },
}

pub fn run(args: &ExportArgs) -> ExitCode {
    match args.export() {
        Ok(notes) => {
            notes.iter().for_each(|note| say(note));
            ExitCode::SUCCESS
        }
        Err(ExportCommandError::Output(ExportError::Cancelled(cancelled))) => {
            say(&format_args!("{cancelled}; {} is not written", args.output.display()));
            ExitCode::from(INTERRUPTED)
        }
        Err(error @ ExportCommandError::Argument(_)) => {
            say(&error);
            ExitCode::from(USAGE)
        }
        Err(error) => fail(&error),
    }
}

impl ExportArgs {
    fn export(&self) -> Result<Vec<String>, ExportCommandError> {
        // Checks the arguments first, so that no file is read if one of them does not apply.
        let format = ExportFormat::of(&self.output).map_err(ExportError::from);
        self.check(format.map_err(ExportCommandError::Output)?)?;
        let limit = self.time_limit.start_long(&self.file);
        let mut document = open::open(&self.file, &self.open.options())?.document;
        if let Some(view) = self.view {
            document.camera = view.framing(&document, self.size());
        }
        let notes = run_with_bar(&limit, |progress| self.write(&document, progress))?;
        named(&self.file, notes).map_err(|(file, error)| {
            if error.is_about_output() {
                ExportCommandError::Output(error)
            } else {
                ExportCommandError::Input { file, error }
            }
        })
    }

    fn write(&self, document: &Document, progress: &Progress) -> Result<Vec<String>, ExportError> {
        export(document, &self.output, &self.options(), progress)
    }

    /// Refuses arguments that do not apply to the format.
    fn check(&self, format: ExportFormat) -> Result<(), ExportCommandError> {
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
                return Err(ExportCommandError::Argument(argument));
            }
        }
        Ok(())
    }

    /// The size of a picture.
    fn size(&self) -> SizeArgument {
        let (width, height) = ExportOptions::default().size;
        self.size.unwrap_or(SizeArgument { width, height })
    }

    fn options(&self) -> ExportOptions {
        let defaults = ExportOptions::default();
        let SizeArgument { width, height } = self.size();
        ExportOptions {
            fps: self.fps.map(|FrameRateArgument(rate)| rate),
            size: (width, height),
            theme: self.theme.map_or(defaults.theme, ThemeName::into),
            time: self.time.map(|time| time.0),
            unit: self.unit.map_or(defaults.unit, UnitName::into),
            skinning: self.skinning,
        }
    }
}

/// The notes and the error of an export, with the name of the file that they are about.
pub fn named(
    file: &Path,
    exported: Result<Vec<String>, ExportError>,
) -> Result<Vec<String>, (String, ExportError)> {
    let name = open::name(file);
    match exported {
        Ok(notes) => Ok(notes.iter().map(|note| format!("{name}: {note}")).collect()),
        Err(error) => Err((name, error)),
    }
}

impl From<UnitName> for BvhUnit {
    fn from(name: UnitName) -> Self {
        match name {
            UnitName::Cm => Self::Centimetres,
            UnitName::M => Self::Metres,
            UnitName::Scene => Self::Scene,
        }
    }
}
