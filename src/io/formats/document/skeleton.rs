//! Fields of the skeleton in a file, and conversions between these fields and a skeleton.

use glam::{Affine3A, Mat3, Vec3};
use serde::{Deserialize, Serialize};

use crate::io::json::JsonPath;
use crate::io::json::{FieldError, FieldWarnings};
use crate::io::json::{JsonNumber, JsonNumbers, JsonObject, JsonPoint, Whole};
use crate::kinematics::skeleton::{
    Joint, JointId, JointLimits, Limit, RotationAxis, Skeleton, SkeletonError,
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
    locked: Option<bool>,
    #[serde(skip_serializing_if = "Option::is_none")]
    connected: Option<bool>,
    radius: Option<JsonNumber>,
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
    /// warning. `at` is the path of the fields.
    pub fn skeleton(
        self,
        at: &JsonPath,
        warnings: &mut FieldWarnings,
    ) -> Result<Skeleton, FieldError> {
        let at_joints = at.clone().key("joints");
        let mut joints: Vec<Joint> = Vec::new();
        for (index, JsonObject(fields)) in self.joints.unwrap_or_default().into_iter().enumerate() {
            let joint = fields.joint(&joints);
            if !joint.limits.contains(joint.rotation) {
                let field = at_joints.clone().index(index).key("rotation");
                warnings.push(field, "must be within the joint's limits; clamped");
            }
            joints.push(joint);
        }
        let names: Vec<_> = joints.iter().map(|joint| joint.name.clone()).collect();
        let mut skeleton = Skeleton::from_joints(joints).map_err(|error| {
            FieldError::new(invalid_field(&error, at_joints, &names), error.to_string())
        })?;
        if let Some(JsonNumbers(transform)) = self.transform {
            skeleton
                .set_transform(Affine3A::from_cols_array(&transform))
                .map_err(|error| FieldError::new(at.clone().key("transform"), error.to_string()))?;
        }
        Ok(skeleton)
    }
}

/// Returns the path of the field that caused `error`. `at_joints` is the path of the joints, and
/// `names` has their names.
fn invalid_field(error: &SkeletonError, at_joints: JsonPath, names: &[String]) -> JsonPath {
    let at = |joint: usize| at_joints.clone().index(joint);
    match error {
        SkeletonError::Parent { joint, .. } => at(joint.index()).key("parent"),
        SkeletonError::Radius { joint, .. } => at(joint.index()).key("radius"),
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
        _ => at_joints,
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
            parent: joint.parent.and_then(|parent| u32::try_from(parent.index()).ok()).map(Whole),
            offset: Some(JsonPoint(joint.offset)),
            axis: Some(JsonPoint(joint.axis)),
            rotation: Some(JsonPoint(joint.rotation)),
            frame: (!is_identity).then_some(JsonNumbers(frame)),
            limits: joint.limits.is_limited().then_some(JsonObject(LimitsFields { x, y, z })),
            locked: joint.locked.then_some(true),
            connected: joint.connected.then_some(true),
            radius: Some(JsonNumber(joint.radius)),
        }
    }

    /// Converts the fields to a joint. Without an offset, the joint is at the tip of its parent,
    /// which is one of the `preceding` joints.
    fn joint(self, preceding: &[Joint]) -> Joint {
        let parent = self.parent.map(|Whole(parent)| parent as usize);
        let axis = self.axis.map_or(Vec3::ZERO, |JsonPoint(axis)| axis);
        let parent_tip = parent.and_then(|parent| Some(preceding.get(parent)?.axis));
        let default = Joint::new(&self.name, parent.map(JointId::new), axis);
        let limits = self.limits.map(|JsonObject(limits)| limits).unwrap_or_default();
        Joint {
            offset: self.offset.map_or(parent_tip.unwrap_or_default(), |JsonPoint(offset)| offset),
            rotation: self.rotation.map_or(Vec3::ZERO, |JsonPoint(rotation)| rotation),
            frame: self
                .frame
                .map_or(Mat3::IDENTITY, |JsonNumbers(frame)| Mat3::from_cols_array(&frame)),
            limits: JointLimits::new(
                [limits.x, limits.y, limits.z]
                    .map(|limit| limit.map(|JsonNumbers([min, max])| Limit { min, max })),
            ),
            locked: self.locked.unwrap_or(default.locked),
            connected: self.connected.unwrap_or(default.connected),
            radius: self.radius.map_or(default.radius.min(f32::MAX), |JsonNumber(radius)| radius),
            ..default
        }
    }
}
