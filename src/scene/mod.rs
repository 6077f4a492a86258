//! What to draw: plain lists of solids, balls, shells, lines and labels, filled from a document.
//!
//! This module does not know how these things are drawn, and [`crate::render`] does not know what
//! they mean.

mod builder;
mod colour;
mod globe;
mod label;
mod palette;
mod planes;
#[expect(clippy::module_inception, reason = "the type that names the module has a file of its own")]
mod scene;
mod shapes;
mod skin_instance;

pub use builder::SceneBuilder;
pub use colour::Colour;
pub use globe::Globe;
pub use label::{Label, LabelSide};
pub use palette::Palette;
pub use planes::Planes;
pub use scene::Scene;
pub use shapes::{Ball, Line, Shadow, Solid, SphereShell};
pub use skin_instance::SkinInstance;
