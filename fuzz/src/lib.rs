//! Properties that hold for any bytes: a function for each target, which panics if one does
//! not.
//!
//! The fuzzer calls them with bytes of its own, and `tests/corpora.rs` of the main package with
//! those that are kept here.

mod bits;
mod bvh;
mod chain;
mod document;
mod gltf;
mod job;
mod js3d;
mod json_lines;
mod obj;
mod opened;
mod two_bone;
mod urdf;

pub use bvh::bvh;
pub use chain::chain;
pub use document::document;
pub use gltf::gltf;
pub use js3d::js3d;
pub use json_lines::json_lines;
pub use obj::obj;
pub use two_bone::two_bone;
pub use urdf::urdf;
