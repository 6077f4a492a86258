use glam::{Quat, Vec3};

use super::fast_path::Solved;
use crate::two_bone::Reach;

/// Result of a [`TwoBoneJob`](super::TwoBoneJob): two rotations that multiply the joints' local
/// rotations on the right, q' = q · Δ.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TwoBoneCorrection {
    /// Δ₁, the correction of the start joint: a unit quaternion with w ≥ 0.
    pub start_correction: Quat,
    /// Δ₂, the correction of the middle joint: a unit quaternion with w ≥ 0.
    pub middle_correction: Quat,
    /// Whether the corrected hand reaches the target, measured in start joint space (in model space
    /// if the start joint has scale 0). [`Reach::Reached`] means within 7e-7 of the chain's length;
    /// a limit may keep the hand at most 2e-7 of the chain's length from the target. Any other hand
    /// (out of reach, softened, or with a weight below 1) is [`Reach::TooClose`] if it is farther
    /// from the start joint than the target is, else [`Reach::TooFar`].
    pub reach: Reach,
    /// Distance from the corrected hand to the target in model space, in the unit of the job's
    /// matrices.
    pub hand_error: f32,
}

impl TwoBoneCorrection {
    /// The correction for joints whose own scale mirrors one or two axes, such as (−1, 1, 1).
    ///
    /// A local transform is translation · rotation · scale, and the job's correction follows the
    /// scale. The returned correction precedes the scale, next to the rotation, for which it is
    /// mirrored. Only the signs of the scales count.
    #[must_use]
    pub fn before_scales(self, start_scale: Vec3, middle_scale: Vec3) -> Self {
        let before = |turn: Quat, scale: Vec3| {
            let Vec3 { x, y, z } = scale.signum();
            Quat::from_xyzw(turn.x * y * z, turn.y * z * x, turn.z * x * y, turn.w)
        };
        Self {
            start_correction: before(self.start_correction, start_scale),
            middle_correction: before(self.middle_correction, middle_scale),
            ..self
        }
    }
}

impl From<Solved> for TwoBoneCorrection {
    fn from(solved: Solved) -> Self {
        Self {
            start_correction: Quat::from_array(solved.start_correction),
            middle_correction: Quat::from_array(solved.middle_correction),
            reach: solved.reach(),
            hand_error: solved.hand_error,
        }
    }
}
