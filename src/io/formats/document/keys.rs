//! Fields of keyed channels, of their keys and of the timeline in a file, and conversions between
//! these fields and the keys and the timeline of a document.
//!
//! A key is `[seconds, x, …]`, or an object with that row and the shape of its curve.

use std::fmt;

use glam::Vec3;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Deserializer, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Serialize, Serializer};

use super::skeleton::joint;
use crate::document::{Channel, Document, Keys, Overlay, Quantity, Timeline};
use crate::io::json::{
    AtField, FieldError, JsonNumber, JsonObject, JsonSeconds, KeyRow, Whole, value_or,
};
use crate::kinematics::skeleton::JointId;
use crate::kinematics::skin::Morph;
use crate::kinematics::spline::{Interpolation, Knot, Slopes, Spline};

/// One channel and its keys.
#[derive(Serialize, Deserialize)]
pub struct ChannelFields {
    pub channel: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    joint: Option<Whole>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub overlay: Option<Overlay>,
    /// Index of a morph target of the skin.
    #[serde(skip_serializing_if = "Option::is_none")]
    morph: Option<Whole>,
    keys: Vec<KeyFields>,
}

#[derive(Serialize, Deserialize)]
pub struct TimelineFields {
    start: Option<JsonSeconds>,
    end: Option<JsonSeconds>,
    frame_rate: Option<FramesPerSecond>,
}

/// Frames per second; a whole number is written without a decimal point.
#[derive(Clone, Copy, Deserialize)]
struct FramesPerSecond(f64);

impl Serialize for FramesPerSecond {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self(rate) = *self;
        let whole = rate as u32;
        if f64::from(whole) == rate {
            serializer.serialize_u32(whole)
        } else {
            JsonSeconds(rate).serialize(serializer)
        }
    }
}

impl ChannelFields {
    pub fn all(keys: &Keys) -> Vec<JsonObject<Self>> {
        keys.tracks().map(|(channel, track)| JsonObject(Self::new(channel, track))).collect()
    }

    fn new(channel: Channel, track: &Spline<Vec3>) -> Self {
        let overlay = match channel {
            Channel::Overlay(overlay) => Some(overlay),
            _ => None,
        };
        let width = channel.quantity().width();
        Self {
            channel: channel.name().to_owned(),
            joint: channel.joint().map(Whole::from),
            overlay,
            morph: match channel {
                Channel::Morph(morph) => Some(Whole(morph.into())),
                _ => None,
            },
            keys: track.knots().iter().map(|key| KeyFields::new(key, width)).collect(),
        }
    }

    fn channel(&self, document: &Document) -> Result<Channel, FieldError> {
        let named = |joint, overlay, morph| {
            let unknown = || format!("must be the name of a channel, got {:?}", self.channel);
            let named = Channel::named(&self.channel, joint, overlay, morph);
            named.ok_or_else(unknown).at("channel")
        };
        let any = named(Some(JointId::default()), Some(Overlay::Cursor), Some(0))?;
        let joint = any.joint().map(|_| self.joint(document)).transpose()?;
        if matches!(any, Channel::Overlay(_)) && self.overlay.is_none() {
            return Err("must have `overlay`: each overlay has such a channel".into());
        }
        if matches!(any, Channel::Morph(_)) && self.morph.is_none() {
            return Err("must have `morph`: each morph target has such a channel".into());
        }
        let channel = named(joint, self.overlay, self.morph.map(morph).transpose()?)?;
        match channel.target() {
            Some(joint) if document.rig.target(joint).is_none() => {
                Err(format!("must be a joint with a target, got {joint}")).at("joint")
            }
            _ => Ok(channel),
        }
    }

    /// The keys, for values of a kind.
    pub fn knots(&self, quantity: Quantity) -> Result<Vec<Knot<Vec3>>, FieldError> {
        let keys = self.keys.iter().enumerate();
        keys.map(|(index, key)| key.key(quantity).at(index).at("keys")).collect()
    }

    fn joint(&self, document: &Document) -> Result<JointId, FieldError> {
        let number = self.joint.ok_or("must have `joint`: each joint has such a channel")?;
        joint(number, document.skeleton().joints().len()).at("joint")
    }
}

/// The index of a morph target. The skin that has it may be in a file that is read later.
fn morph(Whole(index): Whole) -> Result<u16, FieldError> {
    let most = Morph::MOST - 1;
    let index = u16::try_from(index).ok().filter(|index| usize::from(*index) <= most);
    index.ok_or_else(|| format!("must be at most {most}")).at("morph")
}

/// Converts the channels of a file to keys. `document` must have all other fields already.
pub fn keys(
    channels: Vec<JsonObject<ChannelFields>>,
    document: &Document,
) -> Result<Keys, FieldError> {
    let mut keys = Keys::default();
    for (index, JsonObject(fields)) in channels.into_iter().enumerate() {
        let channel = fields.channel(document).at(index)?;
        if keys.has(channel) {
            return Err("channel must have one entry, got a second").at(index);
        }
        let knots = fields.knots(channel.quantity()).at(index)?;
        knots.into_iter().for_each(|knot| keys.insert_key(channel, knot));
    }
    Ok(keys)
}

impl TimelineFields {
    pub fn new(timeline: Timeline) -> Self {
        Self {
            start: Some(JsonSeconds(timeline.start)),
            end: Some(JsonSeconds(timeline.end)),
            frame_rate: Some(FramesPerSecond(timeline.frame_rate)),
        }
    }

    pub fn timeline(self) -> Result<Timeline, FieldError> {
        let default = Timeline::default();
        let start = value_or(self.start, default.start);
        let timeline = Timeline {
            start,
            end: value_or(self.end, start + default.duration()),
            frame_rate: self.frame_rate.map_or(default.frame_rate, |FramesPerSecond(rate)| rate),
        };
        if timeline.is_valid() {
            return Ok(timeline);
        }
        let Timeline { start, end, frame_rate } = timeline;
        let reason = format!(
            "must start before it ends, within ±{} s, at {} to {} frames a second, got {start} s to \
             {end} s at {frame_rate}",
            Timeline::MAX_TIME,
            Timeline::MIN_FRAME_RATE,
            Timeline::MAX_FRAME_RATE,
        );
        Err(reason.into())
    }
}

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

impl<'de> Deserialize<'de> for KeyFields {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct KeyFieldsVisitor;

        impl<'de> Visitor<'de> for KeyFieldsVisitor {
            type Value = KeyFields;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a time and the value at it: [seconds, x, …], or an object with `key`")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, row: A) -> Result<KeyFields, A::Error> {
                let key = KeyRow::deserialize(SeqAccessDeserializer::new(row))?;
                let (interpolation, arriving, leaving) = (None, None, None);
                Ok(KeyFields(ShapedKeyFields { key, interpolation, arriving, leaving }))
            }

            fn visit_map<A: MapAccess<'de>>(self, fields: A) -> Result<KeyFields, A::Error> {
                ShapedKeyFields::deserialize(MapAccessDeserializer::new(fields)).map(KeyFields)
            }
        }

        deserializer.deserialize_any(KeyFieldsVisitor)
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
            value.to_array().into_iter().take(width).map(JsonNumber).collect::<Vec<_>>()
        };
        let is_smooth = knot.interpolation == Interpolation::Smooth;
        Self(ShapedKeyFields {
            key: KeyRow { time: JsonSeconds(knot.time), values: numbers(knot.value) },
            interpolation: (!is_smooth).then_some(knot.interpolation),
            arriving: knot.slopes.map(|slopes| numbers(slopes.arriving)),
            leaving: knot.slopes.map(|slopes| numbers(slopes.leaving)),
        })
    }

    /// The key of a channel with a kind of value.
    pub fn key(&self, quantity: Quantity) -> Result<Knot<Vec3>, FieldError> {
        let ShapedKeyFields { key, interpolation, arriving, leaving } = &self.0;
        let slope = |name: &str, slope: &Option<Vec<JsonNumber>>| {
            slope.as_ref().map(|slope| vector(quantity, slope).at(name)).transpose()
        };
        let value = value(quantity, key)?;
        let (arriving, leaving) = (slope("arriving", arriving)?, slope("leaving", leaving)?);
        let slopes = arriving.or(leaving).map(|either| Slopes {
            arriving: arriving.unwrap_or(either),
            leaving: leaving.unwrap_or(either),
        });
        let JsonSeconds(time) = key.time;
        Ok(Knot { time, value, interpolation: interpolation.unwrap_or_default(), slopes })
    }
}

fn value(quantity: Quantity, row: &KeyRow) -> Result<Vec3, String> {
    let value = vector(quantity, &row.values).map_err(|_| {
        let (numbers, got) = (numbers_of(quantity), row.values.len());
        format!("must have {numbers} after the time, got {got}")
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
    if numbers.len() != quantity.width() {
        return Err(format!("must have {}, got {}", numbers_of(quantity), numbers.len()));
    }
    let mut vector = [0.0; 3];
    for (component, JsonNumber(number)) in vector.iter_mut().zip(numbers) {
        *component = *number;
    }
    Ok(Vec3::from_array(vector))
}

/// The count of numbers of a quantity, in words.
fn numbers_of(quantity: Quantity) -> &'static str {
    if quantity.width() == 1 { "one number" } else { "three numbers" }
}
