//! Fields of targets and of the solver in a file, and conversions between these fields and a
//! skeleton's rig.

use std::collections::HashSet;
use std::fmt;

use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Serialize};

use super::check::{SoftReachFields, above_0, fraction, from_1_to, joint, number};
use crate::document::{
    FollowPath, PathKind, SkeletonRig, Target, TargetMotion, TargetPath, WavyRing,
};
use crate::io::json::{FieldError, JsonNumber, JsonObject, JsonPath, JsonPoint, Whole};
use crate::kinematics::chain_ik::{Method, Root, SolverOptions};
use crate::kinematics::limb_ik::ElbowReference;
use crate::kinematics::skeleton::JointId;
use crate::kinematics::soft_reach::SoftReach;
use crate::kinematics::twist::Stereographic;
use crate::rig::{LimbSettings, TargetKind, TargetSpace};

#[derive(Serialize, Deserialize)]
pub struct TargetFields {
    joint: Whole,
    home: JsonPoint,
    /// The joint that the target is on; without it, the target is in the world.
    #[serde(skip_serializing_if = "Option::is_none")]
    on_joint: Option<Whole>,
    #[serde(skip_serializing_if = "Option::is_none")]
    limb: Option<JsonObject<LimbFields>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    influence: Option<JsonNumber>,
    weight: Option<JsonNumber>,
    enabled: Option<bool>,
    motion: Option<JsonObject<TargetMotionFields>>,
}

#[derive(Serialize, Deserialize)]
struct LimbFields {
    reference: Option<ElbowReferenceName>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pole: Option<JsonPoint>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pole_on_joint: Option<Whole>,
    twist: Option<JsonNumber>,
    soft_reach: Option<JsonObject<SoftReachFields>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    orientation: Option<JsonPoint>,
}

/// An [`ElbowReference`] without its pole or map.
#[derive(Clone, Copy, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum ElbowReferenceName {
    #[default]
    Fk,
    #[serde(alias = "limb")]
    Up,
    Pole,
    Stereographic,
}

#[derive(Serialize, Deserialize)]
struct TargetMotionFields {
    path: TargetPath,
    radius: Option<JsonNumber>,
    period: Option<JsonNumber>,
}

#[derive(Serialize, Deserialize)]
pub struct SolverFields {
    method: Option<Method>,
    iterations: Option<Whole>,
    tolerance: Option<JsonNumber>,
    damping: Option<JsonNumber>,
    step: Option<JsonNumber>,
    root: Option<Root>,
    iterations_per_frame: Option<Whole>,
}

/// Adds the targets of a file to a rig, which must have its skeleton already.
pub fn add_targets(
    rig: &mut SkeletonRig,
    targets: Vec<JsonObject<TargetFields>>,
) -> Result<(), FieldError> {
    let radius = rig.default_path_radius();
    let mut targeted = HashSet::new();
    for (index, JsonObject(fields)) in targets.into_iter().enumerate() {
        let at = JsonPath::root().key("targets").index(index);
        let target = fields.target(&at, rig.skeleton.joints().len(), radius)?;
        if !targeted.insert(target.joint) {
            let reason = format!("must have one target, got a second for joint {}", target.joint);
            return Err(FieldError::new(at.key("joint"), reason));
        }
        rig.targets.push(target);
    }
    let at = JsonPath::root().key("targets");
    rig.check_target_spaces().map_err(|error| FieldError::new(at, error.to_string()))
}

impl TargetFields {
    pub fn new(target: &Target) -> Self {
        let TargetMotion { path, radius, period } = target.motion;
        let motion = TargetMotionFields {
            path,
            radius: Some(JsonNumber(radius)),
            period: Some(JsonNumber(period)),
        };
        Self {
            joint: Whole(u32::try_from(target.joint.index()).unwrap_or(u32::MAX)),
            home: JsonPoint(target.home),
            on_joint: on_joint(target.space),
            limb: match &target.kind {
                TargetKind::WholeBody => None,
                TargetKind::Limb(settings) => Some(JsonObject(LimbFields::new(settings))),
            },
            influence: (target.influence != 0.0).then_some(JsonNumber(target.influence)),
            weight: Some(JsonNumber(target.weight)),
            enabled: Some(target.enabled),
            motion: Some(JsonObject(motion)),
        }
    }

    fn target(&self, at: &JsonPath, joints: usize, radius: f32) -> Result<Target, FieldError> {
        let joint = joint(at.clone().key("joint"), self.joint, joints)?;
        let default = Target::new(JointId::new(joint), self.home.0, radius);
        let motion = match &self.motion {
            Some(JsonObject(fields)) => fields.motion(&at.clone().key("motion"), default.motion)?,
            None => default.motion,
        };
        let kind = match &self.limb {
            Some(JsonObject(fields)) => {
                TargetKind::Limb(fields.settings(&at.clone().key("limb"), joints)?)
            }
            None => TargetKind::WholeBody,
        };
        let influence = number(self.influence, default.influence);
        Ok(Target {
            space: space(at.clone().key("on_joint"), self.on_joint, joints)?,
            kind,
            influence: fraction(at.clone().key("influence"), influence)?,
            weight: above_0(at.clone().key("weight"), number(self.weight, default.weight))?,
            enabled: self.enabled.unwrap_or(default.enabled),
            motion,
            ..default
        })
    }
}

impl LimbFields {
    fn new(settings: &LimbSettings) -> Self {
        let (reference, pole) = match settings.reference {
            ElbowReference::Fk => (ElbowReferenceName::Fk, None),
            ElbowReference::Up => (ElbowReferenceName::Up, None),
            ElbowReference::Pole(pole) => (ElbowReferenceName::Pole, Some(JsonPoint(pole))),
            ElbowReference::Stereographic(_) => (ElbowReferenceName::Stereographic, None),
        };
        Self {
            reference: Some(reference),
            pole,
            pole_on_joint: on_joint(settings.pole_space),
            twist: Some(JsonNumber(settings.twist)),
            soft_reach: Some(JsonObject(SoftReachFields::new(settings.soft_reach))),
            orientation: settings.orientation.map(JsonPoint),
        }
    }

    fn settings(&self, at: &JsonPath, joints: usize) -> Result<LimbSettings, FieldError> {
        let reference = match (self.reference.unwrap_or_default(), self.pole) {
            (ElbowReferenceName::Fk, _) => ElbowReference::Fk,
            (ElbowReferenceName::Up, _) => ElbowReference::Up,
            (ElbowReferenceName::Pole, Some(JsonPoint(pole))) => ElbowReference::Pole(pole),
            (ElbowReferenceName::Pole, None) => {
                return Err(FieldError::new(at.clone(), "must have `pole` for reference `pole`"));
            }
            (ElbowReferenceName::Stereographic, _) => {
                ElbowReference::Stereographic(Stereographic::default())
            }
        };
        let soft_reach = match &self.soft_reach {
            Some(JsonObject(fields)) => fields.soft_reach(&at.clone().key("soft_reach"))?,
            None => SoftReach::default(),
        };
        Ok(LimbSettings {
            reference,
            twist: number(self.twist, 0.0),
            soft_reach,
            orientation: self.orientation.map(|JsonPoint(angles)| angles),
            pole_space: space(at.clone().key("pole_on_joint"), self.pole_on_joint, joints)?,
        })
    }
}

fn on_joint(space: TargetSpace) -> Option<Whole> {
    space.joint().and_then(|joint| u32::try_from(joint.index()).ok()).map(Whole)
}

fn space(at: JsonPath, on_joint: Option<Whole>, joints: usize) -> Result<TargetSpace, FieldError> {
    let Some(index) = on_joint else { return Ok(TargetSpace::World) };
    Ok(TargetSpace::Joint(JointId::new(joint(at, index, joints)?)))
}

impl TargetMotionFields {
    fn motion(&self, at: &JsonPath, default: TargetMotion) -> Result<TargetMotion, FieldError> {
        Ok(TargetMotion {
            path: self.path,
            radius: number(self.radius, default.radius),
            period: above_0(at.clone().key("period"), number(self.period, default.period))?,
        })
    }
}

impl SolverFields {
    pub fn new(rig: &SkeletonRig) -> Self {
        let solver = rig.solver;
        Self {
            method: Some(solver.method),
            iterations: solver.iterations.map(Whole),
            tolerance: solver.tolerance.map(JsonNumber),
            damping: Some(JsonNumber(solver.damping)),
            step: Some(JsonNumber(solver.step)),
            root: Some(solver.root),
            iterations_per_frame: Some(Whole(rig.iterations_per_frame)),
        }
    }

    pub fn set(&self, rig: &mut SkeletonRig, at: &JsonPath) -> Result<(), FieldError> {
        let at = |key| at.clone().key(key);
        let default = SolverOptions::default();
        let positive = |key, value, default| above_0(at(key), number(value, default));
        let iterations = self.iterations.map(|Whole(count)| count);
        if iterations == Some(0) {
            let reason = "must be 1 or more, or null for the method's default, got 0";
            return Err(FieldError::new(at("iterations"), reason));
        }
        let tolerance = self.tolerance.map(|JsonNumber(number)| above_0(at("tolerance"), number));
        rig.solver = SolverOptions {
            method: self.method.unwrap_or(default.method),
            iterations,
            tolerance: tolerance.transpose()?,
            damping: positive("damping", self.damping, default.damping)?,
            step: positive("step", self.step, default.step)?,
            root: self.root.unwrap_or(default.root),
        };
        if let Some(count) = self.iterations_per_frame {
            rig.iterations_per_frame = from_1_to(
                at("iterations_per_frame"),
                count,
                SkeletonRig::MAX_ITERATIONS_PER_FRAME,
            )?;
        }
        Ok(())
    }
}

/// The followed paths, or a single one.
#[derive(Serialize)]
#[serde(untagged)]
pub enum FollowPathList {
    One(JsonObject<FollowPathFields>),
    Many(Vec<JsonObject<FollowPathFields>>),
}

#[derive(Default, Serialize, Deserialize)]
pub struct FollowPathFields {
    /// The head; without it, the first root.
    root: Option<Whole>,
    #[serde(skip_serializing_if = "Option::is_none")]
    path: Option<PathName>,
    #[serde(skip_serializing_if = "Option::is_none")]
    radius: Option<JsonNumber>,
    #[serde(skip_serializing_if = "Option::is_none")]
    amplitude: Option<JsonNumber>,
    #[serde(skip_serializing_if = "Option::is_none")]
    waves: Option<Whole>,
    #[serde(skip_serializing_if = "Option::is_none")]
    period: Option<JsonNumber>,
}

#[derive(Clone, Copy, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum PathName {
    #[default]
    Ring,
    Head,
    Target,
}

impl FollowPathList {
    pub fn new(paths: &[FollowPath]) -> Self {
        Self::Many(paths.iter().map(FollowPathFields::new).map(JsonObject).collect())
    }

    /// Adds the paths to a rig, which must have its skeleton already.
    pub fn add_to(self, rig: &mut SkeletonRig, at: &JsonPath) -> Result<(), FieldError> {
        let at_index = |(index, fields)| (at.clone().index(index), fields);
        let all: Vec<_> = match self {
            Self::One(fields) => vec![(at.clone(), fields)],
            Self::Many(fields) => fields.into_iter().enumerate().map(at_index).collect(),
        };
        for (at, JsonObject(fields)) in all {
            let Some(path) = fields.follow_path(rig, &at)? else { continue };
            if rig.path_kind(path.root).is_some() {
                let reason = format!("must have one path, got a second for root {}", path.root);
                return Err(FieldError::new(at.key("root"), reason));
            }
            rig.follow_paths = rig.with_path(path.root, Some(path.kind));
        }
        Ok(())
    }
}

impl FollowPathFields {
    fn new(path: &FollowPath) -> Self {
        let root = Some(Whole(u32::try_from(path.root.index()).unwrap_or(u32::MAX)));
        match path.kind {
            PathKind::Ring(ring) => Self {
                root,
                path: None,
                radius: Some(JsonNumber(ring.radius)),
                amplitude: Some(JsonNumber(ring.amplitude)),
                waves: Some(Whole(ring.waves)),
                period: Some(JsonNumber(ring.period)),
            },
            PathKind::Head => Self { root, path: Some(PathName::Head), ..Self::default() },
            PathKind::Target => Self { root, path: Some(PathName::Target), ..Self::default() },
        }
    }

    /// The path; `None` for a skeleton without joints.
    fn follow_path(
        &self,
        rig: &SkeletonRig,
        at: &JsonPath,
    ) -> Result<Option<FollowPath>, FieldError> {
        let kind = match self.path.unwrap_or_default() {
            PathName::Ring => PathKind::Ring(self.ring(at)?),
            PathName::Head => PathKind::Head,
            PathName::Target => PathKind::Target,
        };
        let root = match self.root {
            Some(root) => {
                let at = at.clone().key("root");
                let root = JointId::new(joint(at.clone(), root, rig.skeleton.joints().len())?);
                if rig.skeleton[root].parent.is_some() {
                    let reason = format!("must be a joint without a parent, got joint {root}");
                    return Err(FieldError::new(at, reason));
                }
                Some(root)
            }
            None => rig.skeleton.ids().next(),
        };
        Ok(root.map(|root| FollowPath { root, kind }))
    }

    fn ring(&self, at: &JsonPath) -> Result<WavyRing, FieldError> {
        let missing = |name| FieldError::new(at.clone(), format!("must have `{name}` for a ring"));
        let number = |name, field: Option<JsonNumber>| Ok(field.ok_or_else(|| missing(name))?.0);
        Ok(WavyRing {
            radius: number("radius", self.radius)?,
            amplitude: number("amplitude", self.amplitude)?,
            waves: self.waves.ok_or_else(|| missing("waves"))?.0,
            period: above_0(at.clone().key("period"), number("period", self.period)?)?,
        })
    }
}

impl<'de> Deserialize<'de> for FollowPathList {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct OneOrMany;

        impl<'de> Visitor<'de> for OneOrMany {
            type Value = FollowPathList;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an array of objects: [{…}], or one object")
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
                let path = FollowPathFields::deserialize(MapAccessDeserializer::new(map))?;
                Ok(FollowPathList::One(JsonObject(path)))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Self::Value, A::Error> {
                let mut paths = Vec::new();
                while let Some(path) = list.next_element()? {
                    paths.push(path);
                }
                Ok(FollowPathList::Many(paths))
            }
        }

        deserializer.deserialize_any(OneOrMany)
    }
}
