//! Pictures drawn without a window, compared with formulas and with those in `tests/golden`.
#![cfg(feature = "app")]

#[path = "../common/mod.rs"]
mod common;
mod crowd;
mod golden;
mod golden_inside;
mod golden_trouble;
mod gpu_timer;
mod labels;
mod pictures;
mod shaders;
mod shells;
mod skin_gpu;
mod smaller_pictures;
