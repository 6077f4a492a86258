//! One line of `ik-arm solve`: what it asks for, and the pose that it gets.

mod error;
mod twist;

use std::fmt;
use std::str;

use glam::Vec3;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, MapAccess, Visitor};
use serde::{Deserialize, Serialize};

use super::value::{Number, Point};
use crate::kinematics::ik::{Ik, Solved};
use crate::kinematics::soft_reach::{SoftReach, SoftReachError};
use crate::kinematics::twist::{TransportedFrame, TwistReference};
use crate::kinematics::two_bone::{Facing, Reach, TwoBone};
pub use error::LineError;
use twist::Swivel;

/// The longest line, in bytes and without its end: what a line may ask of the memory.
pub const LONGEST_LINE: usize = 64 * 1024;

/// Solves one line of `ik-arm solve`, given without its end. `past` is what the good line before it
/// left, and becomes what this one leaves; a bad line changes nothing.
///
/// # Errors
///
/// If the line is no request, or one that no arm can meet; see [`LineError`].
pub fn solve_line(line: &[u8], past: &mut Option<Past>) -> Result<Answer, LineError> {
    if line.len() > LONGEST_LINE {
        return Err(LineError::TooLong);
    }
    let request = Request::parse(line)?;
    let ik = request.ik()?;
    // Only what is transported has a past: any other line is solved on its own.
    let is_carried = ik.reference == TwistReference::Transport;
    let solved = request.solve(ik, past.filter(|_| is_carried));
    let answer = Answer::new(request.root.0, ik.reference, &solved)?;
    *past = is_carried.then(|| Past::new(&solved));
    Ok(answer)
}

/// What a transported line leaves to the next: where its arm faced, for a hand that says nothing of
/// that (at the shoulder, or straight above or below it), and what its elbow was measured from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Past {
    facing: Facing,
    carried: TransportedFrame,
}

impl Past {
    fn new(solved: &Solved) -> Self {
        Self { facing: solved.pose.facing, carried: solved.transported }
    }
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
    #[serde(default)]
    swivel: Swivel,
    #[serde(default)]
    softness: Number,
    #[serde(default = "default_max_stretch")]
    max_stretch: Number,
    #[serde(default)]
    min_elbow_deg: Number,
}

fn default_upper() -> Number {
    Number(200.0)
}

fn default_lower() -> Number {
    Number(300.0)
}

fn default_max_stretch() -> Number {
    Number(1.0)
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

    fn ik(&self) -> Result<Ik, LineError> {
        Ok(Ik {
            bones: TwoBone::new(self.upper.0, self.lower.0)?,
            reference: self.swivel.0,
            soft_reach: self.softening()?,
        })
    }

    fn softening(&self) -> Result<SoftReach, LineError> {
        let degrees = self.min_elbow_deg.0;
        SoftReach::new(self.softness.0, self.max_stretch.0, degrees.to_radians()).map_err(|error| {
            let SoftReachError { field, value, range } = error;
            match field {
                "min_elbow_angle" => {
                    LineError::SoftReach { field: "min_elbow_deg", value: degrees, range }
                }
                _ => LineError::SoftReach { field, value, range },
            }
        })
    }

    fn solve(&self, ik: Ik, past: Option<Past>) -> Solved {
        // In degrees the remainder is exact; in radians a big spin would lose its turns.
        let spin = (self.elbow_spin_deg.0 % 360.0).to_radians();
        let last = past.map_or_else(Facing::default, |past| past.facing);
        ik.solve(self.hand.0, spin, last, past.map(|past| past.carried))
    }
}

/// The pose that a line gets, to be written as JSON; elbow and hand are in the world.
#[derive(Clone, Debug, PartialEq, Serialize)]
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
    /// Nothing where it is infinite.
    swivel_gain: Option<f32>,
    elbow_angle_deg: f32,
}

impl Answer {
    fn new(root: Vec3, reference: TwistReference, solved: &Solved) -> Result<Self, LineError> {
        let pose = &solved.pose;
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
            swivel_gain: Some(reference.gain(pose.facing)).filter(|gain| gain.is_finite()),
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
