//! Files that the program reads and writes, compared with readers and writers of the tests.

mod bvh;
#[path = "../common/mod.rs"]
mod common;
mod csv;
mod document_format;
mod document_versions;
mod foreign;
mod format_round_trips;
mod gltf;
mod js3d;
mod obj;
#[cfg(unix)]
mod saving;
mod skin_files;
mod urdf;
mod version_2_tables;
