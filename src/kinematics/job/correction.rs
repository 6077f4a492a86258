use glam::{Quat, Vec3};

use crate::kinematics::two_bone::Reach;

/// Result of a [`TwoBoneJob`](super::TwoBoneJob): two rotations by which to multiply the joints' local
/// rotations on the right, q' = q · Δ.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TwoBoneCorrection {
    /// Δ₁ of the start joint; of unit length, w ≥ 0.
    pub start_correction: Quat,
    /// Δ₂ of the middle joint; of unit length, w ≥ 0.
    pub middle_correction: Quat,
    /// Position of the corrected hand relative to the target, in start joint space (in model space
    /// where the start joint has scale 0). [`Reach::Reached`] is within 7e-7 of the chain's length, of
    /// which a limit may use 2e-7. Any other hand (out of reach, softened, or not of full weight) is
    /// [`Reach::TooClose`] where it is farther from the start joint than the target, else
    /// [`Reach::TooFar`].
    pub reach: Reach,
    /// Distance from the corrected hand to the target in model space, in the matrices' unit.
    pub hand_error: f32,
}

impl TwoBoneCorrection {
    /// The correction for joints whose own scale mirrors one or two axes, such as (−1, 1, 1).
    ///
    /// A local transform is translation · rotation · scale: a rotation that follows the scale must be
    /// mirrored to precede it. Only the signs of the scales count.
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
