//! Random documents and damaged files, the same on every run, with the random values of the
//! library's tests.
#![allow(dead_code, unused_imports, reason = "each program takes what it needs")]

pub mod arm;
pub mod damage;
pub mod documents;
#[path = "../../kinematics/tests/common/mod.rs"]
mod kinematics;
pub mod pictures;

pub use kinematics::{Random, all_cases, cases, missed_targets, skeletons, strategies};
