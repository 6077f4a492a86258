//! Targets for the centre of mass, against an f64 twin with finite differences, and against
//! [`Balance`] of the solved pose.

use glam::{DVec3, Vec3};
use ik_arm_kinematics::chain_ik::{
    ChainSolver, ChainTarget, Method, NullSpaceDrag, Orientation, Root, SolveError, SolverOptions,
    solve,
};
use ik_arm_kinematics::skeleton::{Balance, Joint, JointId, JointLimits, Skeleton};

use crate::common::Random;
use crate::common::gradient::{assert_first_step_descends, to_skeleton_f64};
use crate::common::skeletons::{
    ITERATIVE, chain, forest, length, shake, space_f64, transform, tree,
};

const ROOT: JointId = JointId::new(0);

fn balancing() -> impl Iterator<Item = Method> {
    ITERATIVE.into_iter().filter(|method| method.can_balance())
}

/// The centre of mass of a joint and all joints below it, in skeleton space, of bones without radii.
fn centre(skeleton: &Skeleton, top: JointId, angles: &[DVec3]) -> DVec3 {
    let is_below = |joint: &JointId| skeleton.ancestors(*joint).any(|above| above == top);
    let (mut total, mut moment) = (0.0, DVec3::ZERO);
    for joint in skeleton.ids().filter(is_below) {
        let axis = skeleton[joint].axis.as_dvec3();
        let mass = axis.length();
        total += mass;
        moment += mass * space_f64(skeleton, joint, angles).transform_point3(0.5 * axis);
    }
    moment / total
}

/// f = Σ ½ w d², with the distances of tips from points and of the centre of mass from the vertical
/// line through its point, in skeleton units.
fn cost(skeleton: &Skeleton, targets: &[ChainTarget], angles: &[DVec3]) -> f64 {
    let to_skeleton = to_skeleton_f64(skeleton);
    let (balanced, tips) = targets.split_last().expect("a target");
    let of_tip = |target: &ChainTarget| {
        let axis = skeleton[target.joint].axis.as_dvec3();
        let tip = space_f64(skeleton, target.joint, angles).transform_point3(axis);
        let point = to_skeleton.transform_point3(target.point.as_dvec3());
        0.5 * f64::from(target.weight) * (tip - point).length_squared()
    };
    let up = to_skeleton.transform_vector3(DVec3::Y).normalize();
    let off = centre(skeleton, balanced.joint, angles)
        - to_skeleton.transform_point3(balanced.point.as_dvec3());
    let off = off.reject_from_normalized(up).length_squared();
    tips.iter().map(of_tip).sum::<f64>() + 0.5 * f64::from(balanced.weight) * off
}

#[test]
fn the_gradient_of_a_balance_is_that_of_finite_differences() {
    let mut random = Random(381);
    for case in 0..300 {
        let joints = 3 + random.below(7);
        let forest = forest(&mut random, joints);
        let mut joints: Vec<Joint> = forest.iter().map(|(_, joint)| joint.clone()).collect();
        for joint in &mut joints {
            (joint.limits, joint.radius) = (JointLimits::default(), 0.0);
        }
        let mut skeleton = Skeleton::from_joints(joints).expect("a forest");
        skeleton.set_transform(transform(&mut random)).expect("transform");
        let with_bones: Vec<JointId> =
            skeleton.ids().filter(|joint| skeleton[*joint].axis != Vec3::ZERO).collect();
        let Some(tip) = with_bones.last().copied() else { continue };
        let near = |random: &mut Random, joint: JointId| {
            let off = skeleton.transform().transform_vector3(random.vector(0.5));
            skeleton.tip(joint) + off
        };
        let top = skeleton.ancestors(tip).last().expect("a root");
        let (place, over) = (near(&mut random, tip), near(&mut random, top));
        let targets = [
            ChainTarget::at(tip, place),
            ChainTarget::balanced(top, over).with_weight(random.within(0.2..3.0)),
        ];
        let is_above = |joint: &JointId| skeleton.ancestors(tip).any(|above| above == *joint);
        let path = skeleton.ids().filter(is_above).filter(|joint| !skeleton[*joint].locked);
        assert_first_step_descends(
            case,
            &skeleton,
            &targets,
            &path.collect::<Vec<_>>(),
            |angles| cost(&skeleton, &targets, angles),
        );
    }
}

/// A thick tree in a random pose, with targets of its tips and its centre of mass that another
/// random pose reaches.
fn reachable(random: &mut Random, scale: f32) -> (Skeleton, Vec<ChainTarget>) {
    let ends = 1 + random.below(3);
    let (mut skeleton, tips) = tree(random, ends, 1.0);
    for joint in skeleton.ids() {
        let radius = random.within(0.02..0.2);
        skeleton.change(joint, |joint| joint.radius = radius).expect("a radius");
    }
    let (turn, shift) = (random.rotation(), random.vector(3.0));
    let to_world = glam::Affine3A::from_mat3_translation(turn * scale, shift);
    skeleton.set_transform(to_world).expect("a transform");
    let mut posed = skeleton.clone();
    shake(random, &mut posed);
    let over = Balance::of(&posed).expect("mass").centre.with_y(random.within(-9.0..9.0));
    let mut targets: Vec<ChainTarget> =
        tips.iter().map(|tip| ChainTarget::at(*tip, posed.tip(*tip))).collect();
    targets.push(ChainTarget::balanced(ROOT, over));
    shake(random, &mut skeleton);
    (skeleton, targets)
}

/// Distance on the ground from the centre of mass of a pose to the place of the last target.
fn distance_on_ground(posed: &Skeleton, targets: &[ChainTarget]) -> f32 {
    let over = targets.last().expect("a target").point;
    let off = Balance::of(posed).expect("mass").centre - over;
    off.with_y(0.0).length()
}

#[test]
fn places_and_a_balance_are_reached_together_by_all_methods_that_can() {
    const CASES: usize = 100;
    for method in balancing() {
        let mut random = Random(382);
        let mut reached = 0;
        for case in 0..CASES {
            let scale = random.within(0.1..10.0);
            let (mut skeleton, targets) = reachable(&mut random, scale);
            let tips: Vec<JointId> = targets.iter().map(|target| target.joint).collect();
            let size = scale * length(&skeleton, &tips);
            let report =
                solve(&mut skeleton, &targets, &SolverOptions::new(method)).expect("solve");
            let tips = targets[..targets.len() - 1].iter();
            let off = tips.map(|it| skeleton.tip(it.joint).distance(it.point));
            let off = off.fold(distance_on_ground(&skeleton, &targets), f32::max);
            let error = (report.error - off).abs() / size;
            assert!(error < 1e-5, "{method} {case}: reports {}, is {off}", report.error);
            reached += usize::from(report.converged());
        }
        assert!(reached >= 85, "{method}: {reached} of {CASES}");
    }
}

#[test]
fn a_chain_whose_root_is_free_is_balanced_by_moving_it() {
    for method in balancing() {
        let mut random = Random(383);
        for case in 0..20 {
            let mut skeleton = chain(&mut random, 6, 1.0);
            shake(&mut random, &mut skeleton);
            let over = random.vector(4.0);
            let targets = [ChainTarget::balanced(ROOT, over)];
            let options = SolverOptions::new(method).with_root(Root::Free);
            let report = solve(&mut skeleton, &targets, &options).expect("solve");
            let left = distance_on_ground(&skeleton, &targets);
            assert!(report.converged() && left < 1e-3, "{method} {case}: {left}");
        }
    }
}

#[test]
fn a_balance_that_moves_is_tracked_without_pops_while_tips_stay() {
    for method in balancing() {
        // The sweeps of CCD lead to and fro between the tip and the centre.
        let most = if method == Method::Ccd { 40.0 } else { 6.0 };
        let mut random = Random(384);
        for case in 0..6 {
            let mut fk = chain(&mut random, 10, 1.0);
            shake(&mut random, &mut fk);
            let tip = fk.ids().last().expect("a tip");
            let (place, from) = (fk.tip(tip), Balance::of(&fk).expect("mass").centre);
            let to = from + 0.8 * random.direction();
            let targets = |frame: u16| {
                let part = 0.5 - 0.5 * (f32::from(frame) / 20.0).cos();
                [ChainTarget::at(tip, place), ChainTarget::balanced(ROOT, from.lerp(to, part))]
            };
            let options = SolverOptions::new(method);
            let mut solver = ChainSolver::new(&fk, &targets(0), &options).expect("a solver");
            solver.run();
            let mut posed = fk.clone();
            for frame in 1..120 {
                let step = solver.track(&targets(frame), &fk).expect("a step");
                solver.write(&mut posed);
                let at = format!("{method} {case} {frame}");
                assert!(step.joint_motion < most * step.target_motion + 1e-4, "{at}: {step:?}");
                assert!(posed.tip(tip).distance(place) < 2e-3, "{at}");
                assert!(distance_on_ground(&posed, &targets(frame)) < 2e-3, "{at}");
            }
        }
    }
}

#[test]
fn a_drag_in_the_null_space_leaves_the_balance() {
    let mut random = Random(385);
    for case in 0..50 {
        let mut skeleton = chain(&mut random, 10, 1.0);
        shake(&mut random, &mut skeleton);
        let tip = skeleton.ids().last().expect("a tip");
        let centre = Balance::of(&skeleton).expect("mass").centre;
        let held = [
            ChainTarget::at(tip, skeleton.tip(tip)),
            ChainTarget::balanced(ROOT, centre.with_y(-2.0)),
        ];
        let joint = JointId::new(5);
        let before = skeleton.tip(joint);
        let dragged = ChainTarget::at(joint, before + random.direction());
        let mut drag = NullSpaceDrag::new(&skeleton, &held, dragged, Root::Turns).expect("a drag");
        let report = drag.run();
        drag.write(&mut skeleton);
        assert!(report.held_error < 1e-4, "{case}: {report:?}");
        assert!(distance_on_ground(&skeleton, &held) < 1e-4, "{case}");
        assert!(skeleton.tip(tip).distance(held[0].point) < 1e-4, "{case}");
        assert!(report.distance < 0.9, "{case}: the joint comes nearer: {report:?}");
    }
}

#[test]
fn what_cannot_be_balanced_is_refused_by_name() {
    let mut random = Random(1);
    let skeleton = chain(&mut random, 3, 1.0);
    let target = ChainTarget::balanced(ROOT, Vec3::ZERO);
    let solver = |targets: &[ChainTarget], method| {
        ChainSolver::new(&skeleton, targets, &SolverOptions::new(method)).map(|_| ())
    };
    for method in Method::ALL.into_iter().filter(|method| !method.can_balance()) {
        let error = solver(&[target], method).expect_err("no balance");
        assert_eq!(error, SolveError::CannotBalance { method });
        let text = format!("{method} cannot balance a body; transpose, dls, ccd can");
        assert_eq!(error.to_string(), text);
    }
    let second = ChainTarget::balanced(JointId::new(1), Vec3::X);
    let error = solver(&[target, second], Method::DampedLeastSquares);
    assert_eq!(error, Err(SolveError::TwoTargets(JointId::new(1))));
    let aim = Orientation::Aim { axis: Vec3::X, point: Vec3::ONE };
    let turned = solver(&[target.with_orientation(aim)], Method::DampedLeastSquares);
    assert!(matches!(turned, Err(SolveError::Orientation { joint: ROOT, .. })));
}
