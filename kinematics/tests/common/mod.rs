//! Random values of all kinds, the same on every run, for tests, benches and examples.
#![allow(dead_code, unused_imports, reason = "each program takes what it needs")]

pub mod gradient;
pub mod missed_targets;
mod random;
pub mod skeletons;
pub mod strategies;

pub use random::Random;

/// Number of cases that a long test tries: a tenth of `all`, or all of them where
/// `IK_ARM_ALL_CASES` is set, as `scripts/soak.sh` does.
pub fn cases(all: usize) -> usize {
    if all_cases() { all } else { all.div_ceil(10) }
}

/// True if long tests try all their cases.
pub fn all_cases() -> bool {
    std::env::var_os("IK_ARM_ALL_CASES").is_some()
}
