//! The tour: steps that each show a scene, ask a question, and notice when the user has done a task.

mod apply;
mod demonstration;
mod figures;
mod goal;
mod predicates;
mod step;
mod tour_action;
mod tour_state;

pub use figures::filled;
pub use goal::Goal;
pub use step::{Guess, TourEnd, TourStep};
pub use tour_action::TourAction;
pub use tour_state::TourState;
