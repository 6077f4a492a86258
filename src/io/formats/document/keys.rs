//! Fields of keyed channels, of their keys and of the timeline in a file, and conversions between
//! these fields and the keys and the timeline of a document.
//!
//! A key is `[seconds, x, …]`, or an object with that row and the shape of its curve.

use std::fmt;

use glam::Vec3;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Deserializer, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Serialize, Serializer};

use super::check;
use crate::document::{Channel, Document, Keys, Overlay, Quantity, Timeline};
use crate::io::json::{FieldError, JsonNumber, JsonObject, JsonPath, JsonSeconds, KeyRow, Whole};
use crate::kinematics::skeleton::JointId;
use crate::kinematics::spline::{Interpolation, Knot, Slopes, Spline};

/// One channel and its keys.
#[derive(Serialize, Deserialize)]
pub struct ChannelFields {
    channel: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    joint: Option<Whole>,
    #[serde(skip_serializing_if = "Option::is_none")]
    overlay: Option<Overlay>,
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
        let joint = channel.joint().and_then(|joint| u32::try_from(joint.index()).ok());
        Self {
            channel: channel.name().to_owned(),
            joint: joint.map(Whole),
            overlay,
            keys: track.knots().iter().map(|key| KeyFields::new(key, width)).collect(),
        }
    }

    fn channel(&self, at: &JsonPath, document: &Document) -> Result<Channel, FieldError> {
        let unknown = || {
            let reason = format!("must be the name of a channel, got {:?}", self.channel);
            FieldError::new(at.clone().key("channel"), reason)
        };
        let any_owner = (Some(JointId::default()), Some(Overlay::Cursor));
        let any = Channel::named(&self.channel, any_owner.0, any_owner.1).ok_or_else(unknown)?;
        let joint = any.joint().map(|_| self.joint(at, document)).transpose()?;
        if matches!(any, Channel::Overlay(_)) && self.overlay.is_none() {
            let reason = "must have `overlay`: each overlay has such a channel";
            return Err(FieldError::new(at.clone(), reason));
        }
        let channel = Channel::named(&self.channel, joint, self.overlay).ok_or_else(unknown)?;
        if let Some(joint) = channel.target()
            && document.skeleton_rig.target(joint).is_none()
        {
            let reason = format!("must be a joint with a target, got {joint}");
            return Err(FieldError::new(at.clone().key("joint"), reason));
        }
        Ok(channel)
    }

    fn joint(&self, at: &JsonPath, document: &Document) -> Result<JointId, FieldError> {
        let missing =
            || FieldError::new(at.clone(), "must have `joint`: each joint has such a channel");
        let joint = self.joint.ok_or_else(missing)?;
        let joints = document.skeleton().joints().len();
        check::joint(at.clone().key("joint"), joint, joints).map(JointId::new)
    }
}

/// Converts the channels of a file to keys. `document` must have all other fields already.
pub fn keys(
    channels: Vec<JsonObject<ChannelFields>>,
    document: &Document,
) -> Result<Keys, FieldError> {
    let mut keys = Keys::default();
    for (index, JsonObject(fields)) in channels.into_iter().enumerate() {
        let at = JsonPath::root().key("channels").index(index);
        let channel = fields.channel(&at, document)?;
        if keys.has(channel) {
            return Err(FieldError::new(at, "channel must have one entry, got a second"));
        }
        for (index, key) in fields.keys.iter().enumerate() {
            let at = at.clone().key("keys").index(index);
            keys.insert_key(channel, key.key(channel.quantity(), &at)?);
        }
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

    pub fn timeline(&self, at: JsonPath) -> Result<Timeline, FieldError> {
        let default = Timeline::default();
        let start = self.start.map_or(default.start, |JsonSeconds(start)| start);
        let timeline = Timeline {
            start,
            end: self.end.map_or(start + default.duration(), |JsonSeconds(end)| end),
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
        Err(FieldError::new(at, reason))
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

impl ShapedKeyFields {
    fn of_row(key: KeyRow) -> Self {
        Self { key, interpolation: None, arriving: None, leaving: None }
    }
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
                let row = KeyRow::deserialize(SeqAccessDeserializer::new(row))?;
                Ok(KeyFields(ShapedKeyFields::of_row(row)))
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
            let numbers = value.to_array().into_iter().take(width);
            numbers.map(JsonNumber).collect::<Vec<_>>()
        };
        let is_smooth = knot.interpolation == Interpolation::Smooth;
        Self(ShapedKeyFields {
            key: KeyRow { time: JsonSeconds(knot.time), values: numbers(knot.value) },
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
        let JsonSeconds(time) = key.time;
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
