use thiserror::Error;

use crate::render::{DeviceError, GpuError};

/// Reasons why nothing can be drawn in the window.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum GraphicsError {
    /// No surface could be created.
    #[error("the window has no surface to draw on: {0}")]
    Surface(#[from] wgpu::CreateSurfaceError),
    /// The adapter supports no format of the surface.
    #[error("the graphics adapter {0} cannot draw in this window")]
    Unsupported(String),
    /// There is no graphics device.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// The surface was lost twice in a row.
    #[error("the window's surface was lost twice")]
    SurfaceLost,
    /// The surface is invalid.
    #[error("the window's surface provides no frame")]
    NoFrame,
    /// The device was lost or is out of memory.
    #[error(transparent)]
    Device(#[from] DeviceError),
    /// The device did not finish its work in time.
    #[error("the graphics device does not respond: {0}")]
    Poll(#[from] wgpu::PollError),
    /// A graphics library panicked.
    #[error("a graphics library panicked: {0}")]
    Panic(String),
    /// `IK_ARM_DEBUG` requested that the device fails.
    #[error("the graphics device failed as requested by IK_ARM_DEBUG")]
    Requested,
}
