//! The protocol of `ik-arm solve`: one line, and the pose that answers it. The fuzzer uses it
//! without the program's windows and commands.

use std::str::Utf8Error;
use std::{fmt, str};

use glam::Vec3;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, Error, MapAccess, Unexpected, Visitor};
use serde::{Deserialize, Serialize};
use serde_path_to_error::{Path, Segment};
use thiserror::Error;

use crate::io::error::{shortened, without_position};
use crate::io::json::{JsonNumber, JsonPoint};
use crate::kinematics::ik::{Ik, IkState};
use crate::kinematics::soft_reach::{SoftReach, SoftReachError, SoftReachField};
use crate::kinematics::twist::{Stereographic, TwistReference, TwistReferenceKind};
use crate::kinematics::two_bone::{LengthError, Reach, TwoBone, TwoBonePose};

/// Solves one line of `ik-arm solve`, given without its line ending. `previous` is the state after
/// the nearest valid line before this one; it becomes the state after this line. An invalid line
/// leaves `previous` unchanged.
///
/// # Errors
///
/// Fails if the line is not a request, or a number in it is out of range; see [`LineError`].
pub fn solve_line(line: &[u8], previous: &mut Option<PreviousLine>) -> Result<Answer, LineError> {
    if line.len() > LineError::MAX_LENGTH {
        return Err(LineError::TooLong);
    }
    let request = Request::parse(line)?;
    let ik = Ik {
        bones: TwoBone::new(request.upper.0, request.lower.0)?,
        reference: request.reference.0,
        soft_reach: request.soft_reach()?,
    };
    // A line with any other reference is solved without the previous line.
    let is_transported = ik.reference == TwistReference::Transport;
    let carried = match previous {
        Some(PreviousLine(state)) if is_transported => *state,
        _ => IkState::default(),
    };
    // Whole turns are removed in degrees, where the remainder is exact. In radians, the remainder
    // of a large angle would be inexact.
    let twist = (request.twist_deg.0 % 360.0).to_radians();
    let solved = ik.solve(request.hand.0, twist, carried);
    let answer = Answer::new(request.root.0, ik.reference, &solved.pose)?;
    *previous = is_transported.then(|| PreviousLine(solved.state()));
    Ok(answer)
}

/// State that a line with the transport reference passes on to the next line: its Pointer, and the
/// frame in which its twist was measured. The Pointer is used if the hand of the next line is at
/// the shoulder, or straight above or below the shoulder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PreviousLine(IkState);

/// The pose that answers a line, written as JSON. Elbow and hand are in world space.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Answer {
    reach: Option<Reach>,
    elbow: Vec3,
    hand: Vec3,
    distance: f32,
    theta_z_deg: f32,
    theta_y_deg: f32,
    theta_e_deg: f32,
    along: f32,
    out: f32,
    /// The gain of the twist reference; `None` if it is infinite.
    reference_gain: Option<f32>,
    elbow_angle_deg: f32,
}

impl Answer {
    /// Returns the answer for an arm whose shoulder is at `root` in the world. Fails if the elbow
    /// or the hand overflows there.
    fn new(root: Vec3, reference: TwistReference, pose: &TwoBonePose) -> Result<Self, LineError> {
        Ok(Self {
            reach: pose.reach,
            elbow: in_world("elbow", root, pose.elbow)?,
            hand: in_world("hand", root, pose.hand)?,
            distance: pose.distance,
            theta_z_deg: pose.yaw().to_degrees(),
            theta_y_deg: pose.pitch().to_degrees(),
            theta_e_deg: pose.shoulder_angle().to_degrees(),
            along: pose.along,
            out: pose.out,
            reference_gain: Some(reference.gain(pose.pointer)).filter(|gain| gain.is_finite()),
            elbow_angle_deg: pose.elbow_angle().to_degrees(),
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

/// The fields of a line.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Request {
    hand: JsonPoint,
    #[serde(default = "default_upper")]
    upper: JsonNumber,
    #[serde(default = "default_lower")]
    lower: JsonNumber,
    #[serde(default)]
    root: JsonPoint,
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
    fn parse(line: &[u8]) -> Result<Self, LineError> {
        let line = str::from_utf8(line).map_err(|error| LineError::not_utf8(line, error))?;
        let mut json = serde_json::Deserializer::from_str(line);
        let RequestObject(request) = serde_path_to_error::deserialize(&mut json)
            .map_err(|error| LineError::not_a_request(line, error.path(), error.inner()))?;
        json.end().map_err(|error| LineError::not_json(line, String::new(), &error))?;
        Ok(request)
    }

    fn soft_reach(&self) -> Result<SoftReach, LineError> {
        let degrees = self.min_elbow_angle_deg.0;
        SoftReach::new(self.softness.0, self.max_stretch.0, degrees.to_radians()).map_err(|error| {
            let SoftReachError { field, value, range } = error;
            let (field, value) = match field {
                SoftReachField::Softness => ("softness", value),
                SoftReachField::MaxStretch => ("max_stretch", value),
                SoftReachField::MinElbowAngle => ("min_elbow_angle_deg", degrees),
            };
            LineError::SoftReach { field, value, range }
        })
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
struct ReferenceField(TwistReference);

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
                let reference = match name.parse() {
                    Ok(TwistReferenceKind::Up) => TwistReference::Up,
                    Ok(TwistReferenceKind::Stereographic) => {
                        TwistReference::Stereographic(Stereographic::default())
                    }
                    Ok(TwistReferenceKind::Transport) => TwistReference::Transport,
                    Ok(TwistReferenceKind::Pole | TwistReferenceKind::Fk) | Err(_) => {
                        return Err(E::invalid_value(Unexpected::Str(name), &self));
                    }
                };
                Ok(ReferenceField(reference))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<ReferenceField, A::Error> {
                let PoleField { pole } = PoleField::deserialize(MapAccessDeserializer::new(map))?;
                Ok(ReferenceField(TwistReference::Pole(pole.0)))
            }
        }

        deserializer.deserialize_any(ReferenceVisitor)
    }
}

/// The reason why a line has no pose. Messages start with the field, if it is known.
#[derive(Debug, Error)]
pub enum LineError {
    /// The line is longer than [`LineError::MAX_LENGTH`].
    #[error("the line must be at most {} KiB long", LineError::MAX_LENGTH >> 10)]
    TooLong,
    /// The line is not UTF-8.
    #[error("the line must be UTF-8, got {byte:#04x} as byte {at}")]
    NotUtf8 {
        /// Position of the first invalid byte in the line, from 1.
        at: usize,
        /// The invalid byte.
        byte: u8,
    },
    /// The line is not JSON.
    #[error("{prefix}not JSON: {reason} (byte {at})")]
    NotJson {
        /// Path of the field with a colon and a space, or empty.
        prefix: String,
        /// The parser's message.
        reason: String,
        /// Number of bytes read when the parser found the error.
        at: usize,
    },
    /// The line is JSON but not a request: a field is missing, unknown or invalid.
    #[error("{prefix}{reason}")]
    NotARequest {
        /// Path of the field with a colon and a space, or empty.
        prefix: String,
        /// The rule that is broken.
        reason: String,
    },
    /// A number overflows.
    #[error("{prefix}must be between -3.4028235e38 and 3.4028235e38, got {number}")]
    OutOfRange {
        /// Path of the field with a colon and a space, or empty.
        prefix: String,
        /// The number as written in the line.
        number: String,
    },
    /// A bone length is not finite or not above 0.
    #[error("{}: must be finite and above 0, got {}", .0.bone, .0.value)]
    Length(#[from] LengthError),
    /// A soft limit is outside its range.
    #[error("{field}: must be {range}, got {value}")]
    SoftReach {
        /// Name of the field.
        field: &'static str,
        /// The refused value, in the field's unit.
        value: f32,
        /// Description of the valid range.
        range: &'static str,
    },
    /// The elbow or the hand overflows in world space.
    #[error("root: must keep the {joint} within ±3.4028235e38, got {:?}", .root.to_array())]
    OutOfWorld {
        /// `elbow` or `hand`.
        joint: &'static str,
        /// Position of the Root in world space.
        root: Vec3,
    },
}

/// Field names of earlier versions, each with the name in this version.
const RENAMED: [(&str, &str); 3] = [
    ("elbow_spin_deg", "twist_deg"),
    ("swivel", "reference"),
    ("min_elbow_deg", "min_elbow_angle_deg"),
];

impl LineError {
    /// Maximum length of a line in bytes, without its line ending.
    pub const MAX_LENGTH: usize = 64 * 1024;

    /// The error's text. Of a long text, only the start and the end are returned.
    pub fn message(&self) -> String {
        shortened(self.to_string())
    }

    fn not_utf8(line: &[u8], error: Utf8Error) -> Self {
        let valid = error.valid_up_to();
        Self::NotUtf8 { at: valid + 1, byte: line.get(valid).copied().unwrap_or_default() }
    }

    fn not_a_request(line: &str, path: &Path, error: &serde_json::Error) -> Self {
        let reason = renamed(without_position(error));
        let prefix = prefix(path, &reason);
        // serde_json identifies this error by its text alone.
        if reason == "number out of range" {
            let number = word_around(line, error.column()).to_owned();
            return Self::OutOfRange { prefix, number };
        }
        if error.is_data() {
            return Self::NotARequest { prefix, reason };
        }
        Self::not_json(line, prefix, error)
    }

    fn not_json(line: &str, prefix: String, error: &serde_json::Error) -> Self {
        let (reason, at) = (without_position(error), error.column());
        match word_around(line, at) {
            "" => Self::NotJson { prefix, reason, at },
            word => Self::NotJson { prefix, reason: format!("{reason}, found `{word}`"), at },
        }
    }
}

/// Returns `reason`, unless it is about an unknown field that was renamed. Then the result has the
/// field's new name instead of the list of all fields.
fn renamed(reason: String) -> String {
    let is_unknown =
        |(old, _): &&(&str, &str)| reason.starts_with(&format!("unknown field `{old}`"));
    match RENAMED.iter().find(is_unknown) {
        Some((old, new)) => format!("unknown field `{old}`; it is called `{new}`"),
        None => reason,
    }
}

/// The path of the invalid field with a colon and a space. Empty if the path is unknown or `reason`
/// already contains it.
fn prefix(path: &Path, reason: &str) -> String {
    let is_known = path.iter().len() > 0 && !path.iter().any(|s| matches!(s, Segment::Unknown));
    if !is_known || reason.contains(&format!("`{path}`")) {
        return String::new();
    }
    format!("{path}: ")
}

/// The word around byte `read` of the line, up to the nearest space or punctuation on both sides.
fn word_around(line: &str, read: usize) -> &str {
    let in_word = |c: char| !(c.is_whitespace() || r#",:[]{}""#.contains(c));
    let (before, after) = line.split_at_checked(read).unwrap_or((line, ""));
    let start = before.trim_end_matches(in_word).len();
    let end = line.len() - after.trim_start_matches(in_word).len();
    &line[start..end]
}
