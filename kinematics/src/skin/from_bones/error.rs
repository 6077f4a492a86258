use crate::skeleton::JointId;
use crate::skin::SkinError;

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
