//! The tour: steps that each show a scene, ask a question, and notice when the user has done a
//! task.

mod figures;
mod goals;
pub mod state;
pub mod steps;

pub use figures::filled;
pub use state::{TourAction, TourState};
pub use steps::{Goal, Guess, TourEnd, TourStep};
