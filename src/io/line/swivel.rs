//! What a line measures its elbow's spin from.

use std::fmt;

use serde::Deserialize;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, Error, MapAccess, Unexpected, Visitor};

use crate::io::value::Point;
use crate::kinematics::swivel::{Reference, Stereographic};

/// A name, or an object with a pole.
#[derive(Default)]
pub struct Swivel(pub Reference);

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
                    "limb" => Ok(Swivel(Reference::Limb)),
                    "stereographic" => {
                        Ok(Swivel(Reference::Stereographic(Stereographic::default())))
                    }
                    "transport" => Ok(Swivel(Reference::Transport)),
                    _ => Err(E::invalid_value(Unexpected::Str(name), &self)),
                }
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Swivel, A::Error> {
                let Towards { pole } = Towards::deserialize(MapAccessDeserializer::new(map))?;
                Ok(Swivel(Reference::Pole(pole.0)))
            }
        }

        deserializer.deserialize_any(SwivelVisitor)
    }
}
