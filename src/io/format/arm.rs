//! The arm as it stands in a file, and from there to a document and back.

use core::f32::consts::PI;

use glam::{Vec2, Vec3};
use serde::{Deserialize, Serialize};

use super::check::above_0;
use crate::document::{self, Goal};
use crate::io::field::Field;
use crate::io::source::Wrong;
use crate::io::value::{Number, Numbers, Object, Point};
use crate::kinematics::fk;
use crate::kinematics::reach;
use crate::kinematics::swivel;
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
    reference: Option<Reference>,
    pole: Option<Point>,
    #[serde(skip_serializing_if = "Option::is_none")]
    carried: Option<Object<Carried>>,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Reference {
    Limb,
    Pole,
    Stereographic,
    Transport,
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
    space: Option<Space>,
    angles: Option<Point>,
    roll: Option<Number>,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Space {
    Lower,
    World,
}

impl Arm {
    pub fn new(arm: &document::Arm) -> Self {
        let (cursor, pin) = match arm.goal {
            Goal::Root(cursor) => (Some(Point(cursor)), None),
            Goal::World(pin) => (None, Some(Point(pin))),
        };
        let two_bone::Facing { direction, heading } = arm.facing;
        let facing = Facing { direction: Point(direction), heading: Numbers(heading.to_array()) };
        Self {
            cursor,
            pin,
            elbow_spin: Some(Number(arm.elbow_spin)),
            root: Some(Point(arm.root)),
            upper: Some(Number(arm.bones.upper())),
            lower: Some(Number(arm.bones.lower())),
            facing: Some(Object(facing)),
            swivel: Some(Object(Swivel::new(arm))),
            softening: Some(Object(Softening::new(arm.softening))),
            weight: Some(Number(arm.weight)),
            fk: Some(Object(Fk::new(arm.fk))),
            wrist: Some(Object(Wrist::new(arm.wrist))),
        }
    }
}

impl Swivel {
    fn new(arm: &document::Arm) -> Self {
        let carried = |swivel::Carried { direction, outward }| {
            Object(Carried { direction: Point(direction), outward: Point(outward) })
        };
        Self {
            reference: Some(match arm.swivel {
                document::Swivel::Limb => Reference::Limb,
                document::Swivel::Pole => Reference::Pole,
                document::Swivel::Stereographic => Reference::Stereographic,
                document::Swivel::Transport => Reference::Transport,
            }),
            pole: Some(Point(arm.pole)),
            carried: arm.carried.map(carried),
        }
    }
}

impl Softening {
    fn new(softening: reach::Softening) -> Self {
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
            space: Some(match wrist.space {
                document::Space::Lower => Space::Lower,
                document::Space::World => Space::World,
            }),
            angles: Some(Point(wrist.angles)),
            roll: Some(Number(wrist.roll)),
        }
    }
}

pub fn arm(at: &Field, file: &Arm) -> Result<document::Arm, Wrong> {
    let seed = document::Arm::default();
    let bones = bones(at, file, seed.bones)?;
    let goal = match (&file.pin, &file.cursor) {
        (Some(Point(pin)), _) => Goal::World(*pin),
        (None, Some(Point(cursor))) => Goal::Root(*cursor),
        (None, None) => seed.goal,
    };
    let arm = document::Arm {
        goal,
        elbow_spin: number(file.elbow_spin, seed.elbow_spin),
        root: file.root.map_or(seed.root, |Point(root)| root),
        bones,
        weight: part(at.clone().key("weight"), number(file.weight, seed.weight))?,
        softening: softening(&at.clone().key("softening"), file.softening.as_ref())?,
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

fn bones(at: &Field, file: &Arm, seed: TwoBone) -> Result<TwoBone, Wrong> {
    let [upper, lower] = [(file.upper, seed.upper()), (file.lower, seed.lower())]
        .map(|(length, seed)| number(length, seed));
    TwoBone::new(upper, lower)
        .map_err(|error| Wrong::new(at.clone().key(error.bone), error.to_string()))
}

fn facing(at: &Field, file: &Facing) -> Result<two_bone::Facing, Wrong> {
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
    at: &Field,
    file: Option<&Object<Swivel>>,
) -> Result<document::Arm, Wrong> {
    let Some(Object(file)) = file else {
        return Ok(arm);
    };
    let at_carried = at.clone().key("carried");
    let carried = file.carried.as_ref().map(|Object(file)| carried(&at_carried, file));
    Ok(document::Arm {
        swivel: match file.reference {
            None | Some(Reference::Limb) => document::Swivel::Limb,
            Some(Reference::Pole) => document::Swivel::Pole,
            Some(Reference::Stereographic) => document::Swivel::Stereographic,
            Some(Reference::Transport) => document::Swivel::Transport,
        },
        pole: file.pole.map_or(arm.pole, |Point(pole)| pole),
        carried: carried.transpose()?,
        ..arm
    })
}

fn carried(at: &Field, file: &Carried) -> Result<swivel::Carried, Wrong> {
    let (direction, outward) = (file.direction.0, file.outward.0);
    unit(at.clone().key("direction"), direction.length())?;
    unit(at.clone().key("outward"), outward.length())?;
    if direction.dot(outward).abs() > UNIT {
        let reason = "must be perpendicular to `direction`";
        return Err(Wrong::new(at.clone().key("outward"), reason));
    }
    Ok(swivel::Carried { direction: exactly(direction), outward: exactly(outward) })
}

fn softening(at: &Field, file: Option<&Object<Softening>>) -> Result<reach::Softening, Wrong> {
    let seed = reach::Softening::default();
    let Some(Object(file)) = file else {
        return Ok(seed);
    };
    let softening = reach::Softening::new(
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

fn fk(at: &Field, file: Option<&Object<Fk>>) -> Result<fk::Fk, Wrong> {
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
        space: match file.space {
            Some(Space::World) => document::Space::World,
            Some(Space::Lower) | None => document::Space::Lower,
        },
        angles: file.angles.map_or(Vec3::ZERO, |Point(angles)| angles),
        roll: number(file.roll, seed.roll),
    }
}

fn number(number: Option<Number>, seed: f32) -> f32 {
    number.map_or(seed, |Number(number)| number)
}

fn unit(at: Field, length: f32) -> Result<(), Wrong> {
    match (length - 1.0).abs() <= UNIT {
        true => Ok(()),
        false => Err(Wrong::new(at, format!("its length is {length}, not 1"))),
    }
}

/// One that is a unit vector as far as numbers go keeps its bits; one written by hand becomes one.
fn exactly(v: Vec3) -> Vec3 {
    if (v.length() - 1.0).abs() <= EXACT { v } else { v.normalize() }
}

fn part(at: Field, value: f32) -> Result<f32, Wrong> {
    match (0.0..=1.0).contains(&value) {
        true => Ok(value),
        false => Err(Wrong::new(at, format!("is {value}; it must be from 0 to 1"))),
    }
}
