use std::fmt;

use serde::Deserialize;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, Error, MapAccess, Unexpected, Visitor};

use crate::io::json::JsonPoint;
use crate::kinematics::twist::{Stereographic, TwistReference, TwistReferenceKind};

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
