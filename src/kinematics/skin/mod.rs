//! Skins: triangle meshes that follow the joints of a skeleton.
//!
//! Each vertex has weights w_i for up to four joints. With the joint transforms X_i in skeleton space
//! and the inverse bind transforms B_i⁻¹, which map mesh space to joint space in the pose in which the
//! mesh was attached, each joint moves the mesh by J_i = X_i·B_i⁻¹. [`Skinning`] says how the J_i of a
//! vertex are blended:
//!
//! - **Linear**: v' = Σ w_i J_i v, normals by the cofactors of Σ w_i J_i. Between two joints that are
//!   twisted by 180° against each other the mesh collapses to a point (the candy wrapper).
//! - **Dual quaternions**: J_i = q̂_i·S_i with a rigid motion q̂_i and a scale S_i. The scales are blended
//!   linearly first: v_s = Σ w_i S_i v. The rigid motions are then blended as unit dual quaternions, each
//!   negated first if it points away from the heaviest joint's. Keeps the volume under twist and bulges a little at
//!   bends.
//! - **Spread twist**: the roll τ of each joint about its bone is spread along the bone: a vertex at the
//!   fraction t of the bone gets t·τ, as from the twist joints of a rig. Blends linearly after that.
//!
//! [`SkinnedMesh::from_bones`] makes a skin for any skeleton from the radii of its joints.
//!
//! # Spaces
//!
//! Vertices are stored in mesh space; for a skin from bones, that is skeleton space in the bind pose. v' is
//! in skeleton space; the skeleton's own transform then brings it to the world.
//!
//! # Sources
//!
//! L. Kavan, S. Collins, J. Žára, C. O'Sullivan, *Geometric skinning with approximate dual quaternion
//! blending*, ACM TOG 27(4), 2008.

mod dual_quaternion;
mod error;
mod from_bones;
mod mesh_section;
mod roll;
mod skin_pose;
mod skinned_mesh;
mod skinning;
mod triangle_mesh;
mod vertex_weights;

pub use error::SkinError;
pub use from_bones::{Blob, SkinShape, SkinShapeError};
pub use mesh_section::MeshSection;
pub use skin_pose::{JointDeform, SkinPose};
pub use skinned_mesh::SkinnedMesh;
pub use skinning::{Skinning, UnknownSkinning};
pub use triangle_mesh::{MeshHit, TriangleMesh};
pub use vertex_weights::VertexWeights;
