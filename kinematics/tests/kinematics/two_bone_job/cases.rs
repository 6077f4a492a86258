//! Edge cases of a job: those of ozz-animation's `two_bone_ik_job_tests.cc`, and more.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DAffine3, DQuat, DVec3, Quat, Vec3};
use ik_arm_kinematics::job::TwoBoneJob;
use ik_arm_kinematics::two_bone::Reach;

use crate::two_bone_job::skeleton::*;

/// ozz's parents, and a mirror of one axis.
fn parents() -> [DAffine3; 7] {
    [
        DAffine3::IDENTITY,
        DAffine3::from_translation(DVec3::Y),
        DAffine3::from_rotation_x(PI / 3.0),
        DAffine3::from_scale(DVec3::splat(2.0)),
        DAffine3::from_scale(DVec3::new(1.0, 2.0, 1.0)),
        DAffine3::from_scale(DVec3::splat(-3.0)),
        DAffine3::from_scale(DVec3::new(1.0, -1.0, 1.0)),
    ]
}

#[test]
fn under_every_parent_the_start_joint_turns_the_limb_to_the_target() {
    let around = [DVec3::new(1.0, 1.0, 0.0), DVec3::new(0.0, 1.0, 1.0), DVec3::new(-1.0, 1.0, 0.0)];
    // As ozz has it, and with the elbow's own frame turned by a right angle.
    let turned = Skeleton {
        middle: Local { rotation: DQuat::from_rotation_z(FRAC_PI_2), ..Local::at(DVec3::Y) },
        end: Local::at(DVec3::NEG_Y),
        ..Skeleton::square()
    };
    for (parent, own) in parents().into_iter().flat_map(|p| [(p, Skeleton::square()), (p, turned)])
    {
        let skeleton = Skeleton { parent, ..own };
        let pole = parent.transform_vector3(DVec3::Y).as_vec3();
        for (quarters, target) in around.into_iter().enumerate() {
            let target = parent.transform_point3(target);
            let job = TwoBoneJob { pole: Some(pole), hinge: Some(Vec3::Z), ..skeleton.job(target) };
            let correction = run(job);
            is_at(&skeleton, &correction, target);
            assert!(skeleton.off_ss(&correction, target) <= EXACT);
            same_turn(correction.start_correction, DVec3::Y, -FRAC_PI_2 * quarters as f64);
            same_turn(correction.middle_correction, DVec3::Z, 0.0);
        }
    }
}

#[test]
fn under_every_parent_the_middle_joint_opens_and_closes_as_under_none() {
    for target in [DVec3::new(0.5, 0.2, 0.1), DVec3::new(-0.3, 1.7, 0.4)] {
        let ask = |parent: DAffine3| {
            let skeleton = Skeleton { parent, ..Skeleton::square() };
            let pole = parent.transform_vector3(DVec3::new(0.3, 1.0, -0.2)).as_vec3();
            let target = parent.transform_point3(target.as_vec3().as_dvec3());
            let job = TwoBoneJob {
                pole: Some(pole),
                hinge: Some(Vec3::Z),
                twist: 0.4,
                ..skeleton.job(target)
            };
            let correction = run(job);
            assert_eq!(correction.reach, Reach::Reached, "{parent}");
            assert!(skeleton.off_ss(&correction, target) <= EXACT, "{parent}");
            correction
        };
        let under_none = ask(DAffine3::IDENTITY);
        assert!(under_none.middle_correction.w < 0.99, "nothing to open or close");
        for correction in parents().map(ask) {
            assert!(
                apart(
                    correction.start_correction.as_dquat(),
                    under_none.start_correction.as_dquat()
                ) < 2e-6
            );
            assert!(
                apart(
                    correction.middle_correction.as_dquat(),
                    under_none.middle_correction.as_dquat()
                ) < 2e-6
            );
        }
    }
}

#[test]
fn the_elbow_turns_to_the_pole() {
    let skeleton = Skeleton::square();
    let cases = [
        (Vec3::Y, DVec3::new(1.0, 1.0, 0.0), DVec3::X, 0.0),
        (Vec3::Z, DVec3::new(1.0, 0.0, 1.0), DVec3::X, FRAC_PI_2),
        (Vec3::NEG_Z, DVec3::new(1.0, 0.0, -1.0), DVec3::X, -FRAC_PI_2),
        (Vec3::X, DVec3::new(1.0, -1.0, 0.0), DVec3::Z, -FRAC_PI_2),
        (Vec3::NEG_X, DVec3::new(-1.0, 1.0, 0.0), DVec3::Z, FRAC_PI_2),
    ];
    for (pole, target, axis, angle) in cases {
        let job =
            TwoBoneJob { pole: Some(pole * 7.0), hinge: Some(Vec3::Z), ..skeleton.job(target) };
        let correction = run(job);
        is_at(&skeleton, &correction, target);
        same_turn(correction.start_correction, axis, angle);
        same_turn(correction.middle_correction, DVec3::Z, 0.0);
    }
}

#[test]
fn without_a_pole_the_start_joint_makes_the_least_turn() {
    let skeleton = Skeleton::square();
    let target = DVec3::new(1.0, -1.0, 0.0);
    let correction = run(skeleton.job(target));
    is_at(&skeleton, &correction, target);
    same_turn(correction.start_correction, DVec3::Z, -FRAC_PI_2);
    // Opposite to the hand any half turn will do.
    let correction = run(skeleton.job(DVec3::new(-1.0, -1.0, 0.0)));
    is_at(&skeleton, &correction, DVec3::new(-1.0, -1.0, 0.0));
}

#[test]
fn a_pole_on_the_line_to_the_target_is_ignored() {
    let skeleton = Skeleton::square();
    for aside in [0.0, 1e-9, 1e-6, 1e-3] {
        for sign in [1.0, -1.0] {
            let target = DVec3::new(aside, sign * 2_f64.sqrt(), 0.0);
            let job =
                TwoBoneJob { pole: Some(Vec3::Y), hinge: Some(Vec3::Z), ..skeleton.job(target) };
            let correction = run(job);
            let [_, _, hand] = skeleton.turned(&correction).points();
            assert!(hand.distance(target) < 2e-6, "{hand}, not {target}");
        }
    }
    // On the line itself: as without a pole.
    let job = skeleton.job(DVec3::new(0.0, 1.3, 0.0));
    assert_eq!(run(TwoBoneJob { pole: Some(Vec3::Y), ..job }), run(job));
}

#[test]
fn a_joint_of_scale_0_does_not_turn() {
    let target = DVec3::new(0.3, 0.4, 0.5);
    let none = Local { scale: DVec3::ZERO, ..Local::at(DVec3::ZERO) };
    let start = Skeleton { start: none, ..Skeleton::square() };
    let correction =
        run(TwoBoneJob { pole: Some(Vec3::Y), hinge: Some(Vec3::Z), ..start.job(target) });
    assert_eq!(
        (correction.start_correction, correction.middle_correction),
        (Quat::IDENTITY, Quat::IDENTITY)
    );
    assert_eq!(correction.reach, Reach::TooFar);
    assert!((f64::from(correction.hand_error) - target.length()).abs() < 1e-6);
    // The whole limb is at the start joint, and so is this target.
    assert_eq!(run(start.job(DVec3::ZERO)).reach, Reach::Reached);

    // The hand is at the elbow, which the start joint alone points.
    let middle = Skeleton {
        middle: Local { scale: DVec3::ZERO, ..Local::at(DVec3::Y) },
        ..Skeleton::square()
    };
    let correction = run(middle.job(DVec3::X));
    assert_eq!(correction.middle_correction, Quat::IDENTITY);
    is_at(&middle, &correction, DVec3::X);
    assert_eq!(run(middle.job(DVec3::X * 0.5)).reach, Reach::TooClose);
}

#[test]
fn a_softened_hand_stays_behind_near_its_limits() {
    let skeleton = Skeleton::square();
    let reach = |distance: f64, softness| {
        run(TwoBoneJob { softness, pole: Some(Vec3::Y), ..skeleton.job(DVec3::X * distance) }).reach
    };
    // Softness 0.5 of bones 1 and 1: untouched from 0.5 to 1.5.
    assert_eq!(reach(2.0, 0.0), Reach::Reached);
    assert_eq!(reach(2.1, 0.0), Reach::TooFar);
    assert_eq!(reach(0.51, 0.5), Reach::Reached);
    assert_eq!(reach(1.49, 0.5), Reach::Reached);
    assert_eq!(reach(1.6, 0.5), Reach::TooFar);
    assert_eq!(reach(2.0, 0.5), Reach::TooFar);
    assert_eq!(reach(0.4, 0.5), Reach::TooClose);
}

#[test]
fn a_twist_turns_the_limb_about_the_line_to_the_target() {
    let skeleton = Skeleton::square();
    let target = DVec3::new(1.0, 1.0, 0.0);
    for angle in [0.0, FRAC_PI_2, -FRAC_PI_2, 3.0, PI, 2.0 * PI, 1000.0] {
        let twist = angle as f32;
        let job =
            TwoBoneJob { twist, pole: Some(Vec3::Y), hinge: Some(Vec3::Z), ..skeleton.job(target) };
        let correction = run(job);
        is_at(&skeleton, &correction, target);
        same_turn(correction.start_correction, target.normalize(), twist.into());
        same_turn(correction.middle_correction, DVec3::Z, 0.0);
    }
}

#[test]
fn a_mirrored_model_twists_like_its_mirror_image() {
    let parent = DAffine3::from_scale(DVec3::new(1.0, 1.0, -1.0));
    let (own, mirrored) = (Skeleton::square(), Skeleton { parent, ..Skeleton::square() });
    let (target, pole) = (DVec3::new(1.0, 0.5, 0.2), Vec3::new(0.1, 1.0, 0.3));
    let here = run(TwoBoneJob { pole: Some(pole), twist: 1.0, ..own.job(target) });
    let flip = |v: Vec3| v * Vec3::new(1.0, 1.0, -1.0);
    let there = TwoBoneJob {
        pole: Some(flip(pole)),
        twist: 1.0,
        ..mirrored.job(flip(target.as_vec3()).as_dvec3())
    };
    let there = run(there);
    assert!(apart(here.start_correction.as_dquat(), there.start_correction.as_dquat()) < 1e-6);
    let [a, b] = [own.turned(&here), mirrored.turned(&there)].map(|skeleton| skeleton.points()[1]);
    assert!(parent.transform_point3(a).distance(b) < 1e-6);
}

#[test]
fn a_weight_scales_the_correction() {
    let skeleton = Skeleton::square();
    let at = |weight| {
        let job = skeleton.job(DVec3::X * 2.0);
        run(TwoBoneJob { weight, pole: Some(Vec3::Y), hinge: Some(Vec3::Z), ..job })
    };
    for part in [1.0, 0.5, 0.25] {
        let correction = at(part as f32);
        same_turn(correction.start_correction, DVec3::Z, -FRAC_PI_2 * part);
        same_turn(correction.middle_correction, DVec3::Z, FRAC_PI_2 * part);
        let expected = if part == 1.0 { Reach::Reached } else { Reach::TooFar };
        assert_eq!(correction.reach, expected);
    }
    let none = at(0.0);
    assert_eq!((none.start_correction, none.middle_correction), (Quat::IDENTITY, Quat::IDENTITY));
    assert_eq!(none.reach, Reach::TooFar);
    // The target is reached already.
    let job = TwoBoneJob { weight: 0.0, ..skeleton.job(DVec3::new(1.0, 1.0, 0.0)) };
    assert_eq!(run(job).reach, Reach::Reached);
    // As far away as the target, but elsewhere.
    let job = TwoBoneJob { weight: 0.0, ..skeleton.job(DVec3::new(1.0, -1.0, 0.0)) };
    assert_ne!(run(job).reach, Reach::Reached);
}

#[test]
fn a_hinge_axis_the_wrong_way_round_bends_the_limb_to_its_other_side() {
    let skeleton = Skeleton::square();
    let target = DVec3::new(1.0, 1.0, 0.0);
    let job = TwoBoneJob { pole: Some(Vec3::Y), hinge: Some(Vec3::NEG_Z), ..skeleton.job(target) };
    let correction = run(job);
    is_at(&skeleton, &correction, target);
    same_turn(correction.start_correction, DVec3::Y, PI);
    same_turn(correction.middle_correction, DVec3::Z, PI);
    let elbow = skeleton.turned(&correction).points()[1];
    assert!(elbow.distance(DVec3::Y) < 1e-6, "{elbow}");
}

#[test]
fn a_hinge_axis_in_the_plane_of_the_limb_is_ignored() {
    let skeleton = Skeleton::square();
    let job = TwoBoneJob { pole: Some(Vec3::Y), ..skeleton.job(DVec3::new(0.5, 1.0, 0.3)) };
    let by_pose = run(TwoBoneJob { hinge: None, ..job });
    assert_eq!(by_pose.reach, Reach::Reached);
    for hinge in [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::new(1.0, -1.0, -1e-4), Vec3::Z] {
        assert_eq!(run(TwoBoneJob { hinge: Some(hinge), ..job }), by_pose);
    }
}

#[test]
fn a_straight_limb_bends_about_its_hinge_axis() {
    let skeleton = Skeleton::straight();
    let target = DVec3::new(1.0, 1.0, 0.0);
    // Two bones of 1, √2 apart: the elbow closes by a right angle, against the hinge axis.
    for hinge in [Vec3::Z, Vec3::new(8.0, 0.0, 1.0)] {
        let correction =
            run(TwoBoneJob { pole: Some(Vec3::Y), hinge: Some(hinge), ..skeleton.job(target) });
        is_at(&skeleton, &correction, target);
        same_turn(correction.start_correction, DVec3::Z, FRAC_PI_2);
        same_turn(correction.middle_correction, DVec3::Z, -FRAC_PI_2);
    }
    // Only the pole gives a direction, then nothing does.
    for pole in [Vec3::Y, Vec3::ZERO, Vec3::X] {
        for hinge in [Vec3::ZERO, Vec3::X] {
            let correction =
                run(TwoBoneJob { pole: Some(pole), hinge: Some(hinge), ..skeleton.job(target) });
            is_at(&skeleton, &correction, target);
        }
    }
    let correction = run(TwoBoneJob { pole: Some(Vec3::Y), ..skeleton.job(target) });
    same_turn(correction.middle_correction, DVec3::Z, -FRAC_PI_2);
    // Straight already, and to stay so.
    let job =
        TwoBoneJob { pole: Some(Vec3::Y), hinge: Some(Vec3::Z), ..skeleton.job(DVec3::X * 2.0) };
    let correction = run(job);
    is_at(&skeleton, &correction, DVec3::X * 2.0);
    same_turn(correction.start_correction, DVec3::Z, 0.0);
    same_turn(correction.middle_correction, DVec3::Z, 0.0);
    assert_eq!(run(TwoBoneJob { target: Vec3::X * 3.0, ..job }).reach, Reach::TooFar);
}

#[test]
fn a_folded_limb_opens_about_its_hinge_axis() {
    for lower in [1.0, 0.5, 1.5] {
        let skeleton = Skeleton {
            middle: Local::at(DVec3::X),
            end: Local::at(DVec3::NEG_X * lower),
            ..Skeleton::square()
        };
        let target = DVec3::new(0.3, 0.9, -0.2);
        let job = TwoBoneJob { pole: Some(Vec3::X), hinge: Some(Vec3::Z), ..skeleton.job(target) };
        let correction = run(job);
        is_at(&skeleton, &correction, target);
        assert!(
            correction.middle_correction.z > 0.0
                && correction.middle_correction.xyz().truncate().length() < 1e-6
        );
        is_at(&skeleton, &run(skeleton.job(target)), target);
    }
}

#[test]
fn a_target_at_the_start_joint_folds_the_limb() {
    let skeleton = Skeleton::square();
    let job = TwoBoneJob { pole: Some(Vec3::Y), hinge: Some(Vec3::Z), ..skeleton.job(DVec3::ZERO) };
    is_at(&skeleton, &run(job), DVec3::ZERO);
    // The hand keeps its direction where it cannot come to the start joint.
    let longer = Skeleton { end: Local::at(DVec3::X * 2.0), ..skeleton };
    let job = TwoBoneJob { pole: Some(Vec3::Y), hinge: Some(Vec3::Z), ..longer.job(DVec3::ZERO) };
    let correction = run(job);
    assert_eq!(correction.reach, Reach::TooClose);
    let hand = longer.turned(&correction).points()[2];
    assert!(hand.distance(DVec3::new(2.0, 1.0, 0.0).normalize()) < 1e-6, "{hand}");
    // So near that nothing but the direction is left of it.
    for near in [1e-4, 1e-7, 1e-12, 1e-30] {
        is_at(&skeleton, &run(skeleton.job(DVec3::Z * near)), DVec3::Z * near);
    }
}

#[test]
fn a_bone_of_length_0_leaves_one_bone_to_point_at_the_target() {
    let none = Local::at(DVec3::ZERO);
    let target = DVec3::new(0.0, 0.0, 1.0);
    for skeleton in [
        Skeleton { middle: none, ..Skeleton::square() },
        Skeleton { end: none, ..Skeleton::square() },
    ] {
        let job = TwoBoneJob { hinge: Some(Vec3::Z), softness: 0.5, ..skeleton.job(target) };
        for pole in [Vec3::Y, Vec3::ZERO] {
            let correction = run(TwoBoneJob { pole: Some(pole), ..job });
            assert_eq!(correction.middle_correction, Quat::IDENTITY);
            is_at(&skeleton, &correction, target);
        }
        assert_eq!(run(TwoBoneJob { target: Vec3::Z * 1.1, ..job }).reach, Reach::TooFar);
        assert_eq!(run(TwoBoneJob { target: Vec3::Z * 0.9, ..job }).reach, Reach::TooClose);
        assert_eq!(run(TwoBoneJob { target: Vec3::ZERO, ..job }).reach, Reach::TooClose);
    }
    let point = Skeleton { middle: none, end: none, ..Skeleton::square() };
    let correction = run(point.job(target));
    assert_eq!(
        (correction.start_correction, correction.middle_correction),
        (Quat::IDENTITY, Quat::IDENTITY)
    );
    assert_eq!(correction.reach, Reach::TooFar);
    assert_eq!(run(point.job(DVec3::ZERO)).reach, Reach::Reached);
}

#[test]
fn any_unit_of_length_works() {
    for size in [1e-30, 1e-3, 1e6, 1e30] {
        let parent = DAffine3::from_scale(DVec3::splat(size));
        let local = |v: DVec3| Local::at(v * size);
        for skeleton in [
            Skeleton { parent, ..Skeleton::square() },
            Skeleton { middle: local(DVec3::Y), end: local(DVec3::X), ..Skeleton::square() },
        ] {
            let target = DVec3::new(0.3, 0.9, 0.8) * size;
            let job = TwoBoneJob { pole: Some(Vec3::Y), softness: 0.1, ..skeleton.job(target) };
            is_at(&skeleton, &run(job), target);
        }
    }
}
