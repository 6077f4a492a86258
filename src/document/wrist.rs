use glam::{DMat3, Vec3};
use serde::{Deserialize, Serialize};

use crate::kinematics::euler;
use crate::kinematics::fk::limb_rotations;
use crate::kinematics::two_bone::TwoBonePose;

/// How the hand is turned. The part of it about the lower limb rolls the forearm, spread along it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wrist {
    pub space: HandSpace,
    /// Angles about x, y and z in radians: see [`euler`].
    pub angles: Vec3,
    /// τ as it was last, radians, whole turns included: where the hand keeps its orientation, the next
    /// one goes on from it.
    pub roll: f32,
}

/// What the hand's angles are measured in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum HandSpace {
    /// The lower limb: the hand follows it.
    #[default]
    #[serde(rename = "lower_limb")]
    Lower,
    /// The world: the hand keeps its orientation.
    World,
}

impl Wrist {
    /// The hand's rotation in the world: +x out of the wrist, +y the back of the hand.
    pub fn rotation(&self, pose: &TwoBonePose) -> DMat3 {
        let own = euler::rotation(self.angles);
        match self.space {
            HandSpace::Lower => limb_rotations(pose).1 * own,
            HandSpace::World => own,
        }
    }

    /// With the roll that it has in a pose.
    #[must_use]
    pub fn settled(self, pose: &TwoBonePose) -> Self {
        let own = euler::rotation(self.angles);
        let roll = match self.space {
            // The angle about the forearm says its turns itself.
            HandSpace::Lower => euler::roll(own, self.angles.x),
            HandSpace::World => euler::roll(limb_rotations(pose).1.transpose() * own, self.roll),
        };
        Self { roll, ..self }
    }

    /// Measured in another space, with the hand turned as it is.
    #[must_use]
    pub fn measured_in(self, space: HandSpace, pose: &TwoBonePose) -> Self {
        self.measured_in_from(space, pose, None)
    }

    /// As [`Self::measured_in`], with the angles nearest to the last ones.
    pub(super) fn measured_in_from(
        self,
        space: HandSpace,
        pose: &TwoBonePose,
        last: Option<Vec3>,
    ) -> Self {
        if space == self.space {
            return self;
        }
        let rotation = self.rotation(pose);
        let own = match space {
            HandSpace::Lower => limb_rotations(pose).1.transpose() * rotation,
            HandSpace::World => rotation,
        };
        Self { space, angles: euler::angles(own, last.unwrap_or(self.angles)), ..self }
            .settled(pose)
    }
}
