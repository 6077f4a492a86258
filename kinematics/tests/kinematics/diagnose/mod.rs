//! Why targets are not reached, and what helps.

mod chains;
mod rigs;
mod turns;

/// Number of random rigs for each cause, and of those for which the first cause must be right.
const CASES: usize = 100;
const ENOUGH: usize = 95;
