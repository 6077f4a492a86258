//! Fields of targets and of the solver in a file, and conversions between these fields and a
//! skeleton's rig.

use core::f32::consts::PI;
use core::num::NonZeroU32;
use std::collections::HashSet;

use glam::{Vec2, Vec3};
use serde::{Deserialize, Serialize};

use super::skeleton::joint;
use crate::document::{BalanceOver, BalanceTarget, SkeletonRig, Target, TargetMotion, TargetPath};
use crate::io::json::{
    Above0, AtField, AtLeast0, FieldError, Fraction, JsonNumber, JsonObject, JsonPoint, Whole,
    value_or,
};
use crate::kinematics::chain_ik::{Method, Root, SolverOptions};
use crate::kinematics::soft_reach::{SoftReach, SoftReachField};
use crate::kinematics::twist::{Stereographic, TwistReferenceKind};
use crate::rig::{Aim, LimbSettings, TargetKind, TargetSpace};

#[derive(Serialize, Deserialize)]
pub struct TargetFields {
    joint: Whole,
    home: JsonPoint,
    /// The joint that the target is on; without it, the target is in the world.
    #[serde(skip_serializing_if = "Option::is_none")]
    on_joint: Option<Whole>,
    /// The place in the world while the target is pinned; without it, `home`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pin: Option<JsonPoint>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pinned: Option<bool>,
    #[serde(skip_serializing_if = "Option::is_none")]
    limb: Option<JsonObject<LimbFields>>,
    /// The number of joints that the target of a chain turns.
    #[serde(skip_serializing_if = "Option::is_none")]
    chain_length: Option<Whole>,
    /// The orientation of the joint; that of a limb's hand is in `limb`.
    #[serde(skip_serializing_if = "Option::is_none")]
    rotation: Option<JsonPoint>,
    #[serde(skip_serializing_if = "Option::is_none")]
    aim: Option<JsonObject<AimFields>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    rotation_weight: Option<JsonNumber>,
    #[serde(skip_serializing_if = "Option::is_none")]
    influence: Option<Fraction>,
    weight: Option<AtLeast0>,
    #[serde(skip_serializing_if = "Option::is_none")]
    softness: Option<JsonNumber>,
    enabled: Option<bool>,
    motion: Option<JsonObject<TargetMotionFields>>,
}

#[derive(Serialize, Deserialize)]
struct LimbFields {
    reference: Option<TwistReferenceKind>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pole: Option<JsonPoint>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pole_on_joint: Option<Whole>,
    /// The stereographic map, if it is not the default one.
    #[serde(skip_serializing_if = "Option::is_none")]
    map: Option<JsonObject<MapFields>>,
    twist: Option<JsonNumber>,
    soft_reach: Option<JsonObject<SoftReachFields>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    orientation: Option<JsonPoint>,
    #[serde(skip_serializing_if = "Option::is_none")]
    fk_stretch: Option<Above0>,
    /// The axis in the space of the lower joint's base about which a straight limb bends.
    #[serde(skip_serializing_if = "Option::is_none")]
    bends_about: Option<JsonPoint>,
}

#[derive(Serialize, Deserialize)]
struct AimFields {
    axis: JsonPoint,
    point: JsonPoint,
}

#[derive(Serialize, Deserialize)]
struct MapFields {
    singular: JsonPoint,
    up: JsonPoint,
}

#[derive(Serialize, Deserialize)]
struct TargetMotionFields {
    path: TargetPath,
    radius: Option<JsonNumber>,
    period: Option<Above0>,
}

#[derive(Serialize, Deserialize)]
pub struct SoftReachFields {
    softness: Option<JsonNumber>,
    max_stretch: Option<JsonNumber>,
    min_elbow_angle: Option<JsonNumber>,
}

#[derive(Serialize, Deserialize)]
pub struct SolverFields {
    method: Option<Method>,
    iterations: Option<Whole>,
    tolerance: Option<Above0>,
    damping: Option<Above0>,
    step: Option<Above0>,
    #[serde(skip_serializing_if = "Option::is_none")]
    posture_rate: Option<AtLeast0>,
    root: Option<Root>,
    #[serde(skip_serializing_if = "Option::is_none")]
    root_stiffness: Option<AtLeast0>,
    iterations_per_frame: Option<Whole>,
    #[serde(skip_serializing_if = "Option::is_none")]
    track: Option<bool>,
    #[serde(skip_serializing_if = "Option::is_none")]
    body_follows: Option<bool>,
}

#[derive(Serialize, Deserialize)]
pub struct BalanceFields {
    influence: Option<JsonNumber>,
    weight: Option<Above0>,
    over: Option<OverFields>,
}

#[derive(Serialize, Deserialize)]
#[serde(untagged, expecting = "must be \"feet\" or two numbers, x and z of a point")]
enum OverFields {
    Feet(Feet),
    Point([JsonNumber; 2]),
}

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Feet {
    Feet,
}

impl BalanceFields {
    pub fn new(balance: &BalanceTarget) -> Self {
        let over = match balance.over {
            BalanceOver::Feet => OverFields::Feet(Feet::Feet),
            BalanceOver::Point(Vec2 { x, y }) => OverFields::Point([x, y].map(JsonNumber::from)),
        };
        Self {
            influence: Some(balance.influence.into()),
            weight: Some(balance.weight.into()),
            over: Some(over),
        }
    }

    pub fn balance(self) -> Result<BalanceTarget, FieldError> {
        let default = BalanceTarget::default();
        let over = match self.over {
            None | Some(OverFields::Feet(_)) => BalanceOver::Feet,
            Some(OverFields::Point(point)) => BalanceOver::Point(Vec2::from(point.map(f32::from))),
        };
        let influence = value_or(self.influence, default.influence);
        if !(0.0..=1.0).contains(&influence) {
            return Err(format!("must be from 0 to 1, got {influence}")).at("influence");
        }
        Ok(BalanceTarget { influence, weight: value_or(self.weight, default.weight), over })
    }
}

/// Adds the targets of a file to a rig, which must have its skeleton already.
pub fn add_targets(
    rig: &mut SkeletonRig,
    targets: Vec<JsonObject<TargetFields>>,
) -> Result<(), FieldError> {
    let radius = rig.default_path_radius();
    let mut targeted = HashSet::new();
    for (index, JsonObject(fields)) in targets.into_iter().enumerate() {
        let target = fields.target(rig.skeleton.joints().len(), radius).at(index)?;
        if !targeted.insert(target.joint) {
            let reason = format!("must have one target, got a second for joint {}", target.joint);
            return Err(reason).at("joint").at(index);
        }
        rig.targets.push(target);
    }
    Ok(rig.check_target_spaces().map_err(|error| error.to_string())?)
}

impl TargetFields {
    pub fn new(target: &Target) -> Self {
        let TargetMotion { path, radius, period } = target.motion;
        let motion =
            TargetMotionFields { path, radius: Some(radius.into()), period: Some(period.into()) };
        Self {
            joint: target.joint.into(),
            home: target.home.into(),
            on_joint: target.space.joint().map(Whole::from),
            pin: (target.is_pinned || target.pin != target.home).then_some(target.pin.into()),
            pinned: target.is_pinned.then_some(true),
            limb: match &target.kind {
                TargetKind::WholeBody | TargetKind::Chain(_) => None,
                TargetKind::Limb(settings) => {
                    Some(JsonObject(LimbFields::new(settings, target.orientation)))
                }
            },
            chain_length: match target.kind {
                TargetKind::Chain(length) => Some(Whole(length.get())),
                TargetKind::WholeBody | TargetKind::Limb(_) => None,
            },
            rotation: target.orientation.filter(|_| target.limb().is_none()).map(JsonPoint),
            aim: target.aim.map(|Aim { axis, point }| {
                JsonObject(AimFields { axis: axis.into(), point: point.into() })
            }),
            rotation_weight: (target.orientation_weight != 1.0)
                .then_some(target.orientation_weight.into()),
            influence: (target.influence != 0.0).then_some(target.influence.into()),
            weight: Some(target.weight.into()),
            softness: (target.softness != 0.0).then_some(target.softness.into()),
            enabled: Some(target.enabled),
            motion: Some(JsonObject(motion)),
        }
    }

    fn target(self, joints: usize, radius: f32) -> Result<Target, FieldError> {
        let joint = joint(self.joint, joints).at("joint")?;
        let default = Target::new(joint, self.home.0, radius);
        let aim = self.aim.map(|JsonObject(fields)| fields.aim()).transpose().at("aim")?;
        if aim.is_some() && (self.rotation.is_some() || self.limb.is_some()) {
            return Err("must not be beside `rotation` or `limb`").at("aim");
        }
        let length = self.chain_length.map(chain_length).transpose().at("chain_length")?;
        let (kind, orientation) = match self.limb {
            Some(_) if length.is_some() => {
                return Err("must not be beside `limb`").at("chain_length");
            }
            Some(_) if self.rotation.is_some() => {
                return Err("must be `limb.orientation` for a limb").at("rotation");
            }
            Some(JsonObject(fields)) => {
                let orientation = fields.orientation.map(Vec3::from);
                (TargetKind::Limb(fields.settings(joints).at("limb")?), orientation)
            }
            None => {
                let kind = length.map_or(TargetKind::WholeBody, TargetKind::Chain);
                (kind, self.rotation.map(Vec3::from))
            }
        };
        let orientation_weight = value_or(self.rotation_weight, default.orientation_weight);
        if orientation_weight < 0.0 {
            return Err(format!("must be 0 or more, got {orientation_weight}"))
                .at("rotation_weight");
        }
        let weight = value_or(self.weight, default.weight);
        let is_limb = matches!(kind, TargetKind::Limb(_));
        let turns = !is_limb && (orientation.is_some() || aim.is_some());
        if weight == 0.0 && !turns {
            return Err("must be above 0, or 0 with a rotation or an aim, got 0").at("weight");
        }
        let motion = self.motion.map(|JsonObject(fields)| fields.motion(default.motion));
        let softness = value_or(self.softness, default.softness);
        if !(0.0..1.0).contains(&softness) {
            return Err(format!("must be from 0 to less than 1, got {softness}")).at("softness");
        }
        Ok(Target {
            space: space(self.on_joint, joints).at("on_joint")?,
            pin: value_or(self.pin, default.pin),
            is_pinned: self.pinned.unwrap_or(default.is_pinned),
            kind,
            orientation,
            aim,
            orientation_weight,
            influence: value_or(self.influence, default.influence),
            weight,
            softness,
            enabled: self.enabled.unwrap_or(default.enabled),
            motion: motion.unwrap_or(default.motion),
            ..default
        })
    }
}

fn chain_length(Whole(length): Whole) -> Result<NonZeroU32, String> {
    NonZeroU32::new(length).ok_or_else(|| "must be 1 or more, got 0".into())
}

impl AimFields {
    fn aim(self) -> Result<Aim, FieldError> {
        let [axis, point] = [self.axis, self.point].map(Vec3::from);
        if axis == Vec3::ZERO {
            return Err("must not be zero").at("axis");
        }
        Ok(Aim { axis, point })
    }
}

impl LimbFields {
    fn new(settings: &LimbSettings, orientation: Option<Vec3>) -> Self {
        let default = LimbSettings::default();
        let map =
            MapFields { singular: settings.map.singular().into(), up: settings.map.up().into() };
        Self {
            reference: Some(settings.reference),
            pole: settings.pole.map(JsonPoint),
            pole_on_joint: settings.pole_space.joint().map(Whole::from),
            map: (settings.map != default.map).then_some(JsonObject(map)),
            twist: Some(settings.twist.into()),
            soft_reach: Some(JsonObject(SoftReachFields::new(settings.soft_reach))),
            orientation: orientation.map(JsonPoint),
            fk_stretch: (settings.fk_stretch != default.fk_stretch)
                .then_some(settings.fk_stretch.into()),
            bends_about: settings.bends_about.map(JsonPoint),
        }
    }

    fn settings(self, joints: usize) -> Result<LimbSettings, FieldError> {
        let default = LimbSettings::default();
        let reference = self.reference.unwrap_or(default.reference);
        if reference == TwistReferenceKind::Pole && self.pole.is_none() {
            return Err("must have `pole` for reference `pole`".into());
        }
        let bends_about = self.bends_about.map(Vec3::from);
        if bends_about == Some(Vec3::ZERO) {
            return Err("must not be zero").at("bends_about");
        }
        let map = self.map.map(|JsonObject(fields)| fields.map());
        let soft_reach = self.soft_reach.map(|JsonObject(fields)| fields.soft_reach());
        Ok(LimbSettings {
            reference,
            pole: self.pole.map(Vec3::from),
            pole_space: space(self.pole_on_joint, joints).at("pole_on_joint")?,
            map: map.transpose().at("map")?.unwrap_or_default(),
            twist: value_or(self.twist, default.twist),
            soft_reach: soft_reach.transpose().at("soft_reach")?.unwrap_or_default(),
            fk_stretch: value_or(self.fk_stretch, default.fk_stretch),
            bends_about,
        })
    }
}

impl MapFields {
    fn map(self) -> Result<Stereographic, FieldError> {
        let [singular, up] = [self.singular, self.up].map(Vec3::from);
        let parallel = "must have directions `singular` and `up` that are not parallel";
        Stereographic::from_saved(singular, up).ok_or_else(|| parallel.to_owned().into())
    }
}

fn space(on_joint: Option<Whole>, joints: usize) -> Result<TargetSpace, String> {
    on_joint.map_or(Ok(TargetSpace::World), |index| joint(index, joints).map(TargetSpace::Joint))
}

impl SoftReachFields {
    pub fn new(soft_reach: SoftReach) -> Self {
        Self {
            softness: Some(soft_reach.softness().into()),
            max_stretch: Some(soft_reach.max_stretch().into()),
            min_elbow_angle: Some(soft_reach.min_elbow_angle().into()),
        }
    }

    pub fn soft_reach(self) -> Result<SoftReach, FieldError> {
        let default = SoftReach::default();
        let soft_reach = SoftReach::new(
            value_or(self.softness, default.softness()),
            value_or(self.max_stretch, default.max_stretch()),
            value_or(self.min_elbow_angle, default.min_elbow_angle()),
        );
        soft_reach.or_else(|error| {
            let range = match error.field {
                SoftReachField::MinElbowAngle => format!("from 0 to less than {PI}"),
                SoftReachField::Softness | SoftReachField::MaxStretch => error.range.to_owned(),
            };
            let reason = format!("must be {range}, got {}", error.value);
            Err(reason).at(error.field.to_string().as_str())
        })
    }
}

impl TargetMotionFields {
    fn motion(self, default: TargetMotion) -> TargetMotion {
        TargetMotion {
            path: self.path,
            radius: value_or(self.radius, default.radius),
            period: value_or(self.period, default.period),
        }
    }
}

impl SolverFields {
    pub fn new(rig: &SkeletonRig) -> Self {
        let (solver, default) = (rig.solver, SolverOptions::default());
        Self {
            method: Some(solver.method),
            iterations: solver.iterations.map(Whole),
            tolerance: solver.tolerance.map(Above0::from),
            damping: Some(solver.damping.into()),
            step: Some(solver.step.into()),
            posture_rate: (solver.posture_rate != default.posture_rate)
                .then(|| solver.posture_rate.into()),
            root: Some(solver.root),
            root_stiffness: (solver.root_stiffness != default.root_stiffness)
                .then(|| solver.root_stiffness.into()),
            iterations_per_frame: Some(Whole(rig.iterations_per_frame)),
            track: (!rig.is_tracked).then_some(false),
            body_follows: rig.body_follows.then_some(true),
        }
    }

    pub fn set(self, rig: &mut SkeletonRig) -> Result<(), FieldError> {
        const MOST: u32 = SkeletonRig::MAX_ITERATIONS_PER_FRAME;
        let default = SolverOptions::default();
        if self.iterations == Some(Whole(0)) {
            let reason = "must be 1 or more, or null for the method's default, got 0";
            return Err(reason).at("iterations");
        }
        rig.solver = SolverOptions {
            method: self.method.unwrap_or(default.method),
            iterations: self.iterations.map(u32::from),
            tolerance: self.tolerance.map(f32::from),
            damping: value_or(self.damping, default.damping),
            step: value_or(self.step, default.step),
            posture_rate: value_or(self.posture_rate, default.posture_rate),
            root: self.root.unwrap_or(default.root),
            root_stiffness: value_or(self.root_stiffness, default.root_stiffness),
        };
        if rig.solver.root_stiffness >= 1.0 {
            let reason =
                format!("must be 0 or more and below 1, got {}", rig.solver.root_stiffness);
            return Err(reason).at("root_stiffness");
        }
        rig.is_tracked = self.track.unwrap_or(true);
        rig.body_follows = self.body_follows.unwrap_or(false);
        rig.iterations_per_frame = value_or(self.iterations_per_frame, rig.iterations_per_frame);
        let count = rig.iterations_per_frame;
        if (1..=MOST).contains(&count) {
            return Ok(());
        }
        Err(format!("must be from 1 to {MOST}, got {count}")).at("iterations_per_frame")
    }
}
