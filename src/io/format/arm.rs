//! The arm as it stands in a file, and from there to a document and back.

use core::f32::consts::PI;

use glam::{Vec2, Vec3};
use serde::{Deserialize, Serialize};

use super::check::above_0;
use crate::document::{self, Cursor, HandSpace, TwistReferenceKind};
use crate::io::json_path::JsonPath;
use crate::io::source::Wrong;
use crate::io::value::{Number, Numbers, Object, Point};
use crate::kinematics::fk;
use crate::kinematics::soft_reach;
use crate::kinematics::twist;
use crate::kinematics::two_bone::{self, TwoBone};

/// How far a unit vector's length may be from 1, and two of them from perpendicular.
const UNIT: f32 = 1e-3;
const EXACT: f32 = 1e-6;

#[derive(Serialize, Deserialize)]
pub struct Arm {
    /// Where the hand is asked to be relative to the root, unless it is pinned.
    #[serde(skip_serializing_if = "Option::is_none")]
    cursor: Option<Point>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pin: Option<Point>,
    elbow_spin: Option<Number>,
    root: Option<Point>,
    upper: Option<Number>,
    lower: Option<Number>,
    facing: Option<Object<Facing>>,
    swivel: Option<Object<Swivel>>,
    softening: Option<Object<Softening>>,
    weight: Option<Number>,
    fk: Option<Object<Fk>>,
    wrist: Option<Object<Wrist>>,
}

#[derive(Serialize, Deserialize)]
struct Facing {
    direction: Point,
    heading: Numbers<2>,
}

#[derive(Serialize, Deserialize)]
struct Swivel {
    reference: Option<TwistReferenceKind>,
    pole: Option<Point>,
    #[serde(skip_serializing_if = "Option::is_none")]
    carried: Option<Object<Carried>>,
}

#[derive(Serialize, Deserialize)]
struct Carried {
    direction: Point,
    outward: Point,
}

#[derive(Serialize, Deserialize)]
struct Softening {
    softness: Option<Number>,
    max_stretch: Option<Number>,
    min_elbow_angle: Option<Number>,
}

#[derive(Serialize, Deserialize)]
struct Fk {
    shoulder: Option<Point>,
    bend: Option<Number>,
    stretch: Option<Number>,
}

#[derive(Serialize, Deserialize)]
struct Wrist {
    space: Option<HandSpace>,
    angles: Option<Point>,
    roll: Option<Number>,
}

impl Arm {
    pub fn new(arm: &document::Arm) -> Self {
        let (cursor, pin) = match arm.goal {
            Cursor::Root(cursor) => (Some(Point(cursor)), None),
            Cursor::World(pin) => (None, Some(Point(pin))),
        };
        let two_bone::Facing { direction, heading } = arm.facing;
        let facing = Facing { direction: Point(direction), heading: Numbers(heading.to_array()) };
        Self {
            cursor,
            pin,
            elbow_spin: Some(Number(arm.twist)),
            root: Some(Point(arm.root)),
            upper: Some(Number(arm.bones.upper())),
            lower: Some(Number(arm.bones.lower())),
            facing: Some(Object(facing)),
            swivel: Some(Object(Swivel::new(arm))),
            softening: Some(Object(Softening::new(arm.soft_reach))),
            weight: Some(Number(arm.influence)),
            fk: Some(Object(Fk::new(arm.fk))),
            wrist: Some(Object(Wrist::new(arm.wrist))),
        }
    }
}

impl Swivel {
    fn new(arm: &document::Arm) -> Self {
        let carried = |twist::TransportedFrame { direction, outward }| {
            Object(Carried { direction: Point(direction), outward: Point(outward) })
        };
        Self {
            reference: Some(arm.twist_reference),
            pole: Some(Point(arm.pole)),
            carried: arm.transported.map(carried),
        }
    }
}

impl Softening {
    fn new(softening: soft_reach::SoftReach) -> Self {
        Self {
            softness: Some(Number(softening.softness())),
            max_stretch: Some(Number(softening.max_stretch())),
            min_elbow_angle: Some(Number(softening.min_elbow_angle())),
        }
    }
}

impl Fk {
    fn new(fk: fk::Fk) -> Self {
        Self {
            shoulder: Some(Point(fk.shoulder)),
            bend: Some(Number(fk.bend)),
            stretch: Some(Number(fk.stretch)),
        }
    }
}

impl Wrist {
    fn new(wrist: document::Wrist) -> Self {
        Self {
            space: Some(wrist.space),
            angles: Some(Point(wrist.angles)),
            roll: Some(Number(wrist.roll)),
        }
    }
}

pub fn arm(at: &JsonPath, file: &Arm) -> Result<document::Arm, Wrong> {
    let seed = document::Arm::default();
    let bones = bones(at, file, seed.bones)?;
    let goal = match (&file.pin, &file.cursor) {
        (Some(Point(pin)), _) => Cursor::World(*pin),
        (None, Some(Point(cursor))) => Cursor::Root(*cursor),
        (None, None) => seed.goal,
    };
    let arm = document::Arm {
        goal,
        twist: number(file.elbow_spin, seed.twist),
        root: file.root.map_or(seed.root, |Point(root)| root),
        bones,
        influence: part(at.clone().key("weight"), number(file.weight, seed.influence))?,
        soft_reach: softening(&at.clone().key("softening"), file.softening.as_ref())?,
        fk: fk(&at.clone().key("fk"), file.fk.as_ref())?,
        wrist: wrist(file.wrist.as_ref()),
        ..seed
    };
    let arm = with_swivel(arm, &at.clone().key("swivel"), file.swivel.as_ref())?;
    let facing = match &file.facing {
        Some(Object(file)) => facing(&at.clone().key("facing"), file)?,
        None => two_bone::Facing::towards(arm.cursor(), two_bone::Facing::default()),
    };
    Ok(document::Arm { facing, ..arm })
}

fn bones(at: &JsonPath, file: &Arm, seed: TwoBone) -> Result<TwoBone, Wrong> {
    let [upper, lower] = [(file.upper, seed.upper()), (file.lower, seed.lower())]
        .map(|(length, seed)| number(length, seed));
    TwoBone::new(upper, lower)
        .map_err(|error| Wrong::new(at.clone().key(error.bone), error.to_string()))
}

fn facing(at: &JsonPath, file: &Facing) -> Result<two_bone::Facing, Wrong> {
    let (direction, heading) = (file.direction.0, Vec2::from_array(file.heading.0));
    unit(at.clone().key("direction"), direction.length())?;
    unit(at.clone().key("heading"), heading.length())?;
    let (direction, heading) = (exactly(direction), exactly(heading.extend(0.0)).truncate());
    let flat = Vec2::new(direction.x, direction.z);
    if flat.length() > UNIT && flat.normalize().distance(heading) > UNIT {
        let reason = "must be `direction` as seen from above";
        return Err(Wrong::new(at.clone().key("heading"), reason));
    }
    Ok(two_bone::Facing { direction, heading })
}

fn with_swivel(
    arm: document::Arm,
    at: &JsonPath,
    file: Option<&Object<Swivel>>,
) -> Result<document::Arm, Wrong> {
    let Some(Object(file)) = file else {
        return Ok(arm);
    };
    let at_carried = at.clone().key("carried");
    let carried = file.carried.as_ref().map(|Object(file)| carried(&at_carried, file));
    Ok(document::Arm {
        twist_reference: file.reference.unwrap_or(arm.twist_reference),
        pole: file.pole.map_or(arm.pole, |Point(pole)| pole),
        transported: carried.transpose()?,
        ..arm
    })
}

fn carried(at: &JsonPath, file: &Carried) -> Result<twist::TransportedFrame, Wrong> {
    let (direction, outward) = (file.direction.0, file.outward.0);
    unit(at.clone().key("direction"), direction.length())?;
    unit(at.clone().key("outward"), outward.length())?;
    if direction.dot(outward).abs() > UNIT {
        let reason = "must be perpendicular to `direction`";
        return Err(Wrong::new(at.clone().key("outward"), reason));
    }
    Ok(twist::TransportedFrame { direction: exactly(direction), outward: exactly(outward) })
}

fn softening(
    at: &JsonPath,
    file: Option<&Object<Softening>>,
) -> Result<soft_reach::SoftReach, Wrong> {
    let seed = soft_reach::SoftReach::default();
    let Some(Object(file)) = file else {
        return Ok(seed);
    };
    let softening = soft_reach::SoftReach::new(
        number(file.softness, seed.softness()),
        number(file.max_stretch, seed.max_stretch()),
        number(file.min_elbow_angle, seed.min_elbow_angle()),
    );
    softening.map_err(|error| {
        let range = match error.field {
            "min_elbow_angle" => format!("from 0 to less than {PI}"),
            _ => error.range.to_owned(),
        };
        let reason = format!("is {}; it must be {range}", error.value);
        Wrong::new(at.clone().key(error.field), reason)
    })
}

fn fk(at: &JsonPath, file: Option<&Object<Fk>>) -> Result<fk::Fk, Wrong> {
    let seed = fk::Fk::default();
    let Some(Object(file)) = file else {
        return Ok(seed);
    };
    let stretch = above_0(at.clone().key("stretch"), number(file.stretch, seed.stretch))?;
    Ok(fk::Fk {
        shoulder: file.shoulder.map_or(seed.shoulder, |Point(shoulder)| shoulder),
        bend: number(file.bend, seed.bend),
        stretch,
    })
}

fn wrist(file: Option<&Object<Wrist>>) -> document::Wrist {
    let seed = document::Wrist::default();
    let Some(Object(file)) = file else {
        return seed;
    };
    document::Wrist {
        space: file.space.unwrap_or(seed.space),
        angles: file.angles.map_or(Vec3::ZERO, |Point(angles)| angles),
        roll: number(file.roll, seed.roll),
    }
}

fn number(number: Option<Number>, seed: f32) -> f32 {
    number.map_or(seed, |Number(number)| number)
}

fn unit(at: JsonPath, length: f32) -> Result<(), Wrong> {
    match (length - 1.0).abs() <= UNIT {
        true => Ok(()),
        false => Err(Wrong::new(at, format!("its length is {length}, not 1"))),
    }
}

/// One that is a unit vector as far as numbers go keeps its bits; one written by hand becomes one.
fn exactly(v: Vec3) -> Vec3 {
    if (v.length() - 1.0).abs() <= EXACT { v } else { v.normalize() }
}

fn part(at: JsonPath, value: f32) -> Result<f32, Wrong> {
    match (0.0..=1.0).contains(&value) {
        true => Ok(value),
        false => Err(Wrong::new(at, format!("is {value}; it must be from 0 to 1"))),
    }
}
