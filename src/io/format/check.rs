//! From what stands in a file to a document, if it can be one.

use core::f32::consts::FRAC_PI_2;
use std::collections::HashSet;

use glam::{Affine3A, Mat3, Vec3};

use super::arm::arm;
use super::file::{self, File, Root};
use super::keys::{keys, timeline};
use crate::document::{
    Arm, Camera, Document, FollowPath, Keys, RigKind, SkeletonRig, Target, TargetMotion,
};
use crate::io::json_path::JsonPath;
use crate::io::source::{Odd, Wrong};
use crate::io::value::{Number, Numbers, Object, Point, Whole};
use crate::kinematics::chain_ik::{self, Method, SolverOptions};
use crate::kinematics::skeleton::{Joint, Limit, Skeleton, SkeletonError};

pub fn document(file: File, odd: &mut Odd) -> Result<Document, Wrong> {
    let at = |key| JsonPath::root().key(key);
    let rig = file.rig;
    let arm = file.arm.map_or_else(|| Ok(Arm::default()), |Object(file)| arm(&at("arm"), &file))?;
    let skeleton_rig = skeleton_rig(
        file.skeleton.map(|Object(skeleton)| skeleton),
        file.targets.unwrap_or_default(),
        file.solver.map(|Object(solver)| solver).unwrap_or_default(),
        file.slither.map(|Object(slither)| slither),
        odd,
    )?;
    let seen_from = match file.camera {
        Some(Object(file)) => camera(&at("camera"), &file)?,
        None => first_view(rig, &skeleton_rig),
    };
    let other_camera = file.other_camera.map(|Object(file)| camera(&at("other_camera"), &file));
    let display = file.display.map(|layers| layers.into_iter().collect()).unwrap_or_default();
    let metres = file.metres_per_unit.map(|Number(metres)| above_0(at("metres_per_unit"), metres));
    let timeline = file.timeline.map(|Object(file)| timeline(at("timeline"), &file));
    let mut document = Document {
        rig,
        arm,
        skeleton_rig,
        keys: Keys::default(),
        timeline: timeline.transpose()?.unwrap_or_default(),
        camera: seen_from,
        other_camera: other_camera.transpose()?,
        display,
        metres: metres.transpose()?,
    };
    document.keys = keys(file.keys.unwrap_or_default(), &document)?;
    Ok(document)
}

fn skeleton_rig(
    skeleton: Option<file::Skeleton>,
    targets: Vec<Object<file::Target>>,
    solver: file::Solver,
    slither: Option<file::Slither>,
    odd: &mut Odd,
) -> Result<SkeletonRig, Wrong> {
    let mut rig = SkeletonRig::default();
    if let Some(file) = skeleton {
        rig.skeleton = self::skeleton(file, odd)?.into();
    }
    let circle = rig.circle();
    let mut aimed = HashSet::new();
    for (index, Object(file)) in targets.into_iter().enumerate() {
        let at = JsonPath::root().key("targets").index(index);
        let target = target(&at, &file, rig.skeleton.joints().len(), circle)?;
        if !aimed.insert(target.joint) {
            let reason = format!("joint {} has a target already", target.joint);
            return Err(Wrong::new(at.key("joint"), reason));
        }
        rig.targets.push(target);
    }
    let at = JsonPath::root().key("solver");
    rig.solver = options(&at, &solver)?;
    rig.iterations_per_frame = match solver.iterations_per_frame {
        Some(Whole(count)) => iterations_per_frame(at.key("iterations_per_frame"), count)?,
        None => rig.iterations_per_frame,
    };
    rig.follow_path =
        slither.map(|file| self::slither(&JsonPath::root().key("slither"), &file)).transpose()?;
    Ok(rig)
}

fn skeleton(file: file::Skeleton, odd: &mut Odd) -> Result<Skeleton, Wrong> {
    let at = JsonPath::root().key("skeleton");
    let at_joint = |index| at.clone().key("joints").index(index);
    let mut joints: Vec<Joint> = Vec::new();
    for (index, Object(file)) in file.joints.unwrap_or_default().into_iter().enumerate() {
        let joint = joint(file, &joints);
        if is_beyond_limits(&joint) {
            let reason = "is beyond the joint's limits; it is brought within";
            odd.push(at_joint(index).key("rotation"), reason);
        }
        joints.push(joint);
    }
    let names: Vec<_> = joints.iter().map(|joint| joint.name.clone()).collect();
    let mut skeleton = Skeleton::from_joints(joints).map_err(|error| {
        let field = match &error {
            SkeletonError::Parent { joint, .. } => at_joint(*joint).key("parent"),
            SkeletonError::Radius { joint, .. } => at_joint(*joint).key("radius"),
            SkeletonError::Frame { joint } => at_joint(*joint).key("frame"),
            SkeletonError::NotFinite { joint, field, .. } => at_joint(*joint).key(field),
            SkeletonError::Limit { joint, axis, .. } => {
                at_joint(*joint).key("limits").key(&axis.to_string())
            }
            SkeletonError::NoName => {
                let empty = names.iter().position(|name| name.trim().is_empty());
                at_joint(empty.unwrap_or_default()).key("name")
            }
            SkeletonError::Name(twice) => {
                let mut same = (0..names.len()).filter(|index| names[*index] == *twice);
                at_joint(same.nth(1).unwrap_or_default()).key("name")
            }
            _ => at.clone().key("joints"),
        };
        Wrong::new(field, error.to_string())
    })?;
    if let Some(Numbers(transform)) = file.transform {
        skeleton
            .set_transform(Affine3A::from_cols_array(&transform))
            .map_err(|error| Wrong::new(at.key("transform"), error.to_string()))?;
    }
    Ok(skeleton)
}

fn joint(file: file::Joint, before: &[Joint]) -> Joint {
    let parent = file.parent.map(|Whole(parent)| parent as usize);
    let axis = file.axis.map_or(Vec3::ZERO, |Point(axis)| axis);
    let parents_tip = parent.and_then(|parent| Some(before.get(parent)?.axis));
    let seed = Joint::new(&file.name, parent, axis);
    let limits = file.limits.map(|Object(limits)| limits).unwrap_or_default();
    Joint {
        offset: file.offset.map_or(parents_tip.unwrap_or_default(), |Point(offset)| offset),
        rotation: file.rotation.map_or(Vec3::ZERO, |Point(rotation)| rotation),
        frame: file.frame.map_or(Mat3::IDENTITY, |Numbers(frame)| Mat3::from_cols_array(&frame)),
        limits: [limits.x, limits.y, limits.z]
            .map(|limit| limit.map(|Numbers([min, max])| Limit { min, max })),
        locked: file.locked.unwrap_or(seed.locked),
        radius: file.radius.map_or(seed.radius.min(f32::MAX), |Number(radius)| radius),
        ..seed
    }
}

fn target(at: &JsonPath, file: &file::Target, joints: usize, circle: f32) -> Result<Target, Wrong> {
    let joint = file.joint.0 as usize;
    if joint >= joints {
        let reason = format!("there is no joint {joint}; {}", counted(joints));
        return Err(Wrong::new(at.clone().key("joint"), reason));
    }
    let seed = Target::new(joint, file.home.0, circle);
    let weight = file
        .weight
        .map_or(Ok(seed.weight), |Number(weight)| above_0(at.clone().key("weight"), weight))?;
    let motion = match &file.motion {
        Some(Object(file)) => motion(&at.clone().key("motion"), file, seed.motion)?,
        None => seed.motion,
    };
    Ok(Target { weight, motion, enabled: file.enabled.unwrap_or(seed.enabled), ..seed })
}

pub(super) fn counted(joints: usize) -> String {
    match joints {
        0 => "the skeleton has none".to_owned(),
        1 => "there is only joint 0".to_owned(),
        _ => format!("they are 0 to {}", joints - 1),
    }
}

fn motion(at: &JsonPath, file: &file::Motion, seed: TargetMotion) -> Result<TargetMotion, Wrong> {
    let period = file
        .period
        .map_or(Ok(seed.period), |Number(period)| above_0(at.clone().key("period"), period))?;
    Ok(TargetMotion {
        path: file.path,
        radius: file.radius.map_or(seed.radius, |Number(radius)| radius),
        period,
    })
}

fn options(at: &JsonPath, file: &file::Solver) -> Result<SolverOptions, Wrong> {
    let seed = SolverOptions::default();
    let above = |key, value: Option<Number>| {
        value.map(|Number(value)| above_0(at.clone().key(key), value)).transpose()
    };
    let iterations = file.iterations.map(|Whole(iterations)| iterations);
    if iterations == Some(0) {
        let reason = "is 0; it must be 1 or more, or null for the method's own";
        return Err(Wrong::new(at.clone().key("iterations"), reason));
    }
    Ok(SolverOptions {
        method: match &file.method {
            Some(name) => method(at, name)?,
            None => seed.method,
        },
        iterations,
        tolerance: above("tolerance", file.tolerance)?,
        damping: above("damping", file.damping)?.unwrap_or(seed.damping),
        step: above("step", file.step)?.unwrap_or(seed.step),
        root: match file.root {
            Some(Root::Free) => chain_ik::Root::Free,
            Some(Root::Fixed) | None => chain_ik::Root::Fixed,
        },
    })
}

fn method(at: &JsonPath, name: &str) -> Result<Method, Wrong> {
    Method::ALL.into_iter().find(|method| method.name() == name).ok_or_else(|| {
        let names = Method::ALL.map(Method::name).join(", ");
        let reason = format!("{name:?} is not a method; they are {names}");
        Wrong::new(at.clone().key("method"), reason)
    })
}

fn iterations_per_frame(at: JsonPath, count: u32) -> Result<u32, Wrong> {
    const MOST: u32 = SkeletonRig::MOST_ITERATIONS_PER_FRAME;
    if (1..=MOST).contains(&count) {
        return Ok(count);
    }
    Err(Wrong::new(at, format!("is {count}; it must be from 1 to {MOST}")))
}

fn slither(at: &JsonPath, file: &file::Slither) -> Result<FollowPath, Wrong> {
    Ok(FollowPath {
        radius: file.radius.0,
        amplitude: file.amplitude.0,
        waves: file.waves.0,
        period: above_0(at.clone().key("period"), file.period.0)?,
    })
}

fn camera(at: &JsonPath, file: &file::View) -> Result<Camera, Wrong> {
    let seed = Camera::default();
    let pitch = file.pitch.map_or(seed.pitch, |Number(pitch)| pitch);
    if pitch.abs() > FRAC_PI_2 {
        let reason = format!("is {pitch}; it must be from {} to {FRAC_PI_2}", -FRAC_PI_2);
        return Err(Wrong::new(at.clone().key("pitch"), reason));
    }
    let distance = file.distance.map_or(Ok(seed.distance), |Number(distance)| {
        above_0(at.clone().key("distance"), distance)
    })?;
    Ok(Camera {
        target: file.target.map_or(seed.target, |Point(target)| target),
        yaw: file.yaw.map_or(seed.yaw, |Number(yaw)| yaw),
        pitch,
        distance,
        orthographic: file.orthographic.unwrap_or(seed.orthographic),
    })
}

/// What a file that says nothing shows.
fn first_view(rig: RigKind, skeleton: &SkeletonRig) -> Camera {
    match rig {
        RigKind::Arm => Camera::default(),
        RigKind::Skeleton => skeleton.first_view(),
    }
}

pub(super) fn above_0(at: JsonPath, value: f32) -> Result<f32, Wrong> {
    if value > 0.0 {
        return Ok(value);
    }
    Err(Wrong::new(at, format!("is {value}; it must be above 0")))
}

fn is_beyond_limits(joint: &Joint) -> bool {
    let angles = joint.rotation.to_array().into_iter();
    let mut limited = angles.zip(joint.limits).filter_map(|(angle, limit)| Some((angle, limit?)));
    limited.any(|(angle, Limit { min, max })| angle < min || angle > max)
}
