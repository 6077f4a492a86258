//! Random values of all kinds, the same on every run, for tests, benches and examples.
#![allow(dead_code, unused_imports, reason = "each program takes what it needs")]

pub mod missed_targets;
mod random;
pub mod skeletons;
pub mod strategies;

pub use random::Random;
