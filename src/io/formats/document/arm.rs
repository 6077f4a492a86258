//! Fields of the arm in a file, and conversions between these fields and an arm.

use glam::Vec2;
use serde::{Deserialize, Serialize};

use super::check::SoftReachFields;
use super::check::{UNIT_TOLERANCE, above_0, fraction, number, unit_vector};
use crate::document::{Arm, Cursor, HandOrientation, HandSpace, TwistReferenceKind};
use crate::io::json::FieldError;
use crate::io::json::JsonPath;
use crate::io::json::{JsonNumber, JsonNumbers, JsonObject, JsonPoint};
use crate::kinematics::fk::Fk;
use crate::kinematics::twist::TransportedFrame;
use crate::kinematics::two_bone::{Pointer, TwoBone};

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
    influence: Option<JsonNumber>,
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
    stretch: Option<JsonNumber>,
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
            influence: Some(JsonNumber(arm.influence)),
            fk: Some(JsonObject(FkFields::new(arm.fk))),
            hand_orientation: Some(JsonObject(HandOrientationFields::new(arm.hand_orientation))),
        }
    }

    pub fn arm(&self, at: &JsonPath) -> Result<Arm, FieldError> {
        let default = Arm::default();
        let cursor = Cursor {
            in_root: self.cursor.map_or(default.cursor.in_root, |JsonPoint(cursor)| cursor),
            in_world: self.pin.map_or(default.cursor.in_world, |JsonPoint(pin)| pin),
            is_pinned: self.pinned.unwrap_or(self.pin.is_some()),
        };
        let mut arm = Arm {
            cursor,
            twist: number(self.twist, default.twist),
            root: self.root.map_or(default.root, |JsonPoint(root)| root),
            bones: self.bones(at, default.bones)?,
            influence: fraction(
                at.clone().key("influence"),
                number(self.influence, default.influence),
            )?,
            ..default
        };
        arm.ik_state.pointer = Pointer::towards(arm.cursor_in_root(), Pointer::default());
        if let Some(JsonObject(fields)) = &self.twist_reference {
            fields.set(&mut arm, &at.clone().key("twist_reference"))?;
        }
        if let Some(JsonObject(fields)) = &self.soft_reach {
            arm.soft_reach = fields.soft_reach(&at.clone().key("soft_reach"))?;
        }
        if let Some(JsonObject(fields)) = &self.fk {
            arm.fk = fields.fk(&at.clone().key("fk"))?;
        }
        if let Some(JsonObject(fields)) = &self.hand_orientation {
            arm.hand_orientation = fields.hand_orientation();
        }
        if let Some(JsonObject(fields)) = &self.facing {
            arm.ik_state.pointer = fields.facing(&at.clone().key("facing"))?;
        }
        Ok(arm)
    }

    fn bones(&self, at: &JsonPath, default: TwoBone) -> Result<TwoBone, FieldError> {
        TwoBone::new(number(self.upper, default.upper()), number(self.lower, default.lower()))
            .map_err(|error| {
                let reason = format!("must be finite and above 0, got {}", error.value);
                FieldError::new(at.clone().key(&error.bone.to_string()), reason)
            })
    }
}

impl FacingFields {
    fn facing(&self, at: &JsonPath) -> Result<Pointer, FieldError> {
        let [direction, heading] = [
            ("direction", self.direction.0),
            ("heading", Vec2::from_array(self.heading.0).extend(0.0)),
        ]
        .map(|(key, vector)| unit_vector(at.clone().key(key), vector));
        let (direction, heading) = (direction?, heading?.truncate());
        let flat = Vec2::new(direction.x, direction.z);
        if flat.length() > UNIT_TOLERANCE && flat.normalize().distance(heading) > UNIT_TOLERANCE {
            let [x, z] = self.heading.0;
            let reason = format!("must be `direction` as seen from above, got [{x}, {z}]");
            return Err(FieldError::new(at.clone().key("heading"), reason));
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

    fn set(&self, arm: &mut Arm, at: &JsonPath) -> Result<(), FieldError> {
        arm.twist_reference = self.kind.unwrap_or(arm.twist_reference);
        arm.pole = self.pole.map_or(arm.pole, |JsonPoint(pole)| pole);
        if let Some(JsonObject(fields)) = &self.transported {
            arm.ik_state.transported = Some(fields.frame(&at.clone().key("transported"))?);
        }
        Ok(())
    }
}

impl TransportedFields {
    fn frame(&self, at: &JsonPath) -> Result<TransportedFrame, FieldError> {
        let direction = unit_vector(at.clone().key("direction"), self.direction.0)?;
        let outward = unit_vector(at.clone().key("outward"), self.outward.0)?;
        if self.direction.0.dot(self.outward.0).abs() > UNIT_TOLERANCE {
            let [x, y, z] = self.outward.0.to_array();
            let reason = format!("must be perpendicular to `direction`, got [{x}, {y}, {z}]");
            return Err(FieldError::new(at.clone().key("outward"), reason));
        }
        Ok(TransportedFrame { direction, outward })
    }
}

impl FkFields {
    fn new(fk: Fk) -> Self {
        Self {
            shoulder: Some(JsonPoint(fk.shoulder)),
            bend: Some(JsonNumber(fk.bend)),
            stretch: Some(JsonNumber(fk.stretch)),
        }
    }

    fn fk(&self, at: &JsonPath) -> Result<Fk, FieldError> {
        let default = Fk::default();
        Ok(Fk {
            shoulder: self.shoulder.map_or(default.shoulder, |JsonPoint(shoulder)| shoulder),
            bend: number(self.bend, default.bend),
            stretch: above_0(at.clone().key("stretch"), number(self.stretch, default.stretch))?,
        })
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

    fn hand_orientation(&self) -> HandOrientation {
        let default = HandOrientation::default();
        HandOrientation {
            space: self.space.unwrap_or(default.space),
            angles: self.angles.map_or(default.angles, |JsonPoint(angles)| angles),
            roll: number(self.roll, default.roll),
        }
    }
}
