//! Wavefront OBJ, `.obj`: meshes without joints, with materials in `.mtl` files.
//!
//! ```text
//! mtllib file.mtl            materials
//! v x y z [w] [r g b]        position, and a colour that some programs add
//! vt u [v]                   texture coordinates, origin at the lower left
//! vn x y z                   normal
//! usemtl name                material of the faces that follow
//! f v/vt/vn v/vt/vn …        face, by indices from 1, or from −1 backwards; vt and vn may be missing
//! ```
//!
//! # Import
//!
//! The mesh follows one joint, a root at the origin. Faces with more than three corners are cut into
//! triangles around their first corner. Missing normals are smooth. `Kd`, `d` (or `Tr`), `Ke` and
//! `map_Kd` of materials are read.
//!
//! # Export
//!
//! The posed mesh of the skin, without materials.
//!
//! Source: the specification of Wavefront, *Object Files (.obj)*,
//! <https://paulbourke.net/dataformats/obj/>.

mod material;
mod mesh;
mod read;
mod write;

pub use read::{is_obj, read};
pub use write::{ObjError, to_obj};
