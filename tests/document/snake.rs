//! A snake's body follows the path of its head.

use std::cell::Cell;

use glam::Vec3;
use ik_arm::document::{FollowPath, PathKind, SkeletonRig, WavyRing};
use ik_arm::kinematics::follow;
use ik_arm::kinematics::skeleton::{Joint, JointId, Limit, Skeleton};

const PATH: WavyRing = WavyRing { radius: 1.2, amplitude: 0.25, waves: 4, period: 9.0 };

/// Bones of uneven lengths along −x, the head first.
fn snake() -> Skeleton {
    let mut snake = Skeleton::default();
    let mut offset = Vec3::new(0.3, 0.07, -0.2);
    for index in 0..24_usize {
        let axis = Vec3::NEG_X * (0.05 + 0.01 * (index % 5) as f32);
        let parent = index.checked_sub(1);
        let joint = Joint {
            offset,
            ..Joint::new(&format!("joint {index}"), parent.map(JointId::new), axis)
        };
        snake.add(joint).expect("a joint");
        offset = axis;
    }
    snake
}

/// A skeleton at a time in seconds, on the ring.
fn on_ring(skeleton: &Skeleton, time: f64) -> Skeleton {
    let mut rig = SkeletonRig::new(skeleton.clone());
    rig.follow_paths = vec![FollowPath { root: JointId::new(0), kind: PathKind::Ring(PATH) }];
    Skeleton::clone(&rig.skeleton_at(time))
}

/// Distance of a point from the path, by sampling all of it.
fn distance_to_path(point: Vec3) -> f32 {
    const STEPS: usize = 40_000;
    let at = |step: usize| PATH.point(step as f64 / STEPS as f64);
    let flat = Vec3 { y: 0.0, ..point };
    (0..STEPS).map(|step| at(step).distance(flat)).fold(f32::INFINITY, f32::min)
}

#[test]
fn every_joint_is_on_the_path_of_the_head() {
    for time in [0.0, 1.7, 100.0] {
        let pose = on_ring(&snake(), time).pose();
        for joint in 0..pose.len() {
            for point in [pose.base(JointId::new(joint)), pose.tip(JointId::new(joint))] {
                assert!(distance_to_path(point) < 2e-4, "{point} of joint {joint} at {time} s");
            }
        }
    }
}

#[test]
fn the_head_leads_and_bones_keep_their_lengths() {
    let snake = snake();
    for time in [0.0, 0.4, 3.0, 8.99] {
        let pose = on_ring(&snake, time).pose();
        let head = PATH.point(PATH.turns_at(time)) + Vec3::Y * 0.07;
        assert!(pose.base(JointId::new(0)).distance(head) < 1e-6);
        for (joint, before) in snake.joints().iter().enumerate() {
            let length = pose.base(JointId::new(joint)).distance(pose.tip(JointId::new(joint)));
            assert!((length - before.axis.length()).abs() < 1e-5, "{length} of joint {joint}");
        }
    }
}

#[test]
fn joints_after_a_limited_one_start_where_it_ends_and_point_at_the_path() {
    let mut snake = snake();
    let lengths: Vec<f32> = snake.joints().iter().map(|joint| joint.axis.length()).collect();
    for index in (2..24).step_by(5) {
        let limits = [Some(Limit { min: -0.02, max: 0.02 }); 3];
        snake.change(JointId::new(index), |joint| joint.limits = limits.into()).expect("limited");
    }
    let (mut limited, mut free) = (0, 0);
    for step in 0..50 {
        let time = f64::from(step) * 0.17;
        let pose = on_ring(&snake, time);
        let points = follow::along(
            |turns| PATH.point(turns) + Vec3::Y * 0.07,
            PATH.turns_at(time),
            1.0 / 256.0,
            lengths.iter().copied(),
        );
        for (index, joint) in pose.joints().iter().enumerate() {
            let (base, tip) = (pose.base(JointId::new(index)), pose.tip(JointId::new(index)));
            let direction = (tip - base).normalize();
            let aside = direction.cross((points[index + 1] - base).normalize()).length();
            if joint.limits.is_limited() && joint.rotation.abs().max_element() > 0.0199 {
                limited += usize::from(aside > 1e-2);
            } else {
                free += 1;
                assert!(aside < 1e-3, "joint {index} at {time} s: {aside}");
            }
        }
    }
    assert!(limited > 20 && free > 900, "{limited} limited, {free} free");
}

#[test]
fn the_body_trails_behind_the_head_and_never_overtakes_it() {
    let lengths: Vec<f32> = snake().joints().iter().map(|joint| joint.axis.length()).collect();
    let along = |time: f64| {
        follow::along(|s| PATH.point(s), PATH.turns_at(time), 1.0 / 256.0, lengths.iter().copied())
    };
    let turn = |point: Vec3| f64::from(-point.z).atan2(f64::from(point.x));
    let points = along(4.0);
    for ends in points.windows(2) {
        let back = (turn(ends[0]) - turn(ends[1]) + 1.0).rem_euclid(std::f64::consts::TAU) - 1.0;
        assert!(back > 0.0, "{} is not behind {}", ends[1], ends[0]);
    }
}

#[test]
fn the_motion_is_smooth_and_loops() {
    let tip_at = |time: f64| on_ring(&snake(), time).pose().tip(JointId::new(23));
    for step in 0..200 {
        let time = f64::from(step) * 0.05;
        let moved = tip_at(time).distance(tip_at(time + 1e-3));
        assert!(moved < 3e-3, "the tail leaps {moved} at {time} s");
    }
    assert!(tip_at(0.0).distance(tip_at(9.0)) < 1e-4);
}

#[test]
fn following_a_path_of_one_point_terminates() {
    let points = follow::along(|_| Vec3::ONE, 0.0, 0.1, [1.0, 2.0]);
    assert_eq!(points, [Vec3::ONE; 3]);
}

#[test]
fn an_empty_skeleton_and_bones_without_length_are_unchanged() {
    assert_eq!(on_ring(&Skeleton::default(), 1.0), Skeleton::default());
    let mut point = Skeleton::default();
    point.add(Joint::new("head", None, Vec3::ZERO)).expect("a joint");
    let posed = on_ring(&point, 1.0).pose();
    assert_eq!(posed.base(JointId::new(0)), posed.tip(JointId::new(0)));
}

#[test]
fn a_snake_longer_than_its_path_terminates() {
    const JOINTS: usize = 10_000;
    let evaluated = Cell::new(0_usize);
    let ring = |s: f64| {
        evaluated.set(evaluated.get() + 1);
        Vec3::new(s.cos() as f32, 0.0, s.sin() as f32)
    };
    let points = follow::along(ring, 0.0, 0.1, [5.0; JOINTS]);
    assert_eq!(points.len(), JOINTS + 1);
    assert!(evaluated.get() < 2_000_000, "{} evaluations", evaluated.get());
}

#[test]
fn joints_on_a_line_of_many_points_are_where_they_are_on_the_path() {
    let lengths = [0.3, 0.05, 0.2, 0.4, 0.1];
    for turns in [0.0, 0.3, 2.7] {
        let on_path = follow::along(|s| PATH.point(s), turns, 1.0 / 256.0, lengths);
        let line = (0..20_000).map(|step| PATH.point(turns - f64::from(step) * 5e-5));
        let on_line: Vec<Vec3> = follow::along_line(line, lengths).collect();
        for (one, other) in on_path[1..].iter().zip(&on_line) {
            assert!(one.distance(*other) < 1e-4, "{one} and {other}");
        }
    }
}

#[test]
fn a_line_goes_on_straight_beyond_its_end_and_repeated_points_do_not_bend_it() {
    let line = [Vec3::X, Vec3::X, Vec3::ZERO, Vec3::ZERO, Vec3::Y, Vec3::Y];
    let joints: Vec<Vec3> = follow::along_line(line, [0.5, 0.5, 0.0, 1.0, 2.0, 3.0]).collect();
    let expected = [Vec3::X * 0.5, Vec3::ZERO, Vec3::ZERO, Vec3::Y, Vec3::Y * 3.0, Vec3::Y * 6.0];
    for (joint, expected) in joints.iter().zip(expected) {
        assert!(joint.distance(expected) < 1e-6, "{joints:?}");
    }
}

#[test]
fn a_line_of_one_point_or_none_keeps_all_joints_together() {
    let point: Vec<Vec3> = follow::along_line([Vec3::ONE], [1.0, 2.0]).collect();
    assert_eq!(point, [Vec3::ONE; 2]);
    let nothing: Vec<Vec3> = follow::along_line([], [1.0, 2.0]).collect();
    assert_eq!(nothing, [Vec3::ZERO; 2]);
}
