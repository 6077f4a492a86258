use glam::{Affine3A, DQuat, Quat, Vec3};
use multiversion::multiversion;

use super::chain::JointChain;
use super::error::{JobError, JobField};
use super::fast_path::{AT_LIMIT, FastPathJob, NEAR, Solved};
use super::stages;
use crate::soft_reach::SoftReach;
use crate::two_bone::Reach;
use crate::vector::saturate;

/// Three joints of a skeleton, a target for the end joint, and options for reaching it.
/// [`Self::run`] returns a [`TwoBoneCorrection`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TwoBoneJob {
    /// Transform of the start joint (shoulder, hip) to model space.
    pub start: Affine3A,
    /// Transform of the middle joint (elbow, knee) to model space.
    pub middle: Affine3A,
    /// Transform of the end joint (hand, foot) to model space. Only its translation is used.
    pub end: Affine3A,
    /// Target of the end joint, a point in model space.
    pub target: Vec3,
    /// Direction (not a point) from the line between start joint and target to the middle joint, in
    /// model space and of any length. For a pole that is a point, give the point minus the start
    /// joint's position. With `None` or length 0, the start joint turns by the smallest angle.
    pub pole: Option<Vec3>,
    /// Axis about which a positive turn opens the middle joint, in the middle joint's space and of
    /// any length. With `None` or length 0, the limb keeps the side to which it is bent.
    pub hinge: Option<Vec3>,
    /// Angle in radians by which the limb is turned about the line from the start joint to the
    /// target, measured from the pole or, without a pole, from the smallest turn of the start
    /// joint. It is right-handed about the direction to the target in start joint space, and so
    /// left-handed in model space if the start joint's matrix mirrors.
    pub twist: f32,
    /// Softness s of the limits of the reach, from 0 to less than 1: see [`SoftReach`]. A job never
    /// stretches bones.
    pub softness: f32,
    /// Fraction of the correction to apply, from 0 (exactly none) to 1.
    pub weight: f32,
}

/// A correction of weight 1.
#[derive(Default)]
struct FullCorrection {
    /// Δ₁.
    start: DQuat,
    /// Δ₂.
    middle: DQuat,
    /// Distance from the target at which the limits keep the hand, in chain lengths.
    left: f64,
}

impl TwoBoneJob {
    /// A job of weight 1 without softness, pole, hinge and twist.
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
    /// middle joint whose axes, in start joint space, differ in length or deviate from
    /// perpendicular by more than one in a thousand (scale 0 of either joint is accepted), a
    /// softness outside [0, 1) and a weight outside [0, 1].
    pub fn run(&self) -> Result<TwoBoneCorrection, JobError> {
        match self.solve_on_fast_path() {
            Some(correction) => Ok(correction),
            None => self.solve_any(),
        }
    }

    /// The correction by the fast path, with the bits that a batch gives; `None` for a job that
    /// does not fit it.
    fn solve_on_fast_path(&self) -> Option<TwoBoneCorrection> {
        if self.softness != 0.0 || self.weight != 1.0 {
            return None;
        }
        let twist = f64::from(self.twist);
        let twist = if twist == 0.0 { [0.0, 1.0] } else { twist.sin_cos().into() };
        let solved = match self.pole {
            Some(_) => run_fast_path::<true>(self, twist),
            None => run_fast_path::<false>(self, twist),
        };
        solved.is_regular.then(|| solved.into())
    }

    /// The correction of any job, in steps.
    pub(super) fn solve_any(&self) -> Result<TwoBoneCorrection, JobError> {
        let soft_reach = self.checked()?;
        let chain = JointChain::new([self.start, self.middle, self.end])?;
        let full = self.solve(&chain, soft_reach).unwrap_or_default();
        let part = |turn| stages::weight(turn, self.weight.into()).as_quat();
        Ok(self.measured(&chain, part(full.start), part(full.middle), full.left))
    }

    /// The correction of weight 1; `None` if there is nothing to turn.
    fn solve(&self, chain: &JointChain, soft_reach: SoftReach) -> Option<FullCorrection> {
        let limb = chain.limb()?;
        let target_ss = chain.point_ss(self.target.as_dvec3()) * limb.inv_length;
        let target = target_ss.length();
        let pole_ss = self.pole.map(|pole| chain.vector_ss(pole.as_dvec3()));
        let hinge_ss = self.hinge.map(|axis| chain.axis_ss(axis.as_dvec3()));

        let distance = stages::soften(&limb, target, soft_reach);
        let bend = stages::middle_joint(&limb, distance, hinge_ss, pole_ss);
        let towards_ss =
            if target > 0.0 { Some(target_ss / target) } else { limb.hand_ss.try_normalize() };
        let turn = bend.turn_ss;
        let middle = chain.axis_in_middle(turn.xyz());
        Some(FullCorrection {
            start: stages::start_joint(&bend, towards_ss, pole_ss, self.twist.into()),
            middle: DQuat::from_vec4(middle.extend(turn.w)),
            left: (target - distance).abs(),
        })
    }

    /// The correction by two rotations in f32, with the reach of the hand that these rotations
    /// give.
    fn measured(
        &self,
        chain: &JointChain,
        start: Quat,
        middle: Quat,
        left: f64,
    ) -> TwoBoneCorrection {
        let target_ss = chain.point_ss(self.target.as_dvec3());
        let hand_ss = chain.hand_ss(start.as_dquat(), middle.as_dquat());
        let off_ss = hand_ss - target_ss;
        let near_ss = NEAR * chain.length_ss();
        let reach = if off_ss.length_squared() <= near_ss * near_ss && left <= AT_LIMIT {
            Reach::Reached
        } else if hand_ss.length_squared() > target_ss.length_squared() {
            Reach::TooClose
        } else {
            Reach::TooFar
        };
        let hand_error = saturate(chain.length_in_model(off_ss));
        TwoBoneCorrection { start_correction: start, middle_correction: middle, reach, hand_error }
    }

    /// Checks that all numbers are finite and in their ranges, and returns the soft limits.
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
            return Err(out_of_range(JobField::Twist, self.twist, "finite"));
        }
        if !(0.0..=1.0).contains(&self.weight) {
            return Err(out_of_range(JobField::Weight, self.weight, "from 0 to 1"));
        }
        SoftReach::new(self.softness, 1.0, 0.0)
            .map_err(|error| out_of_range(JobField::Softness, error.value, error.range))
    }
}

/// Solves a job without softness, with a weight of 1. `twist` is its sine and cosine.
#[multiversion(targets("x86_64+avx2"))]
fn run_fast_path<const POLE: bool>(job: &TwoBoneJob, twist: [f64; 2]) -> Solved {
    let TwoBoneJob { start, middle, end, target, pole, hinge, .. } = job;
    let job = FastPathJob {
        axes: [start, middle].map(|joint| joint.matrix3.as_dmat3()),
        joints: [start, middle, end].map(|joint| joint.translation.as_dvec3()),
        target: target.as_dvec3(),
        pole: pole.unwrap_or_default().as_dvec3(),
        hinge: hinge.unwrap_or_default().as_dvec3(),
        twist,
    };
    job.solve::<POLE>()
}

fn out_of_range(field: JobField, value: f32, range: &'static str) -> JobError {
    JobError::OutOfRange { field, value, range }
}

/// Result of a [`TwoBoneJob`](super::TwoBoneJob): two rotations that multiply the joints' local
/// rotations on the right, q' = q · Δ.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TwoBoneCorrection {
    /// Δ₁, the correction of the start joint: a unit quaternion with w ≥ 0.
    pub start_correction: Quat,
    /// Δ₂, the correction of the middle joint: a unit quaternion with w ≥ 0.
    pub middle_correction: Quat,
    /// True if the corrected hand reaches the target, measured in start joint space (in model space
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

#[cfg(test)]
mod tests {
    use glam::EulerRot;

    use super::*;

    /// A limb that is bent, with bones of similar lengths, under a scaled and mirrored joint.
    /// `turn` is any number.
    fn regular_job(turn: f32) -> TwoBoneJob {
        let local = |turn: f32, along: f32, scale: Vec3| {
            let rotation = Quat::from_euler(EulerRot::XYZ, turn, 0.3 * turn, 0.9);
            Affine3A::from_scale_rotation_translation(scale, rotation, along * Vec3::X)
        };
        let mirrored = if turn.sin() > 0.0 { Vec3::splat(2.0) } else { Vec3::new(-0.5, 1.0, 3.0) };
        let rotation = Quat::from_rotation_z(0.8 + 0.4 * turn.cos());
        let start = local(turn, 5.0, mirrored);
        let middle = start * Affine3A::from_rotation_translation(rotation, 0.7 * Vec3::X);
        let end = middle * Affine3A::from_translation(Vec3::new(0.4, 0.1, 0.0));
        let target =
            start.transform_point3(0.8 * Vec3::new(turn.sin(), turn.cos(), 0.4 * turn.sin()));
        let pole = Some(Vec3::new(0.2, -1.0, 3.0)).filter(|_| turn.cos() > 0.0);
        let hinge = Some(Vec3::Z).filter(|_| turn.cos() < 0.5);
        TwoBoneJob { pole, hinge, twist: turn, ..TwoBoneJob::new(start, middle, end, target) }
    }

    #[test]
    fn regular_jobs_take_the_fast_path() {
        for number in 0..1_000 {
            let job = regular_job(number as f32);
            assert!(job.solve_on_fast_path().is_some(), "{job:?}");
        }
    }

    #[test]
    fn jobs_near_a_special_case_do_not() {
        let job = regular_job(1.0);
        let straight = job.middle.translation - job.start.translation + job.middle.translation;
        let uneven = Affine3A::from_scale(Vec3::new(1.0, 2.0, 1.0));
        let far = |of: Affine3A| Affine3A { translation: of.translation + 1e8, ..of };
        for (why, job) in [
            ("softness", TwoBoneJob { softness: 0.1, ..job }),
            ("weight", TwoBoneJob { weight: 0.5, ..job }),
            ("straight", TwoBoneJob { end: Affine3A::from_translation(straight.into()), ..job }),
            ("target at the start", TwoBoneJob { target: job.start.translation.into(), ..job }),
            ("no scale", TwoBoneJob { start: Affine3A::from_scale(Vec3::ZERO), ..job }),
            ("not a similarity", TwoBoneJob { middle: uneven, ..job }),
            (
                "coarse coordinates",
                TwoBoneJob {
                    start: far(job.start),
                    middle: far(job.middle),
                    end: far(job.end),
                    ..job
                },
            ),
            (
                "pole towards the target",
                TwoBoneJob { pole: Some(job.target - Vec3::from(job.start.translation)), ..job },
            ),
            ("twist", TwoBoneJob { twist: f32::INFINITY, ..job }),
            ("hinge", TwoBoneJob { hinge: Some(Vec3::NAN), ..job }),
        ] {
            assert!(job.solve_on_fast_path().is_none(), "{why}");
        }
    }
}
