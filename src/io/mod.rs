//! Files. [`open`] reads documents, Scotty3D scenes, glTF, BVH, OBJ and URDF; [`save`], [`glb`],
//! [`to_bvh`], [`to_csv`] and [`to_obj`] write; [`solve_line`] answers the lines of `ik-arm solve`.
//! [`FileFormat::ALL`] is the table of formats, from which texts about them are made; docs/files.md
//! describes their content.
//!
//! An [`OpenError`] names the line, the column, the field, the rule and the value. Warnings about a
//! file that can be opened all the same are [`Remark`]s in [`Opened`]. Content that an export
//! cannot hold is listed in the notes of [`Exported`].
//!
//! Files are written whole or not at all, by [`write()`], [`NewFile`] and [`FileBatch`]. No
//! other code writes documents or exports.

mod bones;
#[cfg(not(target_arch = "wasm32"))]
mod disk;
mod error;
mod examples;
mod exported;
mod foreign;
mod formats;
mod frame_rate;
mod json;
mod link;
mod open;
mod opened;
mod packed;
#[cfg(target_arch = "wasm32")]
mod page;
mod solve_line;
mod source;
mod texture;
#[cfg(not(target_arch = "wasm32"))]
mod write;

#[cfg(target_arch = "wasm32")]
use page as disk;
#[cfg(target_arch = "wasm32")]
use page as write;

pub use disk::FileStamp;
#[cfg(all(feature = "app", not(target_arch = "wasm32")))]
pub(crate) use error::system_reason;
pub use error::{OpenError, Remark, SaveError, WriteError};
pub use examples::{Example, ExampleGroup};
pub use exported::{BvhUnit, Cancelled, ExportFrames, ExportKind, ExportOption, ExportOptions};
pub use exported::{Exported, MotionError, Progress};
pub use formats::bvh::to_bvh;
pub use formats::csv::to_csv;
pub use formats::document::{save, to_json};
#[cfg(feature = "app")]
pub(crate) use formats::dotted;
pub(crate) use formats::enumerated;
pub use formats::gltf::{GlbError, glb};
pub use formats::obj::{ObjError, to_obj};
pub use formats::{ContentError, ContentJob, FileFormat, WriteContent, Writer};
pub use link::{Link, LinkError, LinkScene};
pub use open::{open, parse, read, relocated_skin};
pub use opened::{FileAnimation, OpenOptions, Opened, Upwards};
#[cfg(target_arch = "wasm32")]
pub use page::keep;
pub use solve_line::{Answer, LineError, PreviousLine, solve_line};
#[cfg(all(feature = "app", not(target_arch = "wasm32")))]
pub(crate) use source::read_text;
pub use texture::{texture_pixels, undrawn_textures};
pub use write::{FileBatch, NewFile, write};
