//! What is saved: the arm, where it is looked at from, and what is shown.
//!
//! The pose is a function of the document alone, so whatever a stateful choice needs (the last
//! direction and yaw of the Pointer) is in it too.

mod arm;
mod camera;
mod display;

pub use arm::Arm;
pub use camera::{AxisView, Camera, Projection, Ray};
pub use display::{Display, Layer, Theme};

/// Everything that a file holds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Document {
    pub arm: Arm,
    pub camera: Camera,
    pub display: Display,
}
