use thiserror::Error;

/// Reasons why a crowd is not drawn.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum CrowdError {
    /// The adapter, named here, lacks a feature that crowds require.
    #[error(
        "the graphics adapter {0} cannot draw crowds: it lacks compute shaders, storage buffers in \
         vertex shaders or indirect drawing"
    )]
    Unsupported(String),
    /// The device failed or hung while it solved the crowd.
    #[error("the graphics device did not solve the crowd: {0}")]
    Device(String),
}
