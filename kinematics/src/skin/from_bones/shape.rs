use glam::Vec3;

use crate::skeleton::{JointId, Skeleton};
use crate::skin::SkinError;

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

/// No skin can be made from these bones.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SkinShapeError {
    /// The detail is outside its range.
    #[error("skin detail must be from 1.2 to 16, got {0}")]
    Detail(f32),
    /// The thickness is not above 0.
    #[error("skin thickness must be finite and above 0, got {0}")]
    Thickness(f32),
    /// There are too many blobs.
    #[error("a skin must have at most 4096 blobs, got {0}")]
    TooManyBlobs(usize),
    /// A blob is on a joint that does not exist.
    #[error("the joint of blob {blob} must be below {joints}, got {}", got.index())]
    BlobJoint {
        /// Index of the blob.
        blob: usize,
        /// Number of joints.
        joints: usize,
        /// The joint that does not exist.
        got: JointId,
    },
    /// A blob's centre is not finite, or a radius is not finite and above 0.
    #[error("centres and radii of blob {blob} must be finite, and the radii above 0")]
    Blob {
        /// Index of the blob.
        blob: usize,
    },
    /// No joint has a radius above 0, and there are no blobs.
    #[error("a skin from bones needs a joint with a radius above 0, and there is none")]
    NoRadius,
    /// Sizes differ so much that the grid would not be able to tell them apart.
    #[error("the bones must be less than {most} times as long as thick, got {got:.0}")]
    TooThin {
        /// Greatest ratio.
        most: f64,
        /// Ratio of the size of the skeleton to the smallest radius.
        got: f64,
    },
    /// The surface has numbers that are not finite, because the bones are near the limit of `f32`.
    #[error(transparent)]
    NotFinite(#[from] SkinError),
}
