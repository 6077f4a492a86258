//! The program's own format: JSON, described in docs/files.md field by field.
//!
//! A text of version 1 is [translated](version_1) to the names of version 2. serde parses the text
//! to [fields](file::DocumentFields), where `None` stands for a field that the file leaves out. The
//! fields are converted to a document: missing fields get defaults, and [ranges are
//! checked](check). Saving converts the document to fields, and serde writes the fields as text.

mod arm;
mod camera;
mod check;
mod file;
mod follow_path;
mod header;
mod key;
mod keys;
mod mesh_skin;
mod read;
mod save;
mod skeleton;
mod skin;
mod soft_reach;
mod targets;
mod version_1;

pub use key::KeyFields;
pub use read::read;
pub use save::{save, to_json};
