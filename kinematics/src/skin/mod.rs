//! Skins: triangle meshes that follow the joints of a skeleton.
//!
//! Each vertex has weights w_i for up to four joints. X_i is the transform of joint i from its own
//! space to skeleton space. The bind pose is the pose in which the mesh was attached; there, the
//! inverse bind transform B_i⁻¹ maps mesh space to the joint's own space, where the joint stretches
//! it by S_i, see [`SkinStretch`](crate::skeleton::SkinStretch). So each joint moves the mesh by
//! J_i = X_i·S_i·B_i⁻¹. [`Skinning`] says how the J_i of a vertex are blended:
//!
//! - **Linear**: v' = Σ w_i J_i v, normals by the cofactors of Σ w_i J_i. Between two joints that
//!   are twisted by 180° against each other the mesh collapses to a point (the candy wrapper).
//! - **Dual quaternions**: J_i = q̂_i·D_i with a rigid motion q̂_i and a symmetric scale D_i. The scales
//!   are blended linearly first: v_s = Σ w_i D_i v. The rigid motions are then blended as unit dual
//!   quaternions. Of the two dual quaternions of a motion, ±q̂_i, the one on the side of the
//!   heaviest joint's is taken. Keeps the volume under twist and bulges a little at bends.
//! - **Spread twist**: a joint's roll τ is its rotation about its own bone. A vertex beside the
//!   bone, at the fraction t of its length, gets the roll t·τ instead of τ, as from the twist
//!   joints of a rig. The joints are then blended linearly.
//!
//! [Morph targets](Morph) change the shape of the mesh before its joints move it.
//!
//! [`SkinnedMesh::from_bones`] makes a skin for any skeleton from the radii of its joints,
//! [`SkinnedMesh::bound`] weights for any mesh from the joints that were placed in it.
//!
//! # Spaces
//!
//! Vertices are stored in mesh space; for a skin from bones, that is skeleton space in the bind
//! pose. v' is in skeleton space; the skeleton's own transform then brings it to the world.
//!
//! # Sources
//!
//! L. Kavan, S. Collins, J. Žára, C. O'Sullivan, *Geometric skinning with approximate dual
//! quaternion blending*, ACM TOG 27(4), 2008.

mod binding;
mod from_bones;
mod morph;
mod skin_pose;
mod skinned_mesh;
mod triangle_mesh;
mod vertex_weights;

pub use binding::BindError;
pub use from_bones::{Blob, BlobSphere, SkinShape, SkinShapeError};
pub use morph::Morph;
pub use skin_pose::{JointDeform, SkinPose, Skinning, UnknownSkinning};
pub use skinned_mesh::{BindSet, SkinError, SkinnedMesh};
pub use triangle_mesh::{MeshHit, MeshSection, TriangleMesh};
pub use vertex_weights::VertexWeights;
