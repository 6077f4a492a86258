//! Stiffness of joints: the metric against an f64 twin, and who turns how much.

use std::f32::consts::PI;

use glam::{DMat3, DVec3, Vec3};
use ik_arm_kinematics::chain_ik::{
    ChainSolver, ChainTarget, Method, Root, SolveError, SolverOptions, TwoBoneRefusal, jacobian,
    solve,
};
use ik_arm_kinematics::skeleton::{JointId, JointLimits, Limit, RotationAxis, Skeleton};

use crate::common::Random;
use crate::common::skeletons::{ITERATIVE, chain, length, shake, target};

/// The methods that respect a stiffness.
const RESPECTING: [Method; 5] = [
    Method::TransposeFixed,
    Method::Transpose,
    Method::DampedLeastSquares,
    Method::Ccd,
    Method::Fabrik,
];

fn set_stiffness(skeleton: &mut Skeleton, joint: JointId, stiffness: Vec3) {
    skeleton.change(joint, |joint| joint.stiffness = stiffness).expect("a stiffness");
}

/// A chain in a random pose, its last joint, and a target that it reaches.
fn reachable(random: &mut Random) -> (Skeleton, ChainTarget) {
    let joints = 4 + random.below(4);
    let mut skeleton = chain(random, joints, 1.0);
    shake(random, &mut skeleton);
    let tip = JointId::new(joints);
    let mut posed = skeleton.clone();
    shake(random, &mut posed);
    let point = posed.tip(tip);
    (skeleton, target(tip, point))
}

/// The angle by which a joint is turned, radians.
fn turn(before: &Skeleton, after: &Skeleton, joint: JointId) -> f32 {
    let [before, after] =
        [before, after].map(|it| glam::Quat::from_mat3a(&it[joint].local_rotation()));
    before.angle_between(after)
}

#[test]
fn a_step_of_least_squares_is_that_of_the_metric() {
    const DAMPING: f32 = 0.1;
    let mut random = Random(381);
    for case in 0..300 {
        let (mut skeleton, mut target) = reachable(&mut random);
        for joint in skeleton.ids() {
            let stiffness = Vec3::from_array([(); 3].map(|()| random.within(0.0..0.95)));
            set_stiffness(&mut skeleton, joint, stiffness);
        }
        let tip = skeleton.tip(target.joint);
        target.point = tip + random.direction() * random.within(0.01..0.1);
        let options = SolverOptions::new(Method::DampedLeastSquares).with_damping(DAMPING);
        let mut solver = ChainSolver::new(&skeleton, &[target], &options).expect("solver");
        solver.step();
        let mut posed = skeleton.clone();
        solver.write(&mut posed);

        // Δθ = W⁻¹ Jᵀ (J W⁻¹ Jᵀ + λ² I)⁻¹ r
        let columns = jacobian(&skeleton, target.joint);
        let damping = f64::from(DAMPING * length(&skeleton, &[target.joint]));
        let mut square = DMat3::IDENTITY * damping.powi(2);
        for joint in skeleton.ids().filter(|joint| !skeleton[*joint].locked) {
            let stiffness = skeleton[joint].stiffness.to_array();
            for (column, stiffness) in columns[joint.index()].into_iter().zip(stiffness) {
                let (column, compliance) = (column.as_dvec3(), 1.0 - f64::from(stiffness));
                square += DMat3::from_cols(column * column.x, column * column.y, column * column.z)
                    * compliance;
            }
        }
        let force = square.inverse() * (target.point.as_dvec3() - tip.as_dvec3());
        for joint in skeleton.ids().filter(|joint| !skeleton[*joint].locked) {
            let expected: [f64; 3] = [0, 1, 2].map(|axis| {
                let compliance = 1.0 - f64::from(skeleton[joint].stiffness[axis]);
                compliance * columns[joint.index()][axis].as_dvec3().dot(force)
            });
            let made = (posed[joint].rotation - skeleton[joint].rotation).as_dvec3();
            let off = made.distance(DVec3::from_array(expected));
            assert!(off < 1e-4, "case {case}, joint {joint}: {made} instead of {expected:?}");
        }
    }
}

#[test]
fn a_stiff_joint_turns_less_and_the_target_is_reached_all_the_same() {
    for method in RESPECTING {
        let mut random = Random(382);
        let (mut plain, mut stiff) = (0.0, 0.0);
        let mut reached = [0, 0];
        for _ in 0..100 {
            let (skeleton, target) = reachable(&mut random);
            let joint = JointId::new(1 + random.below(skeleton.joints().len() - 2));
            let options = SolverOptions::new(method);
            let mut soft = skeleton.clone();
            let report = solve(&mut soft, &[target], &options).expect("solved");
            reached[0] += usize::from(report.converged());
            plain += turn(&skeleton, &soft, joint);
            let mut hard = skeleton.clone();
            set_stiffness(&mut hard, joint, Vec3::splat(0.9));
            let report = solve(&mut hard, &[target], &options).expect("solved");
            stiff += turn(&skeleton, &hard, joint);
            reached[1] += usize::from(report.converged());
        }
        assert!(stiff < 0.5 * plain, "{method}: {stiff} beside {plain}");
        assert!(reached[1] + 1 >= reached[0], "{method} reached {reached:?}");
    }
}

#[test]
fn a_joint_of_nearly_all_stiffness_is_as_good_as_locked() {
    let mut random = Random(383);
    for case in 0..50 {
        let (mut skeleton, target) = reachable(&mut random);
        let joint = JointId::new(2);
        set_stiffness(&mut skeleton, joint, Vec3::splat(0.9999));
        let mut locked = skeleton.clone();
        locked.change(joint, |joint| joint.locked = true).expect("a joint");
        for method in [Method::DampedLeastSquares, Method::Transpose] {
            let options = SolverOptions::new(method);
            let mut posed = skeleton.clone();
            let report = solve(&mut posed, &[target], &options).expect("solved");
            let without = solve(&mut locked.clone(), &[target], &options).expect("solved");
            if without.converged() {
                let turned = turn(&skeleton, &posed, joint);
                assert!(report.converged() && turned < 0.02, "{method}, case {case}: {turned}");
            }
        }
    }
}

#[test]
fn a_stiff_chain_that_cannot_reach_comes_as_near_as_it_can() {
    // A fixed step stalls far out of reach, with stiffness and without.
    for method in RESPECTING.into_iter().filter(|method| *method != Method::TransposeFixed) {
        let mut random = Random(384);
        for case in 0..50 {
            let (skeleton, mut target) = reachable(&mut random);
            let reach = length(&skeleton, &[target.joint]);
            target.point = random.direction() * 1.5 * reach;
            let mut stiff = skeleton.clone();
            for joint in skeleton.ids() {
                set_stiffness(&mut stiff, joint, Vec3::splat(random.within(0.0..0.8)));
            }
            let options = SolverOptions::new(method);
            let report = solve(&mut stiff, &[target], &options).expect("solved");
            let least = 0.5 * reach;
            assert!(report.error < 1.002 * least, "{method}, case {case}: {report:?}, {least}");
        }
    }
}

#[test]
fn methods_refuse_by_name_what_they_cannot_respect() {
    let skeleton = chain(&mut Random(385), 3, 1.0);
    let joint = JointId::new(2);
    let target = target(JointId::new(3), Vec3::new(1.0, 1.0, 0.5));
    let refusal = |stiffness: Vec3, limits: JointLimits, method: Method| {
        let mut stiff = skeleton.clone();
        set_stiffness(&mut stiff, joint, stiffness);
        stiff.change(joint, |joint| joint.limits = limits).expect("limits");
        ChainSolver::new(&stiff, &[target], &SolverOptions::new(method)).err()
    };
    let uneven = Vec3::new(0.5, 0.0, 0.5);
    for method in ITERATIVE {
        let (even, per_angle) = (
            refusal(Vec3::splat(0.5), JointLimits::NONE, method),
            refusal(uneven, JointLimits::NONE, method),
        );
        match method {
            Method::Ccd | Method::Fabrik => {
                assert_eq!(even, None);
                assert_eq!(
                    per_angle.map(|error| error.to_string()),
                    Some(format!(
                        "{method} cannot turn joint 2 by angles of different stiffness; \
                         transpose-fixed, transpose, dls can"
                    ))
                );
            }
            Method::Relaxation => {
                let refused = SolveError::CannotStiffen { method, joint, per_angle: false };
                assert_eq!((even, per_angle), (Some(refused.clone()), Some(refused)));
            }
            _ => assert_eq!((even, per_angle), (None, None), "{method}"),
        }
    }
    // A hinge has one angle; the stiffness of those that cannot change does not count.
    let fixed = Some(Limit { min: 0.0, max: 0.0 });
    let hinge = JointLimits::new([fixed, None, fixed]);
    for method in [Method::Ccd, Method::Fabrik] {
        assert_eq!(refusal(uneven, hinge, method), None, "{method}");
    }
    let refused = SolveError::TwoBone { joint: target.joint, reason: TwoBoneRefusal::Stiff };
    assert_eq!(refusal(Vec3::splat(0.5), JointLimits::NONE, Method::TwoBone), Some(refused));
    let mut above = skeleton.clone();
    set_stiffness(&mut above, JointId::new(1), Vec3::splat(0.5));
    assert!(ChainSolver::new(&above, &[target], &SolverOptions::new(Method::TwoBone)).is_ok());
}

#[test]
fn angles_of_different_stiffness_share_a_turn_by_it() {
    // A bone along z on a joint with two hinges, x and y: each moves the tip in its own direction.
    let mut skeleton = Skeleton::with_root("root");
    let bone = ik_arm_kinematics::skeleton::Joint::new("bone", Some(JointId::new(0)), Vec3::Z);
    let joint = skeleton.add(bone).expect("a joint");
    let limits = JointLimits::NONE.with_range(RotationAxis::Z, Some(Limit { min: 0.0, max: 0.0 }));
    skeleton.change(joint, |joint| joint.limits = limits).expect("limits");
    set_stiffness(&mut skeleton, joint, Vec3::new(0.9, 0.0, 0.0));
    let point = Vec3::new(0.01, 0.01, 1.0);
    let options = SolverOptions::new(Method::TransposeFixed);
    let mut solver =
        ChainSolver::new(&skeleton, &[target(joint, point)], &options).expect("solver");
    solver.step();
    let mut posed = skeleton.clone();
    solver.write(&mut posed);
    let Vec3 { x, y, .. } = posed[joint].rotation;
    assert!((x / y + 0.1).abs() < 1e-3, "{x} beside {y}");
    assert!(y > 0.0 && y < PI);
}

#[test]
fn stiff_free_roots_move_less_and_targets_are_reached_as_before() {
    for method in RESPECTING {
        let mut random = Random(93);
        let (mut reached, mut ways) = (0, [0.0; 3]);
        for _ in 0..60 {
            let skeleton = chain(&mut random, 4, 1.0);
            let (root, tip) = (JointId::new(0), JointId::new(4));
            let place = skeleton.tip(tip) + random.direction() * 0.6 * length(&skeleton, &[tip]);
            for (stiffness, way) in [0.0, 0.5, 0.9].into_iter().zip(&mut ways) {
                let mut posed = skeleton.clone();
                let options =
                    SolverOptions::new(method).with_root(Root::Free).with_root_stiffness(stiffness);
                let target = ChainTarget::at(tip, place);
                let report = solve(&mut posed, &[target], &options).expect("solve");
                reached += usize::from(report.converged());
                *way += posed.base(root).distance(skeleton.base(root));
            }
        }
        let [loose, stiff, stiffer] = ways;
        println!("{method}: {reached} of 180 reached; {stiff} and {stiffer} of {loose}");
        assert!(reached >= 178, "{method}: {reached}");
        assert!(stiff < 0.95 * loose && stiffer < 0.9 * stiff, "{method}: {ways:?}");
    }
}

#[test]
fn a_stiffness_of_roots_out_of_range_is_refused() {
    let skeleton = chain(&mut Random(1), 2, 1.0);
    let target = ChainTarget::at(JointId::new(2), Vec3::X);
    for stiffness in [-0.1, 1.0, f32::NAN] {
        let options = SolverOptions::default().with_root_stiffness(stiffness);
        let error = ChainSolver::new(&skeleton, &[target], &options).expect_err("refused");
        let expected = "root stiffness must be finite and 0 or more and below 1, got";
        assert!(error.to_string().starts_with(expected), "{error}");
    }
}
