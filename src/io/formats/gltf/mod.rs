//! glTF 2.0: export of the shown rig as a `.glb` file, import of skeletons from `.glb` and `.gltf`
//! files.
//!
//! # Export
//!
//! Lengths are in metres, times in seconds from the first frame. No node has a scale.
//!
//! ```text
//! Armature             identity transform; the skin's `skeleton`
//!  └ joints…           as in the document, or the arm's `upper` and `lower`: at the bone's base,
//!                      +y along the bone, x as near to the joint's own x as possible, or
//!                      for a bone along that to its z
//!     └ NAME_tip       at the tip of a bone that has no children or whose length changes
//! Limbs                the mesh: the skin, or without one a cone for each bone and balls at joints
//! ```
//!
//! Nodes are in the bind pose: the skeleton before any rotation, the arm straight along the Root's
//! +x. The document's pose is in the animation, with a key in every frame. Mirroring, stretching
//! and shear of a skeleton's transform become rotations and translations in the animation.
//!
//! # Import
//!
//! A skin's joints become a skeleton in the world, in metres, parents before their children, and so
//! do other nodes of their hierarchy that an animation moves. Without a skin, the joints are the
//! nodes that animations move, with their ancestors up to a common one. The nodes are the bind
//! pose: a joint's frame is its node's rotation. A joint that moves has the keys of its node in the
//! chosen animation, with their interpolation: rotations turn by slerp, step, or follow a spline of
//! angles that is as exact as single precision. Below scales that are uneven or change, joints have
//! keys at every frame. A node `NAME_tip` without children is not a joint but the tip of NAME's
//! bone. The other bones follow from the joints, see [`bones`](crate::io::bones).
//!
//! The meshes of the skin, and those of nodes below its joints, become the skin of the skeleton:
//! triangles, normals, weights, and base colours with their textures. Other meshes and channels of
//! materials and morph targets are not read, with one warning. If a mesh is damaged or compressed,
//! the whole skin is left out, with a warning.
//!
//! # Source
//!
//! *glTF 2.0 Specification*, The Khronos Group, 2021.

mod conversions;
mod export;
mod extras;
mod import;
mod names;

pub use export::{GlbError, glb};
pub use import::{former, read};

/// The key by which a file is recognized.
pub const KEY: &str = "asset";
