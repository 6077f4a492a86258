use std::str::FromStr;

use glam::Vec3;
use thiserror::Error;

use super::joint_name::{self, JointNameError};
use crate::cli::argument::PointArgument;
use crate::document::{Document, Posed, Track};
use crate::kinematics::limb_ik::Limb;
use crate::kinematics::skeleton::JointId;
use crate::rig::TargetSpace;

/// A target given on the command line: a joint by name or index, and a position in the world.
#[derive(Clone, Debug, PartialEq)]
pub struct GivenTarget {
    joint: String,
    point: Vec3,
}

#[derive(Debug, Error)]
#[error("must be a joint and a point, like left_hand=0.3,1.2,0.4")]
pub struct GivenTargetError;

/// Reasons why given targets cannot be set.
#[derive(Debug, PartialEq, Eq, Error)]
pub enum SetTargetsError {
    #[error(transparent)]
    Joint(#[from] JointNameError),
    #[error("joint {0:?} must be given one target, got two")]
    Two(String),
}

impl FromStr for GivenTarget {
    type Err = GivenTargetError;

    fn from_str(text: &str) -> Result<Self, GivenTargetError> {
        // A name may contain "=", a point may not.
        let (joint, point) = text.rsplit_once('=').ok_or(GivenTargetError)?;
        let PointArgument(point) = point.parse().map_err(|_| GivenTargetError)?;
        Ok(Self { joint: joint.to_owned(), point })
    }
}

/// The document of a track at `time`, in seconds, with targets at the given positions: those that
/// their joints have are moved, others are added. `order` has the rig's joints in the file's order.
///
/// # Errors
///
/// [`SetTargetsError`] if a joint is not there or has two of the targets.
pub fn with_targets(
    track: &Track,
    time: f64,
    targets: &[GivenTarget],
    order: &[JointId],
) -> Result<Posed, SetTargetsError> {
    let mut posed = track.at(time);
    let mut set = Vec::new();
    for GivenTarget { joint: name, point } in targets {
        let skeleton = posed.document().skeleton();
        let joint = joint_name::find(name, skeleton, order)?;
        let (document, index) = place(&posed, joint, *point);
        if set.contains(&index) {
            return Err(SetTargetsError::Two(skeleton[joint].name.clone()));
        }
        set.push(index);
        posed = track.pose(document, time);
    }
    Ok(posed)
}

/// Moves the joint's target, or adds one; returns the document and the target's index.
fn place(posed: &Posed, joint: JointId, point: Vec3) -> (Document, usize) {
    let mut document = posed.document().clone();
    let (rig, pose) = (&mut document.skeleton_rig, posed.skeleton());
    let lower = Limb::for_end(&rig.skeleton, joint).map_or(joint, |limb| limb.lower);
    let existing = rig.target_of_end(joint).or_else(|| rig.target(lower));
    let index = existing.unwrap_or_else(|| {
        rig.targets.extend(rig.new_target(joint, pose));
        rig.targets.len() - 1
    });
    let target = &mut rig.targets[index];
    // On a joint, it would move with the joint when the targets are solved.
    let in_world = target.in_space(TargetSpace::World, pose, posed.time(), None);
    *target = in_world.placed(pose, posed.time(), point);
    target.enabled = true;
    if target.influence == 0.0 {
        target.influence = 1.0;
    }
    (document, index)
}
