//! Checks of documents and of their state at a time.

use std::collections::HashSet;
use std::f32::consts::FRAC_PI_2;

use glam::Vec3;
use ik_arm::document::{Camera, Document, Quantity, SkeletonRig, Target};
use ik_arm::kinematics::chain_ik::SolverOptions;
use ik_arm::kinematics::skeleton::{Joint, JointId, Limit, RotationAxis, Skeleton};
use ik_arm::kinematics::skin::VertexWeights;
use ik_arm::rig::{Skin, SkinSource};
use ik_arm::session::Session;

use crate::soak::{Broken, hold};

/// Checks that all numbers are finite and in range.
pub fn document(document: &Document) -> Result<(), Broken> {
    let Document { rig, timeline, camera, metres_per_unit, .. } = document;
    skeleton(rig)?;
    hold!(rig.head_tracks.is_empty(), "the head's keys are in the document once");
    self::camera(camera)?;
    hold!(timeline.is_valid(), "the timeline is valid: {timeline:?}");
    hold!(
        metres_per_unit.is_none_or(is_above_0),
        "a unit is longer than nothing: {metres_per_unit:?}"
    );
    keys(document)
}

/// Checks the same of the document at the current time.
pub fn shown(session: &Session) -> Result<(), Broken> {
    let shown = session.shown();
    skeleton(&shown.rig)?;
    hold!(shown.camera == session.document().camera, "the shown camera is the document's");
    hold!(shown.keys == session.document().keys, "the shown keys are the document's");
    Ok(())
}

fn is_above_0(value: f32) -> bool {
    value.is_finite() && value > 0.0
}

fn skeleton(rig: &SkeletonRig) -> Result<(), Broken> {
    let SkeletonRig {
        skeleton,
        targets,
        solver,
        iterations_per_frame,
        follow_paths,
        head_tracks: _,
        is_tracked: _,
        body_follows: _,
        balance,
        posture,
        skin,
    } = rig;
    let joints = skeleton.joints();
    hold!(skeleton.transform().is_finite(), "the skeleton is somewhere");
    let mut names = HashSet::new();
    for (index, joint) in joints.iter().enumerate() {
        self::joint(joint, index)?;
        hold!(names.insert(joint.name.as_str()), "no two joints are called {:?}", joint.name);
    }
    if let Some(posture) = posture {
        let joints = posture.joints.keys().chain(posture.limbs.keys());
        for joint in joints {
            hold!(skeleton.joint(*joint).is_some(), "the posture is of the skeleton: {posture:?}");
        }
    }
    let mut aimed = HashSet::new();
    for target in targets {
        self::target(target, joints.len())?;
        hold!(aimed.insert(target.joint), "joint {} has one target", target.joint);
    }
    if let Some(skin) = skin {
        self::skin(skin, skeleton)?;
    }
    hold!(balance.is_none_or(|it| it.is_valid()), "the balance is sound: {balance:?}");
    let SolverOptions { iterations, tolerance, damping, step, posture_rate, .. } = *solver;
    let root_stiffness = solver.root_stiffness;
    hold!((0.0..1.0).contains(&root_stiffness), "the root's stiffness: {root_stiffness}");
    hold!(posture_rate.is_finite() && posture_rate >= 0.0, "a posture rate: {posture_rate}");
    hold!(is_above_0(damping) && is_above_0(step), "the solver can work: {solver:?}");
    hold!(tolerance.is_none_or(is_above_0), "the solver has a tolerance: {solver:?}");
    hold!(iterations != Some(0), "the solver has iterations: {solver:?}");
    let per_frame = 1..=SkeletonRig::MAX_ITERATIONS_PER_FRAME;
    hold!(per_frame.contains(iterations_per_frame), "{iterations_per_frame} iterations a frame");
    let mut heads = HashSet::new();
    for path in follow_paths {
        hold!(path.kind.is_valid(), "the snake has a way: {path:?}");
        let head = skeleton.joint(path.root);
        hold!(head.is_some_and(|it| it.parent.is_none()), "a head is a root: {path:?}");
        hold!(heads.insert(path.root), "a root has one path: {path:?}");
    }
    Ok(())
}

fn skin(skin: &Skin, skeleton: &Skeleton) -> Result<(), Broken> {
    let mesh = match &skin.source {
        SkinSource::Bones(bones) => {
            let shape = bones.shape();
            hold!(shape.check(skeleton).is_ok(), "the skin has a shape: {shape:?}");
            return Ok(());
        }
        SkinSource::Mesh(mesh) => mesh,
    };
    let count = skeleton.joints().len();
    let mut own = HashSet::new();
    for joint in mesh.joints().iter().flatten() {
        hold!(joint.index() < count, "the skin has joints of the skeleton: {joint:?}");
        hold!(own.insert(joint), "no two joints of the file are the same joint: {joint:?}");
    }
    if let Ok(mesh) = mesh.mesh() {
        let joints = mesh.mesh.weights().iter().flat_map(VertexWeights::iter);
        let greatest = joints.map(|(joint, _)| joint.index()).max().unwrap_or(0);
        hold!(greatest < count.max(1), "vertices follow joints of the skeleton: {greatest}");
    }
    Ok(())
}

fn joint(joint: &Joint, index: usize) -> Result<(), Broken> {
    let Joint {
        name,
        parent,
        offset,
        axis,
        rotation,
        frame,
        limits,
        stiffness,
        locked: _,
        connected: _,
        radius,
        skin,
        human_bone: _,
    } = joint;
    hold!(!name.trim().is_empty(), "joint {index} has a name");
    hold!(
        parent.is_none_or(|parent| parent < JointId::new(index)),
        "{name:?} hangs from one before it"
    );
    let are_finite = offset.is_finite() && axis.is_finite() && rotation.is_finite();
    hold!(are_finite && frame.is_finite(), "{name:?} is finite: {joint:?}");
    let is_stretched = skin.scale.is_finite() && skin.shear.is_finite();
    hold!(is_stretched, "{name:?} stretches the skin: {skin:?}");
    hold!(radius.is_finite() && *radius >= 0.0, "{name:?} is as thick as a bone: {radius}");
    let is_stiffness = |it: f32| (0.0..1.0).contains(&it);
    hold!(stiffness.to_array().into_iter().all(is_stiffness), "{name:?} is stiff: {stiffness}");
    for limit in RotationAxis::ALL.into_iter().filter_map(|axis| limits.range(axis)) {
        let Limit { min, max } = limit;
        hold!(min.is_finite() && max.is_finite() && min <= max, "{name:?} has limits: {limit:?}");
    }
    hold!(joint.limits.contains(*rotation), "{name:?} is within its limits: {joint:?}");
    Ok(())
}

fn target(target: &Target, joints: usize) -> Result<(), Broken> {
    let Target { joint, home, pin, influence, weight, softness, motion, .. } = target;
    hold!((0.0..1.0).contains(softness), "the softness is from 0 to less than 1: {softness}");
    hold!(*joint < JointId::new(joints), "a target is of a joint: {joint} of {joints}");
    let is_placed = home.is_finite() && pin.is_finite();
    hold!(
        is_placed && (is_above_0(*weight) || *weight == 0.0 && target.turns_joint()),
        "a target can be aimed at: {target:?}"
    );
    hold!((0.0..=1.0).contains(influence), "influence is a fraction: {target:?}");
    hold!(motion.radius.is_finite() && is_above_0(motion.period), "a target goes: {target:?}");
    Ok(())
}

fn camera(camera: &Camera) -> Result<(), Broken> {
    let Camera { target, yaw, pitch, distance, orthographic: _ } = camera;
    hold!(target.is_finite() && yaw.is_finite(), "the camera looks somewhere: {camera:?}");
    hold!((-FRAC_PI_2..=FRAC_PI_2).contains(pitch), "the camera is upright: {camera:?}");
    hold!(is_above_0(*distance), "the camera is away from what it looks at: {camera:?}");
    Ok(())
}

fn keys(document: &Document) -> Result<(), Broken> {
    for (channel, track) in document.keys.tracks() {
        let knots = track.knots();
        hold!(!knots.is_empty(), "{channel:?} has keys");
        hold!(knots.is_sorted_by(|a, b| a.time < b.time), "keys of {channel:?} are in order");
        let are_finite = knots.iter().all(|knot| knot.time.is_finite() && knot.value.is_finite());
        hold!(are_finite, "keys of {channel:?} are finite: {knots:?}");
        let is_right = |value: Vec3| match channel.quantity() {
            Quantity::Length => value.x > 0.0,
            Quantity::Fraction => (0.0..=1.0).contains(&value.x),
            Quantity::Switch => value.x == 0.0 || value.x == 1.0,
            Quantity::Point
            | Quantity::Angle
            | Quantity::Number
            | Quantity::Numbers
            | Quantity::Rotation => true,
        };
        let values = knots.iter().map(|knot| knot.value);
        hold!(values.clone().all(is_right), "keys of {channel:?} are in range: {knots:?}");
        // A target without, for instance, an orientation of its own keeps the keys of one.
        let is_of_target = channel.target().is_some_and(|it| document.rig.target(it).is_some());
        let is_of_something = is_of_target || channel.value(document).is_some();
        hold!(is_of_something, "{channel:?} is of something");
    }
    Ok(())
}
