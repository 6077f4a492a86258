//! glTF 2.0: export of the shown rig as a `.glb` file, import of skeletons from `.glb` and `.gltf`
//! files.
//!
//! # Export
//!
//! Lengths are metres, times seconds from 0. No node has a scale.
//!
//! ```text
//! Armature             identity; skin.skeleton
//!  └ joints…           as in the document, or the arm's `upper` and `lower`: at the bone's base,
//!                      +y along the bone, x as near to the joint's own as possible
//!     └ NAME_tip       at the tip of a bone without children, or of a keyed length
//! Limbs                the mesh: a cone for each bone, balls at joints; skinned
//! ```
//!
//! Nodes are in the bind pose: the skeleton before any rotation, the arm straight along the Root's
//! +x. The document's pose is in the animation, with a key in every frame; mirroring, stretching
//! and shear of a skeleton's transform become rotations and translations in it.
//!
//! # Import
//!
//! A skin's joints become a skeleton in the world, in metres, parents before their children. The
//! nodes are the bind pose: a joint's frame is its node's rotation. Keys are at every frame of the
//! first animation; where lengths or scales change, a joint's offset has keys. `NAME_tip` without
//! children is the tip of NAME's bone. Meshes, materials and cameras are ignored.
//!
//! # Source
//!
//! *glTF 2.0 Specification*, The Khronos Group, 2021.

pub(super) mod chunks;
mod export;
mod frame;
mod import;
mod names;

pub use export::{GlbError, glb};
pub use import::read;
