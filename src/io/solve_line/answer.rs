//! The pose that answers a line, and the state that it passes on to the next line.

use glam::Vec3;
use serde::Serialize;

use super::error::LineError;
use crate::kinematics::ik::{IkSolution, IkState};
use crate::kinematics::twist::TwistReference;
use crate::kinematics::two_bone::Reach;

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
    /// Returns the answer with the solved pose of an arm whose shoulder is at `root` in the world.
    ///
    /// # Errors
    ///
    /// Fails with [`LineError::OutOfWorld`] if the elbow or the hand overflows in the world.
    pub fn new(
        root: Vec3,
        reference: TwistReference,
        solved: &IkSolution,
    ) -> Result<Self, LineError> {
        let pose = &solved.pose;
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

/// State that a line with the transport reference passes on to the next line: its Pointer, and the
/// frame in which its twist was measured. The Pointer is used if the hand of the next line is at
/// the shoulder, or straight above or below the shoulder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PreviousLine(pub(super) IkState);

impl PreviousLine {
    pub(super) fn new(solved: &IkSolution) -> Self {
        Self(solved.state())
    }
}
