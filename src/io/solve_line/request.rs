//! The fields of a line.

use std::{fmt, str};

use serde::Deserialize;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, Error, MapAccess, Unexpected, Visitor};

use super::answer::PreviousLine;
use super::error::LineError;
use crate::io::json::{JsonNumber, JsonPoint};
use crate::kinematics::ik::{Ik, IkSolution, IkState};
use crate::kinematics::soft_reach::{SoftReach, SoftReachError, SoftReachField};
use crate::kinematics::twist::{Stereographic, TwistReference, TwistReferenceKind};
use crate::kinematics::two_bone::TwoBone;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Request {
    hand: JsonPoint,
    #[serde(default = "default_upper")]
    upper: JsonNumber,
    #[serde(default = "default_lower")]
    lower: JsonNumber,
    #[serde(default)]
    pub root: JsonPoint,
    #[serde(default)]
    twist_deg: JsonNumber,
    #[serde(default)]
    reference: ReferenceField,
    #[serde(default)]
    softness: JsonNumber,
    #[serde(default = "default_max_stretch")]
    max_stretch: JsonNumber,
    #[serde(default)]
    min_elbow_angle_deg: JsonNumber,
}

fn default_upper() -> JsonNumber {
    JsonNumber(200.0)
}

fn default_lower() -> JsonNumber {
    JsonNumber(300.0)
}

fn default_max_stretch() -> JsonNumber {
    JsonNumber(1.0)
}

impl Request {
    pub fn parse(line: &[u8]) -> Result<Self, LineError> {
        let line = str::from_utf8(line).map_err(|error| LineError::not_utf8(line, error))?;
        let mut json = serde_json::Deserializer::from_str(line);
        let RequestObject(request) = serde_path_to_error::deserialize(&mut json)
            .map_err(|error| LineError::not_a_request(line, error.path(), error.inner()))?;
        json.end().map_err(|error| LineError::not_json(line, String::new(), &error))?;
        Ok(request)
    }

    pub fn ik(&self) -> Result<Ik, LineError> {
        Ok(Ik {
            bones: TwoBone::new(self.upper.0, self.lower.0)?,
            reference: self.reference.0,
            soft_reach: self.soft_reach()?,
        })
    }

    fn soft_reach(&self) -> Result<SoftReach, LineError> {
        let degrees = self.min_elbow_angle_deg.0;
        SoftReach::new(self.softness.0, self.max_stretch.0, degrees.to_radians()).map_err(|error| {
            let SoftReachError { field, value, range } = error;
            match field {
                SoftReachField::MinElbowAngle => {
                    LineError::SoftReach { field: "min_elbow_angle_deg", value: degrees, range }
                }
                SoftReachField::Softness => {
                    LineError::SoftReach { field: "softness", value, range }
                }
                SoftReachField::MaxStretch => {
                    LineError::SoftReach { field: "max_stretch", value, range }
                }
            }
        })
    }

    pub fn solve(&self, ik: Ik, previous: Option<PreviousLine>) -> IkSolution {
        // Whole turns are removed in degrees, where the remainder is exact. In radians, the
        // remainder of a large angle would be inexact.
        let twist = (self.twist_deg.0 % 360.0).to_radians();
        let last = previous.map_or_else(IkState::default, |PreviousLine(state)| state);
        ik.solve(self.hand.0, twist, last)
    }
}

/// A request. Without this wrapper, serde's derived code would accept an array, too.
struct RequestObject(Request);

impl<'de> Deserialize<'de> for RequestObject {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct RequestVisitor;

        impl<'de> Visitor<'de> for RequestVisitor {
            type Value = RequestObject;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(r#"an object like {"hand":[250,120,60]}"#)
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<RequestObject, A::Error> {
                Request::deserialize(MapAccessDeserializer::new(map)).map(RequestObject)
            }
        }

        deserializer.deserialize_map(RequestVisitor)
    }
}

/// The twist reference of a line: a name, or an object with a pole.
#[derive(Default)]
pub struct ReferenceField(pub TwistReference);

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PoleField {
    pole: JsonPoint,
}

impl<'de> Deserialize<'de> for ReferenceField {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ReferenceVisitor;

        impl<'de> Visitor<'de> for ReferenceVisitor {
            type Value = ReferenceField;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(r#""up", {"pole":[x,y,z]}, "stereographic" or "transport""#)
            }

            fn visit_str<E: Error>(self, name: &str) -> Result<ReferenceField, E> {
                match name.parse() {
                    Ok(TwistReferenceKind::Up) => Ok(ReferenceField(TwistReference::Up)),
                    Ok(TwistReferenceKind::Stereographic) => {
                        Ok(ReferenceField(TwistReference::Stereographic(Stereographic::default())))
                    }
                    Ok(TwistReferenceKind::Transport) => {
                        Ok(ReferenceField(TwistReference::Transport))
                    }
                    Ok(TwistReferenceKind::Pole) | Err(_) => {
                        Err(E::invalid_value(Unexpected::Str(name), &self))
                    }
                }
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<ReferenceField, A::Error> {
                let PoleField { pole } = PoleField::deserialize(MapAccessDeserializer::new(map))?;
                Ok(ReferenceField(TwistReference::Pole(pole.0)))
            }
        }

        deserializer.deserialize_any(ReferenceVisitor)
    }
}
