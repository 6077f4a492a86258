use std::error::Error;
use std::fmt::Display;
use std::io::{self, ErrorKind, Write as _};
use std::path::PathBuf;
use std::process::ExitCode;

use serde::Serialize;
use thiserror::Error;

use crate::app::AppError;
use crate::export::ExportError;
use crate::io::{LinkError, OpenError, SaveError, WriteError, system_reason};
use crate::kinematics::two_bone::LengthError;
use crate::render::{CrowdError, DrawError, GpuError, SavePictureError};

/// Exit code that shells expect of a program ended by Ctrl+C.
pub const INTERRUPTED: u8 = 130;
/// Exit code of clap's usage errors.
pub const USAGE: u8 = 2;

/// The reason why a command ends without its result.
#[derive(Debug, Error)]
pub enum CommandError {
    #[error(transparent)]
    Open(#[from] OpenError),
    #[error(transparent)]
    Link(#[from] LinkError),
    #[error(transparent)]
    Save(#[from] SaveError),
    #[error(transparent)]
    Write(#[from] WriteError),
    #[error(transparent)]
    Export(#[from] ExportError),
    #[error("cannot write to standard output: {}", system_reason(.0))]
    StandardOutput(#[from] io::Error),
    #[error("cannot {doing} {name}: {}", system_reason(error))]
    System { doing: &'static str, name: String, error: io::Error },
    #[error("cannot handle Ctrl+C: {0}")]
    Signal(#[from] ctrlc::Error),
    #[error("cancelled; {} is not written", output.display())]
    Cancelled { output: PathBuf },
    #[error("{0}")]
    Usage(String),
    #[error("{file}: {error}")]
    Input { file: String, error: Box<dyn Error> },
    #[error("{0}: the check was cancelled")]
    Stopped(String),
    #[error("{file}: {faults}")]
    Faults { file: String, faults: String },
    #[error("{file}: the position of joint {name:?} must be within ±3.4028235e38")]
    Overflow { file: String, name: String },
    #[error(
        "the lengths of a crowd's arms must be between {min:e} and {max:e}, got {upper} and {lower}"
    )]
    CrowdLength { min: f32, max: f32, upper: f32, lower: f32 },
    #[error(transparent)]
    Length(#[from] LengthError),
    #[error(transparent)]
    Gpu(#[from] GpuError),
    #[error(transparent)]
    Draw(#[from] DrawError),
    #[error(transparent)]
    Crowd(#[from] CrowdError),
    #[error(transparent)]
    Picture(#[from] SavePictureError),
    #[error(transparent)]
    App(#[from] AppError),
}

impl CommandError {
    /// An error about the content of a file, given by its name.
    pub fn of_file(file: String, error: impl Error + 'static) -> Self {
        Self::Input { file, error: Box::new(error) }
    }

    /// Prints the error and returns the exit code. A reader that has closed standard output has
    /// what it wants, so `ik-arm … | head` succeeds.
    pub fn exit(&self) -> ExitCode {
        match self {
            Self::StandardOutput(error) if error.kind() == ErrorKind::BrokenPipe => {
                return ExitCode::SUCCESS;
            }
            _ => say(self),
        }
        match self {
            Self::Cancelled { .. } | Self::Stopped(_) => ExitCode::from(INTERRUPTED),
            Self::Usage(_) => ExitCode::from(USAGE),
            _ => ExitCode::FAILURE,
        }
    }
}

/// Prints a line of JSON to standard output.
///
/// # Errors
///
/// [`CommandError::StandardOutput`].
pub fn print_json(line: &impl Serialize) -> Result<(), CommandError> {
    let line = serde_json::to_string(line).map_err(io::Error::from)?;
    Ok(writeln!(io::stdout(), "{line}")?)
}

/// Prints a message to standard error.
pub fn say(message: &dyn Display) {
    // Not eprintln!, which panics where standard error cannot be written.
    let _ = writeln!(io::stderr(), "ik-arm: {message}");
}
