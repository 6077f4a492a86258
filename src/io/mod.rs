//! Files. [`open`] reads documents, Scotty3D scenes, glTF and BVH; [`save`], [`glb`],
//! [`to_bvh`], [`to_csv`] and [`to_obj`] write; [`solve_line`] answers the lines of `ik-arm solve`.
//! [`FileFormat::ALL`] is the table of formats, from which texts about them are made; docs/files.md
//! describes their content.
//!
//! An [`OpenError`] names the line, the column, the field, the rule and the value. Warnings about a
//! file that can be opened all the same are [`Remark`]s in [`Opened`]. Content that an export
//! cannot hold is listed in the notes of [`Exported`].
//!
//! Files are written whole or not at all, by [`write()`], [`write_with`] and [`FileBatch`]. No
//! other code writes documents or exports.

mod bones;
pub(crate) mod error;
mod examples;
mod exported;
mod file_batch;
mod foreign;
mod formats;
mod frame_rate;
mod frames;
mod glb_chunks;
mod json;
mod open;
mod opened;
mod packed;
mod regular_file;
mod skin_file;
mod solve_line;
mod source;
mod temporary_file;
mod texture;
mod write;

#[cfg(feature = "app")]
pub(crate) use error::system_reason;
pub use error::{OpenError, Remark, SaveError, WriteError};
pub use examples::{Example, Group, new_document};
pub use exported::{BvhUnit, Cancelled, ExportKind, ExportOption, ExportOptions};
pub use exported::{Exported, MotionError, Progress};
pub use file_batch::FileBatch;
pub use formats::bvh::to_bvh;
pub use formats::csv::to_csv;
pub use formats::document::{save, to_json};
pub use formats::gltf::{GlbError, glb};
pub use formats::obj::{ObjError, to_obj};
pub use formats::{ContentError, FileFormat, WriteContent, Writer};
#[cfg(feature = "app")]
pub(crate) use formats::{dotted, enumerated};
pub use frames::ExportFrames;
pub use open::{open, parse, read};
pub use opened::{FileAnimation, OpenOptions, Opened, Upwards};
pub use regular_file::FileStamp;
#[cfg(feature = "app")]
pub(crate) use regular_file::read_text;
pub use skin_file::relocated_skin;
pub use solve_line::{Answer, LineError, PreviousLine, solve_line};
pub use texture::{texture_pixels, undrawn_textures};
pub use write::{write, write_with};
