//! A swing of one angle: the path of the tip and the line that the Jacobian predicts.

use glam::DVec3;
use ik_arm_kinematics::chain_ik::Swing;
use ik_arm_kinematics::skeleton::{JointId, RotationAxis, Skeleton};

use crate::common::Random;
use crate::common::skeletons::{forest, space_f64, transform};

const CASES: usize = 500;

/// A random skeleton with a swing of one of its joints, seen at the tip of a joint below.
fn cases(mut check: impl FnMut(&mut Random, &Skeleton, Swing)) {
    let mut random = Random(31);
    for _ in 0..CASES {
        let mut skeleton = forest(&mut random, 8);
        skeleton.set_transform(transform(&mut random)).expect("transform");
        let tip = JointId::new(random.below(8));
        let above: Vec<_> = skeleton.ancestors(tip).collect();
        let axis = random.one_of(&RotationAxis::ALL);
        let swing = Swing { joint: random.one_of(&above), axis, tip };
        check(&mut random, &skeleton, swing);
    }
}

/// The tip in the world by the formula in f64.
fn tip_f64(skeleton: &Skeleton, swing: Swing, by: f64) -> DVec3 {
    let mut angles: Vec<DVec3> =
        skeleton.iter().map(|(_, joint)| joint.rotation.as_dvec3()).collect();
    angles[swing.joint.index()][swing.axis.index()] += by;
    let tip = skeleton[swing.tip].axis.as_dvec3();
    let in_skeleton = space_f64(skeleton, swing.tip, &angles).transform_point3(tip);
    skeleton.transform().as_daffine3().transform_point3(in_skeleton)
}

/// A bound of all lengths in the world.
fn size(skeleton: &Skeleton) -> f64 {
    let scale = skeleton.transform().matrix3.determinant().abs().cbrt() * 3.0;
    let bones = skeleton.joints().iter().map(|joint| joint.axis.length() + joint.offset.length());
    f64::from(bones.sum::<f32>() * scale) + 10.0
}

#[test]
fn the_path_of_the_tip_is_that_of_forward_kinematics() {
    cases(|random, skeleton, swing| {
        let by = random.within(-0.4..0.4);
        let error =
            swing.tip_at(skeleton, by).as_dvec3().distance(tip_f64(skeleton, swing, by.into()));
        assert!(error < 2e-6 * size(skeleton), "{swing:?}: {error}");
    });
}

#[test]
fn the_predicted_line_touches_the_path_and_parts_from_it_by_the_square_of_the_angle() {
    const STEP: f64 = 1e-5;
    cases(|random, skeleton, swing| {
        let by = random.within(-0.3..0.3);
        let velocity =
            (tip_f64(skeleton, swing, STEP) - tip_f64(skeleton, swing, -STEP)) / (2.0 * STEP);
        let expected = tip_f64(skeleton, swing, 0.0) + velocity * f64::from(by);
        let predicted = swing.predicted_at(skeleton, by).as_dvec3();
        assert!(predicted.distance(expected) < 4e-6 * size(skeleton), "{swing:?}");
        let apart = predicted.distance(swing.tip_at(skeleton, by).as_dvec3());
        let speed = velocity.length();
        let bound = 0.5 * speed.max(size(skeleton)) * f64::from(by * by);
        assert!(apart <= bound + 4e-6 * size(skeleton), "{swing:?}: {apart} {bound}");
    });
}

#[test]
fn a_swing_changes_one_angle_whatever_its_limits_are() {
    cases(|random, skeleton, swing| {
        let by = random.within(-1.0..1.0);
        let posed = swing.posed(skeleton, by);
        for (joint, before) in skeleton.iter() {
            let mut expected = before.rotation;
            if joint == swing.joint {
                expected[swing.axis.index()] += by;
            }
            assert_eq!(posed[joint].rotation, expected);
        }
    });
}
