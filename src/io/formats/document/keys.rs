//! Fields of keyed channels and of the timeline in a file, and conversions between these fields and
//! the keys and the timeline of a document.

use glam::Vec3;
use serde::{Deserialize, Serialize, Serializer};

use super::check;
use super::key::KeyFields;
use crate::document::{Channel, Document, Keys, Overlay, Timeline};
use crate::io::json::FieldError;
use crate::io::json::JsonPath;
use crate::io::json::{JsonObject, Seconds, Whole};
use crate::kinematics::skeleton::JointId;
use crate::kinematics::spline::Spline;

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
    start: Option<Seconds>,
    end: Option<Seconds>,
    frame_rate: Option<FramesPerSecond>,
}

/// Frames per second; a whole number is written without a decimal point.
#[derive(Clone, Copy, Deserialize)]
struct FramesPerSecond(f64);

impl Serialize for FramesPerSecond {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self(rate) = *self;
        let whole = rate as u32;
        match f64::from(whole) == rate {
            true => serializer.serialize_u32(whole),
            false => Seconds(rate).serialize(serializer),
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
            start: Some(Seconds(timeline.start)),
            end: Some(Seconds(timeline.end)),
            frame_rate: Some(FramesPerSecond(timeline.frame_rate)),
        }
    }

    pub fn timeline(&self, at: JsonPath) -> Result<Timeline, FieldError> {
        let default = Timeline::default();
        let start = self.start.map_or(default.start, |Seconds(start)| start);
        let timeline = Timeline {
            start,
            end: self.end.map_or(start + default.duration(), |Seconds(end)| end),
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
