//! Fields of the arm, and conversions from and to a document's arm.

use core::f32::consts::PI;

use glam::Vec2;
use serde::{Deserialize, Serialize};

use super::check::{UNIT_TOLERANCE, above_0, fraction, number, unit_vector};
use crate::document::{Arm, Cursor, HandSpace, TwistReferenceKind, Wrist};
use crate::io::field_error::FieldError;
use crate::io::json_path::JsonPath;
use crate::io::value::{Number, Numbers, Object, Point};
use crate::kinematics::fk::Fk;
use crate::kinematics::soft_reach::SoftReach;
use crate::kinematics::twist::TransportedFrame;
use crate::kinematics::two_bone::{Facing, TwoBone};

#[derive(Serialize, Deserialize)]
pub struct ArmFields {
    #[serde(skip_serializing_if = "Option::is_none")]
    cursor: Option<Point>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pin: Option<Point>,
    twist: Option<Number>,
    root: Option<Point>,
    upper: Option<Number>,
    lower: Option<Number>,
    facing: Option<Object<FacingFields>>,
    twist_reference: Option<Object<TwistReferenceFields>>,
    soft_reach: Option<Object<SoftReachFields>>,
    influence: Option<Number>,
    fk: Option<Object<FkFields>>,
    hand_orientation: Option<Object<HandOrientationFields>>,
}

#[derive(Serialize, Deserialize)]
struct FacingFields {
    direction: Point,
    heading: Numbers<2>,
}

#[derive(Serialize, Deserialize)]
struct TwistReferenceFields {
    kind: Option<TwistReferenceKind>,
    pole: Option<Point>,
    #[serde(skip_serializing_if = "Option::is_none")]
    transported: Option<Object<TransportedFields>>,
}

#[derive(Serialize, Deserialize)]
struct TransportedFields {
    direction: Point,
    outward: Point,
}

#[derive(Serialize, Deserialize)]
struct SoftReachFields {
    softness: Option<Number>,
    max_stretch: Option<Number>,
    min_elbow_angle: Option<Number>,
}

#[derive(Serialize, Deserialize)]
struct FkFields {
    shoulder: Option<Point>,
    bend: Option<Number>,
    stretch: Option<Number>,
}

#[derive(Serialize, Deserialize)]
struct HandOrientationFields {
    space: Option<HandSpace>,
    angles: Option<Point>,
    roll: Option<Number>,
}

impl ArmFields {
    pub fn new(arm: &Arm) -> Self {
        let (cursor, pin) = match arm.goal {
            Cursor::Root(cursor) => (Some(Point(cursor)), None),
            Cursor::World(pin) => (None, Some(Point(pin))),
        };
        let Facing { direction, heading } = arm.facing;
        let facing =
            FacingFields { direction: Point(direction), heading: Numbers(heading.to_array()) };
        Self {
            cursor,
            pin,
            twist: Some(Number(arm.twist)),
            root: Some(Point(arm.root)),
            upper: Some(Number(arm.bones.upper())),
            lower: Some(Number(arm.bones.lower())),
            facing: Some(Object(facing)),
            twist_reference: Some(Object(TwistReferenceFields::new(arm))),
            soft_reach: Some(Object(SoftReachFields::new(arm.soft_reach))),
            influence: Some(Number(arm.influence)),
            fk: Some(Object(FkFields::new(arm.fk))),
            hand_orientation: Some(Object(HandOrientationFields::new(arm.wrist))),
        }
    }

    pub fn arm(&self, at: &JsonPath) -> Result<Arm, FieldError> {
        let default = Arm::default();
        let goal = match (self.pin, self.cursor) {
            (Some(Point(pin)), _) => Cursor::World(pin),
            (None, Some(Point(cursor))) => Cursor::Root(cursor),
            (None, None) => default.goal,
        };
        let arm = Arm {
            goal,
            twist: number(self.twist, default.twist),
            root: self.root.map_or(default.root, |Point(root)| root),
            bones: self.bones(at, default.bones)?,
            influence: fraction(
                at.clone().key("influence"),
                number(self.influence, default.influence),
            )?,
            ..default
        };
        let facing = Facing::towards(arm.cursor(), Facing::default());
        let mut arm = Arm { facing, ..arm };
        if let Some(Object(fields)) = &self.twist_reference {
            fields.set(&mut arm, &at.clone().key("twist_reference"))?;
        }
        if let Some(Object(fields)) = &self.soft_reach {
            arm.soft_reach = fields.soft_reach(&at.clone().key("soft_reach"))?;
        }
        if let Some(Object(fields)) = &self.fk {
            arm.fk = fields.fk(&at.clone().key("fk"))?;
        }
        if let Some(Object(fields)) = &self.hand_orientation {
            arm.wrist = fields.hand_orientation();
        }
        if let Some(Object(fields)) = &self.facing {
            arm.facing = fields.facing(&at.clone().key("facing"))?;
        }
        Ok(arm)
    }

    fn bones(&self, at: &JsonPath, default: TwoBone) -> Result<TwoBone, FieldError> {
        TwoBone::new(number(self.upper, default.upper()), number(self.lower, default.lower()))
            .map_err(|error| {
                let reason = format!("must be finite and above 0, got {}", error.value);
                FieldError::new(at.clone().key(error.bone), reason)
            })
    }
}

impl FacingFields {
    fn facing(&self, at: &JsonPath) -> Result<Facing, FieldError> {
        let [direction, heading] = [
            ("direction", self.direction.0),
            ("heading", Vec2::from_array(self.heading.0).extend(0.0)),
        ]
        .map(|(key, vector)| unit_vector(at.clone().key(key), vector));
        let (direction, heading) = (direction?, heading?.truncate());
        let flat = Vec2::new(direction.x, direction.z);
        if flat.length() > UNIT_TOLERANCE && flat.normalize().distance(heading) > UNIT_TOLERANCE {
            let reason = "must be `direction` as seen from above";
            return Err(FieldError::new(at.clone().key("heading"), reason));
        }
        Ok(Facing { direction, heading })
    }
}

impl TwistReferenceFields {
    fn new(arm: &Arm) -> Self {
        let transported = |TransportedFrame { direction, outward }| {
            Object(TransportedFields { direction: Point(direction), outward: Point(outward) })
        };
        Self {
            kind: Some(arm.twist_reference),
            pole: Some(Point(arm.pole)),
            transported: arm.transported.map(transported),
        }
    }

    fn set(&self, arm: &mut Arm, at: &JsonPath) -> Result<(), FieldError> {
        arm.twist_reference = self.kind.unwrap_or(arm.twist_reference);
        arm.pole = self.pole.map_or(arm.pole, |Point(pole)| pole);
        if let Some(Object(fields)) = &self.transported {
            arm.transported = Some(fields.frame(&at.clone().key("transported"))?);
        }
        Ok(())
    }
}

impl TransportedFields {
    fn frame(&self, at: &JsonPath) -> Result<TransportedFrame, FieldError> {
        let direction = unit_vector(at.clone().key("direction"), self.direction.0)?;
        let outward = unit_vector(at.clone().key("outward"), self.outward.0)?;
        if self.direction.0.dot(self.outward.0).abs() > UNIT_TOLERANCE {
            let reason = "must be perpendicular to `direction`";
            return Err(FieldError::new(at.clone().key("outward"), reason));
        }
        Ok(TransportedFrame { direction, outward })
    }
}

impl SoftReachFields {
    fn new(soft_reach: SoftReach) -> Self {
        Self {
            softness: Some(Number(soft_reach.softness())),
            max_stretch: Some(Number(soft_reach.max_stretch())),
            min_elbow_angle: Some(Number(soft_reach.min_elbow_angle())),
        }
    }

    fn soft_reach(&self, at: &JsonPath) -> Result<SoftReach, FieldError> {
        let default = SoftReach::default();
        let soft_reach = SoftReach::new(
            number(self.softness, default.softness()),
            number(self.max_stretch, default.max_stretch()),
            number(self.min_elbow_angle, default.min_elbow_angle()),
        );
        soft_reach.map_err(|error| {
            let range = match error.field {
                "min_elbow_angle" => format!("from 0 to less than {PI}"),
                _ => error.range.to_owned(),
            };
            let reason = format!("must be {range}, got {}", error.value);
            FieldError::new(at.clone().key(error.field), reason)
        })
    }
}

impl FkFields {
    fn new(fk: Fk) -> Self {
        Self {
            shoulder: Some(Point(fk.shoulder)),
            bend: Some(Number(fk.bend)),
            stretch: Some(Number(fk.stretch)),
        }
    }

    fn fk(&self, at: &JsonPath) -> Result<Fk, FieldError> {
        let default = Fk::default();
        Ok(Fk {
            shoulder: self.shoulder.map_or(default.shoulder, |Point(shoulder)| shoulder),
            bend: number(self.bend, default.bend),
            stretch: above_0(at.clone().key("stretch"), number(self.stretch, default.stretch))?,
        })
    }
}

impl HandOrientationFields {
    fn new(orientation: Wrist) -> Self {
        Self {
            space: Some(orientation.space),
            angles: Some(Point(orientation.angles)),
            roll: Some(Number(orientation.roll)),
        }
    }

    fn hand_orientation(&self) -> Wrist {
        let default = Wrist::default();
        Wrist {
            space: self.space.unwrap_or(default.space),
            angles: self.angles.map_or(default.angles, |Point(angles)| angles),
            roll: number(self.roll, default.roll),
        }
    }
}
