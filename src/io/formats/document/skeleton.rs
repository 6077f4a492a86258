//! Fields of the skeleton and indices of its joints in a file, and conversions between these and a
//! skeleton.

use glam::{Affine3A, Mat3, Vec2, Vec3};
use serde::{Deserialize, Serialize};

use crate::io::json::{
    AtField, FieldError, FieldWarnings, JsonNumber, JsonNumbers, JsonObject, JsonPath, JsonPoint,
    Whole, value_or,
};
use crate::kinematics::skeleton::{
    Cone, Joint, JointId, JointLimits, Limit, RotationAxis, Skeleton, SkeletonError, SkinStretch,
};

#[derive(Serialize, Deserialize)]
pub struct SkeletonFields {
    joints: Option<Vec<JsonObject<JointFields>>>,
    transform: Option<JsonNumbers<12>>,
}

#[derive(Serialize, Deserialize)]
struct JointFields {
    name: String,
    parent: Option<Whole>,
    offset: Option<JsonPoint>,
    axis: Option<JsonPoint>,
    rotation: Option<JsonPoint>,
    #[serde(skip_serializing_if = "Option::is_none")]
    frame: Option<JsonNumbers<9>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    limits: Option<JsonObject<LimitsFields>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    cone: Option<JsonObject<ConeFields>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    stiffness: Option<JsonPoint>,
    #[serde(skip_serializing_if = "Option::is_none")]
    locked: Option<bool>,
    #[serde(skip_serializing_if = "Option::is_none")]
    connected: Option<bool>,
    radius: Option<JsonNumber>,
    #[serde(skip_serializing_if = "Option::is_none")]
    skin_scale: Option<JsonPoint>,
    #[serde(skip_serializing_if = "Option::is_none")]
    skin_shear: Option<JsonPoint>,
    #[serde(skip_serializing_if = "Option::is_none")]
    human_bone: Option<String>,
}

#[derive(Clone, Copy, Default, Serialize, Deserialize)]
struct LimitsFields {
    #[serde(skip_serializing_if = "Option::is_none")]
    x: Option<JsonNumbers<2>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    y: Option<JsonNumbers<2>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    z: Option<JsonNumbers<2>>,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
struct ConeFields {
    x: JsonNumber,
    z: JsonNumber,
    twist: JsonNumbers<2>,
    #[serde(skip_serializing_if = "Option::is_none")]
    middle: Option<JsonNumbers<2>>,
}

impl ConeFields {
    fn new(cone: Cone) -> Self {
        let Cone { x, z, twist: Limit { min, max }, middle } = cone;
        let middle = (middle != Vec2::ZERO).then_some(JsonNumbers(middle.into()));
        Self { x: x.into(), z: z.into(), twist: JsonNumbers([min, max]), middle }
    }

    fn cone(self) -> Cone {
        let JsonNumbers([min, max]) = self.twist;
        let middle = self.middle.map(|JsonNumbers(middle)| Vec2::from(middle));
        Cone {
            x: self.x.into(),
            z: self.z.into(),
            twist: Limit { min, max },
            middle: middle.unwrap_or_default(),
        }
    }
}

impl SkeletonFields {
    pub fn new(skeleton: &Skeleton) -> Self {
        Self {
            joints: Some(
                skeleton.iter().map(|(_, joint)| JsonObject(JointFields::new(joint))).collect(),
            ),
            transform: Some(JsonNumbers(skeleton.transform().to_cols_array())),
        }
    }

    /// Converts the fields to a skeleton. A rotation beyond the joint's limits is clamped, with a
    /// warning.
    pub fn skeleton(self, warnings: &mut FieldWarnings) -> Result<Skeleton, FieldError> {
        let mut joints: Vec<Joint> = Vec::new();
        for (index, JsonObject(fields)) in self.joints.unwrap_or_default().into_iter().enumerate() {
            if fields.limits.is_some() && fields.cone.is_some() {
                let reason = "must not have limits, too: a joint has a cone or ranges of angles";
                return Err(reason).at("cone").at(index).at("joints");
            }
            joints.push(fields.joint(&joints));
        }
        let names: Vec<_> = joints.iter().map(|joint| joint.name.clone()).collect();
        let rotations: Vec<_> = joints.iter().map(|joint| joint.rotation).collect();
        let mut skeleton = Skeleton::from_joints(joints)
            .map_err(|error| FieldError::new(invalid_field(&error, &names), error.to_string()))
            .at("joints")?;
        for (index, (rotation, joint)) in rotations.iter().zip(skeleton.joints()).enumerate() {
            if joint.rotation != *rotation {
                let path = JsonPath::root().key("skeleton").key("joints").index(index);
                warnings.push(path.key("rotation"), "must be within the joint's limits; clamped");
            }
        }
        if let Some(JsonNumbers(transform)) = self.transform {
            let set = skeleton.set_transform(Affine3A::from_cols_array(&transform));
            set.map_err(|error| error.to_string()).at("transform")?;
        }
        Ok(skeleton)
    }
}

/// Returns the path from the joints to the field that caused `error`. `names` has the names of the
/// joints.
fn invalid_field(error: &SkeletonError, names: &[String]) -> JsonPath {
    let at = |joint: usize| JsonPath::root().index(joint);
    match error {
        SkeletonError::Parent { joint, .. } => at(joint.index()).key("parent"),
        SkeletonError::Radius { joint, .. } => at(joint.index()).key("radius"),
        SkeletonError::Stiffness { joint, .. } => at(joint.index()).key("stiffness"),
        SkeletonError::Cone { joint, .. } => at(joint.index()).key("cone"),
        SkeletonError::Frame { joint } => at(joint.index()).key("frame"),
        SkeletonError::NotFinite { joint, field, .. } => at(joint.index()).key(&field.to_string()),
        SkeletonError::Limit { joint, axis, .. } => {
            at(joint.index()).key("limits").key(&axis.to_string())
        }
        SkeletonError::NoName => {
            let empty = names.iter().position(|name| name.trim().is_empty());
            at(empty.unwrap_or_default()).key("name")
        }
        SkeletonError::Name(repeated) => {
            let mut same = (0..names.len()).filter(|index| names[*index] == *repeated);
            at(same.nth(1).unwrap_or_default()).key("name")
        }
        _ => JsonPath::root(),
    }
}

impl JointFields {
    fn new(joint: &Joint) -> Self {
        let frame = joint.frame.to_cols_array();
        // Compares bits, because −0 equals 0: a frame with −0 must be written.
        let is_identity =
            frame.map(f32::to_bits) == Mat3::IDENTITY.to_cols_array().map(f32::to_bits);
        let [x, y, z] = RotationAxis::ALL
            .map(|axis| joint.limits.range(axis).map(|Limit { min, max }| JsonNumbers([min, max])));
        Self {
            name: joint.name.clone(),
            parent: joint.parent.map(Whole::from),
            offset: Some(joint.offset.into()),
            axis: Some(joint.axis.into()),
            rotation: Some(joint.rotation.into()),
            frame: (!is_identity).then_some(JsonNumbers(frame)),
            limits: [x, y, z].iter().any(Option::is_some).then_some(JsonObject(LimitsFields {
                x,
                y,
                z,
            })),
            cone: joint.limits.as_cone().map(ConeFields::new).map(JsonObject),
            stiffness: (joint.stiffness != Vec3::ZERO).then(|| joint.stiffness.into()),
            locked: joint.locked.then_some(true),
            connected: joint.connected.then_some(true),
            radius: Some(joint.radius.into()),
            skin_scale: (joint.skin.scale != SkinStretch::NONE.scale)
                .then(|| joint.skin.scale.into()),
            human_bone: joint.human_bone.clone(),
            skin_shear: (joint.skin.shear != SkinStretch::NONE.shear)
                .then(|| joint.skin.shear.into()),
        }
    }

    /// Converts the fields to a joint. Without an offset, the joint is at the tip of its parent,
    /// which is one of the `preceding` joints.
    fn joint(self, preceding: &[Joint]) -> Joint {
        let parent = self.parent.map(|Whole(parent)| JointId::new(parent as usize));
        let parent_tip = parent.and_then(|parent| Some(preceding.get(parent.index())?.axis));
        let default = Joint::new(&self.name, parent, value_or(self.axis, Vec3::ZERO));
        let JsonObject(LimitsFields { x, y, z }) = self.limits.unwrap_or_default();
        let limits = [x, y, z].map(|axis| axis.map(|JsonNumbers([min, max])| Limit { min, max }));
        let frame = self.frame.map(|JsonNumbers(frame)| Mat3::from_cols_array(&frame));
        Joint {
            offset: value_or(self.offset, parent_tip.unwrap_or_default()),
            rotation: value_or(self.rotation, Vec3::ZERO),
            frame: frame.unwrap_or(Mat3::IDENTITY),
            limits: match self.cone {
                Some(JsonObject(cone)) => JointLimits::cone(cone.cone()),
                None => JointLimits::new(limits),
            },
            stiffness: value_or(self.stiffness, default.stiffness),
            locked: self.locked.unwrap_or(default.locked),
            connected: self.connected.unwrap_or(default.connected),
            radius: value_or(self.radius, default.radius.min(f32::MAX)),
            human_bone: self.human_bone,
            skin: SkinStretch {
                scale: value_or(self.skin_scale, default.skin.scale),
                shear: value_or(self.skin_shear, default.skin.shear),
            },
            ..default
        }
    }
}

impl From<JointId> for Whole {
    fn from(joint: JointId) -> Self {
        Self(u32::try_from(joint.index()).unwrap_or(u32::MAX))
    }
}

/// The joint of an index in a file, which must be below `joints`, the number of joints.
pub fn joint(Whole(joint): Whole, joints: usize) -> Result<JointId, String> {
    let index = joint as usize;
    if index < joints {
        return Ok(JointId::new(index));
    }
    let rule = match joints {
        0 => "must be a joint, but the skeleton has none".to_owned(),
        1 => "must be 0, the only joint".to_owned(),
        _ => format!("must be a joint from 0 to {}", joints - 1),
    };
    Err(format!("{rule}, got {joint}"))
}
