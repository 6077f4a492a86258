//! What allocates memory, and how much.

mod chain_ik;
#[path = "../common/mod.rs"]
mod common;
#[cfg(feature = "app")]
mod render;
mod scene;
mod sharing;
