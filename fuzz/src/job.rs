use glam::{Affine3A, DMat3, DQuat, DVec3, Quat, Vec3};
use ik_arm::kinematics::job::{TwoBoneCorrection, TwoBoneJob};
use ik_arm::kinematics::two_bone::Reach;

use super::bits::Bits;
use super::opened::is_readable;

/// A job of any numbers: it is refused with a short message, or its two rotations bring the hand
/// to the reported position.
pub fn job(bits: &mut Bits<'_>) {
    let [start, middle, end] = [(); 3].map(|()| matrix(bits));
    let job = TwoBoneJob {
        pole: Some(bits.vector()),
        hinge: Some(bits.vector()),
        twist: bits.number(),
        softness: if bits.coin() { bits.number() } else { bits.part() },
        weight: if bits.coin() { 1.0 } else { bits.number() },
        ..TwoBoneJob::new(start, middle, end, bits.vector())
    };
    // Any parent transform, often with a non-uniform scale.
    let parent = if bits.coin() { bits.matrix() } else { Affine3A::IDENTITY };
    let [start, middle, end] = [job.start, job.middle, job.end].map(|joint| parent * joint);
    let job = TwoBoneJob { start, middle, end, ..job };
    match job.run() {
        Ok(correction) => check(&job, correction),
        Err(error) => is_readable(&error.to_string()),
    }
}

/// Of any numbers, or one that can be a joint's.
fn matrix(bits: &mut Bits<'_>) -> Affine3A {
    if bits.byte() < 32 {
        return bits.matrix();
    }
    let scale = Vec3::splat(bits.number());
    let mirror = if bits.coin() { Vec3::new(-1.0, 1.0, 1.0) } else { Vec3::ONE };
    let (rotation, translation) = (bits.rotation(), bits.vector());
    Affine3A::from_scale_rotation_translation(scale * mirror, rotation, translation)
}

fn check(job: &TwoBoneJob, correction: TwoBoneCorrection) {
    let TwoBoneCorrection { start_correction: start, middle_correction: middle, reach, hand_error } =
        correction;
    for turn in [start, middle] {
        assert!(turn.is_normalized() && turn.w >= 0.0, "{correction:?} of {job:?}");
    }
    assert!((0.0..=f32::MAX).contains(&hand_error), "{correction:?} of {job:?}");
    if job.weight == 0.0 {
        assert_eq!([start, middle], [Quat::IDENTITY; 2]);
    }
    let Some(twin) = Twin::new(job, correction) else { return };
    let Twin { off, missed, length, size } = twin;
    let blur = 1e-6 * size * length + f64::from(f32::from_bits(4));
    let differs = (missed.min(f64::from(f32::MAX)) - f64::from(hand_error)).abs();
    assert!(differs <= blur + 1e-6 * missed, "{missed} away: {correction:?} of {job:?}");
    let is_there = off <= 1e-6 * length;
    assert!(reach != Reach::Reached || is_there, "{off} of {length}: {correction:?} of {job:?}");
}

/// Position of the hand, from the joints' matrices alone.
struct Twin {
    /// From the hand to the target, in start joint space and in model space.
    off: f64,
    missed: f64,
    /// Of the chain, in start joint space.
    length: f64,
    /// Of the start joint's axes together.
    size: f64,
}

impl Twin {
    /// `None` if a joint has no inverse or the position of the hand overflows.
    fn new(job: &TwoBoneJob, correction: TwoBoneCorrection) -> Option<Self> {
        let start = job.start.matrix3.as_dmat3();
        let middle = start.inverse() * job.middle.matrix3.as_dmat3();
        let places = [job.start, job.middle, job.end].map(|joint| joint.translation.as_dvec3());
        let upper = start.inverse() * (places[1] - places[0]);
        let lower = start.inverse() * (places[2] - places[1]);
        let turned: DVec3 =
            middle * (unit(correction.middle_correction) * (middle.inverse() * lower));
        let hand = unit(correction.start_correction) * (upper + turned);
        let off = hand - start.inverse() * (job.target.as_dvec3() - places[0]);
        hand.is_finite().then(|| Self {
            off: off.length(),
            missed: (start * off).length(),
            length: upper.length() + lower.length(),
            size: size(start),
        })
    }
}

/// Their Frobenius norm.
fn size(axes: DMat3) -> f64 {
    axes.to_cols_array().map(|x| x * x).into_iter().sum::<f64>().sqrt()
}

fn unit(turn: Quat) -> DQuat {
    turn.as_dquat().normalize()
}
