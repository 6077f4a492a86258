//! Things to draw: plain lists of solids, balls, shells, lines and labels, filled from a pose.
//!
//! This module does not know how these things are drawn, and [`crate::render`] does not know what
//! they mean.

mod builder;
mod hand;
mod palette;
#[expect(clippy::module_inception, reason = "the type that names the module has a file of its own")]
mod scene;
mod shapes;

pub use builder::SceneBuilder;
pub use hand::hand_mesh;
pub use palette::{Colour, Palette};
pub use scene::Scene;
pub use shapes::Globe;
pub use shapes::{
    Ball, Hand, Line, Planes, Shadow, SkinInstance, Solid, SphereShell, WeightColours,
};
pub use shapes::{Label, LabelSide};
