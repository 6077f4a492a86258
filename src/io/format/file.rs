//! What stands in a file, field by field.

use glam::Mat3;
use serde::{Deserialize, Serialize};

use super::arm::Arm;
use super::keys::{self, Timeline, Track};
use super::{NAME, VERSION};
use crate::document::{self, Camera, Document, Overlay, RigKind, SkeletonRig, TargetPath};
use crate::io::value::{Number, Numbers, Object, Point, Whole};
use crate::kinematics::chain_ik;
use crate::kinematics::skeleton::{self, Limit};

#[derive(Serialize, Deserialize)]
pub struct File {
    format: String,
    version: Whole,
    pub rig: RigKind,
    pub arm: Option<Object<Arm>>,
    pub skeleton: Option<Object<Skeleton>>,
    pub targets: Option<Vec<Object<Target>>>,
    pub solver: Option<Object<Solver>>,
    pub slither: Option<Object<Slither>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub keys: Option<Vec<Object<Track>>>,
    pub timeline: Option<Object<Timeline>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub metres_per_unit: Option<Number>,
    pub camera: Option<Object<View>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub other_camera: Option<Object<View>>,
    pub display: Option<Vec<Overlay>>,
}

#[derive(Default, Serialize, Deserialize)]
pub struct Skeleton {
    pub joints: Option<Vec<Object<Joint>>>,
    pub transform: Option<Numbers<12>>,
}

#[derive(Serialize, Deserialize)]
pub struct Joint {
    pub name: String,
    pub parent: Option<Whole>,
    pub offset: Option<Point>,
    pub axis: Option<Point>,
    pub rotation: Option<Point>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub frame: Option<Numbers<9>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub limits: Option<Object<Limits>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub locked: Option<bool>,
    pub radius: Option<Number>,
}

#[derive(Clone, Copy, Default, Serialize, Deserialize)]
pub struct Limits {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub x: Option<Numbers<2>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub y: Option<Numbers<2>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub z: Option<Numbers<2>>,
}

#[derive(Serialize, Deserialize)]
pub struct Target {
    pub joint: Whole,
    pub home: Point,
    pub weight: Option<Number>,
    pub enabled: Option<bool>,
    pub motion: Option<Object<Motion>>,
}

#[derive(Serialize, Deserialize)]
pub struct Motion {
    pub path: TargetPath,
    pub radius: Option<Number>,
    pub period: Option<Number>,
}

#[derive(Default, Serialize, Deserialize)]
pub struct Solver {
    pub method: Option<String>,
    pub iterations: Option<Whole>,
    pub tolerance: Option<Number>,
    pub damping: Option<Number>,
    pub step: Option<Number>,
    pub root: Option<Root>,
    pub iterations_per_frame: Option<Whole>,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Root {
    Fixed,
    Free,
}

#[derive(Serialize, Deserialize)]
pub struct Slither {
    pub radius: Number,
    pub amplitude: Number,
    pub waves: Whole,
    pub period: Number,
}

#[derive(Serialize, Deserialize)]
pub struct View {
    pub target: Option<Point>,
    pub yaw: Option<Number>,
    pub pitch: Option<Number>,
    pub distance: Option<Number>,
    pub orthographic: Option<bool>,
}

impl File {
    pub fn new(document: &Document) -> Self {
        let Document { rig, arm, skeleton_rig, camera, display, .. } = document;
        let SkeletonRig { skeleton, targets, follow_path: slither, .. } = skeleton_rig;
        Self {
            format: NAME.to_owned(),
            version: Whole(VERSION),
            rig: *rig,
            arm: Some(Object(Arm::new(arm))),
            skeleton: Some(Object(Skeleton::new(skeleton))),
            targets: Some(targets.iter().map(Target::new).map(Object).collect()),
            solver: Some(Object(Solver::new(skeleton_rig))),
            slither: slither.as_ref().map(Slither::new).map(Object),
            keys: (!document.keys.is_empty()).then(|| keys::tracks(&document.keys)),
            timeline: Some(Object(Timeline::new(document.timeline))),
            metres_per_unit: document.metres.map(Number),
            camera: Some(Object(View::new(camera))),
            other_camera: document.other_camera.as_ref().map(View::new).map(Object),
            display: Some(display.layers().collect()),
        }
    }
}

impl Skeleton {
    fn new(skeleton: &skeleton::Skeleton) -> Self {
        Self {
            joints: Some(skeleton.joints().iter().map(Joint::new).map(Object).collect()),
            transform: Some(Numbers(skeleton.transform().to_cols_array())),
        }
    }
}

impl Joint {
    fn new(joint: &skeleton::Joint) -> Self {
        let frame = joint.frame.to_cols_array();
        let is_identity =
            frame.map(f32::to_bits) == Mat3::IDENTITY.to_cols_array().map(f32::to_bits);
        let [x, y, z] =
            joint.limits.map(|limit| limit.map(|Limit { min, max }| Numbers([min, max])));
        Self {
            name: joint.name.clone(),
            parent: joint.parent.and_then(|parent| u32::try_from(parent).ok()).map(Whole),
            offset: Some(Point(joint.offset)),
            axis: Some(Point(joint.axis)),
            rotation: Some(Point(joint.rotation)),
            frame: (!is_identity).then_some(Numbers(frame)),
            limits: joint.is_limited().then_some(Object(Limits { x, y, z })),
            locked: joint.locked.then_some(true),
            radius: Some(Number(joint.radius)),
        }
    }
}

impl Target {
    fn new(target: &document::Target) -> Self {
        let document::TargetMotion { path, radius, period } = target.motion;
        let motion = Motion { path, radius: Some(Number(radius)), period: Some(Number(period)) };
        Self {
            joint: Whole(u32::try_from(target.joint).unwrap_or(u32::MAX)),
            home: Point(target.home),
            weight: Some(Number(target.weight)),
            enabled: Some(target.enabled),
            motion: Some(Object(motion)),
        }
    }
}

impl Solver {
    fn new(rig: &SkeletonRig) -> Self {
        let solver = rig.solver;
        Self {
            method: Some(solver.method.name().to_owned()),
            iterations: solver.iterations.map(Whole),
            tolerance: solver.tolerance.map(Number),
            damping: Some(Number(solver.damping)),
            step: Some(Number(solver.step)),
            root: Some(match solver.root {
                chain_ik::Root::Fixed => Root::Fixed,
                chain_ik::Root::Free => Root::Free,
            }),
            iterations_per_frame: Some(Whole(rig.iterations_per_frame)),
        }
    }
}

impl Slither {
    fn new(slither: &document::FollowPath) -> Self {
        Self {
            radius: Number(slither.radius),
            amplitude: Number(slither.amplitude),
            waves: Whole(slither.waves),
            period: Number(slither.period),
        }
    }
}

impl View {
    fn new(camera: &Camera) -> Self {
        Self {
            target: Some(Point(camera.target)),
            yaw: Some(Number(camera.yaw)),
            pitch: Some(Number(camera.pitch)),
            distance: Some(Number(camera.distance)),
            orthographic: Some(camera.orthographic),
        }
    }
}
