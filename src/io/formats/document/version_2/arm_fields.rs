use glam::{Vec2, Vec3};
use serde::Deserialize;

use super::arm::{Arm, HandSpace};
use crate::io::formats::document::targets::SoftReachFields;
use crate::io::json::{
    Above0, AtField, FieldError, Fraction, JsonNumber, JsonNumbers, JsonObject, JsonPoint, value_or,
};
use crate::kinematics::fk::Fk;
use crate::kinematics::twist::{TransportedFrame, TwistReferenceKind};
use crate::kinematics::two_bone::{LengthError, Pointer, TwoBone};

#[derive(Deserialize)]
pub struct ArmFields {
    cursor: Option<JsonPoint>,
    pin: Option<JsonPoint>,
    pinned: Option<bool>,
    twist: Option<JsonNumber>,
    root: Option<JsonPoint>,
    upper: Option<JsonNumber>,
    lower: Option<JsonNumber>,
    facing: Option<JsonObject<FacingFields>>,
    twist_reference: Option<JsonObject<TwistReferenceFields>>,
    soft_reach: Option<JsonObject<SoftReachFields>>,
    influence: Option<Fraction>,
    fk: Option<JsonObject<FkFields>>,
    hand_orientation: Option<JsonObject<HandOrientationFields>>,
}

#[derive(Deserialize)]
struct FacingFields {
    direction: JsonPoint,
    heading: JsonNumbers<2>,
}

#[derive(Deserialize)]
struct TwistReferenceFields {
    kind: Option<TwistReferenceKind>,
    pole: Option<JsonPoint>,
    transported: Option<JsonObject<TransportedFields>>,
}

#[derive(Deserialize)]
struct TransportedFields {
    direction: JsonPoint,
    outward: JsonPoint,
}

#[derive(Deserialize)]
struct FkFields {
    shoulder: Option<JsonPoint>,
    bend: Option<JsonNumber>,
    stretch: Option<Above0>,
}

#[derive(Deserialize)]
struct HandOrientationFields {
    space: Option<HandSpace>,
    angles: Option<JsonPoint>,
    roll: Option<JsonNumber>,
}

impl ArmFields {
    pub(super) fn arm(self) -> Result<Arm, FieldError> {
        let default = Arm::default();
        let bones = TwoBone::new(
            value_or(self.upper, default.bones.upper()),
            value_or(self.lower, default.bones.lower()),
        )
        .or_else(|LengthError { bone, value }| {
            let reason = format!("must be finite and above 0, got {value}");
            Err(reason).at(bone.to_string().as_str())
        })?;
        let mut arm = Arm {
            cursor: value_or(self.cursor, default.cursor),
            pin: value_or(self.pin, default.pin),
            is_pinned: self.pinned.unwrap_or(self.pin.is_some()),
            twist: value_or(self.twist, default.twist),
            root: value_or(self.root, default.root),
            bones,
            influence: value_or(self.influence, default.influence),
            ..default
        };
        let cursor = if arm.is_pinned { arm.pin - arm.root } else { arm.cursor };
        arm.state.pointer = Pointer::towards(cursor, Pointer::default());
        if let Some(JsonObject(fields)) = self.twist_reference {
            arm.reference = fields.kind.unwrap_or(arm.reference);
            arm.pole = value_or(fields.pole, arm.pole);
            let frame = fields.transported.map(|JsonObject(fields)| fields.frame());
            arm.state.transported = frame.transpose().at("transported").at("twist_reference")?;
        }
        if let Some(JsonObject(fields)) = self.soft_reach {
            arm.soft_reach = fields.soft_reach().at("soft_reach")?;
        }
        if let Some(JsonObject(fields)) = self.fk {
            arm.fk = fields.fk();
        }
        if let Some(JsonObject(fields)) = self.hand_orientation {
            arm.hand_space = fields.space.unwrap_or_default();
            arm.hand_angles = value_or(fields.angles, arm.hand_angles);
            arm.roll = value_or(fields.roll, arm.roll);
        }
        if let Some(JsonObject(fields)) = self.facing {
            arm.state.pointer = fields.facing().at("facing")?;
        }
        Ok(arm)
    }
}

/// Tolerance for unit vectors in a file: the maximum difference of a length from 1, and the maximum
/// absolute cosine of the angle between two vectors that must be perpendicular.
const UNIT_TOLERANCE: f32 = 1e-3;

/// Checks that the length of a vector is 1 within [`UNIT_TOLERANCE`], and returns the normalized
/// vector. If the length is 1 within rounding, returns the vector unchanged, bit for bit.
fn unit_vector(vector: Vec3) -> Result<Vec3, String> {
    const ROUNDING: f32 = 1e-6;
    let length = vector.length();
    if (length - 1.0).abs() > UNIT_TOLERANCE {
        return Err(format!("must have length 1, got {length}"));
    }
    Ok(if (length - 1.0).abs() <= ROUNDING { vector } else { vector.normalize() })
}

impl FacingFields {
    fn facing(self) -> Result<Pointer, FieldError> {
        let direction = unit_vector(self.direction.0).at("direction")?;
        let [x, z] = self.heading.0;
        let heading = unit_vector(Vec3::new(x, z, 0.0)).at("heading")?.truncate();
        let flat = Vec2::new(direction.x, direction.z);
        if flat.length() > UNIT_TOLERANCE && flat.normalize().distance(heading) > UNIT_TOLERANCE {
            let reason = format!("must be `direction` as seen from above, got [{x}, {z}]");
            return Err(reason).at("heading");
        }
        Ok(Pointer { direction, heading })
    }
}

impl TransportedFields {
    fn frame(self) -> Result<TransportedFrame, FieldError> {
        let direction = unit_vector(self.direction.0).at("direction")?;
        let outward = unit_vector(self.outward.0).at("outward")?;
        if self.direction.0.dot(self.outward.0).abs() > UNIT_TOLERANCE {
            let [x, y, z] = self.outward.0.to_array();
            let reason = format!("must be perpendicular to `direction`, got [{x}, {y}, {z}]");
            return Err(reason).at("outward");
        }
        Ok(TransportedFrame { direction, outward })
    }
}

impl FkFields {
    fn fk(self) -> Fk {
        let default = Fk::default();
        Fk {
            shoulder: value_or(self.shoulder, default.shoulder),
            bend: value_or(self.bend, default.bend),
            stretch: value_or(self.stretch, default.stretch),
        }
    }
}
