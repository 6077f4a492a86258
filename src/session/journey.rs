use glam::Vec3;

use crate::kinematics::swivel::Carried;
use crate::kinematics::two_bone::Pose;

/// What is carried along with the Pointer on its way: what transport would measure the elbow from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Journey {
    start: Carried,
    now: Carried,
}

impl Journey {
    /// From where the elbow stands out.
    pub(super) fn new(pose: &Pose) -> Self {
        let start = Carried { direction: pose.facing.direction, outward: pose.outward() };
        Self { start, now: start }
    }

    pub(super) fn go_on(&mut self, direction: Vec3) {
        if direction != self.now.direction {
            self.now = self.now.to(direction);
        }
    }

    /// What has been carried to here.
    pub fn carried(&self) -> Carried {
        self.now
    }

    /// How far it came out turned against what goes straight from the start to here, radians in
    /// (−π, π]: the solid angle that the way goes around.
    pub fn holonomy(&self) -> f32 {
        self.start.turn_to(self.now)
    }
}
