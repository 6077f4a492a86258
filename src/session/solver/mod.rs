//! Solver runs, their comparison, and what an iteration does inside.

pub mod edits;
pub mod iterates;
pub mod run;
pub mod solvers;
pub mod status;
pub mod wiggle;
