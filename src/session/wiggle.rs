use core::f64::consts::TAU;

use glam::Vec3;

use crate::kinematics::skeleton::{JointId, RotationAxis, SkeletonPose};
use crate::kinematics::swing::Swing;

/// An angle that swings to and fro in the view, to show what the Jacobian is; the document does not
/// change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Wiggle {
    pub joint: JointId,
    pub axis: RotationAxis,
    /// Seconds since it began.
    time: f64,
}

/// A wiggle as the view shows it, in the world.
#[derive(Clone, Debug, PartialEq)]
pub struct WiggleView {
    /// The turn.
    pub swing: Swing,
    /// The pose at this moment.
    pub pose: SkeletonPose,
    /// The path of the tip, from the end of the swing to its other end and a little beyond.
    pub path: Vec<Vec3>,
    /// The ends of the line along which the Jacobian moves the tip by the same angles.
    pub predicted: [Vec3; 2],
    /// The change of the angle at this moment, in radians.
    pub by: f32,
    /// What the tip is to reach; `None` without a target.
    pub target: Option<WiggleTarget>,
}

/// The residual of a tip that swings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WiggleTarget {
    /// Position of the target.
    pub position: Vec3,
    /// Distance from the tip to the target before the turn.
    pub before: f32,
    /// Distance at this moment.
    pub now: f32,
    /// Distance that the Jacobian predicts for this moment.
    pub predicted: f32,
}

impl Wiggle {
    /// Greatest change of the angle, in radians, and seconds for a swing to and fro.
    pub const MOST: f32 = 5.0 * core::f32::consts::PI / 180.0;
    const PERIOD: f64 = 1.8;

    pub fn new(joint: JointId, axis: RotationAxis) -> Self {
        Self { joint, axis, time: 0.0 }
    }

    pub fn advance(&mut self, passed: f64) {
        self.time = (self.time + passed) % Self::PERIOD;
    }

    /// The present change of the angle, in radians.
    pub fn by(self) -> f32 {
        Self::MOST * (TAU * self.time / Self::PERIOD).sin() as f32
    }
}
