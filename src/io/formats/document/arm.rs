//! Fields of the arm in a file, and conversions between these fields and an arm.

use glam::{Vec2, Vec3};
use serde::{Deserialize, Serialize};

use super::targets::SoftReachFields;
use crate::document::{Arm, Cursor, HandOrientation, HandSpace, TwistReferenceKind};
use crate::io::json::{
    Above0, AtField, FieldError, Fraction, JsonNumber, JsonNumbers, JsonObject, JsonPoint, value_or,
};
use crate::kinematics::fk::Fk;
use crate::kinematics::twist::TransportedFrame;
use crate::kinematics::two_bone::{LengthError, Pointer, TwoBone};

#[derive(Serialize, Deserialize)]
pub struct ArmFields {
    #[serde(skip_serializing_if = "Option::is_none")]
    cursor: Option<JsonPoint>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pin: Option<JsonPoint>,
    #[serde(skip_serializing_if = "Option::is_none")]
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

#[derive(Serialize, Deserialize)]
struct FacingFields {
    direction: JsonPoint,
    heading: JsonNumbers<2>,
}

#[derive(Serialize, Deserialize)]
struct TwistReferenceFields {
    kind: Option<TwistReferenceKind>,
    pole: Option<JsonPoint>,
    #[serde(skip_serializing_if = "Option::is_none")]
    transported: Option<JsonObject<TransportedFields>>,
}

#[derive(Serialize, Deserialize)]
struct TransportedFields {
    direction: JsonPoint,
    outward: JsonPoint,
}

#[derive(Serialize, Deserialize)]
struct FkFields {
    shoulder: Option<JsonPoint>,
    bend: Option<JsonNumber>,
    stretch: Option<Above0>,
}

#[derive(Serialize, Deserialize)]
struct HandOrientationFields {
    space: Option<HandSpace>,
    angles: Option<JsonPoint>,
    roll: Option<JsonNumber>,
}

impl ArmFields {
    pub fn new(arm: &Arm) -> Self {
        let Cursor { in_root, in_world, is_pinned } = arm.cursor;
        let default = Arm::default().cursor;
        let cursor = (!is_pinned || in_root != default.in_root).then_some(JsonPoint(in_root));
        let pin = (is_pinned || in_world != default.in_world).then_some(JsonPoint(in_world));
        let pinned = (is_pinned != pin.is_some()).then_some(is_pinned);
        let Pointer { direction, heading } = arm.ik_state.pointer;
        let facing = FacingFields {
            direction: JsonPoint(direction),
            heading: JsonNumbers(heading.to_array()),
        };
        Self {
            cursor,
            pin,
            pinned,
            twist: Some(JsonNumber(arm.twist)),
            root: Some(JsonPoint(arm.root)),
            upper: Some(JsonNumber(arm.bones.upper())),
            lower: Some(JsonNumber(arm.bones.lower())),
            facing: Some(JsonObject(facing)),
            twist_reference: Some(JsonObject(TwistReferenceFields::new(arm))),
            soft_reach: Some(JsonObject(SoftReachFields::new(arm.soft_reach))),
            influence: Some(arm.influence.into()),
            fk: Some(JsonObject(FkFields::new(arm.fk))),
            hand_orientation: Some(JsonObject(HandOrientationFields::new(arm.hand_orientation))),
        }
    }

    pub fn arm(self) -> Result<Arm, FieldError> {
        let default = Arm::default();
        let cursor = Cursor {
            in_root: value_or(self.cursor, default.cursor.in_root),
            in_world: value_or(self.pin, default.cursor.in_world),
            is_pinned: self.pinned.unwrap_or(self.pin.is_some()),
        };
        let bones = TwoBone::new(
            value_or(self.upper, default.bones.upper()),
            value_or(self.lower, default.bones.lower()),
        )
        .or_else(|LengthError { bone, value }| {
            let reason = format!("must be finite and above 0, got {value}");
            Err(reason).at(bone.to_string().as_str())
        })?;
        let mut arm = Arm {
            cursor,
            twist: value_or(self.twist, default.twist),
            root: value_or(self.root, default.root),
            bones,
            influence: value_or(self.influence, default.influence),
            ..default
        };
        arm.ik_state.pointer = Pointer::towards(arm.cursor_in_root(), Pointer::default());
        if let Some(JsonObject(fields)) = self.twist_reference {
            fields.set(&mut arm).at("twist_reference")?;
        }
        if let Some(JsonObject(fields)) = self.soft_reach {
            arm.soft_reach = fields.soft_reach().at("soft_reach")?;
        }
        if let Some(JsonObject(fields)) = self.fk {
            arm.fk = fields.fk();
        }
        if let Some(JsonObject(fields)) = self.hand_orientation {
            arm.hand_orientation = fields.hand_orientation();
        }
        if let Some(JsonObject(fields)) = self.facing {
            arm.ik_state.pointer = fields.facing().at("facing")?;
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

impl TwistReferenceFields {
    fn new(arm: &Arm) -> Self {
        let transported = |TransportedFrame { direction, outward }| {
            JsonObject(TransportedFields {
                direction: JsonPoint(direction),
                outward: JsonPoint(outward),
            })
        };
        Self {
            kind: Some(arm.twist_reference),
            pole: Some(JsonPoint(arm.pole)),
            transported: arm.ik_state.transported.map(transported),
        }
    }

    fn set(self, arm: &mut Arm) -> Result<(), FieldError> {
        arm.twist_reference = self.kind.unwrap_or(arm.twist_reference);
        arm.pole = value_or(self.pole, arm.pole);
        if let Some(JsonObject(fields)) = self.transported {
            arm.ik_state.transported = Some(fields.frame().at("transported")?);
        }
        Ok(())
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
    fn new(fk: Fk) -> Self {
        Self {
            shoulder: Some(fk.shoulder.into()),
            bend: Some(fk.bend.into()),
            stretch: Some(fk.stretch.into()),
        }
    }

    fn fk(self) -> Fk {
        let default = Fk::default();
        Fk {
            shoulder: value_or(self.shoulder, default.shoulder),
            bend: value_or(self.bend, default.bend),
            stretch: value_or(self.stretch, default.stretch),
        }
    }
}

impl HandOrientationFields {
    fn new(orientation: HandOrientation) -> Self {
        Self {
            space: Some(orientation.space),
            angles: Some(JsonPoint(orientation.angles)),
            roll: Some(JsonNumber(orientation.roll)),
        }
    }

    fn hand_orientation(self) -> HandOrientation {
        let default = HandOrientation::default();
        HandOrientation {
            space: self.space.unwrap_or(default.space),
            angles: value_or(self.angles, default.angles),
            roll: value_or(self.roll, default.roll),
        }
    }
}
