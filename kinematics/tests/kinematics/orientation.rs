//! Targets that ask for a rotation or an aim, against an f64 twin: matrices of the formula, and
//! finite differences.

use std::f32::consts::PI;

use glam::{DMat3, DQuat, DVec3, Quat, Vec3};
use ik_arm_kinematics::chain_ik::{
    ChainSolver, ChainTarget, Method, OrientRefusal, Orientation, SolveError, SolverOptions,
    Status, SubStepKind, solve,
};
use ik_arm_kinematics::skeleton::{Joint, JointId, JointLimits, Limit, RotationAxis, Skeleton};

use crate::common::Random;
use crate::common::gradient::{angles_f64, assert_first_step_descends, to_skeleton_f64};
use crate::common::skeletons::{
    ITERATIVE, chain, forest, length, shake, space_f64, transform, tree,
};

/// The methods that turn joints to rotations where their tips have places.
fn orienting() -> impl Iterator<Item = Method> {
    ITERATIVE.into_iter().filter(|method| method.can_orient())
}

/// The methods that also aim, and turn joints whose tips may be anywhere.
fn aiming() -> impl Iterator<Item = Method> {
    orienting().filter(|method| {
        ![OrientRefusal::Aim, OrientRefusal::FreePlace].iter().any(|it| method.refuses(*it))
    })
}

/// The rotation of a joint's space in skeleton space.
fn rotation(skeleton: &Skeleton, joint: JointId, angles: &[DVec3]) -> DMat3 {
    DMat3::from_mat4(space_f64(skeleton, joint, angles))
}

fn rotation_target(posed: &Skeleton, joint: JointId) -> Orientation {
    let wanted = DQuat::from_mat3(&rotation(posed, joint, &angles_f64(posed)));
    Orientation::Rotation(wanted.as_quat())
}

/// The angle that a target's orientation misses.
fn missing(skeleton: &Skeleton, target: &ChainTarget, angles: &[DVec3]) -> f64 {
    let space = space_f64(skeleton, target.joint, angles);
    match target.orientation {
        None => 0.0,
        Some(Orientation::Rotation(wanted)) => {
            let off = DMat3::from_quat(wanted.as_dquat().normalize()).transpose()
                * DMat3::from_mat4(space);
            let sine = DVec3::new(
                off.y_axis.z - off.z_axis.y,
                off.z_axis.x - off.x_axis.z,
                off.x_axis.y - off.y_axis.x,
            );
            let trace = off.x_axis.x + off.y_axis.y + off.z_axis.z;
            sine.length().atan2(trace - 1.0)
        }
        Some(Orientation::Aim { axis, point }) => {
            let point = to_skeleton_f64(skeleton).transform_point3(point.as_dvec3());
            let way = point - space.transform_point3(DVec3::ZERO);
            let axis = space.transform_vector3(axis.as_dvec3());
            axis.cross(way).length().atan2(axis.dot(way))
        }
    }
}

/// f = Σ ½ w |tip − target|² + Σ ½ w ℓ² φ², in skeleton units, with ℓ a quarter of the chain.
fn cost(skeleton: &Skeleton, targets: &[ChainTarget], angles: &[DVec3]) -> f64 {
    let tips: Vec<JointId> = targets.iter().map(|target| target.joint).collect();
    let turn_length = 0.25 * f64::from(length(skeleton, &tips));
    let of_target = |target: &ChainTarget| {
        let axis = skeleton[target.joint].axis.as_dvec3();
        let tip = space_f64(skeleton, target.joint, angles).transform_point3(axis);
        let off = tip - to_skeleton_f64(skeleton).transform_point3(target.point.as_dvec3());
        let turned = turn_length * missing(skeleton, target, angles);
        let turned = f64::from(target.orientation_weight) * turned.powi(2);
        0.5 * (f64::from(target.weight) * off.length_squared() + turned)
    };
    targets.iter().map(of_target).sum()
}

/// A skeleton of random trees and targets of all kinds, without limits, under any transform.
fn problem(random: &mut Random) -> (Skeleton, Vec<ChainTarget>) {
    let joints = 3 + random.below(7);
    let forest = forest(random, joints);
    let mut joints: Vec<Joint> = forest.iter().map(|(_, joint)| joint.clone()).collect();
    joints.iter_mut().for_each(|joint| joint.limits = JointLimits::default());
    let mut skeleton = Skeleton::from_joints(joints).expect("a forest");
    skeleton.set_transform(transform(random)).expect("transform");
    let mut targets = Vec::new();
    for joint in skeleton.ids().filter(|joint| skeleton[*joint].axis != Vec3::ZERO) {
        if !random.chance(0.5) && !targets.is_empty() {
            continue;
        }
        let point =
            skeleton.tip(joint) + skeleton.transform().transform_vector3(random.vector(0.5));
        let orientation = if random.chance(0.5) {
            Orientation::Rotation(Quat::from_mat3(&random.rotation()))
        } else {
            let far = skeleton.transform().transform_vector3(3.0 * random.direction());
            Orientation::Aim { axis: random.direction(), point: skeleton.tip(joint) + far }
        };
        let target = ChainTarget::at(joint, point).with_orientation(orientation);
        let weights = [random.within(0.0..2.0), random.within(0.1..2.0)];
        targets.push(target.with_weight(weights[0]).with_orientation_weight(weights[1]));
    }
    (skeleton, targets)
}

#[test]
fn gradients_are_those_of_finite_differences() {
    let mut random = Random(38);
    for case in 0..300 {
        let (skeleton, targets) = problem(&mut random);
        let free = skeleton.ids().filter(|joint| !skeleton[*joint].locked);
        assert_first_step_descends(
            case,
            &skeleton,
            &targets,
            &free.collect::<Vec<_>>(),
            |angles| cost(&skeleton, &targets, angles),
        );
    }
}

#[test]
fn missing_turns_inside_an_iteration_and_their_columns_are_those_of_finite_differences() {
    const STEP: f64 = 1e-5;
    let mut random = Random(380);
    let mut columns = 0;
    for case in 0..150 {
        let (skeleton, targets) = problem(&mut random);
        let options = SolverOptions::new(Method::DampedLeastSquares);
        let mut solver = ChainSolver::new(&skeleton, &targets, &options).expect("a solver");
        let (_, parts) = solver.step_inside(&skeleton);
        let target = |joint| *targets.iter().find(|it| it.joint == joint).expect("a target");
        for part in &parts {
            for missed in &part.turns {
                let angle = missing(&part.pose, &target(missed.joint), &angles_f64(&part.pose));
                assert!((f64::from(missed.turn.length()) - angle).abs() < 1e-3, "{case}");
                let base = part.pose.base(missed.joint);
                assert!(missed.at.distance(base) < 1e-4 * (1.0 + base.length()), "{case}");
            }
        }
        let SubStepKind::Gradient(gradient) = &parts[0].kind else { continue };
        let pose = &parts[0].pose;
        for column in &gradient.turn_columns {
            let at = |by: f64| {
                let mut turned = angles_f64(pose);
                turned[column.joint.index()][column.axis.index()] += by;
                missing(pose, &target(column.target), &turned)
            };
            // Near no turn and half a turn the angle is not smooth.
            if (0.05..3.0).contains(&at(0.0)) {
                let expected = (at(-STEP) - at(STEP)) / (2.0 * STEP);
                assert!((f64::from(column.gain) - expected).abs() < 2e-3, "{case}: {column:?}");
                columns += 1;
            }
        }
    }
    assert!(columns > 1000, "{columns}");
}

#[test]
fn small_steps_leave_the_turns_that_the_jacobian_predicts() {
    let mut random = Random(381);
    let mut compared = 0;
    for case in 0..150 {
        let (skeleton, targets) = problem(&mut random);
        let options = SolverOptions::new(Method::Transpose);
        let mut solver = ChainSolver::new(&skeleton, &targets, &options).expect("a solver");
        for _ in 0..20 {
            let (_, parts) = solver.step_inside(&skeleton);
            let [before, after] = &parts[..] else { continue };
            let SubStepKind::Step(step) = &after.kind else { continue };
            let turned: f32 = step.changes.iter().map(|change| change.by.abs()).sum();
            let turns = before.turns.iter().zip(&after.turns).zip(&step.predicted_turns);
            for ((before, after), predicted) in turns {
                if turned < 0.2 && (0.2..2.5).contains(&before.turn.length()) {
                    let off = (after.turn.length() - predicted.length()).abs();
                    // The curvature of a turn by φ is 1/φ.
                    assert!(off < 5.0 * turned.powi(2) + 1e-4, "{case}: {off}, {turned}");
                    compared += 1;
                }
            }
        }
    }
    assert!(compared > 100, "{compared}");
}

/// Random trees, of which every second has limits, with place and rotation of all tips from a
/// random pose.
fn reachable(random: &mut Random, is_limited: bool) -> (Skeleton, Vec<ChainTarget>) {
    let ends = 1 + random.below(2);
    let (skeleton, tips) = tree(random, ends, 1.0);
    let mut joints: Vec<Joint> = skeleton.iter().map(|(_, joint)| joint.clone()).collect();
    for joint in joints.iter_mut().filter(|_| is_limited) {
        for axis in RotationAxis::ALL {
            let (min, max) = (random.within(-1.5..-0.3), random.within(0.3..1.5));
            joint.limits.set_range(axis, Some(Limit { min, max }));
        }
    }
    let mut skeleton = Skeleton::from_joints(joints).expect("a tree");
    skeleton.set_transform(transform(random)).expect("transform");
    let mut posed = skeleton.clone();
    for joint in skeleton.ids().filter(|joint| !skeleton[*joint].locked) {
        let spread = if is_limited { 0.9 } else { PI };
        let angles = random.vector(spread);
        posed.set_rotation(joint, skeleton[joint].limits.project(angles)).expect("angles");
    }
    let target = |tip: &JointId| {
        ChainTarget::at(*tip, posed.tip(*tip)).with_orientation(rotation_target(&posed, *tip))
    };
    (skeleton, tips.iter().map(target).collect())
}

#[test]
fn places_and_rotations_are_reached_together() {
    const CASES: usize = 200;
    for is_limited in [false, true] {
        for method in orienting() {
            let mut random = Random(7);
            let mut reached = 0;
            for case in 0..CASES {
                let (mut skeleton, targets) = reachable(&mut random, is_limited);
                let tips: Vec<JointId> = targets.iter().map(|target| target.joint).collect();
                let length = skeleton.transform().matrix3.determinant().abs().cbrt()
                    * length(&skeleton, &tips);
                let report =
                    solve(&mut skeleton, &targets, &SolverOptions::new(method)).expect("solve");
                let off = targets.iter().map(|target| {
                    let place = skeleton.tip(target.joint).distance(target.point);
                    let turn = missing(&skeleton, target, &angles_f64(&skeleton)) as f32;
                    place.max(0.25 * length * turn)
                });
                let off = off.fold(0.0, f32::max);
                let told = report.error.max(0.25 * length * report.orientation_error);
                assert!((off - told).abs() < 2e-5 * length, "{method} {case}: {off}, told {told}");
                assert_eq!(report.converged(), told <= 1.001e-4 * length, "{method} {case}");
                reached += usize::from(report.converged());
                for joint in skeleton.ids() {
                    let Joint { limits, rotation, .. } = skeleton[joint];
                    assert!(limits.project(rotation).distance(rotation) < 1e-5, "{method} {case}");
                }
            }
            println!("{method}, limited: {is_limited}: {reached} of {CASES}");
            // The fixed step comes nearer all the time, but not within its iterations.
            let least = if method == Method::TransposeFixed { 60 } else { 95 };
            assert!(100 * reached >= least * CASES, "{method}, {is_limited}: {reached}");
        }
    }
}

#[test]
fn inner_joints_are_turned_as_the_last_ones() {
    const CASES: usize = 100;
    // The fixed step comes nearer all the time, but not within its iterations.
    for method in orienting().filter(|method| *method != Method::TransposeFixed) {
        let mut random = Random(17);
        let mut reached = 0;
        for _ in 0..CASES {
            let mut skeleton = chain(&mut random, 8, 1.0);
            let mut posed = skeleton.clone();
            shake(&mut random, &mut posed);
            let targets = [JointId::new(4), JointId::new(8)].map(|joint| {
                let rotation = rotation_target(&posed, joint);
                ChainTarget::at(joint, posed.tip(joint)).with_orientation(rotation)
            });
            let report = solve(&mut skeleton, &targets, &SolverOptions::new(method));
            reached += usize::from(report.expect("solve").converged());
        }
        println!("{method}: {reached} of {CASES}");
        assert!(reached >= 90, "{method}: {reached}");
    }
}

#[test]
fn a_place_and_a_rotation_that_cannot_be_had_together_are_weighed_as_the_cost_says() {
    const CASES: usize = 60;
    // The fixed step, again, does not come there within its iterations.
    for method in orienting().filter(|method| *method != Method::TransposeFixed) {
        let mut random = Random(23);
        let mut ratios = Vec::new();
        for _ in 0..CASES {
            let mut skeleton = chain(&mut random, 3, 1.0);
            let tip = JointId::new(3);
            let length = length(&skeleton, &[tip]);
            let place = 1.1 * length * random.direction();
            let rotation = Orientation::Rotation(Quat::from_mat3(&random.rotation()));
            let target = ChainTarget::at(tip, place)
                .with_orientation(rotation)
                .with_orientation_weight(random.within(0.2..2.0));
            let mut best = skeleton.clone();
            let options = SolverOptions::new(Method::DampedLeastSquares);
            let of = |pose: &Skeleton| cost(pose, &[target], &angles_f64(pose));
            solve(&mut best, &[target], &options).expect("solve");
            solve(&mut skeleton, &[target], &SolverOptions::new(method)).expect("solve");
            ratios.push(of(&skeleton) / of(&best));
        }
        ratios.sort_by(f64::total_cmp);
        let (median, worst) = (ratios[CASES / 2], ratios[CASES - 1]);
        println!("{method}: {median}, {worst}");
        assert!(median < 1.02 && worst < 1.5, "{method}: {median}, {worst}");
    }
}

#[test]
fn a_rotation_is_that_of_three_places_fixed_to_the_joint() {
    let mut random = Random(11);
    let mut compared = 0;
    for case in 0..200 {
        let joints = 4 + random.below(4);
        let mut skeleton = chain(&mut random, joints, 1.0);
        let tip = JointId::new(joints);
        let distance = 0.25 * length(&skeleton, &[tip]) / 2.0_f32.sqrt();
        let leaves = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| {
            let offset = skeleton[tip].axis;
            let name = skeleton.free_name("leaf");
            let leaf =
                Joint { offset, locked: true, ..Joint::new(&name, Some(tip), axis * distance) };
            skeleton.add(leaf).expect("a leaf")
        });
        let mut posed = skeleton.clone();
        shake(&mut random, &mut posed);
        let rotation = rotation_target(&posed, tip);
        let own = [ChainTarget::at(tip, posed.tip(tip)).with_orientation(rotation)];
        let by_places = leaves.map(|leaf| ChainTarget::at(leaf, posed.tip(leaf)));
        let options = SolverOptions::new(Method::DampedLeastSquares).with_tolerance(1e-5);
        let solved = [&own[..], &by_places].map(|targets| {
            let mut solved = skeleton.clone();
            let report = solve(&mut solved, targets, &options).expect("solve");
            (report.converged(), solved)
        });
        let [(true, one), (true, other)] = &solved else { continue };
        compared += 1;
        let spaces = [one, other].map(|skeleton| space_f64(skeleton, tip, &angles_f64(skeleton)));
        assert!(spaces[0].abs_diff_eq(spaces[1], 2e-4), "{case}");
    }
    assert!(compared > 150, "{compared}");
}

#[test]
fn an_axis_is_aimed_at_a_point_wherever_the_tip_is() {
    for method in aiming() {
        let mut random = Random(5);
        let mut reached = 0;
        for case in 0..100 {
            let mut skeleton = chain(&mut random, 4, 1.0);
            skeleton.set_transform(transform(&mut random)).expect("transform");
            let (tip, axis) = (JointId::new(4), random.direction());
            let point = skeleton.transform().transform_point3(random.vector(6.0));
            let target = ChainTarget::turned(tip, Orientation::Aim { axis, point });
            let report =
                solve(&mut skeleton, &[target], &SolverOptions::new(method)).expect("solve");
            let angle = missing(&skeleton, &target, &angles_f64(&skeleton));
            assert!((angle - f64::from(report.orientation_error)).abs() < 1e-4, "{method} {case}");
            assert_eq!(report.error, 0.0, "the place is free");
            reached += usize::from(report.converged());
        }
        assert!(reached >= 97, "{method}: {reached} of 100");
    }
}

#[test]
fn opposite_directions_and_points_at_the_base_give_finite_poses() {
    let mut skeleton = Skeleton::with_root("root");
    let upper = skeleton.add(Joint::new("upper", Some(JointId::new(0)), Vec3::Y)).expect("a joint");
    let lower = Joint { offset: Vec3::Y, ..Joint::new("lower", Some(upper), Vec3::Y) };
    let lower = skeleton.add(lower).expect("a joint");
    let back = Orientation::Aim { axis: Vec3::Y, point: Vec3::new(0.0, -3.0, 0.0) };
    let here = Orientation::Aim { axis: Vec3::Y, point: Vec3::Y };
    let around = Orientation::Rotation(Quat::from_rotation_x(PI));
    for method in aiming() {
        for orientation in [back, here, around] {
            let mut posed = skeleton.clone();
            let target = ChainTarget::turned(lower, orientation);
            let report = solve(&mut posed, &[target], &SolverOptions::new(method)).expect("solve");
            assert!(posed.joints().iter().all(|joint| joint.rotation.is_finite()));
            if orientation != here {
                assert!(report.converged(), "{method}: {report:?}");
            }
        }
    }
}

#[test]
fn what_a_method_cannot_do_and_what_is_no_orientation_is_refused_by_name() {
    let skeleton = chain(&mut Random(1), 3, 1.0);
    let tip = JointId::new(3);
    let turned = |orientation| ChainTarget::turned(tip, orientation);
    let rotation = turned(Orientation::Rotation(Quat::IDENTITY));
    let aim = turned(Orientation::Aim { axis: Vec3::X, point: Vec3::X });
    for method in Method::ALL {
        let made = |target| ChainSolver::new(&skeleton, &[target], &SolverOptions::new(method));
        let placed = made(rotation.with_weight(1.0));
        let (aim, rotation) = (made(aim.with_weight(1.0)), made(rotation));
        let told = |made: Result<ChainSolver, SolveError>| made.expect_err("refused").to_string();
        if !method.can_orient() {
            let can = "to an orientation; transpose-fixed, transpose, dls, ccd, fabrik can";
            let expected = format!("{method} cannot turn joint {tip} {can}");
            assert_eq!([placed, aim, rotation].map(told), [(); 3].map(|()| expected.clone()));
        } else if method == Method::Fabrik {
            let can = "transpose-fixed, transpose, dls, ccd can";
            assert_eq!(told(aim), format!("fabrik cannot aim joint {tip} at a point; {can}"));
            let expected = format!("fabrik cannot turn joint {tip} while its place is free; {can}");
            assert_eq!(told(rotation), expected);
            assert!(placed.is_ok());
        } else {
            assert!(placed.is_ok() && aim.is_ok() && rotation.is_ok(), "{method}");
        }
    }
    let options = SolverOptions::new(Method::DampedLeastSquares);
    let refused = |target| ChainSolver::new(&skeleton, &[target], &options).expect_err("refused");
    for orientation in [
        Orientation::Rotation(Quat::from_xyzw(0.0, 0.0, 0.0, 0.0)),
        Orientation::Rotation(Quat::NAN),
        Orientation::Aim { axis: Vec3::ZERO, point: Vec3::X },
        Orientation::Aim { axis: Vec3::X, point: Vec3::INFINITY },
    ] {
        assert!(matches!(refused(turned(orientation)), SolveError::Orientation { .. }));
    }
    let weightless = rotation.with_orientation_weight(0.0);
    assert!(matches!(refused(weightless), SolveError::Weight { .. }));
    assert!(matches!(refused(rotation.with_weight(-1.0)), SolveError::Weight { .. }));
    assert!(matches!(
        refused(ChainTarget::at(tip, Vec3::X).with_weight(0.0)),
        SolveError::Weight { .. }
    ));
}

#[test]
fn the_fixed_step_refuses_rotations_by_hinges_alone() {
    let tip = JointId::new(3);
    let target = |skeleton: &Skeleton| {
        ChainTarget::at(tip, skeleton.tip(tip)).with_orientation(rotation_target(skeleton, tip))
    };
    let fixed = Some(Limit { min: 0.0, max: 0.0 });
    let mut hinged = chain(&mut Random(1), 3, 1.0);
    for (joint, axes) in [(1, "xy"), (2, "yz"), (3, "xz")] {
        let mut limits = JointLimits::default();
        for axis in RotationAxis::ALL.into_iter().filter(|axis| axes.contains(axis.name())) {
            limits.set_range(axis, fixed);
        }
        hinged.change(JointId::new(joint), |joint| joint.limits = limits).expect("limits");
    }
    for method in orienting() {
        let made = ChainSolver::new(&hinged, &[target(&hinged)], &SolverOptions::new(method));
        let refused = made.err().map(|error| error.to_string());
        let expected = format!(
            "transpose-fixed cannot turn joint {tip} to an orientation by hinges alone; \
             transpose, dls, ccd, fabrik can"
        );
        assert_eq!(refused, (method == Method::TransposeFixed).then_some(expected), "{method}");
    }
    // One joint that turns about two axes is enough.
    let mut limits = hinged[JointId::new(2)].limits;
    limits.set_range(RotationAxis::Y, None);
    let mut freed = hinged.clone();
    freed.change(JointId::new(2), |joint| joint.limits = limits).expect("limits");
    let options = SolverOptions::new(Method::TransposeFixed);
    let place_alone = ChainTarget::at(tip, freed.tip(tip));
    let mut solver = ChainSolver::new(&freed, &[target(&freed)], &options).expect("a solver");
    assert!(solver.track(&[target(&freed)], &freed).is_ok());
    assert!(solver.track(&[target(&freed)], &hinged).is_err(), "the limits have become narrower");
    let mut solver = ChainSolver::new(&hinged, &[place_alone], &options).expect("a solver");
    assert!(solver.retarget(&[target(&hinged)]).is_err(), "the target asks for more");
}

#[test]
fn a_hand_that_turns_full_circle_while_it_moves_lets_no_joint_jump() {
    use std::f32::consts::TAU;
    const FRAMES: u16 = 240;
    for method in orienting() {
        let fk = chain(&mut Random(3), 7, 1.0);
        let (tip, most) = (JointId::new(7), length(&fk, &[JointId::new(7)]));
        let target = |frame: u16| {
            let angle = TAU * f32::from(frame) / f32::from(FRAMES);
            let (sin, cos) = angle.sin_cos();
            let place = Vec3::new(0.5 + 0.1 * cos, 0.1 * sin, 0.15) * most;
            let turn = Quat::from_rotation_z(angle) * Quat::from_rotation_x(0.4);
            ChainTarget::at(tip, place).with_orientation(Orientation::Rotation(turn))
        };
        let mut solver =
            ChainSolver::new(&fk, &[target(0)], &SolverOptions::new(method)).expect("a solver");
        solver.run();
        solver.relax();
        let (mut worst, mut lost) = (0.0_f32, 0);
        for frame in 1..=2 * FRAMES {
            let step = solver.track(&[target(frame % FRAMES)], &fk).expect("a step");
            assert!(!step.has_jumped, "{method}, {frame}");
            worst = worst.max(step.joint_motion / step.target_motion);
            lost += u32::from(step.report.status != Status::Converged);
        }
        println!("{method}: {worst}, {lost} lost");
        assert!(worst < 8.0, "{method}: {worst}");
        assert!(lost < 24, "{method}: {lost}");
    }
}
