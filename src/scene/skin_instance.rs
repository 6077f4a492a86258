use glam::Vec3;

use super::Colour;
use crate::kinematics::Shared;
use crate::kinematics::skeleton::JointId;
use crate::kinematics::skin::{SkinPose, Skinning};
use crate::rig::AttachedMesh;

/// A skin in a pose.
#[derive(Clone, Debug, PartialEq)]
pub struct SkinInstance {
    /// The mesh. Clones of one mesh are sent to the device once.
    pub mesh: Shared<AttachedMesh>,
    /// How the joints move the mesh.
    pub pose: Shared<SkinPose>,
    /// How the joints of a vertex are blended.
    pub skinning: Skinning,
    /// Offset in the world.
    pub offset: Vec3,
    /// Colour of the surface, with opacity. Where a see-through skin overlaps itself, only its nearest
    /// surface is drawn.
    pub colour: Colour,
    /// Colour of the edges of the triangles; `None` hides them.
    pub wireframe: Option<Colour>,
    /// The joint whose weights colour the surface; `None` for the plain colour.
    pub weights_of: Option<JointId>,
}
