//! One line of `ik-arm solve`: what it asks for, and the pose that it gets.

use std::fmt;
use std::str::{self, Utf8Error};

use glam::Vec3;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, MapAccess, Visitor};
use serde::{Deserialize, Serialize};
use serde_path_to_error::{Path, Segment};
use thiserror::Error;

use crate::io::error::shortened;
use crate::io::value::{Number, Point};
use crate::kinematics::two_bone::{LengthError, Pose, Reach, TwoBone};

/// Solves one line, given without its end.
pub fn solve(line: &[u8]) -> Result<Answer, LineError> {
    Request::parse(line)?.answer()
}

/// What a line asks for.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Request {
    hand: Point,
    #[serde(default = "default_upper")]
    upper: Number,
    #[serde(default = "default_lower")]
    lower: Number,
    #[serde(default)]
    root: Point,
    #[serde(default)]
    elbow_spin_deg: Number,
}

fn default_upper() -> Number {
    Number(200.0)
}

fn default_lower() -> Number {
    Number(300.0)
}

impl Request {
    fn parse(line: &[u8]) -> Result<Self, LineError> {
        let line = str::from_utf8(line).map_err(|error| LineError::not_utf8(line, error))?;
        let mut json = serde_json::Deserializer::from_str(line);
        let Object(request) = serde_path_to_error::deserialize(&mut json)
            .map_err(|error| LineError::not_a_request(line, error.path(), error.inner()))?;
        json.end().map_err(|error| LineError::not_json(line, String::new(), &error))?;
        Ok(request)
    }

    fn answer(&self) -> Result<Answer, LineError> {
        let arm = TwoBone::new(self.upper.0, self.lower.0)?;
        // In degrees the remainder is exact; in radians a big spin would lose its turns.
        let spin = (self.elbow_spin_deg.0 % 360.0).to_radians();
        Answer::new(self.root.0, &arm.solve(self.hand.0, spin))
    }
}

/// The pose that a line gets.
#[derive(Debug, Serialize)]
pub struct Answer {
    reach: &'static str,
    elbow: Vec3,
    hand: Vec3,
    distance: f32,
    theta_z_deg: f32,
    theta_y_deg: f32,
    theta_e_deg: f32,
    along: f32,
    out: f32,
}

impl Answer {
    fn new(root: Vec3, pose: &Pose) -> Result<Self, LineError> {
        Ok(Self {
            reach: match pose.reach {
                Reach::Reached => "reached",
                Reach::TooFar => "too_far",
                Reach::TooClose => "too_close",
            },
            elbow: in_world("elbow", root, pose.elbow)?,
            hand: in_world("hand", root, pose.hand)?,
            distance: pose.distance,
            theta_z_deg: pose.yaw().to_degrees(),
            theta_y_deg: pose.pitch().to_degrees(),
            theta_e_deg: pose.shoulder_angle().to_degrees(),
            along: pose.along,
            out: pose.out,
        })
    }
}

fn in_world(joint: &'static str, root: Vec3, joint_root: Vec3) -> Result<Vec3, LineError> {
    let joint_world = root + joint_root;
    if !joint_world.is_finite() {
        return Err(LineError::OutOfWorld { joint, root });
    }
    Ok(joint_world)
}

/// A line's object. The derived code alone would take an array, too.
struct Object(Request);

impl<'de> Deserialize<'de> for Object {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ObjectVisitor;

        impl<'de> Visitor<'de> for ObjectVisitor {
            type Value = Object;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(r#"an object like {"hand":[250,120,60]}"#)
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Object, A::Error> {
                Request::deserialize(MapAccessDeserializer::new(map)).map(Object)
            }
        }

        deserializer.deserialize_map(ObjectVisitor)
    }
}

/// Why a line has no pose. `place` is empty or ends in a colon and a space.
#[derive(Debug, Error)]
pub enum LineError {
    #[error("the line is longer than 64 KiB; a pose needs far less")]
    TooLong,
    #[error("byte {at} is {byte:#04x}, which is not UTF-8 there; JSON is written in UTF-8")]
    NotUtf8 { at: usize, byte: u8 },
    #[error("{place}not JSON: {reason} (byte {at})")]
    NotJson { place: String, reason: String, at: usize },
    #[error("{place}{reason}")]
    NotARequest { place: String, reason: String },
    #[error("{place}{number} is out of range; it must be between -3.4028235e38 and 3.4028235e38")]
    OutOfRange { place: String, number: String },
    #[error("{}: length is {}; it must be a finite number above 0", .0.bone, .0.value)]
    Length(#[from] LengthError),
    #[error("root: {:?} puts the {joint} beyond 3.4028235e38; bring it nearer to 0", .root.to_array())]
    OutOfWorld { joint: &'static str, root: Vec3 },
}

impl LineError {
    pub fn message(&self) -> String {
        shortened(self.to_string())
    }

    fn not_utf8(line: &[u8], error: Utf8Error) -> Self {
        let valid = error.valid_up_to();
        Self::NotUtf8 { at: valid + 1, byte: line.get(valid).copied().unwrap_or_default() }
    }

    fn not_a_request(line: &str, path: &Path, error: &serde_json::Error) -> Self {
        let reason = without_position(error);
        let place = place(path, &reason);
        // serde_json has no other way to tell this error from the rest.
        if reason == "number out of range" {
            let number = word_around(line, error.column()).to_owned();
            return Self::OutOfRange { place, number };
        }
        if error.is_data() {
            return Self::NotARequest { place, reason };
        }
        Self::not_json(line, place, error)
    }

    fn not_json(line: &str, place: String, error: &serde_json::Error) -> Self {
        let (reason, at) = (without_position(error), error.column());
        match word_around(line, at) {
            "" => Self::NotJson { place, reason, at },
            word => Self::NotJson { place, reason: format!("{reason}, found `{word}`"), at },
        }
    }
}

/// The parser counts lines too, and would always say "line 1".
fn without_position(error: &serde_json::Error) -> String {
    let position = format!(" at line {} column {}", error.line(), error.column());
    let text = error.to_string();
    text.strip_suffix(&position).unwrap_or(&text).to_owned()
}

/// The field that an error is about, unless the reason names it already or nobody knows it.
fn place(path: &Path, reason: &str) -> String {
    let known = path.iter().len() > 0 && !path.iter().any(|s| matches!(s, Segment::Unknown));
    if !known || reason.contains(&format!("`{path}`")) {
        return String::new();
    }
    format!("{path}: ")
}

/// What stands where the parser was when it had read `read` bytes, up to the next punctuation.
fn word_around(line: &str, read: usize) -> &str {
    let in_word = |c: char| !(c.is_whitespace() || r#",:[]{}""#.contains(c));
    let (before, after) = line.split_at_checked(read).unwrap_or((line, ""));
    let start = before.trim_end_matches(in_word).len();
    let end = line.len() - after.trim_start_matches(in_word).len();
    &line[start..end]
}
