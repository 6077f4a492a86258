use std::io;

use thiserror::Error;

use crate::io::OpenError;
use crate::io::system_reason;
use crate::kinematics::two_bone::LengthError;
use crate::render::{CrowdError, DrawError, GpuError, SavePictureError};

/// Reasons why no picture or no timings are written.
#[derive(Debug, Error)]
pub enum RenderCommandError {
    #[error(transparent)]
    Length(#[from] LengthError),
    #[error(transparent)]
    Open(#[from] OpenError),
    #[error(transparent)]
    Gpu(#[from] GpuError),
    #[error(transparent)]
    Draw(#[from] DrawError),
    #[error(transparent)]
    Crowd(#[from] CrowdError),
    #[error(
        "the lengths of a crowd's arms must be between {min:e} and {max:e}, got {upper} and {lower}"
    )]
    CrowdLength { min: f32, max: f32, upper: f32, lower: f32 },
    #[error(transparent)]
    Save(#[from] SavePictureError),
    #[error("cannot write to standard output: {}", system_reason(.0))]
    Write(#[from] io::Error),
}
