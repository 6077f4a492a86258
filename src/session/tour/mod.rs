//! The tour: steps that each show a scene, ask a question, and notice when the user has done a
//! task.

mod apply;
mod figures;
mod goals;
mod state;
mod steps;

pub use figures::filled;
pub use state::{TourAction, TourState};
pub use steps::{Goal, Guess, TourEnd, TourStep};
