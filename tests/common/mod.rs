//! Random values of all kinds, the same on every run, for tests, benches and examples.
#![allow(dead_code, unused_imports, reason = "each of them takes what it needs")]

#[cfg(feature = "document")]
pub mod damage;
#[cfg(feature = "document")]
pub mod documents;
pub mod missed_targets;
#[cfg(feature = "document")]
pub mod pictures;
mod random;
pub mod skeletons;
pub mod strategies;

pub use random::Random;
