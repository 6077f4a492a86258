//! Files: documents in the program's own format, Scotty3D's skeletons, and skeletons with their
//! motions in glTF (`.gltf`, `.glb`) and BVH in; documents, [glTF](glb), [BVH](to_bvh) and
//! [tables](to_csv) out; and the [lines](solve_line) of `ik-arm solve`.
//!
//! What is wrong in a file is said with its line, its column (of a text), the path of the field, and
//! what would be right: see [`OpenError`]. What is only odd is a [`Remark`] beside the document. What
//! a file made of a document cannot say is in the notes of [`Exported`].
//!
//! Files are written whole or not at all, by [`write()`], [`write_with`] and [`FileBatch`]; nothing else
//! writes to the disk.

mod bvh;
mod csv;
pub(crate) mod error;
mod examples;
mod field_error;
mod file_batch;
mod format;
mod frames;
mod gltf;
mod js3d;
mod json_path;
mod json_style;
mod line;
mod motion;
mod open;
mod opened;
mod progress;
mod source;
mod translation;
pub(crate) mod value;
mod write;

pub use bvh::{BvhUnit, to_bvh};
pub use csv::to_csv;
pub use error::{OpenError, Remark, SaveError, WriteError};
pub use examples::{Example, Group, new_document};
pub use file_batch::FileBatch;
pub use format::{save, to_json};
pub use frames::{Frames, Playback};
pub use gltf::{GlbError, glb};
pub use line::{Answer, LineError, PreviousLine, solve_line};
pub use motion::{Exported, MotionError};
pub use open::{open, parse, read};
pub use opened::Opened;
pub use progress::{Cancelled, Progress};
pub use write::{write, write_with};
