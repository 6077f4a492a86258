//! The file formats.

pub mod bvh;
pub mod csv;
pub mod document;
mod file_format;
pub mod gltf;
pub mod js3d;
pub mod obj;

pub use file_format::FileFormat;
