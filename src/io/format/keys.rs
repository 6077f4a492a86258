//! Keys and timeline as they stand in a file, and from there to a document and back.

use glam::Vec3;
use serde::{Deserialize, Serialize};

use super::check::counted;
use crate::document::{self, Channel, Document, Keys, Overlay, Quantity};
use crate::io::json_path::JsonPath;
use crate::io::source::Wrong;
use crate::io::value::{Knot, Number, Object, Seconds, Whole};
use crate::kinematics::spline::Spline;

#[derive(Serialize, Deserialize)]
pub struct Track {
    channel: Name,
    #[serde(skip_serializing_if = "Option::is_none")]
    joint: Option<Whole>,
    #[serde(skip_serializing_if = "Option::is_none")]
    layer: Option<Overlay>,
    knots: Vec<Knot>,
}

#[derive(Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Name {
    Hand,
    ElbowSpin,
    Root,
    Upper,
    Lower,
    Pin,
    Pole,
    Weight,
    Shoulder,
    Bend,
    Stretch,
    Wrist,
    Translation,
    Rotation,
    Offset,
    Target,
    Enabled,
    Layer,
}

#[derive(Serialize, Deserialize)]
pub struct Timeline {
    start: Option<Seconds>,
    end: Option<Seconds>,
    frame_rate: Option<Whole>,
}

pub fn tracks(keys: &Keys) -> Vec<Object<Track>> {
    keys.tracks().map(|(channel, track)| Object(Track::new(channel, track))).collect()
}

impl Track {
    fn new(channel: Channel, track: &Spline<Vec3>) -> Self {
        let (name, layer) = match channel {
            Channel::Hand => (Name::Hand, None),
            Channel::Twist => (Name::ElbowSpin, None),
            Channel::Root => (Name::Root, None),
            Channel::Upper => (Name::Upper, None),
            Channel::Lower => (Name::Lower, None),
            Channel::Pin => (Name::Pin, None),
            Channel::Pole => (Name::Pole, None),
            Channel::Influence => (Name::Weight, None),
            Channel::Shoulder => (Name::Shoulder, None),
            Channel::Bend => (Name::Bend, None),
            Channel::Stretch => (Name::Stretch, None),
            Channel::Wrist => (Name::Wrist, None),
            Channel::Translation => (Name::Translation, None),
            Channel::Rotation(_) => (Name::Rotation, None),
            Channel::Offset(_) => (Name::Offset, None),
            Channel::Target(_) => (Name::Target, None),
            Channel::Enabled(_) => (Name::Enabled, None),
            Channel::Overlay(layer) => (Name::Layer, Some(layer)),
        };
        let width = channel.quantity().width();
        let knot = |time, value: Vec3| Knot {
            time: Seconds(time),
            values: value.to_array().into_iter().take(width).map(Number).collect(),
        };
        let joint = channel.joint().and_then(|joint| u32::try_from(joint).ok());
        Self {
            channel: name,
            joint: joint.map(Whole),
            layer,
            knots: track.knots().iter().map(|it| knot(it.time, it.value)).collect(),
        }
    }

    fn channel(&self, at: &JsonPath, document: &Document) -> Result<Channel, Wrong> {
        let joint = || {
            let missing =
                || Wrong::new(at.clone(), "this channel is a joint's: `joint` is missing");
            let joint = self.joint.ok_or_else(missing)?.0 as usize;
            let joints = document.skeleton().joints().len();
            if joint < joints {
                return Ok(joint);
            }
            let reason = format!("there is no joint {joint}; {}", counted(joints));
            Err(Wrong::new(at.clone().key("joint"), reason))
        };
        let target = || {
            let joint = joint()?;
            let none = || format!("joint {joint} has no target");
            let target = document.skeleton_rig.target(joint);
            target.ok_or_else(|| Wrong::new(at.clone().key("joint"), none()))?;
            Ok(joint)
        };
        Ok(match self.channel {
            Name::Hand => Channel::Hand,
            Name::ElbowSpin => Channel::Twist,
            Name::Root => Channel::Root,
            Name::Upper => Channel::Upper,
            Name::Lower => Channel::Lower,
            Name::Pin => Channel::Pin,
            Name::Pole => Channel::Pole,
            Name::Weight => Channel::Influence,
            Name::Shoulder => Channel::Shoulder,
            Name::Bend => Channel::Bend,
            Name::Stretch => Channel::Stretch,
            Name::Wrist => Channel::Wrist,
            Name::Translation => Channel::Translation,
            Name::Rotation => Channel::Rotation(joint()?),
            Name::Offset => Channel::Offset(joint()?),
            Name::Target => Channel::Target(target()?),
            Name::Enabled => Channel::Enabled(target()?),
            Name::Layer => Channel::Overlay(self.layer.ok_or_else(|| {
                Wrong::new(at.clone(), "this channel is a layer's: `layer` is missing")
            })?),
        })
    }
}

impl Timeline {
    pub fn new(timeline: document::Timeline) -> Self {
        Self {
            start: Some(Seconds(timeline.start)),
            end: Some(Seconds(timeline.end)),
            frame_rate: Some(Whole(timeline.frame_rate)),
        }
    }
}

/// The keys of a document that has all but them.
pub fn keys(tracks: Vec<Object<Track>>, document: &Document) -> Result<Keys, Wrong> {
    let mut keys = Keys::default();
    for (index, Object(track)) in tracks.into_iter().enumerate() {
        let at = JsonPath::root().key("keys").index(index);
        let channel = track.channel(&at, document)?;
        if keys.has(channel) {
            return Err(Wrong::new(at, "another entry has keys of the same channel"));
        }
        for (index, knot) in track.knots.iter().enumerate() {
            let value = value(channel.quantity(), knot)
                .map_err(|reason| Wrong::new(at.clone().key("knots").index(index), reason))?;
            keys.insert(channel, knot.time.0, value);
        }
    }
    Ok(keys)
}

fn value(quantity: Quantity, knot: &Knot) -> Result<Vec3, String> {
    let width = quantity.width();
    if knot.values.len() != width {
        let numbers = if width == 1 { "one number" } else { "three numbers" };
        let found = knot.values.len();
        return Err(format!("found {found} after the time, expected {numbers}"));
    }
    let mut value = [0.0; 3];
    for (place, Number(number)) in value.iter_mut().zip(&knot.values) {
        *place = *number;
    }
    let x = value[0];
    match quantity {
        Quantity::Switch if x != 0.0 && x != 1.0 => Err(format!("{x} is no switch; it is 0 or 1")),
        Quantity::Fraction if !(0.0..=1.0).contains(&x) => {
            Err(format!("{x} is no part; it is from 0 to 1"))
        }
        Quantity::Length if x <= 0.0 => Err(format!("length {x} must be above 0")),
        _ => Ok(Vec3::from_array(value)),
    }
}

pub fn timeline(at: JsonPath, file: &Timeline) -> Result<document::Timeline, Wrong> {
    let seed = document::Timeline::default();
    let start = file.start.map_or(seed.start, |Seconds(start)| start);
    let timeline = document::Timeline {
        start,
        end: file.end.map_or(start + seed.duration(), |Seconds(end)| end),
        frame_rate: file.frame_rate.map_or(seed.frame_rate, |Whole(rate)| rate),
    };
    if timeline.is_valid() {
        return Ok(timeline);
    }
    let reason = format!(
        "must start before it ends, within {} s of 0, and have 1 to {} frames in a second",
        document::Timeline::FARTHEST,
        document::Timeline::HIGHEST_FRAME_RATE,
    );
    Err(Wrong::new(at, reason))
}
