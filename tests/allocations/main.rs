//! Allocations of memory, and their number.

mod chain_ik;
#[path = "../common/mod.rs"]
mod common;
#[cfg(feature = "app")]
mod render;
mod scene;
mod sharing;
