//! Places of targets: for other points of a joint than its tip, and at several distances.

use glam::Vec3;
use ik_arm_kinematics::chain_ik::{
    ChainSolver, ChainTarget, Effector, Method, SolveError, SolverOptions, solve,
};
use ik_arm_kinematics::skeleton::{Joint, JointId, JointLimits, Limit, RotationAxis, Skeleton};

use crate::common::Random;
use crate::common::skeletons::{ITERATIVE, chain, grip, shake, transform, tree};

#[test]
fn a_grip_is_solved_like_the_tip_of_a_locked_child() {
    let mut random = Random(391);
    for case in 0..300 {
        let (mut skeleton, tips) = tree(&mut random, 2, 1.0);
        skeleton.set_transform(transform(&mut random)).expect("a transform");
        shake(&mut random, &mut skeleton);
        let method = random.one_of(&ITERATIVE);
        let grips = [(); 2].map(|()| random.vector(0.7));
        let points = [(); 2].map(|()| skeleton.tip(tips[0]) + random.vector(1.0));
        let mut leaves = skeleton.clone();
        let mut targets = [Vec::new(), Vec::new()];
        for index in 0..2 {
            let (joint, grip) = (tips[index], grips[index]);
            let leaf =
                Joint { locked: true, ..Joint::new(&format!("leaf{index}"), Some(joint), grip) };
            let leaf = leaves.add(leaf).expect("a leaf");
            let place = ChainTarget::at(joint, points[index]);
            targets[0].push(place.with_grip(grip));
            targets[1].push(ChainTarget { joint: leaf, ..place });
        }
        let options = SolverOptions::new(method).with_iterations(40);
        let one = solve(&mut skeleton, &targets[0], &options).expect("solved");
        let other = solve(&mut leaves, &targets[1], &options).expect("solved");
        assert_eq!(one, other, "case {case}, {method}");
        for (joint, own) in skeleton.iter() {
            assert_eq!(own.rotation, leaves[joint].rotation, "case {case}, {method}, {joint}");
        }
    }
}

#[test]
fn two_grips_of_a_joint_place_and_turn_it() {
    let mut random = Random(392);
    for method in [Method::DampedLeastSquares, Method::Transpose, Method::Ccd, Method::Fabrik] {
        let mut reached = 0;
        for _ in 0..40 {
            let mut skeleton = chain(&mut random, 5, 1.0);
            let mut posed = skeleton.clone();
            shake(&mut random, &mut posed);
            let joint = JointId::new(5);
            let targets: Vec<ChainTarget> = [Vec3::X, Vec3::Z]
                .map(|grip| {
                    let point = posed.point_in_world(joint, grip);
                    ChainTarget::at(joint, point).with_grip(grip)
                })
                .to_vec();
            let report =
                solve(&mut skeleton, &targets, &SolverOptions::new(method)).expect("solved");
            reached += usize::from(report.converged());
        }
        assert!(reached >= 38, "{method}: {reached}");
    }
}

#[test]
fn targets_of_the_same_point_and_distances_out_of_order_are_refused() {
    let skeleton = chain(&mut Random(393), 3, 1.0);
    let joint = JointId::new(3);
    let place = ChainTarget::at(joint, Vec3::ONE);
    let refusal = |targets: &[ChainTarget]| {
        ChainSolver::new(&skeleton, targets, &SolverOptions::default()).err()
    };
    let gripped = place.with_grip(Vec3::X);
    assert_eq!(refusal(&[place, gripped]), None);
    assert_eq!(refusal(&[gripped, place, gripped]), Some(SolveError::TwoTargets(joint)));
    for [least, most] in [[1.0, 0.5], [-0.1, 1.0], [0.0, f32::INFINITY]] {
        let refused = SolveError::Distances { joint, least, most };
        assert_eq!(refusal(&[place.with_distances(least, most)]), Some(refused));
    }
    let nowhere = ChainTarget { effector: Effector::Grip(Vec3::NAN), ..place };
    assert!(matches!(refusal(&[nowhere]), Some(SolveError::Point { .. })));
}

/// Distance of a joint's tip from a point in f64.
fn distance(skeleton: &Skeleton, target: &ChainTarget) -> f64 {
    skeleton.tip(target.joint).as_dvec3().distance(target.point.as_dvec3())
}

#[test]
fn a_tip_at_an_allowed_distance_moves_nothing() {
    let mut random = Random(394);
    for method in ITERATIVE {
        for case in 0..30 {
            let mut skeleton = chain(&mut random, 5, 1.0);
            shake(&mut random, &mut skeleton);
            let joint = JointId::new(5);
            let point = skeleton.tip(joint) + random.direction();
            let target = ChainTarget::at(joint, point).with_distances(0.5, 1.5);
            let before = skeleton.clone();
            let report =
                solve(&mut skeleton, &[target], &SolverOptions::new(method)).expect("solved");
            assert_eq!((report.iterations, report.error), (0, 0.0), "{method}, case {case}");
            assert_eq!(skeleton, before, "{method}, case {case}");
        }
    }
}

#[test]
fn a_tip_too_far_or_too_near_comes_to_the_border() {
    for method in ITERATIVE {
        let mut random = Random(395);
        let mut reached = 0;
        for _ in 0..100 {
            let mut skeleton = chain(&mut random, 5, 1.0);
            shake(&mut random, &mut skeleton);
            let joint = JointId::new(5);
            let point = random.vector(1.5);
            let now = skeleton.tip(joint).distance(point);
            let [least, most] = if random.chance(0.5) {
                [0.0, now * random.within(0.3..0.9)]
            } else {
                [now * random.within(1.05..1.2), 100.0]
            };
            let target = ChainTarget::at(joint, point).with_distances(least, most);
            let options = SolverOptions::new(method);
            let report = solve(&mut skeleton, &[target], &options).expect("solved");
            let distance = distance(&skeleton, &target);
            let border = if most < 100.0 { most } else { least };
            // A method may come past the border by its last step.
            let way = f64::from((now - border).abs());
            let is_there = (distance - f64::from(border)).abs() < 0.1 * way + 1e-3;
            reached += usize::from(report.converged() && is_there);
        }
        assert!(reached >= 95, "{method}: {reached}");
    }
}

#[test]
fn held_places_give_way_only_as_far_as_they_may() {
    // Two legs on a pelvis that turns and moves, each foot point near its place; a third target
    // pulls the top.
    for method in [Method::DampedLeastSquares, Method::Transpose, Method::Ccd, Method::Fabrik] {
        let mut random = Random(396);
        let mut reached = 0;
        for _ in 0..60 {
            let mut skeleton = chain(&mut random, 4, 1.0);
            let root = JointId::new(0);
            skeleton.change(root, |root| root.locked = false).expect("a root");
            shake(&mut random, &mut skeleton);
            let grips = [Vec3::new(0.3, -0.5, 0.0), Vec3::new(-0.3, -0.5, 0.0)];
            let tip = JointId::new(4);
            let mut targets: Vec<ChainTarget> = grips
                .iter()
                .map(|grip| {
                    let from = skeleton.point_in_world(root, *grip);
                    let point = from + random.direction() * random.within(0.2..0.95);
                    ChainTarget::at(root, point).with_grip(*grip).with_distances(0.1, 1.0)
                })
                .collect();
            // A pose that all can have: the root shifted and turned a little.
            let mut posed = skeleton.clone();
            shake(&mut random, &mut posed);
            posed.set_rotation(root, skeleton[root].rotation).expect("angles");
            targets.push(ChainTarget::at(tip, posed.tip(tip) + random.vector(0.05)));
            let options =
                SolverOptions::new(method).with_root(ik_arm_kinematics::chain_ik::Root::Free);
            let report = solve(&mut skeleton, &targets, &options).expect("solved");
            let held = targets[..2].iter().all(|target| {
                let at = skeleton.point_in_world(root, grip(target));
                (0.1 - 1e-3..1.0 + 1e-3).contains(&at.distance(target.point))
            });
            reached += usize::from(report.converged() && held);
        }
        assert!(reached >= 57, "{method}: {reached}");
    }
}

#[test]
fn a_hinge_stops_where_its_tip_comes_into_the_shell() {
    let mut skeleton = Skeleton::with_root("root");
    let fixed = Some(Limit { min: 0.0, max: 0.0 });
    let bone = Joint::new("bone", Some(JointId::new(0)), Vec3::X);
    let joint = skeleton.add(bone).expect("a joint");
    let limits = JointLimits::new([fixed, fixed, None]);
    skeleton.change(joint, |joint| joint.limits = limits).expect("limits");
    // The tip on the unit circle at the angle θ is at 2 sin((90° − θ)/2) from (0, 1).
    let target = ChainTarget::at(joint, Vec3::Y).with_distances(0.0, 0.8);
    let expected = 90.0_f64.to_radians() - 2.0 * (0.4_f64).asin();
    for method in ITERATIVE {
        let mut posed = skeleton.clone();
        let options = SolverOptions::new(method).with_tolerance(1e-5);
        let report = solve(&mut posed, &[target], &options).expect("solved");
        let turned = f64::from(posed[joint].rotation[RotationAxis::Z.index()]);
        assert!(report.converged(), "{method}: {report:?}");
        assert!(
            (turned - expected).abs() < 0.1 * expected,
            "{method}: {turned} instead of {expected}"
        );
    }
}
