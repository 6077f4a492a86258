use crate::document::Document;
use crate::kinematics::skeleton::JointId;

/// A baked document, and what the bake cost.
#[derive(Clone, Debug, PartialEq)]
pub struct Baked {
    /// The document with the keys. Its targets have no influence in the range, and its skeleton
    /// follows no path.
    pub document: Document,
    /// Number of keys at every frame, before keys were removed.
    pub keys_at_frames: usize,
    /// Number of keys that are left.
    pub keys: usize,
    /// Largest distance of a base or tip from its evaluated position at a frame, in the world. Tips
    /// of shortened bones are compared at their own length.
    pub error: f32,
    /// Bones that targets stretch. They keep their own length in the baked document.
    pub shortened: Vec<ShortenedBone>,
}

/// A bone that cannot keep the length that a target gives it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShortenedBone {
    /// The bone's joint.
    pub joint: JointId,
    /// Largest distance of its tip from the evaluated position at a frame, in the world.
    pub error: f32,
}
