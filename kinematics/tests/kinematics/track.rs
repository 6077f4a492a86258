//! Poses tracked from step to step: smooth, on their targets, the same bits at rest.

use std::f32::consts::TAU;

use glam::{Affine3A, Mat3, Vec3};
use ik_arm_kinematics::chain_ik::{
    ChainSolver, ChainTarget, Method, Root, SolveError, SolverOptions, TrackStep, solve,
};
use ik_arm_kinematics::skeleton::{Joint, JointId, JointLimits, Limit, Skeleton, SkeletonPose};

use crate::common::skeletons::{ITERATIVE, chain, forest, length, limit, target, transform};
use crate::common::{Random, cases};

const JOINTS: usize = 10;
const FRAMES: u16 = 180;

/// A chain in its FK pose and a circular path of its target.
struct Motion {
    fk: Skeleton,
    tip: JointId,
    centre: Vec3,
    axes: [Vec3; 2],
}

impl Motion {
    /// `distance`: of the path's centre from the root, in lengths of the chain.
    fn new(random: &mut Random, joints: usize, is_limited: bool, distance: f32) -> Self {
        let mut fk = chain(random, joints, 1.0);
        let tip = JointId::new(joints);
        for joint in (1..=joints).map(JointId::new) {
            let angles = 0.25 * random.angles();
            let change = |it: &mut Joint| {
                if is_limited {
                    it.limits = JointLimits::new([(); 3].map(|()| Some(limit(random))));
                }
                it.rotation = it.limits.project(angles);
            };
            fk.change(joint, change).expect("finite");
        }
        let length = length(&fk, &[tip]);
        let centre = distance * length * random.direction();
        let x = random.direction();
        let y = x.cross(random.direction()).normalize();
        Self { fk, tip, centre, axes: [x, y].map(|axis| 0.25 * length * axis) }
    }

    fn target(&self, frame: u16) -> ChainTarget {
        let (sin, cos) = (TAU * f32::from(frame) / f32::from(FRAMES)).sin_cos();
        target(self.tip, self.centre + cos * self.axes[0] + sin * self.axes[1])
    }

    /// The first pose.
    fn tracked(&self, options: &SolverOptions) -> Tracked {
        Tracked::new(&self.fk, &[self.target(0)], options)
    }
}

/// A solver with the pose of its last step.
struct Tracked {
    solver: ChainSolver,
    posed: Skeleton,
}

impl Tracked {
    fn new(fk: &Skeleton, targets: &[ChainTarget], options: &SolverOptions) -> Self {
        let mut solver = ChainSolver::new(fk, targets, options).expect("a solver");
        solver.run();
        let mut posed = fk.clone();
        solver.write(&mut posed);
        Self { solver, posed }
    }

    fn step(&mut self, targets: &[ChainTarget], fk: &Skeleton) -> TrackStep {
        let step = self.solver.track(targets, fk).expect("a step");
        self.posed = fk.clone();
        self.solver.write(&mut self.posed);
        step
    }
}

/// Largest distance between a joint or a tip in two poses.
fn farthest(one: &SkeletonPose, other: &SkeletonPose) -> f32 {
    let distances = one.points().zip(other.points()).map(|(one, other)| one.distance(other));
    distances.fold(0.0, f32::max)
}

fn quantile(values: &mut [f32], part: f32) -> f32 {
    values.sort_by(f32::total_cmp);
    values[(part * (values.len() - 1) as f32) as usize]
}

/// Steps of joints over steps of targets, and the share of frames that miss a target which a fresh
/// solve reaches.
fn smoothness(method: Method, is_limited: bool, distance: f32) -> (Vec<f32>, f32) {
    let mut random = Random(0x7ac4);
    let options = SolverOptions::new(method);
    let (mut ratios, mut lost, mut looked) = (Vec::new(), 0, 0);
    for _ in 0..cases(60) {
        let motion = Motion::new(&mut random, JOINTS, is_limited, distance);
        let mut tracked = motion.tracked(&options);
        for frame in 1..=FRAMES {
            let before = tracked.posed.pose();
            let step = tracked.step(&[motion.target(frame)], &motion.fk);
            let way = motion.target(frame).point.distance(motion.target(frame - 1).point);
            ratios.push(farthest(&before, &tracked.posed.pose()) / way);
            // A fresh solve that misses takes long.
            if frame % 6 > 0 {
                continue;
            }
            looked += 1;
            if !step.report.converged() {
                let mut fresh = motion.fk.clone();
                let fresh = solve(&mut fresh, &[motion.target(frame)], &options).expect("solved");
                lost += u32::from(fresh.converged());
            }
        }
    }
    (ratios, lost as f32 / looked as f32)
}

#[test]
fn joints_move_as_smoothly_as_targets_and_stay_on_them() {
    for method in ITERATIVE {
        // Out of reach, limits hold chains at local minima for longer.
        for (is_limited, distance, most_of_most, most_lost) in [
            (false, 0.5, 4.0, 0.015),
            (true, 0.5, 8.0, 0.015),
            (false, 0.9, 12.0, 0.05),
            (true, 0.9, 12.0, 0.05),
        ] {
            let (mut ratios, lost) = smoothness(method, is_limited, distance);
            let [median, most] = [0.5, 0.9].map(|part| quantile(&mut ratios, part));
            let which = format!("{method}, limited: {is_limited}, at {distance}");
            assert!(median <= 2.5 && most <= most_of_most, "{which}: {median}, {most}");
            assert!(lost <= most_lost, "{which}: {lost} lost");
        }
    }
}

#[test]
fn a_pose_at_rest_keeps_its_bits() {
    let mut random = Random(3);
    for method in ITERATIVE {
        for (is_limited, distance) in [(true, 0.5), (false, 1.3)] {
            let motion = Motion::new(&mut random, JOINTS, is_limited, distance);
            let mut tracked = motion.tracked(&SolverOptions::new(method));
            tracked.step(&[motion.target(1)], &motion.fk);
            while tracked.step(&[motion.target(1)], &motion.fk).is_held_back {}
            let (rest, report) = (tracked.posed.clone(), tracked.solver.report());
            for _ in 0..100 {
                let step = tracked.step(&[motion.target(1)], &motion.fk);
                assert_eq!((step.joint_motion, step.report), (0.0, report), "{method}");
                assert_eq!(tracked.posed, rest, "{method}");
            }
        }
    }
}

#[test]
fn a_pose_goes_along_with_the_fk_pose_that_turns_and_moves() {
    let mut random = Random(9);
    for method in ITERATIVE {
        let motion = Motion::new(&mut random, JOINTS, false, 0.5);
        let mut tracked = motion.tracked(&SolverOptions::new(method));
        tracked.step(&[motion.target(1)], &motion.fk);
        let length = length(&motion.fk, &[motion.tip]);
        let space = tracked.posed.pose();
        // The whole skeleton, with its target.
        for step in 1..=20_u8 {
            let turned = Affine3A::from_mat3_translation(
                Mat3::from_rotation_y(0.05 * f32::from(step)),
                0.1 * f32::from(step) * Vec3::X,
            );
            let mut fk = motion.fk.clone();
            fk.set_transform(turned).expect("rigid");
            let target = target(motion.tip, turned.transform_point3(motion.target(1).point));
            let step = tracked.step(&[target], &fk);
            assert!(step.target_motion < 1e-3 * length, "{method}: {}", step.target_motion);
            assert!(step.joint_motion < 5e-3 * length, "{method}: {}", step.joint_motion);
        }
        let back = tracked.posed.transform().inverse();
        let there = tracked.posed.pose();
        let apart = space.points().zip(there.points());
        let apart = apart.map(|(a, b)| a.distance(back.transform_point3(b))).fold(0.0, f32::max);
        assert!(apart < 0.02 * length, "{method}: {apart}");
    }
}

#[test]
fn joints_turn_by_what_the_fk_pose_turns() {
    // With the target where its tip goes by itself, a turn of one joint is all that happens.
    let mut random = Random(4);
    for method in ITERATIVE {
        let motion = Motion::new(&mut random, JOINTS, false, 0.5);
        let mut tracked = motion.tracked(&SolverOptions::new(method));
        let first = JointId::new(1);
        let mut fk = motion.fk.clone();
        for _ in 0..30 {
            let before = fk[first].rotation;
            let after = before + Vec3::new(0.01, -0.02, 0.015);
            fk.set_rotation(first, after).expect("finite");
            // The rotation relative to FK is kept: q · FK⁻¹ · FK.
            let rotation = |angles: Vec3| {
                Mat3::from_rotation_z(angles.z)
                    * Mat3::from_rotation_y(angles.y)
                    * Mat3::from_rotation_x(angles.x)
            };
            let own = rotation(tracked.posed[first].rotation);
            let expected = own * rotation(before).transpose() * rotation(after);
            let base = tracked.posed.pose().base(first);
            let turn = expected * own.transpose();
            let point = base + turn * (tracked.posed.tip(motion.tip) - base);
            let step = tracked.step(&[target(motion.tip, point)], &fk);
            let length = length(&fk, &[motion.tip]);
            assert!(step.joint_motion < 2e-3 * length, "{method}: {}", step.joint_motion);
            assert!(rotation(tracked.posed[first].rotation).abs_diff_eq(expected, 0.02));
        }
    }
}

#[test]
fn bones_may_change_their_lengths_and_targets_their_weights() {
    let mut random = Random(6);
    for method in ITERATIVE {
        for is_limited in [false, true] {
            let motion = Motion::new(&mut random, JOINTS, is_limited, 0.4);
            let mut tracked = motion.tracked(&SolverOptions::new(method));
            for frame in 1..=120 {
                // Beyond a power of two, by which problems are scaled.
                let scale = 1.0 + 0.015 * f32::from(frame);
                let mut fk = motion.fk.clone();
                for joint in fk.ids() {
                    let grow = |it: &mut Joint| {
                        it.offset *= scale;
                        it.axis *= scale;
                    };
                    fk.change(joint, grow).expect("finite");
                }
                let ChainTarget { joint, point, .. } = motion.target(frame);
                let weight = 1.0 + f32::from(frame % 7);
                let step =
                    tracked.step(&[ChainTarget::at(joint, point * scale).with_weight(weight)], &fk);
                let length = length(&fk, &[motion.tip]);
                let seen = tracked.posed.tip(joint).distance(point * scale);
                assert!((seen - step.report.error).abs() < 1e-5 * length, "{method}");
                // The first pose may be at a local minimum, from which a step comes back.
                if !is_limited && frame > 20 {
                    assert!(step.report.converged(), "{method}, {frame}: {step:?}");
                }
            }
        }
    }
}

#[test]
fn steps_in_a_moved_scaled_or_mirrored_skeleton_are_as_smooth() {
    let mut random = Random(8);
    for method in ITERATIVE {
        for _ in 0..cases(20) {
            let is_limited = random.coin();
            let mut motion = Motion::new(&mut random, JOINTS, is_limited, 0.5);
            let space = transform(&mut random);
            motion.fk.set_transform(space).expect("invertible");
            let target = |frame| {
                let ChainTarget { joint, point, weight, .. } = motion.target(frame);
                ChainTarget::at(joint, space.transform_point3(point)).with_weight(weight)
            };
            let options = SolverOptions::new(method);
            let mut tracked = Tracked::new(&motion.fk, &[target(0)], &options);
            let mut ratios = Vec::new();
            for frame in 1..=FRAMES {
                let before = tracked.posed.pose();
                let step = tracked.step(&[target(frame)], &motion.fk);
                let way = target(frame).point.distance(target(frame - 1).point);
                let seen = farthest(&before, &tracked.posed.pose());
                ratios.push(seen / way);
                assert!(step.joint_motion.is_finite() && step.target_motion.is_finite());
            }
            // Uneven scales give directions of their own: the length of the same way differs.
            assert!(quantile(&mut ratios, 0.5) <= 4.0, "{method}");
        }
    }
}

#[test]
fn a_target_that_jumps_is_solved_anew() {
    let mut random = Random(5);
    for method in ITERATIVE {
        let motion = Motion::new(&mut random, JOINTS, false, 0.4);
        let mut tracked = motion.tracked(&SolverOptions::new(method));
        let step = tracked.step(&[motion.target(FRAMES / 2)], &motion.fk);
        assert!(step.has_jumped && step.report.converged(), "{method}: {step:?}");
        let step = tracked.step(&[motion.target(FRAMES / 2 + 1)], &motion.fk);
        assert!(!step.has_jumped && step.report.converged(), "{method}: {step:?}");
    }
}

#[test]
fn a_target_that_was_out_of_reach_is_found_again() {
    let mut random = Random(12);
    for method in ITERATIVE {
        let motion = Motion::new(&mut random, JOINTS, false, 0.5);
        let length = length(&motion.fk, &[motion.tip]);
        let direction = random.direction();
        let at = |distance: f32| target(motion.tip, distance * length * direction);
        let mut tracked = Tracked::new(&motion.fk, &[at(0.8)], &SolverOptions::new(method));
        for step in 0..60 {
            tracked.step(&[at(0.8 + 0.01 * step as f32)], &motion.fk);
        }
        assert!(!tracked.solver.report().converged(), "{method}");
        for step in 0..80 {
            tracked.step(&[at(1.4 - 0.01 * step as f32)], &motion.fk);
        }
        for _ in 0..100 {
            tracked.step(&[at(0.6)], &motion.fk);
        }
        assert!(tracked.solver.report().converged(), "{method}: {:?}", tracked.solver.report());
    }
}

#[test]
fn a_run_after_steps_of_a_track_is_written_as_any_run() {
    let mut random = Random(17);
    for method in ITERATIVE {
        let motion = Motion::new(&mut random, JOINTS, false, 0.4);
        let Tracked { mut solver, mut posed } = motion.tracked(&SolverOptions::new(method));
        solver.track(&[motion.target(1)], &motion.fk).expect("a step");
        let other = motion.target(FRAMES / 3);
        solver.retarget(&[other]).expect("the same joint");
        let report = solver.run();
        solver.write(&mut posed);
        let length = length(&motion.fk, &[motion.tip]);
        let seen = posed.tip(motion.tip).distance(other.point);
        assert!((seen - report.error).abs() < 1e-5 * length, "{method}: {seen}, {report:?}");
        assert!(report.converged(), "{method}: {report:?}");

        let before = posed.pose();
        let step = solver.track(&[motion.target(FRAMES / 3 + 1)], &motion.fk).expect("a step");
        solver.write(&mut posed);
        let ratio = farthest(&before, &posed.pose()) / step.target_motion;
        assert!(step.report.converged() && !step.has_jumped, "{method}: {step:?}");
        assert!(ratio < 12.0, "{method}: {ratio}");
    }
}

#[test]
fn the_elbow_of_two_bones_goes_on_on_its_side() {
    let mut random = Random(2);
    for _ in 0..cases(100) {
        let motion = Motion::new(&mut random, 2, false, 0.5);
        let options = SolverOptions::new(Method::TwoBone);
        let mut tracked = motion.tracked(&options);
        let [upper, lower] = [1, 2].map(|joint| motion.fk[JointId::new(joint)].axis.length());
        for frame in 1..=FRAMES {
            let before = tracked.posed.pose();
            let step = tracked.step(&[motion.target(frame)], &motion.fk);
            let distance = motion.target(frame).point.length();
            let is_bent =
                distance < 0.95 * (upper + lower) && distance > 1.2 * (upper - lower).abs();
            let is_off_the_axis = distance > 0.1 * (upper + lower);
            if is_bent && is_off_the_axis {
                assert!(step.report.converged());
                let ratio = farthest(&before, &tracked.posed.pose()) / step.target_motion;
                assert!(ratio < 12.0, "{ratio} at {distance} of {}", upper + lower);
            }
        }
    }
}

#[test]
fn free_roots_follow_and_keep_their_precision_far_away() {
    let mut random = Random(13);
    for method in ITERATIVE {
        let motion = Motion::new(&mut random, 5, false, 0.5);
        let options = SolverOptions { root: Root::Free, ..SolverOptions::new(method) };
        let length = length(&motion.fk, &[motion.tip]);
        let mut tracked = motion.tracked(&options);
        let start = motion.target(0).point;
        for step in 1..=1000_u16 {
            let point = start + 0.05 * length * f32::from(step) * Vec3::X;
            let result = tracked.step(&[target(motion.tip, point)], &motion.fk);
            assert!(result.report.error < 1e-3 * length, "{method}, {step}: {result:?}");
            assert!(!result.has_jumped);
        }
    }
}

#[test]
fn refused_steps_change_nothing() {
    let mut random = Random(1);
    for method in ITERATIVE {
        let motion = Motion::new(&mut random, JOINTS, true, 0.5);
        let mut tracked = motion.tracked(&SolverOptions::new(method));
        tracked.step(&[motion.target(1)], &motion.fk);
        let mut untouched = tracked.solver.clone();
        let next = motion.target(2);

        let mut flat = motion.fk.clone();
        let singular = Affine3A::from_scale(Vec3::new(1.0, 0.0, 1.0));
        let mut locked = motion.fk.clone();
        locked.change(JointId::new(4), |joint| joint.locked = true).expect("a joint");
        let nowhere = ChainTarget { point: Vec3::NAN, ..next };
        let weightless = ChainTarget { weight: 0.0, ..next };
        let other = ChainTarget { joint: JointId::new(3), ..next };
        let solver = &mut tracked.solver;
        if flat.set_transform(singular).is_ok() {
            assert_eq!(solver.track(&[next], &flat), Err(SolveError::Singular));
        }
        let refused = solver.track(&[next], &locked);
        assert_eq!(refused, Err(SolveError::OtherJoint(JointId::new(4))));
        assert!(matches!(solver.track(&[nowhere], &motion.fk), Err(SolveError::Point { .. })));
        assert!(matches!(solver.track(&[weightless], &motion.fk), Err(SolveError::Weight { .. })));
        assert_eq!(solver.track(&[other], &motion.fk), Err(SolveError::NoJoint(other.joint)));
        assert_eq!(solver.track(&[], &motion.fk), Err(SolveError::NoJoint(next.joint)));

        assert_eq!(solver.track(&[next], &motion.fk), untouched.track(&[next], &motion.fk));
        let [mut one, mut two] = [motion.fk.clone(), motion.fk.clone()];
        solver.write(&mut one);
        untouched.write(&mut two);
        assert_eq!(one, two, "{method}");
    }
}

/// A power of ten within the range of f32, or 1.
fn size(random: &mut Random) -> f32 {
    if random.coin() { 1.0 } else { random.power_of_ten(-18.0..18.0) as f32 }
}

#[test]
fn steps_of_any_skeleton_are_finite_and_keep_locked_joints_and_joints_off_the_path() {
    let mut random = Random(0xf0e5);
    for _ in 0..cases(4000) {
        let mut fk = forest(&mut random, 12);
        let unit = size(&mut random);
        for joint in fk.ids() {
            let grow = |it: &mut Joint| {
                it.offset *= unit;
                it.axis *= unit;
            };
            fk.change(joint, grow).expect("finite");
        }
        let mut joints: Vec<_> = fk.ids().filter(|_| random.chance(0.3)).collect();
        joints.push(JointId::new(11));
        joints.dedup();
        let mut targets: Vec<_> = joints
            .iter()
            .map(|joint| {
                let point = random.vector(4.0) * unit;
                ChainTarget::at(*joint, point).with_weight(random.within(0.1..5.0))
            })
            .collect();
        let root = random.one_of(&Root::ALL);
        let method = random.one_of(&Method::ALL);
        let options = SolverOptions { root, iterations: Some(40), ..SolverOptions::new(method) };
        let Ok(mut solver) = ChainSolver::new(&fk, &targets, &options) else { continue };
        solver.run();
        for _ in 0..12 {
            let way = 10_f32.powi(-(random.below(5) as i32)) * unit;
            for target in &mut targets {
                target.point += way * random.direction();
            }
            if random.coin() {
                for joint in fk.ids() {
                    let turned = fk[joint].rotation + 0.1 * random.angles();
                    fk.set_rotation(joint, turned).expect("finite");
                }
            }
            if random.chance(0.2) {
                let joint = JointId::new(random.below(12));
                let moved = random.vector(0.1) * unit;
                fk.change(joint, |it| it.offset += moved).expect("finite");
            }
            let step = match solver.track(&targets, &fk) {
                Ok(step) => step,
                // A bone that has lost its length.
                Err(SolveError::TwoBone { .. }) => continue,
                Err(error) => panic!("{error}"),
            };
            let numbers = [step.joint_motion, step.target_motion, step.report.error];
            assert!(numbers.iter().all(|it| *it >= 0.0), "{method}: {step:?}");
            let mut posed = fk.clone();
            solver.write(&mut posed);
            for (id, joint) in posed.iter() {
                assert!(joint.rotation.is_finite() && joint.offset.is_finite(), "{method}");
                assert!(joint.limits.contains(joint.rotation), "{method}: {joint:?}");
                let is_moved = joints.iter().any(|tip| fk.is_in_subtree(*tip, id));
                if joint.locked || !is_moved {
                    assert_eq!(joint.rotation, fk[id].rotation, "{method}");
                }
                if joint.parent.is_some() || root != Root::Free {
                    assert_eq!(joint.offset, fk[id].offset, "{method}");
                }
            }
        }
    }
}

#[test]
fn limits_hold_in_each_step() {
    let mut random = Random(21);
    for method in ITERATIVE {
        let mut motion = Motion::new(&mut random, JOINTS, true, 0.7);
        let mut tracked = motion.tracked(&SolverOptions::new(method));
        for frame in 1..=FRAMES {
            // A limit that narrows from step to step.
            let most = 2.0 - 1.9 * f32::from(frame) / f32::from(FRAMES);
            let narrow = |joint: &mut Joint| {
                joint.limits =
                    JointLimits::new([(); 3].map(|()| Some(Limit { min: -most, max: most })));
            };
            motion.fk.change(JointId::new(5), narrow).expect("limits");
            tracked.step(&[motion.target(frame)], &motion.fk);
            let joints = tracked.posed.joints().iter();
            for joint in joints {
                assert!(joint.limits.contains(joint.rotation), "{method}: {}", joint.name);
            }
        }
    }
}
