use glam::{Affine3A, DAffine3, DQuat, DVec3, Quat, Vec3};
use ik_arm::kinematics::job::{Correction, TwoBoneJob};
use ik_arm::kinematics::two_bone::Reach;

use super::bits::Bits;
use super::opened::is_readable;

/// A job of any numbers: it is refused in a few words, or two rotations come out that bring the hand
/// to where it is said to be.
pub fn job(bits: &mut Bits<'_>) {
    let [start, middle, end] = [(); 3].map(|()| matrix(bits));
    let job = TwoBoneJob {
        pole: bits.vector(),
        hinge: bits.vector(),
        twist: bits.number(),
        softness: if bits.coin() { bits.number() } else { bits.part() },
        weight: if bits.coin() { 1.0 } else { bits.number() },
        ..TwoBoneJob::new(start, middle, end, bits.vector())
    };
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

fn check(job: &TwoBoneJob, correction: Correction) {
    let Correction { start, middle, reach, hand_error } = correction;
    for turn in [start, middle] {
        assert!(turn.is_normalized() && turn.w >= 0.0, "{correction:?} of {job:?}");
    }
    assert!((0.0..=f32::MAX).contains(&hand_error), "{correction:?} of {job:?}");
    if job.weight == 0.0 {
        assert_eq!([start, middle], [Quat::IDENTITY; 2]);
    }
    let Some(twin) = twin(job, correction) else { return };
    let [from, to] = [job.target.as_dvec3(), twin.hand];
    let missed = from.distance(to);
    // What the matrices are off from being a rotation and a scale is felt twice.
    let blur = 1e-6 * twin.length + 4.0 * twin.rounding;
    let off = (missed.min(f64::from(f32::MAX)) - f64::from(hand_error)).abs();
    assert!(off <= blur + 1e-6 * missed, "{missed} away: {correction:?} of {job:?}");
    let is_there = missed <= 2e-6 * twin.length + 4.0 * twin.rounding;
    assert!(reach != Reach::Reached || is_there, "{missed} away: {correction:?} of {job:?}");
}

/// Where the hand goes, by the joints' matrices alone.
struct Twin {
    hand: DVec3,
    length: f64,
    /// An ulp of the largest coordinate.
    rounding: f64,
}

/// Nothing where a joint has no inverse, or the hand is farther than numbers go.
fn twin(job: &TwoBoneJob, correction: Correction) -> Option<Twin> {
    let [start, middle, end] = [job.start, job.middle, job.end].map(as_f64);
    let own = start.inverse() * middle;
    let of_middle = middle.inverse().transform_point3(end.translation);
    let turned = |joint: DAffine3, turn: Quat| joint * DAffine3::from_quat(unit(turn));
    let hand = turned(turned(start, correction.start) * own, correction.middle)
        .transform_point3(of_middle);
    let points = [start.translation, middle.translation, end.translation, job.target.as_dvec3()];
    let largest = points.into_iter().map(|point| point.abs().max_element()).fold(0.0, f64::max);
    let [upper, lower] = [(0, 1), (1, 2)].map(|(a, b)| points[a].distance(points[b]));
    let length = upper + lower;
    let rounding = largest * f64::from(f32::EPSILON) + f64::from(f32::from_bits(4));
    hand.is_finite().then_some(Twin { hand, length, rounding })
}

fn as_f64(joint: Affine3A) -> DAffine3 {
    DAffine3::from_mat3_translation(joint.matrix3.as_dmat3(), joint.translation.as_dvec3())
}

fn unit(turn: Quat) -> DQuat {
    turn.as_dquat().normalize()
}
