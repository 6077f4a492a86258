//! Start joints with any matrix that has an inverse: sheared, unevenly scaled, mirrored.
//!
//! The matrices of a job are taken as they are, in f32. The skeleton is posed anew from them in
//! f64.

use glam::{Affine3A, DAffine3, DMat3, DVec3, Mat3, Quat, Vec3};
use ik_arm_kinematics::job::{TwoBoneCorrection, TwoBoneJob};
use ik_arm_kinematics::two_bone::Reach;

use crate::common::Random;
use crate::two_bone_job::skeleton::*;

/// The chain by its matrices alone, in start joint space.
struct Twin {
    start: DAffine3,
    /// The middle joint, and the end's position in its space.
    middle_ss: DAffine3,
    end_ms: DVec3,
    target_ss: DVec3,
    upper: f64,
    lower: f64,
}

impl Twin {
    fn new(job: &TwoBoneJob) -> Self {
        let [start, middle, end] = [job.start, job.middle, job.end].map(as_f64);
        let middle_ss = start.inverse() * middle;
        let end_ms = middle.inverse().transform_point3(end.translation);
        let target_ss = start.inverse().transform_point3(job.target.as_dvec3());
        let elbow = middle_ss.translation;
        let lower = middle_ss.transform_point3(end_ms).distance(elbow);
        Self { start, middle_ss, end_ms, target_ss, upper: elbow.length(), lower }
    }

    fn length(&self) -> f64 {
        self.upper + self.lower
    }

    /// The hand after a correction, in start joint space.
    fn hand_ss(&self, by: &TwoBoneCorrection) -> DVec3 {
        let [start, middle] =
            [by.start_correction, by.middle_correction].map(|turn| turn.as_dquat().normalize());
        let elbow = DAffine3::from_quat(start) * self.middle_ss;
        (elbow * DAffine3::from_quat(middle)).transform_point3(self.end_ms)
    }

    /// Returns whether the target is between the limits, clear of both by a millionth of the chain.
    fn is_in_reach(&self) -> bool {
        let (distance, clear) = (self.target_ss.length(), 1e-6 * self.length());
        let least = (self.upper - self.lower).abs();
        least + clear < distance && distance < self.length() - clear
    }

    /// The point in reach that is nearest to the target.
    fn nearest_ss(&self) -> DVec3 {
        let (least, distance) = ((self.upper - self.lower).abs(), self.target_ss.length());
        self.target_ss * (distance.clamp(least, self.length()) / distance)
    }
}

fn as_f64(joint: Affine3A) -> DAffine3 {
    DAffine3::from_mat3_translation(joint.matrix3.as_dmat3(), joint.translation.as_dvec3())
}

/// Any axes with an inverse: their longest radius over their shortest is up to `condition`.
fn axes(random: &mut Random, condition: f32) -> Mat3 {
    let half = condition.sqrt().ln();
    let stretch = [(); 3].map(|()| random.within(-half..half).exp());
    let turns = [random.rotation(), random.rotation()];
    let mirror = if random.chance(0.5) { -1.0 } else { 1.0 };
    let [x, y, z] = stretch;
    turns[0] * Mat3::from_diagonal(Vec3::new(x * mirror, y, z)) * turns[1]
}

/// A random chain and target under a start joint; `middle` are the middle joint's axes in its
/// space.
fn job(random: &mut Random, start: Mat3, middle: Mat3, share: f64) -> TwoBoneJob {
    let ratio = f64::from(random.within(-30_f32.ln()..30_f32.ln())).exp();
    let (upper, lower) = (ratio / (1.0 + ratio), 1.0 / (1.0 + ratio));
    let [u, l, way] = [(); 3].map(|()| random.direction().as_dvec3());
    let least = (upper - lower).abs();
    let target = way * (least + share * (1.0 - least));
    let place = random.vector(2.0);
    let at = |point: DVec3| (start.as_dmat3() * point).as_vec3() + place;
    let (elbow, hand) = (u * upper, u * upper + l * lower);
    TwoBoneJob {
        pole: Some(random.vector(1.0)),
        hinge: Some(if random.chance(0.2) { Vec3::ZERO } else { random.vector(1.0) }),
        twist: random.within(-4.0..4.0),
        ..TwoBoneJob::new(
            Affine3A::from_mat3_translation(start, place),
            Affine3A::from_mat3_translation(start * middle, at(elbow)),
            // Only its position is used.
            Affine3A::from_translation(at(hand)),
            at(target),
        )
    }
}

/// Axes of size 1, 2 or ½ in any order and with any signs: products with them are exact.
fn exact_axes(random: &mut Random) -> Mat3 {
    let mut columns = Vec3::AXES;
    columns.rotate_left(random.below(3));
    if random.chance(0.5) {
        columns.swap(0, 1);
    }
    let size = [0.5, 1.0, 2.0][random.below(3)];
    let [x, y, z] = columns.map(|axis| axis * if random.chance(0.5) { -size } else { size });
    Mat3::from_cols(x, y, z)
}

#[test]
fn under_every_start_matrix_with_an_inverse_the_hand_is_where_it_can_be() {
    let (mut random, mut worst, mut most, mut reached) = (Random(4), 0.0_f64, 0.0_f64, 0);
    for _ in 0..30_000 {
        let start = axes(&mut random, 1e3);
        let (middle, share) = (exact_axes(&mut random), random.within(-0.3..1.3));
        let job = job(&mut random, start, middle, share.into());
        let (twin, correction) = (Twin::new(&job), run(job));
        let (hand, nearest) = (twin.hand_ss(&correction), twin.nearest_ss());
        worst = worst.max(hand.distance(nearest) / twin.length());
        most = most.max(condition(start));

        let off = hand.distance(twin.target_ss) / twin.length();
        if twin.is_in_reach() {
            reached += 1;
            assert_eq!(correction.reach, Reach::Reached, "{job:?}");
        } else if off > 2.0 * EXACT {
            let is_beyond = twin.target_ss.length() > hand.length();
            let expected = if is_beyond { Reach::TooFar } else { Reach::TooClose };
            assert_eq!(correction.reach, expected, "{job:?}");
        }
        if correction.reach == Reach::Reached {
            assert!(off <= EXACT, "{off:e}: {job:?}");
        }
        let in_model = (twin.start.matrix3 * (hand - twin.target_ss)).length();
        let said = f64::from(correction.hand_error);
        let longest = twin.start.matrix3.to_cols_array().map(f64::abs).into_iter().sum::<f64>();
        assert!((said - in_model).abs() <= 1e-6 * (in_model + longest * twin.length()), "{job:?}");
    }
    println!("worst hand error: {worst:e} of the chain's length in start joint space");
    assert!(worst <= EXACT, "{worst:e}");
    assert!(most > 500.0 && reached > 10_000, "{most}, {reached}");
}

#[test]
fn the_rotations_under_a_start_matrix_are_those_under_none() {
    let (mut random, mut compared) = (Random(5), 0);
    while compared < 2_000 {
        // Small whole numbers, so that nothing is rounded on the way to model space.
        let mut whole = |size: f32| random.vector(size).round();
        let start = Mat3::from_cols(whole(4.0), whole(4.0), whole(4.0));
        let points = [(); 3].map(|()| whole(8.0));
        let [elbow, hand, target] = points;
        let (pole, hinge) = (whole(8.0), whole(8.0));
        let cross = |a: Vec3, b: Vec3| a.normalize_or_zero().cross(b.normalize_or_zero()).length();
        // Away from ill-conditioned cases: bones and pole in one line.
        let is_clear = cross(elbow, hand - elbow).min(cross(pole, target)) > 0.2;
        if start.determinant() == 0.0 || !is_clear {
            continue;
        }
        compared += 1;
        let under = |axes: Mat3| {
            let joint = |point: Vec3| Affine3A::from_mat3_translation(axes, axes * point);
            let job = TwoBoneJob::new(joint(Vec3::ZERO), joint(elbow), joint(hand), axes * target);
            run(TwoBoneJob {
                pole: Some(axes * pole),
                hinge: Some(hinge),
                twist: 0.7,
                softness: 0.2,
                ..job
            })
        };
        let (here, there) = (under(Mat3::IDENTITY), under(start));
        for (a, b) in [
            (here.start_correction, there.start_correction),
            (here.middle_correction, there.middle_correction),
        ] {
            let off = apart(a.as_dquat(), b.as_dquat());
            assert!(off < 1e-6, "{off:e} apart under {start}");
        }
        assert_eq!(here.reach, there.reach);
    }
}

#[test]
fn a_middle_joint_that_rounding_makes_uneven_is_not_reported_reached() {
    let (mut random, mut reached, mut missed) = (Random(6), 0, 0);
    for _ in 0..20_000 {
        let start = axes(&mut random, 1e3);
        let middle = Mat3::from_quat(Quat::from_mat3(&random.rotation()));
        let share = random.within(0.05..0.95);
        let job = job(&mut random, start, middle, share.into());
        let (twin, correction) = (Twin::new(&job), run(job));
        let off = twin.hand_ss(&correction).distance(twin.target_ss) / twin.length();
        // Rounding of the middle joint's axes, as start joint space magnifies it.
        let rounding = condition(start) * f64::from(f32::EPSILON);
        assert!(off <= EXACT + 4.0 * rounding, "{off:e}, {rounding:e}: {job:?}");
        if correction.reach == Reach::Reached {
            reached += 1;
            assert!(off <= EXACT, "{off:e}: {job:?}");
        } else if twin.is_in_reach() {
            missed += 1;
            assert!(rounding > 2e-7, "{off:e}, {rounding:e}: {job:?}");
        }
    }
    assert!(reached > 1_000 && missed > 1_000, "{reached}, {missed}");
}

/// Of Frobenius norms: at least the ratio of the longest radius to the shortest.
fn condition(axes: Mat3) -> f64 {
    let size = |axes: DMat3| axes.to_cols_array().map(|x| x * x).into_iter().sum::<f64>().sqrt();
    size(axes.as_dmat3()) * size(axes.as_dmat3().inverse())
}
