use glam::{Affine3A, DQuat, DVec3, Quat, Vec3};

use super::chain::JointChain;
use super::correction::TwoBoneCorrection;
use super::error::{JobError, JobField};
use super::stages;
use crate::kinematics::saturate::saturate;
use crate::kinematics::soft_reach::SoftReach;
use crate::kinematics::two_bone::Reach;

/// Three joints of a skeleton, a target for the last, and how to reach it. The result is a
/// [`TwoBoneCorrection`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TwoBoneJob {
    /// The start joint (shoulder, hip), in model space.
    pub start: Affine3A,
    /// The middle joint (elbow, knee), in model space.
    pub middle: Affine3A,
    /// The end joint (hand, foot), in model space. Only its translation is used.
    pub end: Affine3A,
    /// Target of the end joint, a point in model space.
    pub target: Vec3,
    /// Direction (not a point) of the middle joint from the line to the target, in model space; any
    /// length. For a pole that is a point, give that point less the start joint's. Without one, or
    /// with length 0, the start joint makes the least rotation.
    pub pole: Option<Vec3>,
    /// Axis about which a positive turn opens the middle joint, in the middle joint's space; any
    /// length. Without one, or with length 0, the limb keeps the side to which it is bent.
    pub hinge: Option<Vec3>,
    /// Angle of the limb about the line from start to target, from the pole (without one, from the
    /// least rotation): radians, right-handed from start to target in start joint space.
    /// Where that is mirrored in the model, it is left-handed there.
    pub twist: f32,
    /// Softness s of the limits, from 0 to less than 1: see [`SoftReach`]. Bones do not stretch.
    pub softness: f32,
    /// Fraction of the correction, from 0 (exactly none) to 1.
    pub weight: f32,
}

/// A correction of weight 1.
#[derive(Default)]
struct FullCorrection {
    /// Δ₁ and Δ₂.
    start: DQuat,
    middle: DQuat,
    /// Distance that the hand stays from the target, in lengths of the chain.
    left: f64,
}

impl TwoBoneJob {
    /// A job of weight 1 with hard limits, without pole, hinge and twist.
    pub fn new(start: Affine3A, middle: Affine3A, end: Affine3A, target: Vec3) -> Self {
        Self {
            start,
            middle,
            end,
            target,
            pole: None,
            hinge: None,
            twist: 0.0,
            softness: 0.0,
            weight: 1.0,
        }
    }

    /// Computes the correction.
    ///
    /// # Errors
    ///
    /// [`JobError`] for numbers that are not finite, a start joint whose matrix has no inverse, a
    /// middle joint whose axes, in start joint space, differ in length or from perpendicular by more
    /// than one in a thousand (scale 0 of either is accepted), a softness outside [0, 1) and a weight
    /// outside [0, 1].
    pub fn run(&self) -> Result<TwoBoneCorrection, JobError> {
        let soft_reach = self.checked()?;
        let chain = JointChain::new([self.start, self.middle, self.end])?;
        let full = self.solve(&chain, soft_reach).unwrap_or_default();
        let part = |turn| stages::weight(turn, self.weight.into()).as_quat();
        Ok(self.measured(&chain, part(full.start), part(full.middle), full.left))
    }

    /// The correction of weight 1; `None` where there is nothing to turn.
    fn solve(&self, chain: &JointChain, soft_reach: SoftReach) -> Option<FullCorrection> {
        let limb = chain.limb()?;
        let target_ss = chain.point_ss(self.target.as_dvec3()) / limb.unit;
        let pole = self.pole.map(|pole| chain.vector_ss(pole.as_dvec3()));
        let pole_ss = pole.and_then(DVec3::try_normalize);
        let hinge = self.hinge.and_then(|hinge| hinge.as_dvec3().try_normalize());
        let hinge_ss = hinge.map(|axis| chain.middle_turn * axis);

        let distance = stages::soften(&limb, target_ss.length(), soft_reach);
        let bend = stages::middle_joint(&limb, distance, hinge_ss, pole_ss);
        let towards_ss = target_ss.try_normalize().or(limb.hand_ss().try_normalize());
        Some(FullCorrection {
            start: stages::start_joint(&bend, towards_ss, pole_ss, self.twist.into()),
            middle: chain.middle_turn.inverse() * bend.turn_ss * chain.middle_turn,
            left: (target_ss.length() - distance).abs(),
        })
    }

    /// The correction with the reach of the hand, by the rotations as they are returned.
    fn measured(
        &self,
        chain: &JointChain,
        start: Quat,
        middle: Quat,
        left: f64,
    ) -> TwoBoneCorrection {
        // Rounding of the middle joint's axes and of the rotations to f32; and of the limits alone.
        const NEAR: f64 = 7e-7;
        const AT_LIMIT: f64 = 2e-7;
        let target_ss = chain.point_ss(self.target.as_dvec3());
        let hand_ss = chain.hand_ss(start.as_dquat(), middle.as_dquat());
        let off_ss = hand_ss - target_ss;
        let reach = if off_ss.length() <= NEAR * chain.length_ss() && left <= AT_LIMIT {
            Reach::Reached
        } else if hand_ss.length() > target_ss.length() {
            Reach::TooClose
        } else {
            Reach::TooFar
        };
        let hand_error = saturate(chain.length_in_model(off_ss));
        TwoBoneCorrection { start_correction: start, middle_correction: middle, reach, hand_error }
    }

    /// The soft limits, of finite numbers in their ranges.
    fn checked(&self) -> Result<SoftReach, JobError> {
        let are_finite = [
            (JobField::Start, self.start.is_finite()),
            (JobField::Middle, self.middle.is_finite()),
            (JobField::End, self.end.translation.is_finite()),
            (JobField::Target, self.target.is_finite()),
            (JobField::Pole, self.pole.is_none_or(Vec3::is_finite)),
            (JobField::Hinge, self.hinge.is_none_or(Vec3::is_finite)),
        ];
        if let Some((field, _)) = are_finite.into_iter().find(|(_, is_finite)| !is_finite) {
            return Err(JobError::NotFinite { field });
        }
        if !self.twist.is_finite() {
            return Err(out_of_range(JobField::Twist, self.twist, "a finite number"));
        }
        if !(0.0..=1.0).contains(&self.weight) {
            return Err(out_of_range(JobField::Weight, self.weight, "from 0 to 1"));
        }
        SoftReach::new(self.softness, 1.0, 0.0)
            .map_err(|error| out_of_range(JobField::Softness, error.value, error.range))
    }
}

fn out_of_range(field: JobField, value: f32, range: &'static str) -> JobError {
    JobError::OutOfRange { field, value, range }
}
