//! Files: documents in the program's own format and Scotty3D's skeletons in, documents out.
//!
//! What is wrong in a file is said with its line, its column, the path of the field, and what would
//! be right: see [`OpenError`]. What is only odd is a [`Remark`] beside the document.

pub(crate) mod error;
mod examples;
mod field;
mod format;
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
pub use open::{Opened, open, parse, read};
pub use progress::{Cancelled, Progress};
pub use write::write;
