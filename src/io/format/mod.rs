//! The program's own format: JSON, described in docs/files.md field by field.
//!
//! A text of version 1 is [translated](version_1) to the names of version 2. serde parses the text
//! to [fields](file::DocumentFields), where `None` stands for what the file leaves out; these
//! become a document with defaults filled in and [ranges checked](check). Saving goes the same way
//! back.

mod arm;
mod camera;
mod check;
mod file;
mod header;
mod keys;
mod read;
mod save;
mod skeleton;
mod targets;
mod version_1;

pub use read::read;
pub use save::{save, to_json};
