use glam::Vec3;

use crate::kinematics::skeleton::JointId;

/// What a skin from bones is made of beside the skeleton.
#[derive(Clone, Debug, PartialEq)]
pub struct SkinShape {
    /// Cells of the grid on the smallest radius, from [`SkinShape::LEAST_DETAIL`] to
    /// [`SkinShape::MOST_DETAIL`]. Twice the detail gives four times the vertices.
    pub detail: f32,
    /// Factor of all radii, above 0.
    pub thickness: f32,
    /// Bodies beside the bones.
    pub blobs: Vec<Blob>,
}

/// A body beside a joint's bone, the convex hull of two spheres, for example a rib cage or a heel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blob {
    /// The joint that the blob moves with.
    pub joint: JointId,
    /// Centre of the first sphere, in the joint's own space.
    pub base: Vec3,
    /// Centre of the second sphere, in the joint's own space.
    pub tip: Vec3,
    /// Radius of the first sphere, in skeleton units.
    pub base_radius: f32,
    /// Radius of the second sphere, in skeleton units.
    pub tip_radius: f32,
}

impl SkinShape {
    /// The coarsest grid: no sphere falls between its points.
    pub const LEAST_DETAIL: f32 = 1.2;
    /// The finest grid.
    pub const MOST_DETAIL: f32 = 16.0;
    /// The most blobs.
    pub const MOST_BLOBS: usize = 4096;
}

impl Default for SkinShape {
    fn default() -> Self {
        Self { detail: 2.0, thickness: 1.0, blobs: Vec::new() }
    }
}
