use glam::{DMat3, Vec3};

use crate::kinematics::euler;
use crate::kinematics::fk::limb_rotations;
use crate::kinematics::two_bone::Pose;

/// How the hand is turned. The part of it about the lower limb rolls the forearm, spread along it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wrist {
    pub space: Space,
    /// Angles about x, y and z in radians: see [`euler`].
    pub angles: Vec3,
    /// τ as it was last, radians, whole turns included: the next one goes on from it.
    pub roll: f32,
}

/// What the hand's angles are measured in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Space {
    /// The lower limb: the hand follows it.
    #[default]
    Lower,
    /// The world: the hand keeps its orientation.
    World,
}

impl Wrist {
    /// The hand's rotation in the world: +x out of the wrist, +y the back of the hand.
    pub fn rotation(&self, pose: &Pose) -> DMat3 {
        let own = euler::rotation(self.angles);
        match self.space {
            Space::Lower => limb_rotations(pose).1 * own,
            Space::World => own,
        }
    }

    /// With the roll that it has in a pose.
    #[must_use]
    pub fn settled(self, pose: &Pose) -> Self {
        let relative = match self.space {
            Space::Lower => euler::rotation(self.angles),
            Space::World => limb_rotations(pose).1.transpose() * euler::rotation(self.angles),
        };
        Self { roll: euler::roll(relative, self.roll), ..self }
    }

    /// Measured in another space, with the hand turned as it is.
    #[must_use]
    pub fn measured_in(self, space: Space, pose: &Pose) -> Self {
        if space == self.space {
            return self;
        }
        let rotation = self.rotation(pose);
        let own = match space {
            Space::Lower => limb_rotations(pose).1.transpose() * rotation,
            Space::World => rotation,
        };
        Self { space, angles: euler::angles(own, self.angles), ..self }.settled(pose)
    }
}
