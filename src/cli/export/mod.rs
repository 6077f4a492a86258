//! `ik-arm export`: a file's motion or pictures, for other programs.

mod bar;

use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;

use clap::ValueEnum;
use thiserror::Error;

use super::argument::{Size, ThemeName, Time};
use super::{open, say};
use crate::document::{Document, Timeline};
use crate::export::{ExportError, Format, Options, export};
use crate::io::{BvhUnit, OpenError, Progress};

#[derive(clap::Args)]
#[command(after_help = r#"The ending of OUT says what it is:
  .glb        the shown rig as a skinned, animated model in metres: glTF in one file
  .bvh        its joints and their motion, for programs that animate
  .csv        where every joint is, a row for each frame
  .png        a picture at --time
  .png with # in its name, as walk_####.png: a picture for each frame, walk_0000.png and on
  .apng       all frames in one animated picture
Frames go from the start of the file's timeline to its end; where nothing moves there is one.
What OUT cannot say is told on stderr. Ctrl+C stops it: nothing is written then, and it exits with 130."#)]
pub struct Args {
    /// Document of ik-arm, .js3d scene of Scotty3D, .bvh, .glb or .gltf, or - for standard input
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Where it goes
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    /// Which skeleton of a scene; the first if nothing is said
    #[arg(long, value_name = "NAME")]
    skeleton: Option<String>,
    /// How many frames in a second; the file's timeline says if nothing is said here
    #[arg(
        long,
        value_name = "N",
        value_parser = clap::value_parser!(u32).range(1..=i64::from(Timeline::HIGHEST_FRAME_RATE))
    )]
    fps: Option<u32>,
    /// Pixels across and down of a picture, each 1 to 8192 [default: 1280x800]
    #[arg(long, value_name = "WxH")]
    size: Option<Size>,
    /// Of a picture [default: dark]
    #[arg(long, value_enum)]
    theme: Option<ThemeName>,
    /// When a single picture is taken, in seconds [default: where the timeline starts]
    #[arg(long, value_name = "S", allow_hyphen_values = true)]
    time: Option<Time>,
    /// What lengths in .bvh are measured in; scene is as they are in the file [default: cm]
    #[arg(long, value_enum)]
    unit: Option<UnitName>,
}

#[derive(Clone, Copy, ValueEnum)]
enum UnitName {
    Cm,
    M,
    Scene,
}

/// Why there is no file.
#[derive(Debug, Error)]
enum Failure {
    #[error(transparent)]
    Open(#[from] OpenError),
    #[error("{0} is not for files of this kind: see ik-arm export --help")]
    Argument(&'static str),
    #[error("Ctrl+C could not be listened to: {0}")]
    Signal(#[from] ctrlc::Error),
    #[error(transparent)]
    Export(#[from] ExportError),
}

/// What a shell says of a program that Ctrl+C has ended.
const INTERRUPTED: u8 = 130;
/// As for other arguments that make no sense.
const USAGE: u8 = 2;

pub fn run(args: &Args) -> ExitCode {
    match args.export() {
        Ok(notes) => {
            notes.iter().for_each(|note| say(note));
            ExitCode::SUCCESS
        }
        Err(Failure::Export(ExportError::Cancelled(cancelled))) => {
            say(&format_args!("{cancelled}; {} is not written", args.output.display()));
            ExitCode::from(INTERRUPTED)
        }
        Err(failure @ Failure::Argument(_)) => {
            say(&failure);
            ExitCode::from(USAGE)
        }
        Err(failure) => super::fail(&failure),
    }
}

impl Args {
    fn export(&self) -> Result<Vec<String>, Failure> {
        // What is wrong with OUT is said before a long file is read.
        self.check(Format::of(&self.output)?)?;
        let document = open::open(&self.file, self.skeleton.as_deref())?.document;
        let progress = Arc::new(Progress::default());
        let interrupted = Arc::clone(&progress);
        ctrlc::set_handler(move || interrupted.cancel())?;
        let notes = bar::shown(&progress, || self.write(&document, &progress))?;
        Ok(notes)
    }

    fn write(&self, document: &Document, progress: &Progress) -> Result<Vec<String>, ExportError> {
        export(document, &self.output, &self.options(), progress)
    }

    /// An argument that the format has no use for is a mistake.
    fn check(&self, format: Format) -> Result<(), Failure> {
        let is_still = format == Format::Png;
        for (is_given, is_of_use, argument) in [
            (self.fps.is_some(), !is_still, "--fps"),
            (self.size.is_some(), format.is_picture(), "--size"),
            (self.theme.is_some(), format.is_picture(), "--theme"),
            (self.time.is_some(), is_still, "--time"),
            (self.unit.is_some(), format == Format::Bvh, "--unit"),
        ] {
            if is_given && !is_of_use {
                return Err(Failure::Argument(argument));
            }
        }
        Ok(())
    }

    fn options(&self) -> Options {
        let usual = Options::default();
        Options {
            fps: self.fps,
            size: self.size.map_or(usual.size, |size| (size.width, size.height)),
            theme: self.theme.map_or(usual.theme, ThemeName::into),
            time: self.time.map(|time| time.0),
            unit: self.unit.map_or(usual.unit, UnitName::into),
        }
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
