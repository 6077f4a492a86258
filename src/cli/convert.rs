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
use crate::export::{ExportError, ExportOptions, Format, export};
use crate::io::{OpenError, SaveError, save};

#[derive(clap::Args)]
#[command(after_help = "The extension of OUT chooses the format:
  .json    a document of ik-arm, with skeleton, skin, keys and timeline
  .glb     joints, skinned mesh and motion
  .bvh     joints and motion
What the format cannot hold is listed on stderr. ik-arm export also writes tables, meshes and pictures.")]
pub struct ConvertArgs {
    /// File to convert: ik-arm document (.json), Scotty3D scene (.js3d), .bvh, .glb or .gltf; -
    /// reads standard input
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// File to write: .json, .glb or .bvh
    #[arg(short, long, value_name = "OUT")]
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
    #[error("OUT must end in .json, .glb or .bvh, got {0}; ik-arm export writes other formats")]
    Extension(String),
    #[error("{0} does not apply to this format")]
    Argument(&'static str),
}

/// The format of the output.
#[derive(Clone, Copy, PartialEq)]
enum Output {
    Document,
    Export(Format),
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
        Err(error @ (ConvertError::Extension(_) | ConvertError::Argument(_))) => {
            say(&error);
            ExitCode::from(USAGE)
        }
        Err(error) => fail(&error),
    }
}

impl ConvertArgs {
    fn convert(&self) -> Result<Vec<String>, ConvertError> {
        let output = self.output()?;
        for (is_given, applies, argument) in [
            (self.fps.is_some(), output != Output::Document, "--fps"),
            (self.unit.is_some(), output == Output::Export(Format::Bvh), "--unit"),
        ] {
            if is_given && !applies {
                return Err(ConvertError::Argument(argument));
            }
        }
        let limit = self.time_limit.start_long(&self.file);
        let document = open::open(&self.file, &self.open.options())?.document;
        if output == Output::Document {
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
        named(&self.file, exported).map_err(|(file, error)| match error.is_about_output() {
            true => ConvertError::Output(error),
            false => ConvertError::Input { file, error },
        })
    }

    fn output(&self) -> Result<Output, ConvertError> {
        if open::is_document(&self.output) {
            return Ok(Output::Document);
        }
        match Format::of(&self.output) {
            Ok(format @ (Format::Glb | Format::Bvh)) => Ok(Output::Export(format)),
            _ => Err(ConvertError::Extension(self.output.display().to_string())),
        }
    }
}
