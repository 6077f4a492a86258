//! A key in a file: `[seconds, x, …]`, or an object with that row and the shape of its curve.

use std::fmt;

use glam::Vec3;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Deserializer, MapAccess, SeqAccess, Visitor};
use serde::ser::Serializer;
use serde::{Deserialize, Serialize};

use crate::document::Quantity;
use crate::io::json::FieldError;
use crate::io::json::JsonPath;
use crate::io::json::{JsonNumber, KeyRow, Seconds};
use crate::kinematics::spline::{Interpolation, Knot, Slopes};

/// A key. Without interpolation and slopes of its own, it is written as its row alone.
pub struct KeyFields(ShapedKeyFields);

#[derive(Serialize, Deserialize)]
struct ShapedKeyFields {
    key: KeyRow,
    #[serde(skip_serializing_if = "Option::is_none")]
    interpolation: Option<Interpolation>,
    #[serde(skip_serializing_if = "Option::is_none")]
    arriving: Option<Vec<JsonNumber>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    leaving: Option<Vec<JsonNumber>>,
}

impl ShapedKeyFields {
    fn of_row(key: KeyRow) -> Self {
        Self { key, interpolation: None, arriving: None, leaving: None }
    }
}

impl<'de> Deserialize<'de> for KeyFields {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct KeyVisitor;

        impl<'de> Visitor<'de> for KeyVisitor {
            type Value = KeyFields;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a time and the value at it: [seconds, x, …], or an object with `key`")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, row: A) -> Result<KeyFields, A::Error> {
                let row = KeyRow::deserialize(SeqAccessDeserializer::new(row))?;
                Ok(KeyFields(ShapedKeyFields::of_row(row)))
            }

            fn visit_map<A: MapAccess<'de>>(self, fields: A) -> Result<KeyFields, A::Error> {
                ShapedKeyFields::deserialize(MapAccessDeserializer::new(fields)).map(KeyFields)
            }
        }

        deserializer.deserialize_any(KeyVisitor)
    }
}

impl Serialize for KeyFields {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let ShapedKeyFields { key, interpolation, arriving, leaving } = &self.0;
        match (interpolation, arriving, leaving) {
            (None, None, None) => key.serialize(serializer),
            _ => self.0.serialize(serializer),
        }
    }
}

impl KeyFields {
    /// The fields of a key whose values have `width` components.
    pub fn new(knot: &Knot<Vec3>, width: usize) -> Self {
        let numbers = |value: Vec3| {
            let numbers = value.to_array().into_iter().take(width);
            numbers.map(JsonNumber).collect::<Vec<_>>()
        };
        let is_smooth = knot.interpolation == Interpolation::Smooth;
        Self(ShapedKeyFields {
            key: KeyRow { time: Seconds(knot.time), values: numbers(knot.value) },
            interpolation: (!is_smooth).then_some(knot.interpolation),
            arriving: knot.slopes.map(|slopes| numbers(slopes.arriving)),
            leaving: knot.slopes.map(|slopes| numbers(slopes.leaving)),
        })
    }

    /// The key of a channel with a kind of value; `at` is the place of these fields.
    pub fn key(&self, quantity: Quantity, at: &JsonPath) -> Result<Knot<Vec3>, FieldError> {
        let ShapedKeyFields { key, interpolation, arriving, leaving } = &self.0;
        let value = value(quantity, key).map_err(|reason| FieldError::new(at.clone(), reason))?;
        let slope = |name: &str, slope: &Option<Vec<JsonNumber>>| {
            let slope = slope.as_ref().map(|slope| vector(quantity, slope)).transpose();
            slope.map_err(|reason| FieldError::new(at.clone().key(name), reason))
        };
        let slopes = match (slope("arriving", arriving)?, slope("leaving", leaving)?) {
            (None, None) => None,
            (Some(arriving), Some(leaving)) => Some(Slopes { arriving, leaving }),
            (Some(slope), None) | (None, Some(slope)) => {
                Some(Slopes { arriving: slope, leaving: slope })
            }
        };
        let Seconds(time) = key.time;
        Ok(Knot { time, value, interpolation: interpolation.unwrap_or_default(), slopes })
    }
}

fn value(quantity: Quantity, row: &KeyRow) -> Result<Vec3, String> {
    let value = vector(quantity, &row.values).map_err(|_| {
        let numbers = if quantity.width() == 1 { "one number" } else { "three numbers" };
        format!("must have {numbers} after the time, got {}", row.values.len())
    })?;
    let x = value.x;
    match quantity {
        Quantity::Switch if x != 0.0 && x != 1.0 => Err(format!("switch must be 0 or 1, got {x}")),
        Quantity::Fraction if !(0.0..=1.0).contains(&x) => {
            Err(format!("fraction must be from 0 to 1, got {x}"))
        }
        Quantity::Length if x <= 0.0 => Err(format!("length must be above 0, got {x}")),
        _ => Ok(value),
    }
}

/// The numbers as a vector; the components that the quantity does not have are 0.
fn vector(quantity: Quantity, numbers: &[JsonNumber]) -> Result<Vec3, String> {
    let width = quantity.width();
    if numbers.len() != width {
        let wanted = if width == 1 { "one number" } else { "three numbers" };
        return Err(format!("must have {wanted}, got {}", numbers.len()));
    }
    let mut vector = [0.0; 3];
    for (component, JsonNumber(number)) in vector.iter_mut().zip(numbers) {
        *component = *number;
    }
    Ok(Vec3::from_array(vector))
}
