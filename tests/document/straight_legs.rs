//! Legs that are straight at the limits of their knees, by every iterative method.

use glam::{Mat3, Vec3, Vec3A};
use ik_arm::io::Example;
use ik_arm::kinematics::chain_ik::{ChainTarget, Method, SolverOptions, solve};
use ik_arm::kinematics::skeleton::{Joint, JointId, JointLimits, Limit, RotationAxis, Skeleton};
use ik_arm::rig::{Carried, EvaluatedSkeleton, SkeletonRig};
use ik_arm::words;
use serde_json::Value;

use crate::common::Random;

const CASES: usize = 1_000;

/// Ranges of the angles of a hip, in place of the cone in the file.
const HIP: [Option<Limit>; 3] = [
    Some(Limit { min: -2.1, max: 0.5 }),
    Some(Limit { min: -0.7, max: 0.7 }),
    Some(Limit { min: -0.8, max: 0.8 }),
];

/// The example figure in its bind pose, read from its file without the library's reader.
fn human() -> Skeleton {
    let file: Value = serde_json::from_str(include_str!("../../assets/human.json")).expect("JSON");
    let listed = file["skeleton"]["joints"].as_array().expect("joints");
    let mut joints: Vec<Joint> = Vec::new();
    for json in listed {
        let parent = json["parent"].as_u64().map(|parent| JointId::new(parent as usize));
        let tip = parent.map_or(Vec3::ZERO, |parent| joints[parent.index()].axis);
        let name = json["name"].as_str().expect("name");
        let mut joint = Joint::new(name, parent, vector(&json["axis"]).expect("axis"));
        joint.offset = vector(&json["offset"]).unwrap_or(tip);
        joint.locked = parent.is_none();
        joint.limits = match name {
            "left_thigh" | "right_thigh" => JointLimits::new(HIP),
            _ => RotationAxis::ALL.map(|axis| limit(&json["limits"][axis.name()])).into(),
        };
        joints.push(joint);
    }
    Skeleton::from_joints(joints).expect("a tree")
}

fn vector(json: &Value) -> Option<Vec3> {
    let [x, y, z] = json.as_array()?.as_slice() else { return None };
    Some(Vec3::new(number(x)?, number(y)?, number(z)?))
}

fn limit(json: &Value) -> Option<Limit> {
    let [min, max] = json.as_array()?.as_slice() else { return None };
    Some(Limit { min: number(min)?, max: number(max)? })
}

fn number(json: &Value) -> Option<f32> {
    json.as_f64().map(|value| value as f32)
}

fn joint(skeleton: &Skeleton, name: &str) -> JointId {
    skeleton.iter().find(|(_, joint)| joint.name == name).expect("the joint").0
}

/// Random angles within the limits of the joint and its ancestors.
fn pose_within_limits(random: &mut Random, skeleton: &mut Skeleton, joint: JointId) {
    for joint in skeleton.ancestors(joint).collect::<Vec<_>>() {
        if !skeleton[joint].locked {
            let limits = skeleton[joint].limits;
            let angles = RotationAxis::ALL.map(|axis| {
                let Limit { min, max } = limits.range(axis).expect("a limited leg");
                min + (max - min) * random.within(0.0..1.0)
            });
            skeleton.set_rotation(joint, Vec3::from_array(angles)).expect("angles");
        }
    }
}

/// Asserts that all joints are within their limits and that the knee is in front of the line from
/// hip to ankle.
fn assert_knee_is_forward(skeleton: &Skeleton, method: Method) {
    let [thigh, shin] = ["left_thigh", "left_shin"].map(|name| joint(skeleton, name));
    for (_, joint) in skeleton.iter() {
        assert_eq!(joint.limits.project(joint.rotation), joint.rotation, "{method:?}");
    }
    let Vec3 { x, y, z } = skeleton[thigh].rotation;
    let forward =
        Mat3::from_rotation_z(z) * Mat3::from_rotation_y(y) * Mat3::from_rotation_x(x) * Vec3::Z;
    let [hip, knee, ankle] = [skeleton.base(thigh), skeleton.base(shin), skeleton.tip(shin)];
    let line = (ankle - hip).normalize();
    let out = (knee - hip).reject_from_normalized(line);
    assert!(out.dot(forward) >= -1e-6, "{method:?}: {out}");
}

/// Number of targets reached from the bind pose within 1e-3 of the leg's length.
fn reached(options: &SolverOptions, tip: &str) -> usize {
    let mut random = Random(79);
    let bind = human();
    let tip = joint(&bind, tip);
    let inner = bind.ancestors(tip).filter(|id| !bind[*id].locked);
    let length: f32 = inner.map(|id| bind[id].axis.length()).sum();
    let is_reached = |_: &usize| {
        let (mut posed, mut solved) = (bind.clone(), bind.clone());
        pose_within_limits(&mut random, &mut posed, tip);
        let target = ChainTarget::at(tip, posed.tip(tip));
        solve(&mut solved, &[target], options).expect("solve");
        assert_knee_is_forward(&solved, options.method);
        solved.tip(tip).distance(target.point) <= 1e-3 * length
    };
    (0..CASES).filter(is_reached).count()
}

#[test]
fn a_straight_leg_bends_its_knee_to_bring_the_ankle_to_every_target() {
    for method in [
        Method::DampedLeastSquares,
        Method::Ccd,
        Method::Transpose,
        Method::TransposeFixed,
        Method::Fabrik,
        Method::Relaxation,
    ] {
        assert_eq!(reached(&SolverOptions::new(method), "left_shin"), CASES, "{method:?}");
    }
}

/// The example figure with its pelvis down by so much, posed by its targets.
fn squat(down: f32) -> (SkeletonRig, EvaluatedSkeleton) {
    let opened = Example::find("human").expect("an example").open().expect("opens");
    let mut rig = opened.document.rig;
    let pelvis = joint(&rig.skeleton, "pelvis");
    rig.skeleton_mut().change(pelvis, |pelvis| pelvis.offset.y -= down).expect("a joint");
    let evaluated = rig.evaluate(0.0);
    (rig, evaluated)
}

#[test]
fn the_human_squats_with_flat_feet_and_no_toe_below_the_floor() {
    for down in [0.0, 0.1, 0.2, 0.3, 0.4] {
        let (rig, evaluated) = squat(down);
        for (shin, foot) in [("left_shin", "left_foot"), ("right_shin", "right_foot")] {
            let report = &evaluated.targets[rig.target(joint(&rig.skeleton, shin)).expect("one")];
            assert!(rig.is_reached(report), "{foot}, {down} down: {report:?}");
            let foot = joint(&rig.skeleton, foot);
            let pose = evaluated.solved.full_transform(foot);
            // The sole's normal, and the lowest point of the toes' skin in the foot's space.
            assert!(pose.matrix3.y_axis.distance(Vec3A::Y) < 1e-4, "{foot}, {down} down: {pose}");
            let toe = pose.transform_point3(Vec3::new(0.0, -0.075, 0.2));
            assert!(toe.y >= 0.0, "{foot}, {down} down: the toes are at {toe}");
        }
    }
}

#[test]
fn feet_whose_ankles_bend_too_little_are_said_to_miss_their_rotation() {
    let (mut rig, _) = squat(0.2);
    let foot = joint(&rig.skeleton, "right_foot");
    let stiff = Some(Limit { min: -0.6, max: 0.8 });
    rig.skeleton_mut()
        .change(foot, |foot| foot.limits.set_range(RotationAxis::X, stiff))
        .expect("a joint");
    let found = rig.diagnose(0.0, &Carried::default());
    assert_eq!(found.len(), 1, "{found:?}");
    let sentence = words::cause(&rig, &found[0]);
    let end = "° short of its target's rotation: its limit about x is in the way";
    assert!(sentence.starts_with("right_foot is ") && sentence.ends_with(end), "{sentence}");
}

#[test]
fn a_fixed_step_needs_more_iterations_than_a_variable_one() {
    let options = SolverOptions::new(Method::TransposeFixed).with_iterations(500);
    assert_eq!(reached(&options, "left_shin"), 953);
}

#[test]
fn a_straight_leg_leaves_its_limits_to_bring_the_toes_to_their_target() {
    for (method, least) in [
        (Method::DampedLeastSquares, 1_000),
        (Method::Transpose, 1_000),
        (Method::Ccd, 990),
        (Method::Fabrik, 990),
        (Method::Relaxation, 990),
    ] {
        let count = reached(&SolverOptions::new(method), "left_foot");
        assert!(count >= least, "{method:?}: {count} of {CASES}");
    }
}
