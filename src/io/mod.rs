//! Files: documents in the program's own format, Scotty3D's skeletons, and skeletons with their
//! motions in glTF (`.gltf`, `.glb`) in; documents, and the shown rig as [glTF](glb) out.
//!
//! What is wrong in a file is said with its line, its column (of a text), the path of the field, and
//! what would be right: see [`OpenError`]. What is only odd is a [`Remark`] beside the document.

pub(crate) mod error;
mod examples;
mod field;
mod format;
mod gltf;
mod js3d;
mod layout;
mod open;
mod progress;
mod source;
pub(crate) mod value;
mod write;

pub use error::{OpenError, Remark, SaveError, WriteError};
pub use examples::Example;
pub use format::{save, to_json};
pub use gltf::{GlbError, glb};
pub use open::{Opened, open, parse, read};
pub use progress::{Cancelled, Progress};
pub use write::write;
