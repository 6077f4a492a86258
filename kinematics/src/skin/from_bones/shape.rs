use glam::Vec3;

use super::error::SkinShapeError;
use crate::skeleton::{JointId, Skeleton};

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

    /// Checks the numbers, and that the joints of the blobs exist.
    ///
    /// # Errors
    ///
    /// [`SkinShapeError`] names the number and the rule.
    pub fn check(&self, skeleton: &Skeleton) -> Result<(), SkinShapeError> {
        let Self { detail, thickness, blobs } = self;
        if !(Self::LEAST_DETAIL..=Self::MOST_DETAIL).contains(detail) {
            return Err(SkinShapeError::Detail(*detail));
        }
        if !(thickness.is_finite() && *thickness > 0.0) {
            return Err(SkinShapeError::Thickness(*thickness));
        }
        if blobs.len() > Self::MOST_BLOBS {
            return Err(SkinShapeError::TooManyBlobs(blobs.len()));
        }
        let joints = skeleton.joints().len();
        for (index, blob) in blobs.iter().enumerate() {
            if blob.joint.index() >= joints {
                return Err(SkinShapeError::BlobJoint { blob: index, joints, got: blob.joint });
            }
            let is_radius = |radius: f32| radius.is_finite() && radius > 0.0;
            let is_sound = blob.base.is_finite()
                && blob.tip.is_finite()
                && is_radius(blob.base_radius)
                && is_radius(blob.tip_radius);
            if !is_sound {
                return Err(SkinShapeError::Blob { blob: index });
            }
        }
        Ok(())
    }
}

impl Default for SkinShape {
    fn default() -> Self {
        Self { detail: 2.0, thickness: 1.0, blobs: Vec::new() }
    }
}
