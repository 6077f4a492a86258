use crate::document::{Posed, Theme};
use crate::session::Overlays;

/// Everything that a picture of the viewport shows.
pub struct ViewportPicture {
    pub posed: Posed,
    pub overlays: Overlays,
    pub theme: Theme,
    /// Width and height in pixels.
    pub size: (u32, u32),
    /// Pixels per point.
    pub scale: f32,
}
