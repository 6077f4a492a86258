//! One line of `ik-arm solve`, and the pose that answers it.

mod answer;
mod error;
mod previous;
mod reference;
mod request;
mod solve;

pub use answer::Answer;
pub use error::LineError;
pub use previous::PreviousLine;
pub use solve::solve_line;
