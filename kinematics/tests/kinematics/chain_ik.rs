//! Every method against random rigs: reach, limits, stalling, roots, edges.

use glam::{Affine3A, DAffine3, DVec3, Mat3A, Vec3};
use ik_arm_kinematics::chain_ik::{
    ChainSolver, ChainTarget, Method, OptionField, Report, Root, SolveError, SolverOptions, Status,
    TwoBoneRefusal, jacobian, solve,
};
use ik_arm_kinematics::skeleton::{Joint, JointId, Limit, Skeleton};

use crate::common::skeletons::{
    ITERATIVE, chain, forest, length, limit, reachable, shake, space_f64, target, transform, tree,
};
use crate::common::{Random, cases};

const CASES: usize = 1_000;

/// Up from a locked root, bones of length 1.
fn straight(joints: usize) -> Skeleton {
    let mut skeleton = Skeleton::with_root("root");
    for index in 0..joints {
        let offset = if index == 0 { Vec3::ZERO } else { Vec3::Y };
        let joint = Joint::new(&format!("j{index}"), Some(JointId::new(index)), Vec3::Y);
        skeleton.add(Joint { offset, ..joint }).expect("joint");
    }
    skeleton
}

/// The largest distance from a tip to its target, from the skeleton alone.
fn error(skeleton: &Skeleton, targets: &[ChainTarget]) -> f32 {
    targets.iter().map(|t| skeleton.tip(t.joint).distance(t.point)).fold(0.0, f32::max)
}

/// Root mean square distance of tips from their targets.
fn rms(skeleton: &Skeleton, targets: &[ChainTarget]) -> f32 {
    let squares = targets.iter().map(|t| skeleton.tip(t.joint).distance_squared(t.point));
    (squares.sum::<f32>() / targets.len() as f32).sqrt()
}

/// Number of cases that end within `share` of the chain's length, by the method's budget.
fn reached(
    method: Method,
    share: f32,
    mut case: impl FnMut(&mut Random) -> (Skeleton, Vec<JointId>),
) -> usize {
    let mut random = Random(20);
    let count = (0..CASES).filter(|index| {
        let (mut skeleton, tips) = case(&mut random);
        let targets = reachable(&mut random, &skeleton, &tips);
        if index % 2 == 1 {
            shake(&mut random, &mut skeleton);
        }
        let report = solve(&mut skeleton, &targets, &SolverOptions::new(method)).expect("solve");
        let length = length(&skeleton, &tips);
        let seen = error(&skeleton, &targets);
        assert!((seen - report.error).abs() <= 1e-5 * length, "{report:?} but {seen}");
        assert!(report.iterations <= method.budget());
        seen <= share * length
    });
    count.count()
}

fn chains_reached(method: Method, joints: usize, share: f32) -> usize {
    let mut nth = 0;
    reached(method, share, |random| {
        nth += 1;
        (chain(random, joints, [1.0, 500.0][nth % 2]), vec![JointId::new(joints)])
    })
}

fn trees_reached(method: Method, targets: usize) -> usize {
    let mut nth = 0;
    reached(method, 1e-3, |random| {
        nth += 1;
        tree(random, targets, [1.0, 500.0][nth % 2])
    })
}

#[test]
fn chains_of_2_and_3_reach_every_reachable_target() {
    for method in [Method::Fabrik, Method::Relaxation, Method::Ccd, Method::DampedLeastSquares] {
        for joints in [2, 3] {
            assert_eq!(chains_reached(method, joints, 1e-3), CASES, "{method:?}, {joints} joints");
        }
    }
}

#[test]
fn chains_of_10_reach_every_reachable_target() {
    for method in [Method::Fabrik, Method::Relaxation, Method::Ccd, Method::DampedLeastSquares] {
        assert_eq!(chains_reached(method, 10, 1e-3), CASES, "{method:?}");
    }
}

#[test]
fn chains_of_30_reach_every_reachable_target() {
    for method in [Method::Fabrik, Method::Ccd, Method::DampedLeastSquares] {
        assert_eq!(chains_reached(method, 30, 1e-3), CASES, "{method:?}");
    }
}

#[test]
fn constraint_relaxation_reaches_98_percent_of_reachable_targets_with_2_to_30_joints() {
    for joints in 2..=30 {
        let mut random = Random(20);
        let all = cases(1_000);
        let mut iterations = Vec::new();
        let reached = (0..all).filter(|index| {
            let mut skeleton = chain(&mut random, joints, [1.0, 500.0][index % 2]);
            let targets = reachable(&mut random, &skeleton, &[JointId::new(joints)]);
            if index % 4 > 1 {
                shake(&mut random, &mut skeleton);
            }
            let options = SolverOptions::new(Method::Relaxation).with_iterations(2_000);
            let report = solve(&mut skeleton, &targets, &options).expect("solve");
            iterations.push(report.iterations);
            error(&skeleton, &targets) <= 1e-3 * length(&skeleton, &[JointId::new(joints)])
        });
        let reached = reached.count();
        iterations.sort_unstable();
        println!(
            "{joints} joints: {reached} of {all}, {} iterations (median), {} most",
            iterations[all / 2],
            iterations[all - 1]
        );
        assert!(reached * 100 >= all * 98, "{reached} of {all} with {joints} joints");
    }
}

#[test]
fn jacobian_transpose_comes_within_1_percent_of_nearly_every_target() {
    for joints in [2, 3, 10, 30] {
        let count = chains_reached(Method::Transpose, joints, 1e-2);
        assert!(count * 100 >= CASES * 99, "{count} of {CASES} with {joints} joints");
    }
}

#[test]
fn the_closed_form_reaches_every_reachable_target() {
    assert_eq!(chains_reached(Method::TwoBone, 2, 1e-5), CASES);
}

#[test]
fn trees_bring_several_tips_to_their_targets() {
    for (method, least) in [
        (Method::Fabrik, 99),
        (Method::Relaxation, 99),
        (Method::DampedLeastSquares, 99),
        (Method::Ccd, 99),
        (Method::Transpose, 99),
    ] {
        for targets in 2..=5 {
            let count = trees_reached(method, targets);
            assert!(
                count * 100 >= CASES * least,
                "{method:?}: {count} of {CASES} with {targets} targets"
            );
        }
    }
}

#[test]
fn a_fixed_step_brings_several_tips_nearer_to_their_targets() {
    for ends in 2..=5 {
        let mut random = Random(21);
        for _ in 0..100 {
            let (mut skeleton, tips) = tree(&mut random, ends, 1.0);
            let targets = reachable(&mut random, &skeleton, &tips);
            let before = rms(&skeleton, &targets);
            let options = SolverOptions::new(Method::TransposeFixed).with_step(0.5);
            solve(&mut skeleton, &targets, &options).expect("solve");
            let after = rms(&skeleton, &targets);
            assert!(after < 0.5 * before, "{after} of {before} with {ends} targets");
        }
    }
}

#[test]
fn the_closed_form_brings_several_limbs_to_their_targets() {
    for limbs in 2..=5 {
        let mut random = Random(22);
        for _ in 0..100 {
            let mut skeleton = Skeleton::with_root("root");
            let mut tips = Vec::new();
            for _ in 0..limbs {
                let mut limb = Joint::new("upper", Some(JointId::new(0)), random.direction());
                limb.offset = random.vector(1.0);
                limb.name = skeleton.free_name("upper");
                let upper = skeleton.add(limb).expect("upper");
                let name = skeleton.free_name("lower");
                let lower = Joint::new(&name, Some(upper), random.direction());
                let offset = skeleton[upper].axis;
                tips.push(skeleton.add(Joint { offset, ..lower }).expect("lower"));
            }
            let targets = reachable(&mut random, &skeleton, &tips);
            let options = SolverOptions::new(Method::TwoBone);
            solve(&mut skeleton, &targets, &options).expect("solve");
            assert!(error(&skeleton, &targets) <= 1e-5 * length(&skeleton, &tips));
        }
    }
}

#[test]
fn the_jacobian_is_the_derivative_of_the_tip() {
    const STEP: f64 = 1e-6;
    let mut random = Random(3);
    for _ in 0..300 {
        let skeleton = forest(&mut random, 12);
        let joint = JointId::new(random.below(12));
        let axis = skeleton[joint].axis.as_dvec3();
        let mut angles: Vec<_> =
            skeleton.joints().iter().map(|joint| joint.rotation.as_dvec3()).collect();
        let columns = jacobian(&skeleton, joint);
        assert_eq!(columns.len(), 12);
        for (turning, column) in columns.iter().enumerate() {
            for angle in 0..3 {
                let mut tip = |by: f64| {
                    let before = angles[turning][angle];
                    angles[turning][angle] += by;
                    let tip = space_f64(&skeleton, joint, &angles).transform_point3(axis);
                    angles[turning][angle] = before;
                    tip
                };
                let expected = (tip(STEP) - tip(-STEP)) / (2.0 * STEP);
                let off = column[angle].as_dvec3().distance(expected);
                assert!(off <= 1e-4 * expected.length().max(1e-2), "{off} of {expected}");
                if !skeleton.is_in_subtree(joint, turning.into()) {
                    assert_eq!(column[angle], Vec3::ZERO);
                }
            }
        }
    }
}

/// Random forests with random targets, likely out of reach.
fn anything(random: &mut Random) -> (Skeleton, Vec<ChainTarget>) {
    let joints = 2 + random.below(10);
    let mut skeleton = forest(random, joints);
    skeleton.set_transform(transform(random)).expect("transform");
    let mut targets = Vec::new();
    for joint in skeleton.ids() {
        if random.chance(0.3) {
            let weight = random.within(0.1..3.0);
            targets.push(ChainTarget::at(joint, random.vector(5.0)).with_weight(weight));
        }
    }
    (skeleton, targets)
}

fn is_within_limits(skeleton: &Skeleton) -> bool {
    skeleton.joints().iter().all(|joint| joint.limits.contains(joint.rotation))
}

#[test]
fn every_step_keeps_limits_locked_joints_joints_off_the_path_and_roots() {
    for method in ITERATIVE {
        let mut random = Random(11);
        for _ in 0..200 {
            let (mut skeleton, targets) = anything(&mut random);
            let before = skeleton.clone();
            let is_moved = |index: usize| {
                targets.iter().any(|t| before.is_in_subtree(t.joint, JointId::new(index)))
            };
            let mut solve =
                ChainSolver::new(&skeleton, &targets, &SolverOptions::new(method)).expect("solve");
            for _ in 0..15 {
                solve.step();
                solve.write(&mut skeleton);
                assert!(is_within_limits(&skeleton), "{method:?}");
                let joints = skeleton.joints().iter().zip(before.joints()).enumerate();
                for (index, (after, before)) in joints {
                    assert!(after.rotation.is_finite());
                    assert_eq!(after.offset, before.offset);
                    if before.locked || !is_moved(index) {
                        assert_eq!(after, before, "{method:?}");
                    }
                }
            }
        }
    }
}

#[test]
fn targets_within_the_limits_are_reached() {
    // Random limits, and a target from a pose within them; from the bind pose or a random one.
    for (method, least) in [
        (Method::DampedLeastSquares, 90),
        (Method::Ccd, 90),
        (Method::Fabrik, 90),
        (Method::Relaxation, 90),
    ] {
        let mut random = Random(5);
        let mut count = 0;
        for _ in 0..300 {
            let mut skeleton = chain(&mut random, 5, 1.0);
            for joint in 1..=5 {
                let limits = [(); 3].map(|()| Some(limit(&mut random)));
                skeleton
                    .change(JointId::new(joint), |joint| joint.limits = limits.into())
                    .expect("limits");
            }
            let targets = reachable(&mut random, &skeleton, &[JointId::new(5)]);
            solve(&mut skeleton, &targets, &SolverOptions::new(method)).expect("solve");
            assert!(is_within_limits(&skeleton));
            count += usize::from(
                error(&skeleton, &targets) <= 1e-3 * length(&skeleton, &[JointId::new(5)]),
            );
        }
        println!("{method:?}: {count} of 300");
        assert!(count * 100 >= 300 * least, "{method:?}: {count} of 300");
    }
}

#[test]
fn reported_errors_are_in_world_space_under_any_mirroring_and_scale() {
    for method in ITERATIVE {
        let mut random = Random(17);
        for _ in 0..200 {
            let (mut skeleton, targets) = anything(&mut random);
            let report =
                solve(&mut skeleton, &targets, &SolverOptions::new(method)).expect("solve");
            let seen = error(&skeleton, &targets);
            assert!((report.error - seen).abs() <= 1e-4 + 1e-4 * seen, "{report:?} but {seen}");
        }
    }
}

#[test]
fn mirrored_and_scaled_skeletons_reach_their_targets() {
    for method in [
        Method::Fabrik,
        Method::Relaxation,
        Method::Ccd,
        Method::DampedLeastSquares,
        Method::TwoBone,
    ] {
        let mut random = Random(23);
        for _ in 0..200 {
            let joints = if method == Method::TwoBone { 2 } else { 6 };
            let mut skeleton = chain(&mut random, joints, 1.0);
            skeleton.set_transform(transform(&mut random)).expect("transform");
            let targets = reachable(&mut random, &skeleton, &[JointId::new(joints)]);
            let report =
                solve(&mut skeleton, &targets, &SolverOptions::new(method)).expect("solve");
            let scale = skeleton.transform().matrix3.determinant().abs().cbrt();
            let length = scale * length(&skeleton, &[JointId::new(joints)]);
            assert!(error(&skeleton, &targets) <= 1e-3 * length, "{report:?}, length {length}");
        }
    }
}

/// Largest distance that a joint moved.
fn farthest_move(before: &Skeleton, after: &Skeleton) -> f32 {
    let (before, after) = (before.pose(), after.pose());
    before.points().zip(after.points()).map(|(a, b)| a.distance(b)).fold(0.0, f32::max)
}

#[test]
fn an_unreachable_target_straightens_the_chain_and_stalls_the_solver() {
    for method in Method::ALL {
        let mut random = Random(29);
        for case in 0..60 {
            // At its gimbal a single joint has no slope towards some targets.
            let joints = match (method, case % 4) {
                (Method::TwoBone, _) | (Method::Transpose, 0) => 2,
                (_, nth) => [1, 2, 3, 10][nth],
            };
            let mut skeleton = chain(&mut random, joints, 1.0);
            // A step size that converges from the bind pose may not converge from others.
            if method == Method::TransposeFixed {
                skeleton = straight(joints);
            } else if case % 3 > 0 {
                shake(&mut random, &mut skeleton);
            }
            let length = length(&skeleton, &[JointId::new(joints)]);
            let distance = length * [1.02, 1.5, 3.0, 1e6][case % 4 / 2 * 2 + case / 4 % 2];
            let targets = [target(JointId::new(joints), random.direction() * distance)];
            // Half a step: at the gimbal a whole one goes back and forth.
            let mut options = SolverOptions::new(method).with_step(0.4);
            if ![Method::Fabrik, Method::Relaxation, Method::Ccd, Method::TwoBone].contains(&method)
            {
                options.iterations = Some(20_000);
            }
            let report = solve(&mut skeleton, &targets, &options).expect("solve");
            let missing = report.error - (distance - length);
            let what = format!("{report:?}: {joints} joints, {distance} of {length}");
            assert!(missing.abs() <= 1e-3 * length + 1e-6 * distance, "{what}");
            assert!(report.status == Status::Stalled, "{what}");

            let stalled = skeleton.clone();
            solve(&mut skeleton, &targets, &options).expect("solve");
            let moved = farthest_move(&stalled, &skeleton);
            assert!(moved <= 1e-4 * length, "{what} moved by {moved} again");
        }
    }
}

#[test]
fn trees_with_unreachable_targets_stall_and_stay() {
    for method in ITERATIVE {
        let mut random = Random(31);
        for _ in 0..40 {
            let (mut skeleton, tips) = tree(&mut random, 3, 1.0);
            let length = length(&skeleton, &tips);
            let mut point = || random.direction() * 3.0 * length;
            let targets: Vec<_> = tips.iter().map(|tip| target(*tip, point())).collect();
            let options = SolverOptions::new(method).with_iterations(20_000).with_step(0.2);
            let report = solve(&mut skeleton, &targets, &options).expect("solve");
            assert!(report.status == Status::Stalled, "{report:?}");
            let stalled = skeleton.clone();
            solve(&mut skeleton, &targets, &options).expect("solve");
            let moved = farthest_move(&stalled, &skeleton);
            assert!(moved <= 1e-4 * length, "{report:?} moved by {moved}");
        }
    }
}

#[test]
fn a_straight_chain_bends_although_its_target_is_on_its_line() {
    for method in Method::ALL {
        for joints in [2, 3, 10] {
            if method == Method::TwoBone && joints > 2 {
                continue;
            }
            let skeleton = straight(joints);
            let length = joints as f32;
            for along in [0.9, 0.5, 0.1, 0.0, -0.1, -0.5, -0.9, -1.0, -2.0] {
                let targets = [target(JointId::new(joints), Vec3::Y * along * length)];
                let mut bent = skeleton.clone();
                let mut options = SolverOptions::new(method);
                options.iterations = options.iterations.max(Some(20 * method.budget()));
                let report = solve(&mut bent, &targets, &options).expect("solve");
                let least = (along.abs() - 1.0).max(0.0) * length;
                // At full stretch every iterative method converges slowly.
                assert!(report.error <= least + 1e-2 * length, "{report:?} at {along}, {joints}");
                assert!(bent.joints().iter().all(|joint| joint.rotation.is_finite()));
            }
        }
    }
}

#[test]
fn a_straight_knee_bends_the_way_its_limits_allow() {
    for method in Method::ALL {
        for range in [0.0..2.5, -2.5..0.0_f32] {
            let mut skeleton = Skeleton::default();
            skeleton.add(Joint::new("thigh", None, -Vec3::Y)).expect("thigh");
            let mut shin = Joint::new("shin", Some(JointId::new(0)), -Vec3::Y);
            shin.offset = -Vec3::Y;
            let still = Some(Limit { min: 0.0, max: 0.0 });
            shin.limits = [Some(Limit { min: range.start, max: range.end }), still, still].into();
            skeleton.add(shin).expect("shin");
            let targets = [target(JointId::new(1), Vec3::Y * -1.4)];
            let report =
                solve(&mut skeleton, &targets, &SolverOptions::new(method)).expect("solve");
            assert!(is_within_limits(&skeleton));
            assert!(report.error <= 2e-3, "{report:?} {range:?}");
        }
    }
}

#[test]
fn free_roots_move_to_their_targets() {
    for method in ITERATIVE {
        let mut random = Random(37);
        for case in 0..60 {
            let (mut skeleton, tips) = if case % 2 == 0 {
                (chain(&mut random, 5, 1.0), vec![5.into()])
            } else {
                tree(&mut random, 2, 1.0)
            };
            skeleton.set_transform(transform(&mut random)).expect("transform");
            let far = random.vector(100.0);
            let mut targets = reachable(&mut random, &skeleton, &tips);
            targets.iter_mut().for_each(|target| target.point += far);
            let options = SolverOptions::new(method).with_root(Root::Free);
            let report = solve(&mut skeleton, &targets, &options).expect("solve");
            let scale = skeleton.transform().matrix3.determinant().abs().cbrt();
            let length = scale * length(&skeleton, &tips);
            let seen = error(&skeleton, &targets);
            let share = match method {
                Method::TransposeFixed | Method::Transpose if tips.len() > 1 => 0.2,
                Method::TransposeFixed | Method::Transpose => 0.05,
                _ => 1e-3,
            };
            assert!(seen <= share * length + 1e-4, "{report:?} but {seen} of {length}");
            assert!((seen - report.error).abs() <= 1e-4 * length + 1e-4, "{report:?} but {seen}");
        }
    }
}

#[test]
fn roots_turn_and_move_only_as_they_may() {
    for method in ITERATIVE {
        let mut random = Random(38);
        for case in 0..60 {
            let (mut skeleton, tips) = tree(&mut random, 2, 1.0);
            skeleton.set_axis(JointId::new(0), Vec3::Y).expect("axis");
            shake(&mut random, &mut skeleton);
            skeleton.change(JointId::new(0), |root| root.locked = false).expect("unlock");
            let before = skeleton.clone();
            let mut targets = reachable(&mut random, &skeleton, &tips);
            targets.iter_mut().for_each(|target| target.point += Vec3::X);
            let root = Root::ALL[case % 3];
            let options = SolverOptions::new(method).with_root(root).with_iterations(20);
            solve(&mut skeleton, &targets, &options).expect("solve");
            let [was, is] = [&before, &skeleton].map(|skeleton| &skeleton[JointId::new(0)]);
            let turns = tips.iter().any(|tip| skeleton.tip(*tip) != before.tip(*tip));
            assert!(turns, "{method:?} {root:?}");
            assert_eq!(is.rotation != was.rotation, root != Root::Locked, "{method:?} {root:?}");
            assert_eq!(is.offset != was.offset, root == Root::Free, "{method:?} {root:?}");
        }
    }
}

#[test]
fn a_locked_root_solves_like_a_root_joint_that_is_locked() {
    for method in Method::ALL {
        let mut random = Random(39);
        for _ in 0..30 {
            let joints = if method == Method::TwoBone { 2 } else { 5 };
            let mut skeleton = chain(&mut random, joints, 1.0);
            let mut unlocked = skeleton.clone();
            unlocked.change(JointId::new(0), |root| root.locked = false).expect("unlock");
            let targets = reachable(&mut random, &skeleton, &[JointId::new(joints)]);
            let options = SolverOptions::new(method);
            let expected = solve(&mut skeleton, &targets, &options).expect("solve");
            let options = options.with_root(Root::Locked);
            let report = solve(&mut unlocked, &targets, &options).expect("solve");
            assert_eq!(report, expected);
            let rotations = |skeleton: &Skeleton| -> Vec<Vec3> {
                skeleton.joints().iter().map(|joint| joint.rotation).collect()
            };
            assert_eq!(rotations(&unlocked), rotations(&skeleton));
        }
    }
}

#[test]
fn the_heavier_of_two_targets_that_conflict_is_nearer() {
    for method in ITERATIVE {
        let mut skeleton = Skeleton::with_root("root");
        skeleton.add(Joint::new("trunk", Some(JointId::new(0)), Vec3::Y * 2.0)).expect("trunk");
        for (name, side) in [("left", -Vec3::X), ("right", Vec3::X)] {
            let joint =
                Joint { offset: Vec3::Y * 2.0, ..Joint::new(name, Some(JointId::new(1)), side) };
            skeleton.add(joint).expect("arm");
        }
        for (left, right) in [(5.0, 1.0), (1.0, 5.0), (500.0, 100.0)] {
            let mut solved = skeleton.clone();
            let mut targets = [
                target(JointId::new(2), Vec3::new(-3.0, 1.5, 0.2)),
                target(JointId::new(3), Vec3::new(3.0, 1.5, 0.2)),
            ];
            targets[0].weight = left;
            targets[1].weight = right;
            let report = solve(&mut solved, &targets, &SolverOptions::new(method)).expect("solve");
            let off = targets.map(|t| solved.tip(t.joint).distance(t.point));
            assert_eq!(off[0] < off[1], left > right, "{report:?}: {off:?}");
            assert!((off[0] - off[1]).abs() > 0.1, "{report:?}: {off:?}");
        }
    }
}

#[test]
fn single_steps_are_bit_identical_to_a_run() {
    for method in ITERATIVE {
        let mut random = Random(41);
        for _ in 0..30 {
            let (skeleton, targets) = anything(&mut random);
            let new = || {
                ChainSolver::new(&skeleton, &targets, &SolverOptions::new(method)).expect("solve")
            };
            let (mut run, mut again, mut stepped) = (new(), new(), new());
            run.run();
            again.run();
            assert_eq!(run, again);
            for _ in 0..method.budget() {
                let report = stepped.step();
                assert_eq!(report, stepped.report());
            }
            assert_eq!(run, stepped);
        }
    }
}

#[test]
fn a_solver_follows_moving_targets() {
    for method in ITERATIVE {
        let mut skeleton = straight(6);
        let length = 6.0;
        let at = |turn: f32| {
            let point = Vec3::new(turn.cos(), turn.sin(), (2.0 * turn).sin()) * 0.5 * length;
            [target(JointId::new(6), point)]
        };
        let mut solve =
            ChainSolver::new(&skeleton, &at(0.0), &SolverOptions::new(method)).expect("solve");
        for step in 0..100 {
            let targets = at(step as f32 * 0.05);
            solve.retarget(&targets).expect("the same joints");
            solve.run();
            solve.write(&mut skeleton);
            assert!(error(&skeleton, &targets) <= 1e-2 * length, "{:?}", solve.report());
        }
        // Out of reach and back.
        solve
            .retarget(&[target(JointId::new(6), Vec3::X * 10.0 * length)])
            .expect("the same joint");
        assert!(solve.report().status != Status::Stalled);
        assert!(!solve.run().converged());
        solve.retarget(&at(1.0)).expect("the same joint");
        assert!(solve.run().error <= 1e-2 * length, "{:?}", solve.report());
        assert_eq!(solve.retarget(&[]), Err(SolveError::NoJoint(JointId::new(6))));
        assert_eq!(
            solve.retarget(&[target(JointId::new(5), Vec3::X)]),
            Err(SolveError::NoJoint(JointId::new(5)))
        );
    }
}

#[test]
fn a_solver_that_returns_to_its_start_writes_the_start_pose() {
    for method in [Method::Ccd, Method::Fabrik, Method::Relaxation] {
        let mut skeleton = straight(1);
        let mut solve = ChainSolver::new(
            &skeleton,
            &[target(JointId::new(1), Vec3::X)],
            &SolverOptions::new(method),
        )
        .expect("solve");
        solve.run();
        solve.write(&mut skeleton);
        assert!(skeleton.tip(JointId::new(1)).distance(Vec3::X) < 1e-6);
        solve.retarget(&[target(JointId::new(1), Vec3::Y)]).expect("the same joint");
        solve.run();
        solve.write(&mut skeleton);
        assert!(
            skeleton.tip(JointId::new(1)).distance(Vec3::Y) < 1e-6,
            "{method:?}: {:?}",
            solve.report()
        );
    }
}

#[test]
fn a_target_at_a_tiny_distance_from_a_joint_does_not_stretch_its_bone() {
    for method in ITERATIVE {
        let mut skeleton = straight(1);
        let targets = [target(JointId::new(1), Vec3::new(3e-23, 2e-23, 1e-23))];
        let report = solve(&mut skeleton, &targets, &SolverOptions::new(method)).expect("solve");
        let seen = error(&skeleton, &targets);
        assert!((seen - report.error).abs() <= 1e-5, "{report:?} but {seen}");
    }
}

#[test]
fn a_bone_negligibly_short_beside_its_chain_keeps_the_closed_form_finite() {
    let mut skeleton = Skeleton::default();
    let far = skeleton.add(Joint::new("far", None, Vec3::X * 1e13)).expect("joint");
    let upper = Joint { offset: Vec3::X * 1e13, ..Joint::new("upper", Some(far), Vec3::Y) };
    let upper = skeleton.add(upper).expect("joint");
    let lower = Joint { offset: Vec3::Y, ..Joint::new("lower", Some(upper), Vec3::Y * 1e8) };
    let lower = skeleton.add(lower).expect("joint");
    solve(&mut skeleton, &[target(lower, Vec3::Y)], &SolverOptions::new(Method::TwoBone))
        .expect("solve");
    assert!(skeleton.joints().iter().all(|joint| joint.rotation.is_finite()));
}

#[test]
fn a_step_that_overflows_leaves_finite_angles() {
    for root in Root::ALL {
        let mut skeleton = straight(3);
        let options =
            SolverOptions::new(Method::TransposeFixed).with_step(f32::MAX).with_root(root);
        let targets = [target(JointId::new(3), Vec3::new(1.0, 0.5, 0.0))];
        solve(&mut skeleton, &targets, &options).expect("solve");
        let is_whole = |joint: &Joint| joint.rotation.is_finite() && joint.offset.is_finite();
        assert!(skeleton.iter().all(|(_, joint)| is_whole(joint)), "{root:?}");
    }
}

#[test]
fn a_free_root_that_is_clamped_reports_its_error() {
    let mut skeleton = straight(2);
    skeleton.set_transform(Affine3A::from_scale(Vec3::splat(1e-30))).expect("transform");
    let targets = [target(JointId::new(2), Vec3::X * 1e38)];
    let options = SolverOptions::new(Method::Fabrik).with_root(Root::Free);
    let report = solve(&mut skeleton, &targets, &options).expect("solve");
    let seen = skeleton.tip(JointId::new(2)).as_dvec3().distance(targets[0].point.as_dvec3());
    assert!((f64::from(report.error) / seen - 1.0).abs() < 1e-3, "{report:?} but {seen}");
}

#[test]
fn without_targets_there_is_nothing_to_do() {
    for method in Method::ALL {
        let mut skeleton = Skeleton::with_root("root");
        let report = solve(&mut skeleton, &[], &SolverOptions::new(method)).expect("solve");
        let expected = Report {
            method,
            iterations: 0,
            error: 0.0,
            orientation_error: 0.0,
            status: Status::Converged,
        };
        assert_eq!(report, expected);
    }
}

#[test]
fn poses_stay_finite_at_every_edge() {
    let scales = [1e-30, 1e-20, 1e-3, 1.0, 1e3, 1e20, 1e30];
    for method in ITERATIVE {
        for root in Root::ALL {
            let mut random = Random(47);
            for case in 0..scales.len() * 12 {
                let scale = scales[case % scales.len()];
                let (mut skeleton, tips) = match case / scales.len() {
                    0..4 => (chain(&mut random, 4, scale), vec![4.into()]),
                    4..6 => (chain(&mut random, 1, scale), vec![1.into()]),
                    6..8 => tree(&mut random, 3, scale),
                    8 => (chain(&mut random, 3, 0.0), vec![3.into(), 1.into()]),
                    _ => (Skeleton::with_root("root"), vec![0.into()]),
                };
                if case % 5 == 0 && skeleton.joints().len() > 2 {
                    skeleton.set_axis(JointId::new(1), Vec3::ZERO).expect("axis");
                }
                let distances = [0.0, 0.5 * scale, 1e8 * scale.min(1.0), f32::MAX / 4.0];
                let far = distances[case / scales.len() % 4];
                let point = random.direction() * far;
                let targets: Vec<_> = tips.iter().map(|tip| target(*tip, point)).collect();
                let options = SolverOptions::new(method).with_root(root).with_iterations(60);
                let report = solve(&mut skeleton, &targets, &options).expect("solve");
                assert!(report.error.is_finite(), "{report:?} at {scale}, {far}");
                for joint in skeleton.joints() {
                    assert!(joint.rotation.is_finite() && joint.offset.is_finite(), "{report:?}");
                }
            }
        }
    }
}

#[test]
fn huge_and_tiny_skeletons_solve_like_others() {
    for method in [
        Method::Fabrik,
        Method::Relaxation,
        Method::Ccd,
        Method::DampedLeastSquares,
        Method::TwoBone,
    ] {
        for scale in [1e-30, 1e30] {
            let mut random = Random(53);
            for _ in 0..20 {
                let mut skeleton = chain(&mut random, 2, scale);
                let targets = reachable(&mut random, &skeleton, &[JointId::new(2)]);
                let report =
                    solve(&mut skeleton, &targets, &SolverOptions::new(method)).expect("solve");
                assert!(
                    report.error <= 1e-3 * length(&skeleton, &[JointId::new(2)]),
                    "{report:?} at {scale}"
                );
            }
        }
    }
}

#[test]
fn two_bones_keep_the_elbow_on_its_side() {
    let mut skeleton = Skeleton::default();
    skeleton.add(Joint::new("upper", None, Vec3::X)).expect("upper");
    let lower = Joint { offset: Vec3::X, ..Joint::new("lower", Some(JointId::new(0)), Vec3::X) };
    skeleton.add(lower).expect("lower");
    for side in [1.0, -1.0] {
        skeleton.set_rotation(JointId::new(0), Vec3::Z * side).expect("rotation");
        skeleton.set_rotation(JointId::new(1), Vec3::Z * -2.0 * side).expect("rotation");
        for along in [0.1, 0.5, 1.0, 1.5, 1.99] {
            let mut solved = skeleton.clone();
            let targets = [target(JointId::new(1), Vec3::X * along)];
            let report =
                solve(&mut solved, &targets, &SolverOptions::new(Method::TwoBone)).expect("solve");
            assert!(report.converged(), "{report:?}");
            let elbow = solved.base(JointId::new(1));
            assert!(elbow.y * side > 0.0 && elbow.z.abs() < 1e-5, "{elbow}");
        }
    }
}

#[test]
fn invalid_problems_are_refused() {
    let mut random = Random(59);
    let skeleton = chain(&mut random, 3, 1.0);
    let options = SolverOptions::default();
    let refused = |targets: &[ChainTarget], options: &SolverOptions| {
        ChainSolver::new(&skeleton, targets, options).map(|_| ()).expect_err("refused")
    };
    let at = |joint| target(joint, Vec3::ONE);
    assert_eq!(refused(&[at(JointId::new(4))], &options), SolveError::NoJoint(JointId::new(4)));
    assert_eq!(
        refused(&[at(JointId::new(3)), at(JointId::new(3))], &options),
        SolveError::TwoTargets(JointId::new(3))
    );
    let nowhere = target(JointId::new(3), Vec3::new(0.0, f32::INFINITY, 0.0));
    assert_eq!(
        refused(&[nowhere], &options),
        SolveError::Point { joint: JointId::new(3), point: nowhere.point }
    );
    for weight in [0.0, -1.0, f32::INFINITY] {
        let light = ChainTarget { weight, ..at(JointId::new(3)) };
        assert_eq!(
            refused(&[light], &options),
            SolveError::Weight { joint: JointId::new(3), weight }
        );
    }
    let field = |options: SolverOptions| match refused(&[at(JointId::new(3))], &options) {
        SolveError::Option { field, .. } => field,
        other => panic!("{other}"),
    };
    assert_eq!(field(options.with_damping(0.0)), OptionField::Damping);
    assert_eq!(field(options.with_step(f32::NAN)), OptionField::Step);
    assert_eq!(field(options.with_tolerance(-1.0)), OptionField::Tolerance);
}

#[test]
fn a_singular_transform_is_refused() {
    let mut random = Random(61);
    let mut skeleton = chain(&mut random, 2, 1.0);
    for scale in [Vec3::ZERO, Vec3::new(1.0, 0.0, 1.0)] {
        let flat = Mat3A::from_diagonal(scale);
        for matrix3 in
            [flat, Mat3A::from(random.rotation()) * flat, flat * Mat3A::from(random.rotation())]
        {
            let transform = Affine3A { matrix3, ..Affine3A::IDENTITY };
            skeleton.set_transform(transform).expect("finite");
            let refused = ChainSolver::new(
                &skeleton,
                &[target(JointId::new(2), Vec3::ONE)],
                &SolverOptions::default(),
            );
            assert_eq!(refused, Err(SolveError::Singular));
        }
    }
}

#[test]
fn the_closed_form_is_refused_without_two_bones() {
    let mut random = Random(67);
    let skeleton = chain(&mut random, 4, 1.0);
    let refused = |skeleton: &Skeleton, joints: &[JointId]| {
        let targets: Vec<_> = joints.iter().map(|joint| target(*joint, Vec3::ONE)).collect();
        match ChainSolver::new(skeleton, &targets, &SolverOptions::new(Method::TwoBone)) {
            Err(SolveError::TwoBone { joint, reason }) => (joint.index(), reason),
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(refused(&skeleton, &[JointId::new(0)]), (0, TwoBoneRefusal::NoParent));
    assert_eq!(refused(&skeleton, &[JointId::new(1)]), (1, TwoBoneRefusal::ParentLocked));
    assert_eq!(
        refused(&skeleton, &[JointId::new(3), JointId::new(4)]),
        (4, TwoBoneRefusal::Shared)
    );
    let mut locked = skeleton.clone();
    locked.change(JointId::new(3), |joint| joint.locked = true).expect("lock");
    assert_eq!(refused(&locked, &[JointId::new(3)]), (3, TwoBoneRefusal::Locked));
    let mut short = skeleton.clone();
    short.set_axis(JointId::new(3), Vec3::ZERO).expect("axis");
    assert_eq!(refused(&short, &[JointId::new(3)]), (3, TwoBoneRefusal::NoLength));
    // One arm may hang from another.
    let targets = reachable(&mut random, &skeleton, &[JointId::new(4), JointId::new(2)]);
    let report = solve(&mut skeleton.clone(), &targets, &SolverOptions::new(Method::TwoBone))
        .expect("two arms");
    assert!(report.converged(), "{report:?}");
}

#[test]
fn a_reached_target_leaves_every_angle_unchanged() {
    let mut random = Random(71);
    for method in Method::ALL {
        let mut skeleton = chain(&mut random, 2, 1.0);
        shake(&mut random, &mut skeleton);
        let before = skeleton.clone();
        let targets = [target(JointId::new(2), skeleton.tip(JointId::new(2)))];
        assert!(
            solve(&mut skeleton, &targets, &SolverOptions::new(method)).expect("solve").converged()
        );
        assert_eq!(skeleton, before);
    }
}

#[test]
fn world_errors_use_the_inverse_of_the_transform_in_f64() {
    // A skeleton far from the world's origin and scaled by a thousandth still meets its tolerance.
    let mut random = Random(73);
    let mut skeleton = chain(&mut random, 4, 1.0);
    let small = DAffine3::from_scale(DVec3::splat(1e-3)).as_affine3a();
    skeleton.set_transform(small).expect("transform");
    let targets = reachable(&mut random, &skeleton, &[JointId::new(4)]);
    let options = SolverOptions::default().with_tolerance(1e-6);
    let report = solve(&mut skeleton, &targets, &options).expect("solve");
    assert!(report.converged() && report.error <= 1e-6, "{report:?}");
}

#[test]
fn an_unreachable_target_does_not_stop_another_chain_from_reaching_its_own() {
    for (method, near_enough) in [
        (Method::Transpose, 2e-2),
        (Method::DampedLeastSquares, 1e-3),
        (Method::Ccd, 1e-3),
        (Method::Fabrik, 1e-3),
        (Method::Relaxation, 1e-3),
    ] {
        let mut skeleton = Skeleton::default();
        let mut tips = Vec::new();
        for chain in 0..2_usize {
            let mut parent = None;
            for bone in 0..4_usize {
                let offset = match parent {
                    None => Vec3::X * (3.0 * chain as f32),
                    Some(_) => Vec3::Y * 0.5,
                };
                let name = format!("bone {bone} of chain {chain}");
                let rotation = Vec3::new(0.0, 0.0, 0.2);
                let joint = Joint { offset, rotation, ..Joint::new(&name, parent, Vec3::Y * 0.5) };
                parent = Some(skeleton.add(joint).expect("a joint"));
            }
            tips.extend(parent);
        }
        let near = ChainTarget::at(tips[0], Vec3::new(0.9, 1.0, 0.4));
        let far = ChainTarget::at(tips[1], Vec3::new(9.0, 1.0, 0.0));
        let options = SolverOptions::new(method);
        let report = solve(&mut skeleton, &[near, far], &options).expect("it can be solved");
        assert!(!report.converged());
        let missed = skeleton.tip(tips[0]).distance(near.point);
        assert!(missed < near_enough, "{method:?} misses by {missed} after {report:?}");
    }
}

#[test]
fn bones_whose_squares_overflow_get_finite_rotations_or_none() {
    let mut random = Random(19);
    for unit in [3e18, 1e19, 1e30, 1e38] {
        let roots = Root::ALL;
        for (method, root) in Method::ALL.into_iter().flat_map(|it| roots.map(|root| (it, root))) {
            for _ in 0..20 {
                let mut skeleton = chain(&mut random, 3, 1.0);
                let long = random.direction() * unit;
                skeleton.set_axis(JointId::new(3), long).expect("finite");
                let point = random.direction() * unit;
                let options = SolverOptions::new(method).with_root(root);
                if let Ok(report) =
                    solve(&mut skeleton, &[target(JointId::new(3), point)], &options)
                {
                    assert!(report.error.is_finite(), "{report:?}");
                }
                for joint in skeleton.joints() {
                    let are_numbers = joint.rotation.is_finite() && joint.offset.is_finite();
                    assert!(are_numbers, "{method:?} {root:?} of {unit}: {joint:?}");
                }
            }
        }
    }
}

#[cfg(feature = "serde")]
#[test]
fn methods_and_states_have_one_name_in_serde_and_on_the_command_line() {
    for method in Method::ALL {
        let json = serde_json::to_string(&SolverOptions::new(method)).expect("finite numbers");
        assert!(json.contains(&format!("\"method\":\"{method}\"")), "{json}");
        let read: SolverOptions = serde_json::from_str(&json).expect("the same");
        assert_eq!(read, SolverOptions::new(method));
    }
    let error = serde_json::from_str::<Method>("\"newton\"").expect_err("no method");
    assert!(error.to_string().starts_with("must be one of transpose-fixed, "), "{error}");
    assert_eq!(Status::OutOfIterations.to_string(), "out of iterations");
}
