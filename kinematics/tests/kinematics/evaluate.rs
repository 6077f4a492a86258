//! Skeletons posed by their targets, as a function of rig and time.

use glam::{Affine3A, DMat3, DVec3, Quat, Vec3};
use ik_arm_kinematics::Shared;
use ik_arm_kinematics::limb_ik::{Limb, LimbReach};
use ik_arm_kinematics::rig::{
    Carried, EvaluatedSkeleton, LimbSettings, SkeletonRig, Target, TargetKind, TargetMotion,
    TargetOutcome, TargetPath, TargetSpace,
};
use ik_arm_kinematics::skeleton::{Joint, JointId, JointLimits, Limit, Skeleton};
use ik_arm_kinematics::soft_reach::SoftReach;
use ik_arm_kinematics::twist::TwistReferenceKind;

use crate::common::Random;
use crate::common::skeletons::{forest, space_f64, transform};

/// A figure in its bind pose: pelvis, chest, two arms and two legs with hinged elbows and knees.
struct Figure {
    rig: SkeletonRig,
    pelvis: JointId,
    /// Forearms and shins.
    lower: Vec<JointId>,
}

impl Figure {
    fn new() -> Self {
        let mut skeleton = Skeleton::default();
        let mut add = |joint: Joint| skeleton.add(joint).expect("a joint");
        let pelvis =
            add(Joint { offset: Vec3::Y * 0.95, ..Joint::new("pelvis", None, Vec3::ZERO) });
        let chest = add(Joint::new("chest", Some(pelvis), Vec3::Y * 0.5));
        let hinge = |min, max| {
            let fixed = Some(Limit { min: 0.0, max: 0.0 });
            JointLimits::new([Some(Limit { min, max }), fixed, fixed])
        };
        let mut lower = Vec::new();
        for (name, side) in [("left", 1.0), ("right", -1.0)] {
            for (limb, parent, offset, lengths, limits) in [
                ("arm", chest, Vec3::new(0.18 * side, 0.48, 0.0), [0.29, 0.25], hinge(-2.5, 0.0)),
                ("leg", pelvis, Vec3::new(0.1 * side, -0.03, 0.0), [0.43, 0.41], hinge(0.0, 2.5)),
            ] {
                let name = |bone: &str| format!("{name}_{limb}_{bone}");
                let [upper_axis, lower_axis] = lengths.map(|length| Vec3::NEG_Y * length);
                let upper = Joint::new(&name("upper"), Some(parent), upper_axis);
                let upper = add(Joint { offset, ..upper });
                let bone = Joint::new(&name("lower"), Some(upper), lower_axis);
                let bone = add(Joint { offset: upper_axis, limits, ..bone });
                let end = Joint::new(&name("end"), Some(bone), Vec3::Z * 0.1);
                add(Joint { offset: lower_axis, ..end });
                lower.push(bone);
            }
        }
        let mut rig = SkeletonRig::new(skeleton);
        for joint in &lower {
            let target = Target::new(*joint, rig.skeleton.tip(*joint), 0.1);
            let kind = TargetKind::Limb(LimbSettings::default());
            rig.targets.push(Target { kind, influence: 1.0, ..target });
        }
        Self { rig, pelvis, lower }
    }

    /// Least and greatest distance of the tip from the upper joint, with hinges that bend by 2.5
    /// rad.
    fn reach(&self, joint: JointId) -> [f32; 2] {
        let skeleton = &self.rig.skeleton;
        let (upper, lower) = (skeleton[joint].offset.length(), skeleton[joint].axis.length());
        let squares = upper * upper + lower * lower;
        [(squares + 2.0 * upper * lower * 2.5_f32.cos()).sqrt(), upper + lower]
    }
}

/// A random skeleton with targets of both kinds, moving and still.
fn random_rig(random: &mut Random) -> SkeletonRig {
    let mut skeleton = forest(random, 14);
    skeleton.set_transform(transform(random)).expect("finite");
    let mut rig = SkeletonRig::new(skeleton);
    rig.solver = rig.solver.with_method(random.one_of(&[
        ik_arm_kinematics::chain_ik::Method::Fabrik,
        ik_arm_kinematics::chain_ik::Method::Ccd,
        ik_arm_kinematics::chain_ik::Method::DampedLeastSquares,
    ]));
    for joint in rig.skeleton.ids().collect::<Vec<_>>() {
        if !random.chance(0.4) {
            continue;
        }
        let home = rig.skeleton.tip(joint) + random.vector(0.5);
        let motion = TargetMotion {
            path: random.one_of(&[TargetPath::Still, TargetPath::Circle, TargetPath::FigureEight]),
            radius: random.within(0.0..1.0),
            period: random.within(0.5..4.0),
        };
        let settings = LimbSettings {
            reference: random.one_of(&[
                TwistReferenceKind::Fk,
                TwistReferenceKind::Up,
                TwistReferenceKind::Pole,
            ]),
            pole: Some(random_pole()),
            twist: random.within(-3.0..3.0),
            soft_reach: SoftReach::new(random.within(0.0..0.5), random.one_of(&[1.0, 1.3]), 0.1)
                .expect("in range"),
            ..LimbSettings::default()
        };
        let orientation = random.coin().then(|| random.angles());
        let kind = if random.coin() { TargetKind::Limb(settings) } else { TargetKind::WholeBody };
        let influence = random.one_of(&[0.0, 0.3, 1.0]);
        let enabled = random.chance(0.9);
        let target = Target::new(joint, home, 0.1);
        let orientation = orientation.filter(|_| kind != TargetKind::WholeBody);
        rig.targets.push(Target { kind, orientation, influence, enabled, motion, ..target });
    }
    rig
}

fn random_pole() -> Vec3 {
    Vec3::new(1.0, 5.0, -2.0)
}

fn bits(evaluated: &EvaluatedSkeleton) -> Vec<u32> {
    let joints = evaluated.solved.iter().flat_map(|(_, joint)| {
        [joint.rotation, joint.offset, joint.axis].into_iter().flat_map(|v| v.to_array())
    });
    joints.map(f32::to_bits).collect()
}

#[test]
fn a_pose_depends_on_rig_and_time_alone_in_whatever_order_times_are_evaluated() {
    let mut random = Random(150);
    for case in 0..12 {
        let rig = random_rig(&mut random);
        let times: Vec<f64> = (0..50).map(|frame| f64::from(frame) / 24.0).collect();
        let first: Vec<_> = times.iter().map(|time| bits(&rig.evaluate(*time))).collect();
        let again = rig.clone();
        for _ in 0..60 {
            let index = random.below(times.len());
            assert_eq!(bits(&again.evaluate(times[index])), first[index], "{case}");
        }
        assert_eq!(again, rig, "evaluating writes nothing");
    }
}

#[test]
fn influence_0_is_the_fk_pose_bit_for_bit() {
    let mut random = Random(151);
    for _ in 0..100 {
        let mut rig = random_rig(&mut random);
        rig.targets.iter_mut().for_each(|target| target.influence = 0.0);
        let evaluated = rig.evaluate(1.5);
        assert_eq!(*evaluated.solved, *rig.skeleton);
        assert!(evaluated.targets.iter().all(|report| report.outcome == TargetOutcome::Off));
    }
}

#[test]
fn limits_and_bone_lengths_hold_in_every_evaluated_pose() {
    let mut random = Random(152);
    for case in 0..60 {
        let mut rig = random_rig(&mut random);
        for target in &mut rig.targets {
            if let TargetKind::Limb(settings) = &mut target.kind {
                settings.soft_reach = SoftReach::default();
            }
        }
        let evaluated = rig.evaluate(random.within(0.0..10.0).into());
        for (joint, before) in rig.skeleton.iter() {
            let after = &evaluated.solved[joint];
            let beyond =
                (before.limits.project(after.rotation) - after.rotation).abs().max_element();
            let was_beyond =
                (before.limits.project(before.rotation) - before.rotation).abs().max_element();
            assert!(beyond <= was_beyond, "{case}: {joint} is {beyond} beyond its limits");
            assert_eq!(after.axis, before.axis, "{case}: {joint}");
            assert_eq!(after.offset, before.offset, "{case}: {joint}");
        }
    }
}

#[test]
fn hands_and_feet_stay_at_their_targets_when_the_pelvis_moves() {
    let mut random = Random(153);
    let figure = Figure::new();
    let reach = figure.rig.reach();
    let mut reached = 0;
    for case in 0..1_000 {
        let mut rig = figure.rig.clone();
        let moved = random.vector(0.25) - Vec3::Y * 0.15;
        let turned = random.vector(0.3);
        rig.skeleton_mut()
            .change(figure.pelvis, |pelvis| {
                pelvis.offset += moved;
                pelvis.rotation = turned;
            })
            .expect("a joint");
        let evaluated = rig.evaluate(0.0);
        for (report, joint) in evaluated.targets.iter().zip(&figure.lower) {
            let TargetOutcome::Limb(limb) = &report.outcome else { panic!("{report:?}") };
            match limb.reach {
                LimbReach::Reached => {
                    reached += 1;
                    assert!(report.error <= 1e-5 * reach, "{case}: {joint}: {report:?}");
                }
                LimbReach::TooFar | LimbReach::TooClose => {
                    let upper = rig.skeleton[*joint].parent.expect("an upper bone");
                    let distance = rig.skeleton.base(upper).distance(report.position);
                    let [least, most] = figure.reach(*joint);
                    let short = distance - distance.clamp(least, most);
                    assert!(
                        (report.error - short.abs()).abs() <= 1e-5 * reach,
                        "{case}: {report:?}"
                    );
                }
                LimbReach::Limited(_) => panic!("{case}: {report:?}"),
            }
            let after = &evaluated.solved[*joint];
            assert_eq!((after.rotation.y, after.rotation.z), (0.0, 0.0), "{case}: about the hinge");
            assert_eq!(
                after.limits.project(after.rotation),
                after.rotation,
                "{case}: within the limits"
            );
        }
    }
    assert!(reached > 2_000, "most targets are within reach: {reached}");
}

#[test]
fn whole_body_targets_bend_the_spine_and_limb_targets_follow_it() {
    let mut figure = Figure::new();
    let head = figure.rig.skeleton.find("chest").expect("a chest");
    let home = figure.rig.skeleton.tip(head) + Vec3::new(0.1, -0.05, 0.2);
    let target = Target::new(head, home, 0.1);
    figure.rig.targets.iter_mut().for_each(|target| target.home.y += 0.15);
    figure.rig.targets.insert(0, Target { influence: 1.0, ..target });
    let evaluated = figure.rig.evaluate(0.0);
    let reach = figure.rig.reach();
    for report in &evaluated.targets[1..] {
        assert!(report.error <= 1e-5 * reach, "{report:?}");
    }
    let TargetOutcome::WholeBody(report) = &evaluated.targets[0].outcome else { panic!() };
    assert!(report.iterations > 0);
    assert_ne!(evaluated.solved[head].rotation, Vec3::ZERO);
}

#[test]
fn reported_distances_are_those_of_the_final_pose_although_limbs_share_a_joint() {
    let mut random = Random(158);
    for case in 0..100 {
        let mut skeleton = forest(&mut random, 1);
        let mut parent = JointId::new(0);
        for name in ["upper arm", "forearm", "hand", "finger"] {
            let above = skeleton[parent].axis;
            let joint = Joint::new(name, Some(parent), random.direction());
            parent = skeleton.add(Joint { offset: above, ..joint }).expect("a joint");
        }
        let mut rig = SkeletonRig::new(skeleton);
        for joint in [2, 3, 4].map(JointId::new) {
            let target = Target::new(joint, rig.skeleton.tip(joint) + random.vector(0.5), 0.1);
            let kind = TargetKind::Limb(LimbSettings::default());
            rig.targets.push(Target {
                kind,
                influence: random.within(0.3..1.5).min(1.0),
                ..target
            });
        }
        let evaluated = rig.evaluate(0.0);
        for (target, report) in rig.targets.iter().zip(&evaluated.targets) {
            let distance = evaluated.solved.tip(target.joint).distance(report.position);
            assert!((report.error - distance).abs() < 1e-5, "case {case}: {report:?}, {distance}");
        }
    }
}

#[test]
fn what_cannot_be_solved_is_reported_and_leaves_the_fk_pose() {
    let mut figure = Figure::new();
    figure.rig.targets[0].joint = figure.pelvis;
    let evaluated = figure.rig.evaluate(0.0);
    let TargetOutcome::NoLimb(error) = &evaluated.targets[0].outcome else {
        panic!("{:?}", evaluated.targets[0])
    };
    assert_eq!(error.to_string(), "it has no bone");

    let flat = Affine3A::from_scale(Vec3::new(1.0, 0.0, 1.0));
    figure.rig.skeleton_mut().set_transform(flat).expect("finite");
    figure.rig.targets[1].kind = TargetKind::WholeBody;
    let evaluated = figure.rig.evaluate(0.0);
    assert_eq!(evaluated.solved, evaluated.fk);
    for report in &evaluated.targets[1..] {
        assert!(matches!(report.outcome, TargetOutcome::Refused(_)), "{report:?}");
    }
}

#[test]
fn a_foot_keeps_its_rotation_in_the_world_while_the_pelvis_turns() {
    let mut figure = Figure::new();
    let shin = figure.lower[1];
    let foot = figure.rig.skeleton.find("left_leg_end").expect("a foot");
    assert_eq!(Limb::ending_at(&figure.rig.skeleton, shin).expect("a leg").hand, Some(foot));
    figure.rig.targets[1].kind = TargetKind::Limb(LimbSettings::default());
    figure.rig.targets[1].orientation = Some(Vec3::ZERO);
    let pelvis = figure.pelvis;
    let turn = |pelvis: &mut Joint| {
        pelvis.rotation = Vec3::new(0.1, 0.4, 0.0);
        pelvis.offset.y -= 0.2;
    };
    figure.rig.skeleton_mut().change(pelvis, turn).expect("a joint");
    let evaluated = figure.rig.evaluate(0.0);
    let axes = evaluated.solved.full_transform(foot).matrix3;
    assert!(axes.abs_diff_eq(glam::Mat3A::IDENTITY, 1e-5), "{axes}");
}

/// Angle of a rotation in radians, from its matrix.
fn angle(rotation: DMat3) -> f64 {
    let [x, y, z] = [rotation.x_axis, rotation.y_axis, rotation.z_axis];
    let axis = DVec3::new(y.z - z.y, z.x - x.z, x.y - y.x);
    axis.length().atan2(x.x + y.y + z.z - 1.0)
}

/// R_z · R_y · R_x.
fn turned(angles: Vec3) -> DMat3 {
    let DVec3 { x, y, z } = angles.as_dvec3();
    DMat3::from_rotation_z(z) * DMat3::from_rotation_y(y) * DMat3::from_rotation_x(x)
}

/// The rotation of a joint in the world, by the formula in f64.
fn rotation_f64(skeleton: &Skeleton, joint: JointId, to_world: DMat3) -> DMat3 {
    let angles: Vec<_> = skeleton.iter().map(|(_, it)| it.rotation.as_dvec3()).collect();
    to_world * DMat3::from_mat4(space_f64(skeleton, joint, &angles))
}

#[test]
fn the_missing_angle_of_a_foot_is_the_one_computed_in_f64_and_0_within_its_limits() {
    let mut random = Random(159);
    let figure = Figure::new();
    let (mut missed, mut reached) = (0, 0);
    for case in 0..400 {
        let mut rig = figure.rig.clone();
        let to_world = random.rotation();
        let transform = Affine3A::from_scale_rotation_translation(
            Vec3::splat(random.within(0.1..10.0)),
            Quat::from_mat3(&to_world),
            random.vector(5.0),
        );
        let skeleton = rig.skeleton_mut();
        skeleton.set_transform(transform).expect("finite");
        skeleton.change(figure.pelvis, |pelvis| pelvis.offset.y -= 0.2).expect("a joint");
        let foot = skeleton.find("left_leg_end").expect("a foot");
        let is_limited = case % 2 == 0;
        let limits = [-0.6..0.8, -0.4..0.4, -0.4..0.4_f32];
        let limits = limits.map(|it| is_limited.then_some(Limit { min: it.start, max: it.end }));
        skeleton.change(foot, |joint| joint.limits = limits.into()).expect("limits");
        let space =
            if case % 4 < 2 { TargetSpace::World } else { TargetSpace::Joint(figure.pelvis) };
        let angles = random.vector(2.5);
        let settings = LimbSettings::default();
        let influence = if case % 5 == 0 { random.within(0.1..1.0) } else { 1.0 };
        let kind = TargetKind::Limb(settings);
        let orientation = Some(angles);
        let target = Target { kind, orientation, influence, ..rig.targets[1] };
        rig.targets[1] = target.in_space(space, &rig.skeleton, 0.0, None);
        rig.targets[1].orientation = Some(angles);
        let evaluated = rig.evaluate(0.0);

        let to_world = to_world.as_dmat3();
        let frame = match space.joint() {
            Some(joint) => rotation_f64(&evaluated.solved, joint, to_world),
            None => DMat3::IDENTITY,
        };
        let hand = rotation_f64(&evaluated.solved, foot, to_world);
        let expected = angle(hand.transpose() * frame * turned(angles));
        let report = &evaluated.targets[1];
        let told = report.rotation_error.expect("an angle");
        assert!((f64::from(told) - expected).abs() < 1e-4, "{case}: {told}, {expected}");
        missed += usize::from(report.misses_rotation());
        let must_reach = !is_limited && influence == 1.0;
        assert!(!must_reach || told < 1e-4, "{case}: {told}");
        reached += usize::from(!report.misses_rotation());
        assert_eq!(evaluated.targets[0].rotation_error, None, "a hand that follows its bone");
    }
    assert!(missed > 150 && reached > 150, "{missed} {reached}");
}

#[test]
fn a_step_carries_the_same_state_whether_its_pose_is_needed_or_not() {
    let mut random = Random(160);
    for case in 0..40 {
        let rig = random_rig(&mut random);
        let mut carried = Carried::default();
        for frame in 0..20 {
            let time = f64::from(frame) / 24.0;
            let (_, after) = rig.step(time, &carried);
            rig.carry(time, &mut carried);
            assert_eq!(after, carried, "{case}: frame {frame}");
        }
    }
}

#[test]
fn a_motion_that_begins_with_its_own_posture_begins_with_its_pose() {
    let mut random = Random(161);
    for case in 0..40 {
        let mut rig = random_rig(&mut random);
        rig.targets.iter_mut().for_each(|target| {
            target.influence = 1.0;
            target.kind = TargetKind::WholeBody;
        });
        let (posed, carried) = rig.settle(0.5, &Carried::default());
        let posture = Shared::from(carried.to_posture());
        let (again, _) = rig.step(0.5, &Carried::from_posture(&posture));
        let [one, other] = [&posed, &again].map(|it| it.solved.pose());
        let size = one.points().map(Vec3::length).fold(1.0, f32::max);
        for (one, other) in one.points().zip(other.points()) {
            assert!(one.distance(other) <= 1e-4 * size, "{case}: {one} {other}");
        }
        let limbs = carried.to_posture().limbs;
        assert!(limbs.is_empty() && posture.fits(rig.skeleton.joints().len()));
    }
}
