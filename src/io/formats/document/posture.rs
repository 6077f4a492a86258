//! Fields of a posture in a file, and conversions between these fields and a [`Posture`].

use serde::{Deserialize, Serialize};

use super::skeleton::joint;
use crate::io::json::{AtField, FieldError, JsonObject, JsonPoint, Whole};
use crate::kinematics::limb_ik::LimbPosture;
use crate::rig::{Posture, PosturedJoint};

#[derive(Serialize, Deserialize)]
pub struct PostureFields {
    joints: Option<Vec<JsonObject<JointFields>>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    limbs: Option<Vec<JsonObject<LimbFields>>>,
}

#[derive(Serialize, Deserialize)]
struct JointFields {
    joint: Whole,
    #[serde(skip_serializing_if = "Option::is_none")]
    rotation: Option<JsonPoint>,
    #[serde(skip_serializing_if = "Option::is_none")]
    offset: Option<JsonPoint>,
}

/// The joint of a limb's target with the fields of [`LimbPosture`].
#[derive(Serialize, Deserialize)]
struct LimbFields {
    joint: Whole,
    pointer: JsonPoint,
    elbow: JsonPoint,
    bend_axis: JsonPoint,
    bend: JsonPoint,
    #[serde(skip_serializing_if = "Option::is_none")]
    hand: Option<JsonPoint>,
}

impl PostureFields {
    pub fn new(posture: &Posture) -> Self {
        let joint = |(joint, of): (&_, &PosturedJoint)| JointFields {
            joint: Whole::from(*joint),
            rotation: of.rotation.map(JsonPoint),
            offset: of.offset.map(JsonPoint),
        };
        let limb = |(joint, of): (&_, &LimbPosture)| {
            let [pointer, elbow, bend_axis, bend] =
                [of.pointer, of.elbow, of.bend_axis, of.bend].map(JsonPoint);
            let hand = of.hand.map(JsonPoint);
            LimbFields { joint: Whole::from(*joint), pointer, elbow, bend_axis, bend, hand }
        };
        let limbs: Vec<_> = posture.limbs.iter().map(limb).map(JsonObject).collect();
        Self {
            joints: Some(posture.joints.iter().map(joint).map(JsonObject).collect()),
            limbs: (!limbs.is_empty()).then_some(limbs),
        }
    }

    /// Converts the fields to the posture of a skeleton with this number of joints.
    pub fn posture(self, joints: usize) -> Result<Posture, FieldError> {
        let mut posture = Posture::default();
        for (index, JsonObject(fields)) in self.joints.unwrap_or_default().into_iter().enumerate() {
            let at = joint(fields.joint, joints).at("joint").at(index).at("joints")?;
            let [rotation, offset] = [fields.rotation, fields.offset].map(|it| it.map(|it| it.0));
            posture.joints.insert(at, PosturedJoint { rotation, offset });
        }
        for (index, JsonObject(fields)) in self.limbs.unwrap_or_default().into_iter().enumerate() {
            let at = joint(fields.joint, joints).at("joint").at(index).at("limbs")?;
            let LimbFields { pointer, elbow, bend_axis, bend, hand, .. } = fields;
            let [pointer, elbow, bend_axis, bend] =
                [pointer, elbow, bend_axis, bend].map(|vector| vector.0);
            let hand = hand.map(|hand| hand.0);
            posture.limbs.insert(at, LimbPosture { pointer, elbow, bend_axis, bend, hand });
        }
        Ok(posture)
    }
}
