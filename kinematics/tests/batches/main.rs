//! Many arms at once, on all cores with the feature `parallel` and on one without it.

mod batch;
#[path = "../common/mod.rs"]
mod common;
mod crowd;
