use thiserror::Error;

/// Reasons why a crowd is not drawn.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum CrowdError {
    /// The adapter lacks a feature.
    #[error(
        "the graphics adapter {0} cannot draw crowds: it lacks compute shaders, storage buffers in \
         vertex shaders or indirect drawing"
    )]
    Unsupported(String),
    /// The device failed or hung.
    #[error("the graphics device did not solve the crowd: {0}")]
    Device(String),
}
