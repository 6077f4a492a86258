//! Targets that are given on the command line.

use std::str::FromStr;

use glam::Vec3;
use thiserror::Error;

use crate::cli::argument;
use crate::document::{Document, Posed, Target, Track};
use crate::kinematics::limb_ik::Limb;
use crate::kinematics::skeleton::{JointId, Skeleton};
use crate::rig::{Aim, TargetSpace};

/// What is given on the command line for a target: a joint by name or index, and three numbers, a
/// position in the world or angles in degrees.
#[derive(Clone, Debug, PartialEq)]
pub struct GivenTarget {
    joint: String,
    numbers: Vec3,
}

#[derive(Debug, Error)]
#[error("must be a joint and three numbers, like left_hand=0.3,1.2,0.4")]
pub struct GivenTargetError;

/// Reasons why given targets cannot be set.
#[derive(Debug, PartialEq, Eq, Error)]
pub enum SetTargetsError {
    #[error(transparent)]
    Joint(#[from] JointNameError),
    #[error("joint {0:?} must be given one target, got two")]
    Two(String),
    #[error(
        "the target of joint {0:?} poses a limb without one joint at its tip, so it turns none"
    )]
    NoHand(String),
    #[error("the target of joint {0:?} poses a limb, which is aimed at nothing; aim another joint")]
    LimbAim(String),
}

impl FromStr for GivenTarget {
    type Err = GivenTargetError;

    fn from_str(text: &str) -> Result<Self, GivenTargetError> {
        // A name may contain "=", a point may not.
        let (joint, point) = text.rsplit_once('=').ok_or(GivenTargetError)?;
        let numbers = argument::point(point).map_err(|_| GivenTargetError)?;
        Ok(Self { joint: joint.to_owned(), numbers })
    }
}

/// The document of a track at `time`, in seconds, with targets that are given positions, rotations and
/// points to aim at: those that their joints have are changed, others are added. `order` has the
/// rig's joints in the file's order.
///
/// # Errors
///
/// [`SetTargetsError`] if a joint is not there or has two of the targets.
pub fn with_targets(
    track: &Track,
    time: f64,
    given: [&[GivenTarget]; 3],
    order: &[JointId],
) -> Result<Posed, SetTargetsError> {
    let mut posed = track.at(time);
    let set_all = [set_place, set_rotation, set_aim];
    for (given, set_on) in given.into_iter().zip(set_all) {
        let mut set = Vec::new();
        for GivenTarget { joint: name, numbers } in given {
            let skeleton = posed.document().skeleton();
            let joint = find(name, skeleton, order)?;
            let name = || skeleton[joint].name.clone();
            let count = posed.document().rig.targets.len();
            let (mut document, index) = with_target(&posed, joint);
            if set.contains(&index) {
                return Err(SetTargetsError::Two(name()));
            }
            set.push(index);
            let set_one = set_on(&mut document.rig.targets[index], &posed, *numbers);
            set_one.map_err(|refused| refused(name()))?;
            let target = &mut document.rig.targets[index];
            if index == count && target.turns_joint() {
                // Only its rotation was given.
                target.weight = 0.0;
            }
            posed = track.pose(document, time);
        }
    }
    Ok(posed)
}

/// The error for a target that cannot be set, by the name of its joint.
type Refused = fn(String) -> SetTargetsError;

fn set_place(target: &mut Target, posed: &Posed, point: Vec3) -> Result<(), Refused> {
    *target = target.placed(posed.skeleton(), posed.time(), point);
    Ok(())
}

fn set_rotation(target: &mut Target, posed: &Posed, degrees: Vec3) -> Result<(), Refused> {
    target.orientation = Some(degrees.map(f32::to_radians));
    target.aim = None;
    let has_hand = target.oriented_joint(posed.skeleton()).is_some();
    if has_hand { Ok(()) } else { Err(SetTargetsError::NoHand) }
}

fn set_aim(target: &mut Target, _: &Posed, point: Vec3) -> Result<(), Refused> {
    let axis = target.aim.map_or(Vec3::Z, |aim| aim.axis);
    target.aim = Some(Aim { axis, point });
    target.orientation = None;
    if target.limb().is_none() { Ok(()) } else { Err(SetTargetsError::LimbAim) }
}

/// The document with an enabled target of the joint in the world, where it is at present; a new one
/// is at the joint's tip. Returns its index, too.
fn with_target(posed: &Posed, joint: JointId) -> (Document, usize) {
    let mut document = posed.document().clone();
    let (rig, pose) = (&mut document.rig, posed.skeleton());
    let lower = Limb::for_end(&rig.skeleton, joint).map_or(joint, |limb| limb.lower);
    let existing = rig.target_of_end(joint).or_else(|| rig.target(lower));
    let index = existing.unwrap_or_else(|| {
        rig.targets.extend(rig.new_target(joint, pose));
        rig.targets.len() - 1
    });
    let target = &mut rig.targets[index];
    // On a joint, it would move with the joint when the targets are solved.
    *target = target.in_space(TargetSpace::World, pose, posed.time(), None);
    target.enabled = true;
    if target.influence == 0.0 {
        target.influence = 1.0;
    }
    (document, index)
}

/// Names below this similarity (Jaro–Winkler, from 0 to 1) are not suggested.
const NEAR: f64 = 0.7;
const MOST_NAMES: usize = 5;

/// A text that names no joint.
#[derive(Debug, PartialEq, Eq, Error)]
pub enum JointNameError {
    #[error("there is no joint {text:?}; near names are {}", quoted(near))]
    Near { text: String, near: Vec<String> },
    #[error("there is no joint {text:?}; the joints are 0 to {last}, called {}", quoted(first))]
    Unlike { text: String, last: usize, first: Vec<String> },
}

/// Finds the joint with this name, else the one with this index in the file. `order` has the joints
/// in the file's order.
///
/// # Errors
///
/// [`JointNameError`] if there is no such joint.
fn find(text: &str, skeleton: &Skeleton, order: &[JointId]) -> Result<JointId, JointNameError> {
    let by_index = || order.get(text.parse::<usize>().ok()?).copied();
    skeleton.find(text).or_else(by_index).ok_or_else(|| missing(text, skeleton, order))
}

fn missing(text: &str, skeleton: &Skeleton, order: &[JointId]) -> JointNameError {
    let names = || order.iter().map(|joint| &skeleton[*joint].name);
    let near = near(text, names());
    let text = text.to_owned();
    if near.is_empty() {
        let first = names().take(MOST_NAMES).cloned().collect();
        return JointNameError::Unlike { text, last: order.len().saturating_sub(1), first };
    }
    JointNameError::Near { text, near }
}

/// The names most similar to a text, the nearest first.
fn near<'a>(text: &str, names: impl Iterator<Item = &'a String>) -> Vec<String> {
    let text = text.to_lowercase();
    let similarity = |name: &String| strsim::jaro_winkler(&text, &name.to_lowercase());
    let mut near: Vec<(f64, &String)> = names.map(|name| (similarity(name), name)).collect();
    near.retain(|(similarity, _)| *similarity >= NEAR);
    near.sort_by(|one, other| other.0.total_cmp(&one.0));
    near.into_iter().take(MOST_NAMES).map(|(_, name)| name.clone()).collect()
}

fn quoted(names: &[String]) -> String {
    names.iter().map(|name| format!("{name:?}")).collect::<Vec<_>>().join(", ")
}
