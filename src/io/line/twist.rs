//! What a line measures its elbow's spin from.

use std::fmt;

use serde::Deserialize;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, Error, MapAccess, Unexpected, Visitor};

use crate::io::value::Point;
use crate::kinematics::twist::{Stereographic, TwistReference};

/// A name, or an object with a pole.
#[derive(Default)]
pub struct Swivel(pub TwistReference);

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Towards {
    pole: Point,
}

impl<'de> Deserialize<'de> for Swivel {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct SwivelVisitor;

        impl<'de> Visitor<'de> for SwivelVisitor {
            type Value = Swivel;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(r#""limb", {"pole":[x,y,z]}, "stereographic" or "transport""#)
            }

            fn visit_str<E: Error>(self, name: &str) -> Result<Swivel, E> {
                match name {
                    "limb" => Ok(Swivel(TwistReference::Limb)),
                    "stereographic" => {
                        Ok(Swivel(TwistReference::Stereographic(Stereographic::default())))
                    }
                    "transport" => Ok(Swivel(TwistReference::Transport)),
                    _ => Err(E::invalid_value(Unexpected::Str(name), &self)),
                }
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Swivel, A::Error> {
                let Towards { pole } = Towards::deserialize(MapAccessDeserializer::new(map))?;
                Ok(Swivel(TwistReference::Pole(pole.0)))
            }
        }

        deserializer.deserialize_any(SwivelVisitor)
    }
}
