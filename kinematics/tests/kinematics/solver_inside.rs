//! The parts of an iteration: the same bits as the iteration, and numbers that forward kinematics
//! confirms.

use glam::{Affine3A, DVec3, Quat, Vec3};
use ik_arm_kinematics::chain_ik::{
    ChainSolver, ChainTarget, Column, Method, Root, SolverOptions, SubStep, SubStepKind,
};
use ik_arm_kinematics::skeleton::{Joint, JointId, Skeleton};
use nalgebra::Matrix3xX;

use crate::common::Random;
use crate::common::skeletons::{chain, limit, reachable, shake, space_f64, transform, tree};

const CASES: usize = 120;

/// A skeleton with targets and options, and a solver for them.
struct Case {
    skeleton: Skeleton,
    targets: Vec<ChainTarget>,
    solver: ChainSolver,
    is_limited: bool,
}

/// Random cases of a method: trees, or limbs of two bones; mirrored, scaled, limited, with free
/// roots.
fn cases(method: Method, mut check: impl FnMut(&mut Random, Case)) {
    let mut random = Random(190);
    for case in 0..CASES {
        let (mut skeleton, tips) = match method {
            Method::TwoBone => (chain(&mut random, 2, 1.0), vec![JointId::new(2)]),
            _ => tree(&mut random, 1 + case % 3, [1.0, 300.0][case % 2]),
        };
        let is_limited = case % 4 >= 2;
        if is_limited {
            for joint in 1..skeleton.joints().len() {
                let limits = [(); 3].map(|()| random.chance(0.5).then(|| limit(&mut random)));
                skeleton
                    .change(joint.into(), |joint| joint.limits = limits.into())
                    .expect("limits");
            }
        }
        let mut targets = reachable(&mut random, &skeleton, &tips);
        shake(&mut random, &mut skeleton);
        let to_world = transform(&mut random);
        skeleton.set_transform(to_world).expect("transform");
        for target in &mut targets {
            target.point = to_world.transform_point3(target.point);
            target.weight = random.within(0.5..2.0);
        }
        let root = if case % 5 == 4 { Root::Free } else { Root::Turns };
        let options = SolverOptions::new(method).with_root(root);
        let solver = ChainSolver::new(&skeleton, &targets, &options).expect("a solver");
        check(&mut random, Case { skeleton, targets, solver, is_limited });
    }
}

/// Iterates twins: one solver as usual, one part by part.
fn iterations(method: Method, mut check: impl FnMut(&Case, &Skeleton, &[SubStep])) {
    cases(method, |_, mut case| {
        let mut inside = case.solver.clone();
        let mut before = case.skeleton.clone();
        for _ in 0..12 {
            if case.solver.is_over() {
                break;
            }
            let report = case.solver.step();
            let (same, steps) = inside.step_inside(&case.skeleton);
            assert_eq!(report, same, "{method:?}");
            assert_eq!(case.solver, inside, "{method:?}");
            check(&case, &before, &steps);
            before = case.skeleton.clone();
            case.solver.write(&mut before);
        }
    });
}

#[test]
fn the_last_part_of_an_iteration_has_the_pose_after_it_bit_for_bit() {
    for method in Method::ALL {
        let mut parts = 0;
        iterations(method, |case, _, steps| {
            let mut after = case.skeleton.clone();
            case.solver.write(&mut after);
            let last = steps.last().expect("at least one part");
            assert_eq!(last.pose, after, "{method:?}");
            parts += steps.len();
        });
        assert!(parts > 100, "{method:?}: {parts}");
    }
}

/// Velocity of a tip in the world by central differences in f64.
fn velocity(pose: &Skeleton, column: &Column) -> DVec3 {
    const STEP: f64 = 1e-5;
    let at = |by: f64| {
        let mut angles: Vec<DVec3> =
            pose.iter().map(|(_, joint)| joint.rotation.as_dvec3()).collect();
        angles[column.joint.index()][column.axis.index()] += by;
        let space = space_f64(pose, column.tip, &angles);
        let tip = space.transform_point3(pose[column.tip].axis.as_dvec3());
        pose.transform().as_daffine3().transform_point3(tip)
    };
    (at(STEP) - at(-STEP)) / (2.0 * STEP)
}

/// A length of the size of the skeleton in the world.
fn size(case: &Case) -> f32 {
    let pose = case.skeleton.pose();
    pose.ids().map(|joint| pose.base(joint).distance(pose.tip(joint))).sum()
}

const GRADIENTS: [Method; 3] =
    [Method::TransposeFixed, Method::Transpose, Method::DampedLeastSquares];

#[test]
fn the_columns_of_the_jacobian_are_the_velocities_of_the_tips() {
    for method in GRADIENTS {
        let mut columns = 0;
        iterations(method, |case, _, steps| {
            for step in steps {
                let SubStepKind::Gradient(gradient) = &step.kind else { continue };
                for column in gradient.columns.iter().take(12) {
                    let expected = velocity(&step.pose, column).as_vec3();
                    let error = column.by.distance(expected);
                    assert!(error < 1e-4 * size(case), "{method:?}: {column:?}, {expected}");
                    let tip = step.pose.tip(column.tip);
                    assert!(column.at.distance(tip) < 1e-5 * size(case) + tip.length() * 1e-6);
                    columns += 1;
                }
            }
        });
        assert!(columns > 1000, "{method:?}");
    }
}

#[test]
fn the_ellipsoid_has_the_singular_values_and_vectors_of_the_jacobian() {
    iterations(Method::DampedLeastSquares, |case, _, steps| {
        for step in steps {
            let SubStepKind::Gradient(gradient) = &step.kind else { continue };
            assert!(gradient.damping.is_some_and(|damping| damping > 0.0));
            for ellipsoid in &gradient.ellipsoids {
                let columns: Vec<_> =
                    gradient.columns.iter().filter(|column| column.tip == ellipsoid.tip).collect();
                let columns: Vec<_> = columns
                    .iter()
                    .map(|column| nalgebra::Vector3::from(column.by.as_dvec3().to_array()))
                    .collect();
                let svd = Matrix3xX::from_columns(&columns).svd(true, false);
                let vectors = svd.u.expect("vectors");
                for (index, value) in svd.singular_values.iter().enumerate() {
                    let error = (f64::from(ellipsoid.values[index]) - value).abs();
                    // The square root of rounding, where a value is 0.
                    assert!(error < 1e-6 * f64::from(size(case)), "{error}");
                    let gap = |other: usize| (svd.singular_values[other] - value).abs();
                    let is_alone =
                        (0..3).filter(|it| *it != index).all(|it| gap(it) > 1e-2 * value);
                    let axis = vectors.column(index);
                    let axis = Vec3::new(axis[0] as f32, axis[1] as f32, axis[2] as f32);
                    let along = ellipsoid.axes[index].dot(axis).abs();
                    assert!(!is_alone || along > 0.9999, "{along}");
                }
            }
        }
    });
}

#[test]
fn damping_takes_away_less_along_short_axes() {
    let mut cases = 0;
    iterations(Method::DampedLeastSquares, |_, _, steps| {
        let Some(SubStepKind::Gradient(gradient)) = steps.iter().map(|it| &it.kind).next() else {
            return;
        };
        for ellipsoid in &gradient.ellipsoids {
            let damping = gradient.damping.expect("damping");
            let gains = ellipsoid.gains(damping);
            assert!(gains[0] >= gains[1] && gains[1] >= gains[2] && gains[2] >= 0.0);
            assert!(gains[0] < 1.0 || damping == 0.0);
            let stronger = ellipsoid.gains(2.0 * damping);
            assert!(gains.iter().zip(stronger).all(|(weak, strong)| strong <= *weak));
            cases += 1;
        }
    });
    assert!(cases > 100);
}

/// True if a transform scales all directions alike.
fn is_even(transform: Affine3A) -> bool {
    let [x, y, z] = [transform.x_axis, transform.y_axis, transform.z_axis].map(glam::Vec3A::length);
    (x - y).abs() < 1e-4 * x && (x - z).abs() < 1e-4 * x
}

#[test]
fn the_gradient_is_the_pull_of_all_targets_along_the_columns() {
    for method in GRADIENTS {
        let mut checked = 0;
        iterations(method, |case, _, steps| {
            let [.., gradient, step] = steps else { return };
            let (SubStepKind::Gradient(jacobian), SubStepKind::Step(taken)) =
                (&gradient.kind, &step.kind)
            else {
                return;
            };
            if !is_even(case.skeleton.transform()) {
                return;
            }
            checked += 1;
            let heaviest = case.targets.iter().map(|it| it.weight).fold(0.0, f32::max);
            for change in &taken.changes {
                let columns = jacobian.columns.iter().filter(|column| {
                    (column.joint, column.axis.index()) == (change.joint, change.axis.index())
                });
                let pull: f32 = columns
                    .map(|column| {
                        let target = case.targets.iter().find(|it| it.joint == column.tip);
                        let target = target.expect("a target");
                        target.weight / heaviest * column.by.dot(column.at - target.point)
                    })
                    .sum();
                let error = (pull - change.gradient).abs();
                assert!(error < 2e-4 * size(case).powi(2), "{pull} {}", change.gradient);
            }
        });
        assert!(checked > 100, "{method:?}: {checked}");
    }
}

#[test]
fn a_step_changes_the_angles_and_moves_the_tips_as_it_says() {
    for method in GRADIENTS {
        let mut checked = 0;
        iterations(method, |case, _, steps| {
            for pair in steps.windows(2) {
                let SubStepKind::Step(taken) = &pair[1].kind else { continue };
                for change in &taken.changes {
                    let angle =
                        |step: &SubStep| step.pose[change.joint].rotation[change.axis.index()];
                    let by = angle(&pair[1]) - angle(&pair[0]);
                    assert!((by - change.by).abs() < 1e-5, "{by} {}", change.by);
                    let limit = pair[1].pose[change.joint].limits.range(change.axis);
                    assert!(!change.is_at_limit || limit.is_some());
                }
                for tip in &taken.tips {
                    let [from, to] = [0, 1].map(|index| pair[index].pose.tip(tip.joint));
                    let rounding = 2e-5 * size(case) + 1e-5 * from.length();
                    assert!(tip.from.distance(from) < rounding && tip.to.distance(to) < rounding);
                    let turned: f32 = taken.changes.iter().map(|change| change.by.abs()).sum();
                    let is_small = turned < 0.1 && !case.is_limited;
                    let apart = tip.predicted.distance(tip.to);
                    // The remainder is of second order.
                    assert!(!is_small || apart <= turned * turned * size(case) + rounding);
                    checked += usize::from(is_small);
                }
                assert_eq!(taken.damping.is_some(), method == Method::DampedLeastSquares);
                assert_eq!(taken.length.is_some(), method != Method::DampedLeastSquares);
            }
        });
        assert!(checked > 20, "{method:?}: {checked}");
    }
}

#[test]
fn a_sweep_of_ccd_turns_one_joint_after_the_other_from_the_tips_to_the_roots() {
    iterations(Method::Ccd, |case, before, steps| {
        let rounding = 1e-4 * size(case) + 1e-5 * case.skeleton.tip(JointId::new(1)).length();
        let mut last = before;
        let mut turned = Vec::new();
        for step in steps {
            if let SubStepKind::Turn(turn) = &step.kind {
                for joint in case.skeleton.ids().filter(|joint| *joint != turn.joint) {
                    let [now, then] = [&step.pose, last].map(|it| it[joint].local_rotation());
                    assert!(now.abs_diff_eq(then, 1e-4), "{joint} turns with {}", turn.joint);
                }
                assert!(turn.base.distance(step.pose.base(turn.joint)) < rounding);
                let rotation =
                    Quat::from_axis_angle(turn.axis.try_normalize().unwrap_or(Vec3::X), turn.angle);
                for [from, _, to] in &turn.tips {
                    let rotated = turn.base + rotation * (*from - turn.base);
                    let is_rigid = is_even(case.skeleton.transform());
                    assert!(!is_rigid || rotated.distance(*to) < 4.0 * rounding, "{rotated} {to}");
                }
                turned.push(turn.joint);
            }
            last = &step.pose;
        }
        assert!(turned.windows(2).all(|pair| pair[0] > pair[1]), "{turned:?}");
    });
}

#[test]
fn the_passes_of_fabrik_keep_the_bones_and_meet_targets_and_roots() {
    iterations(Method::Fabrik, |case, _, steps| {
        let is_rigid = is_even(case.skeleton.transform());
        for step in steps {
            let rounding = 1e-4 * size(case) + 1e-5 * case.targets[0].point.length();
            match &step.kind {
                SubStepKind::Backward(segments) if case.targets.len() == 1 => {
                    let target = case.targets[0].point;
                    let nearest = segments.iter().map(|[_, end]| end.distance(target));
                    assert!(nearest.fold(f32::MAX, f32::min) < rounding);
                    let connected = segments.windows(2);
                    for pair in connected.filter(|_| is_rigid) {
                        assert!(pair[0][1].distance(pair[1][0]) < rounding, "{pair:?}");
                    }
                }
                SubStepKind::Forward(segments) if !case.is_limited => {
                    let pose = step.pose.pose();
                    for [base, _] in segments {
                        let bases = pose.ids().map(|joint| pose.base(joint).distance(*base));
                        assert!(bases.fold(f32::MAX, f32::min) < rounding, "{base}");
                    }
                }
                _ => {}
            }
        }
    });
}

/// The points after the pass of relaxation in an iteration: one segment for each bone, from the
/// root on.
fn relaxed(steps: &[SubStep]) -> Option<&[[Vec3; 2]]> {
    steps.iter().find_map(|step| match &step.kind {
        SubStepKind::Relaxed(segments) => Some(&segments[..]),
        _ => None,
    })
}

/// One pass by Juckett's *Resolving Constraints*: for a bone from b1 to b2 of length l, with
/// weights w1 and w2, v = b2 − b1, d = |v|, m = v (d − l)/d; b1 += m w1/(w1 + w2), b2 −= m w2/(w1 +
/// w2). The root and the target have weight 0, all other joints 1, and the last bone comes first.
///
/// Three bones of length 1 stand up from the root (0, 0), with joints at (0, 1) and (0, 2); the
/// target is (2, 2).
///
/// - Bone 3, from (0, 2) to the target: v = (2, 0), d = 2, m = (1, 0). The target has weight 0, so
///   the joint moves alone, to (1, 2).
/// - Bone 2, from (0, 1) to (1, 2): v = (1, 1), d = √2, m = (1 − 1/√2) (1, 1) = 0.292893 (1, 1).
///   Both ends move by half of it, to (0.146447, 1.146447) and (0.853553, 1.853553).
/// - Bone 1, from (0, 0) to (0.146447, 1.146447): d = √(0.021447 + 1.314340) = 1.155762. The root
///   has weight 0, so the joint moves alone, to (0.146447, 1.146447)/d = (0.126710, 0.991940).
///
/// Bone 2 is now √(0.726843² + 0.861614²) = 1.127253 long: the next pass goes on.
#[test]
fn a_pass_of_relaxation_over_unit_bones_is_the_one_worked_out_by_hand() {
    let mut skeleton = Skeleton::with_root("root");
    for index in 0..3_usize {
        let offset = if index == 0 { Vec3::ZERO } else { Vec3::Y };
        let name = format!("bone {}", index + 1);
        let joint = Joint { offset, ..Joint::new(&name, Some(index.into()), Vec3::Y) };
        skeleton.add(joint).expect("joint");
    }
    let target = ChainTarget::at(JointId::new(3), Vec3::new(2.0, 2.0, 0.0));
    let options = SolverOptions::new(Method::Relaxation);
    let mut solver = ChainSolver::new(&skeleton, &[target], &options).expect("a solver");
    let (_, steps) = solver.step_inside(&skeleton);

    let [root, target] = [Vec3::ZERO, target.point];
    let first = Vec3::new(0.126_710, 0.991_940, 0.0);
    let second = Vec3::new(0.853_553, 1.853_553, 0.0);
    let expected = [[root, first], [first, second], [second, target]];
    let segments = relaxed(&steps).expect("a pass");
    assert_eq!(segments.len(), expected.len());
    for (segment, expected) in segments.iter().zip(expected) {
        for (end, expected) in segment.iter().zip(expected) {
            assert!(end.distance(expected) < 1e-6, "{segment:?}, {expected}");
        }
    }
    // The bones laid out from the root: (0, 0) towards the first point, then towards the second,
    // each from where the bone before it ends.
    let pose = &steps.last().expect("the pose").pose;
    assert!(pose.tip(JointId::new(1)).distance(first) < 1e-6);
    let towards = (second - first).normalize();
    assert!(pose.tip(JointId::new(2)).distance(first + towards) < 1e-6);
}

/// One pass over a chain in f64; `points` are the joints from the root on, then the target.
fn relax(points: &mut [DVec3], lengths: &[f64]) {
    let last = lengths.len() - 1;
    for bone in (0..=last).rev() {
        let weights = [bone > 0, bone < last].map(|moves| if moves { 1.0 } else { 0.0 });
        let v = points[bone + 1] - points[bone];
        let m = v * (1.0 - lengths[bone] / v.length()) / (weights[0] + weights[1]);
        points[bone] += weights[0] * m;
        points[bone + 1] -= weights[1] * m;
    }
}

#[test]
fn the_points_of_relaxation_are_those_of_the_article_pass_after_pass() {
    let mut random = Random(191);
    let mut passes = 0;
    for joints in 2..=30 {
        let mut skeleton = chain(&mut random, joints, [1.0, 300.0][joints % 2]);
        let target = reachable(&mut random, &skeleton, &[JointId::new(joints)])[0];
        shake(&mut random, &mut skeleton);
        let pose = skeleton.pose();
        let mut points: Vec<DVec3> =
            (1..=joints).map(|joint| pose.base(JointId::new(joint)).as_dvec3()).collect();
        points.push(target.point.as_dvec3());
        let lengths: Vec<f64> = (1..=joints)
            .map(|joint| skeleton[JointId::new(joint)].axis.as_dvec3().length())
            .collect();
        let length: f64 = lengths.iter().sum();
        let options = SolverOptions::new(Method::Relaxation);
        let mut solver = ChainSolver::new(&skeleton, &[target], &options).expect("a solver");
        for _ in 0..8 {
            let (report, steps) = solver.step_inside(&skeleton);
            // The pass after a new start begins with other points.
            if steps
                .iter()
                .any(|step| matches!(step.kind, SubStepKind::Bend | SubStepKind::Restart))
            {
                break;
            }
            relax(&mut points, &lengths);
            let segments = relaxed(&steps).expect("a pass");
            for (bone, segment) in segments.iter().enumerate() {
                for (end, expected) in segment.iter().zip(&points[bone..]) {
                    let error = end.as_dvec3().distance(*expected);
                    assert!(error < 1e-5 * length, "{joints} joints, bone {bone}: {error}");
                }
            }
            passes += 1;
            if report.converged() {
                break;
            }
        }
    }
    assert!(passes > 100, "{passes}");
}

#[test]
fn a_pass_of_relaxation_leaves_roots_in_place_and_lays_out_bones_of_their_lengths() {
    iterations(Method::Relaxation, |case, _, steps| {
        let rounding = 1e-4 * size(case) + 1e-5 * case.targets[0].point.length();
        for step in steps {
            match &step.kind {
                SubStepKind::Relaxed(segments) if case.targets.len() == 1 => {
                    let target = case.targets[0].point;
                    let nearest = segments.iter().map(|[_, end]| end.distance(target));
                    assert!(nearest.fold(f32::MAX, f32::min) < rounding);
                }
                SubStepKind::LaidOut(segments) if !case.is_limited => {
                    let pose = step.pose.pose();
                    for [base, _] in segments {
                        let bases = pose.ids().map(|joint| pose.base(joint).distance(*base));
                        assert!(bases.fold(f32::MAX, f32::min) < rounding, "{base}");
                    }
                }
                _ => {}
            }
        }
    });
}

#[test]
fn two_bones_place_the_elbow_before_they_aim_the_hand() {
    let mut checked = 0;
    iterations(Method::TwoBone, |case, _, steps| {
        let (upper, lower) = (JointId::new(1), JointId::new(2));
        for pair in steps.windows(2) {
            let [SubStepKind::PlaceElbow(_), SubStepKind::Aim(joint)] =
                [&pair[0].kind, &pair[1].kind]
            else {
                continue;
            };
            assert_eq!(*joint, lower);
            let [elbow, hand] = [&pair[0].pose, &pair[1].pose];
            assert_eq!(elbow[upper], hand[upper]);
            // The lower bone already has its length to the target.
            let to_target = elbow.base(lower).distance(case.targets[0].point);
            let bone = hand.base(lower).distance(hand.tip(lower));
            let is_free = !case.is_limited && is_even(case.skeleton.transform());
            if is_free && case.solver.report().converged() {
                assert!((to_target - bone).abs() < 1e-4 * bone, "{to_target} {bone}");
                checked += 1;
            }
        }
    });
    assert!(checked > 20, "{checked}");
}
