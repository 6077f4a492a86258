//! A skeleton of three joints as other programs have it, posed in f64 from local transforms.

use glam::{Affine3A, DAffine3, DQuat, DVec3, Quat};
use ik_arm_kinematics::job::{TwoBoneCorrection, TwoBoneJob};
use ik_arm_kinematics::two_bone::Reach;
use proptest::prelude::*;
use proptest::test_runner::TestCaseResult;

use crate::common::Random;

/// Error of a hand in units of the chain's length.
pub const EXACT: f64 = 1e-6;

/// A stored transform: translation, then rotation, then scale.
#[derive(Clone, Copy, Debug)]
pub struct Local {
    pub translation: DVec3,
    pub rotation: DQuat,
    pub scale: DVec3,
}

impl Local {
    pub fn at(translation: DVec3) -> Self {
        Self { translation, rotation: DQuat::IDENTITY, scale: DVec3::ONE }
    }

    pub fn matrix(self) -> DAffine3 {
        DAffine3::from_scale_rotation_translation(self.scale, self.rotation, self.translation)
    }

    /// q' = q · Δ.
    pub fn turned(self, turn: Quat) -> Self {
        Self { rotation: self.rotation * turn.as_dquat(), ..self }
    }
}

/// Three joints, with one more between the first two.
#[derive(Clone, Copy, Debug)]
pub struct Skeleton {
    pub parent: DAffine3,
    pub start: Local,
    pub between: Local,
    pub middle: Local,
    pub end: Local,
}

impl Skeleton {
    /// Shoulder at the origin, elbow at (0, 1, 0), hand at (1, 1, 0), no joint turned.
    pub fn square() -> Self {
        Self {
            parent: DAffine3::IDENTITY,
            start: Local::at(DVec3::ZERO),
            between: Local::at(DVec3::ZERO),
            middle: Local::at(DVec3::Y),
            end: Local::at(DVec3::X),
        }
    }

    /// Two bones along +x.
    pub fn straight() -> Self {
        Self { middle: Local::at(DVec3::X), ..Self::square() }
    }

    pub fn random(random: &mut Random) -> Self {
        let ratio = f64::from(random.within(0.0..30_f32.ln())).exp();
        let (long, short) = (ratio / (1.0 + ratio), 1.0 / (1.0 + ratio));
        let (upper, lower) = if random.chance(0.5) { (long, short) } else { (short, long) };
        let mut local = |offset: f64| Local {
            translation: random.direction().as_dvec3() * offset,
            rotation: rotation(random),
            scale: scale(random),
        };
        let (start, between) = (local(0.5), local(0.2 * upper));
        let (middle, end) = (local(0.8 * upper / between.scale.x.abs()), local(1.0));
        let end_offset = lower / (between.scale.x * middle.scale.x).abs();
        let end = Local { translation: end.translation * end_offset, ..end };
        Self { parent: DAffine3::IDENTITY, start, between, middle, end }
    }

    pub fn joints(&self) -> [DAffine3; 3] {
        let start = self.parent * self.start.matrix();
        let middle = start * self.between.matrix() * self.middle.matrix();
        [start, middle, middle * self.end.matrix()]
    }

    pub fn points(&self) -> [DVec3; 3] {
        self.joints().map(|joint| joint.translation)
    }

    pub fn bones(&self) -> (f64, f64) {
        let [start, middle, end] = self.points();
        (start.distance(middle), middle.distance(end))
    }

    pub fn length(&self) -> f64 {
        self.bones().0 + self.bones().1
    }

    pub fn turned(&self, by: &TwoBoneCorrection) -> Self {
        Self {
            start: self.start.turned(by.start_correction),
            middle: self.middle.turned(by.middle_correction),
            ..*self
        }
    }

    /// Distance of the hand from a target after a correction, in start joint space and lengths of
    /// the chain there.
    pub fn off_ss(&self, by: &TwoBoneCorrection, target: DVec3) -> f64 {
        let [start, middle, end] = self.joints();
        let to_ss = start.inverse();
        let [elbow, hand] = [middle, end].map(|joint| to_ss.transform_point3(joint.translation));
        let turned = to_ss.transform_point3(self.turned(by).points()[2]);
        let length = elbow.length() + elbow.distance(hand);
        turned.distance(to_ss.transform_point3(target)) / length
    }

    pub fn job(&self, target: DVec3) -> TwoBoneJob {
        let [start, middle, end] = self.joints().map(|joint| {
            let axes = joint.matrix3.as_mat3();
            Affine3A::from_mat3_translation(axes, joint.translation.as_vec3())
        });
        TwoBoneJob::new(start, middle, end, target.as_vec3())
    }

    /// 4 ulp of the largest coordinate.
    pub fn rounding(&self) -> f64 {
        let largest = self.points().map(|point| point.abs().max_element());
        4.0 * f64::from(f32::EPSILON) * largest.into_iter().fold(0.0, f64::max)
    }

    /// Point at a fraction of the way from the inner to the outer limit.
    pub fn point_in_reach(&self, direction: DVec3, share: f64) -> DVec3 {
        let (upper, lower) = self.bones();
        let (least, most) = ((upper - lower).abs(), upper + lower);
        self.points()[0] + direction * (least + share * (most - least))
    }
}

pub fn rotation(random: &mut Random) -> DQuat {
    let axis = random.direction().as_dvec3();
    DQuat::from_axis_angle(axis, f64::from(random.within(-3.2..3.2)))
}

/// A uniform scale, sometimes mirrored.
pub fn scale(random: &mut Random) -> DVec3 {
    let size = f64::from(random.within(-1.0..1.0)).exp();
    DVec3::splat(if random.chance(0.2) { -size } else { size })
}

/// A random model transform: rotated, scaled, mirrored, translated by a multiple of its size.
pub fn model_transform(random: &mut Random, far: f32) -> DAffine3 {
    let size = 10_f64.powf(random.within(-3.0..3.0).into());
    let mirror = if random.chance(0.5) { DVec3::new(-1.0, 1.0, 1.0) } else { DVec3::ONE };
    let at = random.vector(far).as_dvec3() * size;
    DAffine3::from_scale_rotation_translation(mirror * size, rotation(random), at)
}

pub fn run(job: TwoBoneJob) -> TwoBoneCorrection {
    let correction = job.run().expect("a job that can be done");
    for turn in [correction.start_correction, correction.middle_correction] {
        let off = turn.as_dquat().length() - 1.0;
        assert!(turn.w >= 0.0 && off.abs() < 2e-7, "{turn} from {job:?}");
    }
    correction
}

/// The angle between two rotations; exact for little ones.
pub fn apart(a: DQuat, b: DQuat) -> f64 {
    let turn = a.normalize().inverse() * b.normalize();
    2.0 * turn.xyz().length().atan2(turn.w.abs())
}

pub fn close(what: &str, error: f64, bound: f64) -> TestCaseResult {
    prop_assert!(error <= bound, "{what} is off by {error:e}, more than {bound:e}");
    Ok(())
}

pub fn same_turn(found: Quat, axis: DVec3, angle: f64) {
    let expected = DQuat::from_axis_angle(axis, angle);
    let off = apart(expected, found.as_dquat());
    assert!(off < 1e-6, "{found} is {off} from {angle} about {axis}");
    assert!(found.w >= 0.0);
}

pub fn is_at(skeleton: &Skeleton, correction: &TwoBoneCorrection, target: DVec3) {
    let [_, _, hand] = skeleton.turned(correction).points();
    assert_eq!(correction.reach, Reach::Reached);
    assert!(hand.distance(target) < EXACT * skeleton.length(), "{hand}, not {target}");
}
