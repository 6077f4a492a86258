//! The parts of one iteration, in the order in which a method computes them.

mod recorder;
mod sub_step;
mod to_world;

pub(super) use recorder::{Event, LinkSegment, Recorder};
pub use sub_step::Ellipsoid;
pub use sub_step::{AngleChange, Column, Gradient, StepTaken, SubStep, SubStepKind, TipMove, Turn};
pub(super) use to_world::sub_steps;
