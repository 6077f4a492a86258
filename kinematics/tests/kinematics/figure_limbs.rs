//! Limbs of random figures in their frames, against an f64 twin that reads the joints alone.

use core::f64::consts::PI;

use glam::{DAffine3, DMat3, DQuat, DVec3, EulerRot, Vec3};
use ik_arm_kinematics::limb_ik::{Limb, LimbReach};
use ik_arm_kinematics::rig::{
    EvaluatedSkeleton, LimbFrames, LimbPart, LimbSettings, SkeletonRig, Target, TargetKind,
    TargetOutcome,
};
use ik_arm_kinematics::skeleton::{Joint, JointId, RotationAxis, Skeleton};
use ik_arm_kinematics::soft_reach::SoftReach;
use ik_arm_kinematics::twist::TwistReferenceKind;
use ik_arm_kinematics::two_bone::Reach;

use crate::common::Random;
use crate::limb_ik::{leg, reachable, with_hinge};

const CASES: usize = 1_000;

/// Base, elbow and tip of a limb in the world.
struct Points {
    base: DVec3,
    elbow: DVec3,
    tip: DVec3,
}

impl Points {
    fn new(skeleton: &Skeleton, limb: Limb) -> Self {
        let base = transform(skeleton, limb.upper).translation;
        let lower = transform(skeleton, limb.lower);
        let tip = lower.transform_point3(skeleton[limb.lower].axis.as_dvec3());
        Self { base, elbow: lower.translation, tip }
    }
}

/// Transform from a joint's own space to the world.
fn transform(skeleton: &Skeleton, joint: JointId) -> DAffine3 {
    let own = |joint: &Joint| {
        let Vec3 { x, y, z } = joint.rotation;
        let turn = DMat3::from_euler(EulerRot::ZYX, z.into(), y.into(), x.into());
        let frame = joint.frame.as_dmat3();
        let turn = frame * turn * frame.transpose();
        DAffine3::from_mat3_translation(turn, joint.offset.as_dvec3())
    };
    let mut all = DAffine3::IDENTITY;
    for joint in skeleton.ancestors(joint) {
        all = own(&skeleton[joint]) * all;
    }
    skeleton.transform().as_daffine3() * all
}

fn scale(skeleton: &Skeleton) -> f64 {
    skeleton.transform().as_daffine3().matrix3.determinant().abs().cbrt()
}

/// A rig whose only target poses a limb.
struct Case {
    rig: SkeletonRig,
    limb: Limb,
    evaluated: EvaluatedSkeleton,
    frames: LimbFrames,
    points: Points,
    /// Length of both bones in the world.
    length: f64,
}

fn case(random: &mut Random) -> Case {
    let (mut skeleton, limb) = leg(random);
    if random.chance(0.6) {
        skeleton = with_hinge(random, skeleton, limb).0;
    }
    let mut home = reachable(random, &skeleton, limb);
    if random.chance(0.3) {
        let away = skeleton.tip(limb.lower) - skeleton.base(limb.upper);
        home += random.direction() * away.length() * random.within(0.0..2.0);
    }
    let pole = home + random.direction() * scale(&skeleton) as f32;
    let reference = random.one_of(&[
        TwistReferenceKind::Fk,
        TwistReferenceKind::Up,
        TwistReferenceKind::Pole,
        TwistReferenceKind::Stereographic,
        TwistReferenceKind::Transport,
    ]);
    let soft_reach = random.one_of(&[
        SoftReach::default(),
        SoftReach::new(0.3, 1.0, 0.0).expect("soft"),
        SoftReach::new(0.0, 1.4, 0.3).expect("stretch"),
    ]);
    let twist = if random.coin() { random.within(-3.0..3.0) } else { 0.0 };
    let pole = Some(pole);
    let fk_stretch = random.one_of(&[1.0, 1.0, 1.3, 0.8]);
    let settings =
        LimbSettings { reference, pole, twist, soft_reach, fk_stretch, ..LimbSettings::default() };
    let influence = random.one_of(&[1.0, 1.0, 1.0, 0.4, 0.0]);
    let kind = TargetKind::Limb(settings);
    let target = Target { kind, influence, ..Target::new(limb.lower, home, 1.0) };
    let rig = SkeletonRig { targets: vec![target], ..SkeletonRig::new(skeleton) };
    let evaluated = rig.evaluate(0.0);
    let frames = rig.limb_frames(&evaluated, 0).expect("a limb");
    let points = Points::new(&evaluated.solved, limb);
    let length = points.base.distance(points.elbow) + points.elbow.distance(points.tip);
    Case { rig, limb, evaluated, frames, points, length }
}

/// The angle at a corner between two others.
fn angle(corner: DVec3, one: DVec3, other: DVec3) -> f64 {
    (one - corner).angle_between(other - corner)
}

#[track_caller]
fn near(what: &str, case: usize, got: f64, wanted: f64, bound: f64) {
    assert!((got - wanted).abs() <= bound, "case {case}: {what} is {got}, not {wanted}");
}

#[test]
fn all_points_lengths_and_angles_are_those_of_the_joints() {
    let mut random = Random(36);
    for index in 0..CASES {
        let Case { frames, points, length, .. } = case(&mut random);
        let Points { base, elbow, tip } = points;
        let pose = frames.pose();
        let bound = 3e-6 * length + 4.0 * f64::from(f32::EPSILON) * base.abs().max_element();
        let at = |point: Vec3| frames.in_world(point).as_dvec3();
        for (what, got, wanted) in [
            ("the Root", frames.origin(LimbPart::Root).as_dvec3(), base),
            ("the elbow", at(pose.elbow), elbow),
            ("the elbow's part", frames.origin(LimbPart::Elbow).as_dvec3(), elbow),
            ("the hand", at(pose.hand), tip),
            ("the hand's part", frames.origin(LimbPart::Hand).as_dvec3(), tip),
        ] {
            // Where the limb is straight, an angle of a joint moves the elbow by its square root.
            let is_elbow = what.contains("elbow") && f64::from(pose.out) < 0.05 * length;
            let bound = if is_elbow { 5e-4 * length } else { bound };
            assert!(got.distance(wanted) <= bound, "case {index}: {what} at {got}, not {wanted}");
        }
        let distance = base.distance(tip);
        near("D", index, pose.distance.into(), distance, bound);
        let along = (elbow - base).dot((tip - base).normalize());
        near("h_e", index, pose.along.into(), along, 2.0 * bound);
        let upper = f64::from(frames.upper().length);
        near("the Upper limb", index, upper, base.distance(elbow), bound);
        near("the Lower limb", index, frames.lower().length.into(), elbow.distance(tip), bound);
        let stretched = f64::from(frames.bones().upper() * pose.stretch);
        near("d₁", index, stretched, base.distance(elbow), bound);
        let at_elbow = angle(elbow, base, tip);
        if (0.02..PI - 0.02).contains(&at_elbow) && distance > 0.02 * length {
            near("φ", index, pose.elbow_angle().into(), at_elbow, 1e-4);
            near("θ_e", index, pose.shoulder_angle().into(), angle(base, tip, elbow), 1e-4);
        }
    }
}

#[test]
fn in_the_bind_pose_the_pointer_is_x_and_the_elbow_is_towards_y() {
    let mut random = Random(37);
    for index in 0..CASES {
        let Case { rig, limb, .. } = case(&mut random);
        let mut bind = rig.clone();
        for joint in rig.skeleton.ids() {
            bind.skeleton_mut().write_local(joint, |joint| joint.rotation = Vec3::ZERO);
        }
        bind.targets[0].influence = 0.0;
        let evaluated = bind.evaluate(0.0);
        let pose = *bind.limb_frames(&evaluated, 0).expect("a limb").pose();
        let Points { base, elbow, tip } = Points::new(&bind.skeleton, limb);
        let is_bent = (0.02..PI - 0.02).contains(&angle(elbow, base, tip));
        if is_bent && base.distance(tip) > 0.02 * base.distance(elbow) {
            let (hand, outward) = (pose.pointer.direction, pose.outward());
            assert!(hand.distance(Vec3::X) < 1e-5, "case {index}: {hand}");
            assert!(outward.distance(Vec3::Y) < 1e-4, "case {index}: {outward}");
        }
    }
}

#[test]
fn the_twist_is_measured_from_the_reference_and_references_agree_with_what_the_joints_do() {
    let mut random = Random(38);
    let mut compared = 0;
    for index in 0..CASES {
        let Case { rig, evaluated, frames, .. } = case(&mut random);
        let TargetOutcome::Limb(report) = &evaluated.targets[0].outcome else { continue };
        let posed = &frames.posed;
        if posed.influence < 1.0 || matches!(report.reach, LimbReach::Limited(_)) {
            continue;
        }
        let pose = frames.pose();
        let reference = posed.ik.reference.angle(pose.pointer, Some(frames.solution.transported));
        let turn = f64::from(pose.twist - reference - posed.twist);
        let gain = f64::from(posed.ik.reference.gain(pose.pointer)).max(1.0);
        let turn = (turn + PI).rem_euclid(2.0 * PI) - PI;
        near("ψ", index, turn, 0.0, 2e-5 * gain);
        // The same target with another reference: the joints pose the elbow where the page says.
        for kind in TwistReferenceKind::ALL {
            let (Some(said), Some(other)) =
                (frames.pose_with_reference(kind, None), with_reference(&rig, &frames, kind))
            else {
                continue;
            };
            let evaluated = other.evaluate(0.0);
            let after = other.limb_frames(&evaluated, 0).expect("a limb");
            let gain = f64::from(frames.reference_of(kind).expect("it").gain(pose.pointer));
            if after.is_limited() || gain > 10.0 {
                continue;
            }
            let apart = f64::from(after.pose().elbow.distance(said.elbow));
            let bound = 1e-4 * f64::from(frames.bones().outer_limit());
            assert!(apart <= bound, "case {index}: {kind} is {apart} away");
            compared += 1;
        }
    }
    assert!(compared > CASES, "{compared}");
}

/// The rig with its limb measured from a reference of this kind; `None` for Transport, which begins
/// with the FK pose.
fn with_reference(
    rig: &SkeletonRig,
    frames: &LimbFrames,
    kind: TwistReferenceKind,
) -> Option<SkeletonRig> {
    let mut other = rig.clone();
    let limb = other.targets[0].limb_mut()?;
    (limb.reference, limb.twist) = (kind, frames.posed.twist);
    (kind != TwistReferenceKind::Transport).then_some(other)
}

#[test]
fn limits_are_the_least_and_the_greatest_distance_that_the_lower_joint_allows() {
    let mut random = Random(39);
    for index in 0..CASES {
        let Case { rig, limb, frames, .. } = case(&mut random);
        let knee = &rig.skeleton[limb.lower];
        let free: Vec<RotationAxis> =
            RotationAxis::ALL.into_iter().filter(|axis| !knee.limits.is_fixed(*axis)).collect();
        let [hinge] = free[..] else { continue };
        let range = knee.limits.range(hinge);
        let (from, to) = range.map_or((-PI, PI), |it| (it.min.into(), it.max.into()));
        let mut other = Skeleton::clone(&rig.skeleton);
        let scale = scale(&other);
        let sample = |step: u32| {
            let angle = from + (to - from) * f64::from(step) / 2_000.0;
            other.write_local(limb.lower, |knee| knee.rotation[hinge.index()] = angle as f32);
            let Points { base, tip, .. } = Points::new(&other, limb);
            base.distance(tip)
        };
        let distances: Vec<f64> = (0..=2_000).map(sample).collect();
        let least = distances.iter().copied().fold(f64::INFINITY, f64::min);
        let most = distances.iter().copied().fold(0.0, f64::max);
        let bones = frames.bones();
        let bound = 4e-3 * f64::from(bones.outer_limit()) * scale.signum();
        near("the greatest distance", index, frames.range.outer.into(), most, bound);
        if frames.posed.ik.soft_reach.min_elbow_angle() == 0.0 {
            near("the least distance", index, frames.range.inner.into(), least, bound);
        }
    }
}

#[test]
fn the_word_for_the_reach_says_where_the_hand_is() {
    let mut random = Random(40);
    for index in 0..CASES {
        let Case { rig, frames, points, length, .. } = case(&mut random);
        let posed = &frames.posed;
        let target = rig.targets[0].home.as_dvec3();
        let (wanted, distance) = (points.base.distance(target), points.base.distance(points.tip));
        let missing = points.tip.distance(target);
        match posed.pose.reach {
            None => assert_eq!(posed.influence, 0.0, "case {index}"),
            Some(Reach::Reached) => assert!(missing <= 1e-5 * length, "case {index}: {missing}"),
            Some(Reach::TooFar) => assert!(distance <= wanted + 1e-5 * length, "case {index}"),
            Some(Reach::TooClose) => assert!(distance >= wanted - 1e-5 * length, "case {index}"),
        }
        let is_hard = posed.ik.soft_reach.is_hard();
        if posed.pose.reach == Some(Reach::Reached) && is_hard && posed.influence == 1.0 {
            assert_eq!(posed.pose.hand, posed.cursor, "case {index}: bit for bit");
        }
    }
}

#[test]
fn a_twist_leaves_the_tip_and_turns_the_elbow_by_its_angle() {
    let mut random = Random(41);
    let mut turned = 0;
    for index in 0..CASES {
        let Case { mut rig, limb, frames, points, length, .. } = case(&mut random);
        if frames.posed.influence < 1.0 || frames.is_limited() {
            continue;
        }
        let turn = random.within(-3.0..3.0);
        rig.targets[0].limb_mut().expect("a limb").twist += turn;
        let evaluated = rig.evaluate(0.0);
        let after = Points::new(&evaluated.solved, limb);
        if rig.limb_frames(&evaluated, 0).expect("a limb").is_limited() {
            continue;
        }
        assert!(after.tip.distance(points.tip) <= 1e-5 * length, "case {index}: the tip moves");
        let out = f64::from(frames.pose().out);
        if out > 0.05 * length {
            let mirror = rig.skeleton.transform().matrix3.determinant().signum();
            let axis = (points.tip - points.base).normalize();
            let turn = DQuat::from_axis_angle(axis, f64::from(turn * mirror));
            let wanted = points.base + turn * (points.elbow - points.base);
            let apart = after.elbow.distance(wanted);
            assert!(apart <= 3e-5 * length, "case {index}: the elbow is {apart} away");
            turned += 1;
        }
    }
    assert!(turned > CASES / 4, "{turned}");
}
