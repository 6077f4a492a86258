use glam::{DMat3, Vec3};
use serde::{Deserialize, Serialize};

use crate::kinematics::euler;
use crate::kinematics::fk::limb_rotations;
use crate::kinematics::two_bone::TwoBonePose;

/// Orientation of the hand. Its rotation about the lower limb, the roll, is spread along the
/// forearm.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HandOrientation {
    /// Space in which the angles are measured.
    pub space: HandSpace,
    /// Angles about x, y and z in radians: see [`euler`].
    pub angles: Vec3,
    /// Roll τ of the forearm in the previous pose, in radians, whole turns included. With
    /// [`HandSpace::World`] the next roll is the equivalent angle nearest to this one.
    pub roll: f32,
}

/// The space that the hand's angles are measured in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum HandSpace {
    /// The space of the lower limb: the hand turns with the limb.
    #[default]
    LowerLimb,
    /// The world: the hand keeps its orientation when the limb turns.
    World,
}

impl HandOrientation {
    /// Rotation of the hand in the world: +x points out of the lower limb, +y out of the back of
    /// the hand.
    pub fn rotation(&self, pose: &TwoBonePose) -> DMat3 {
        let own = euler::rotation(self.angles);
        match self.space {
            HandSpace::LowerLimb => limb_rotations(pose).1 * own,
            HandSpace::World => own,
        }
    }

    /// Replaces the stored roll by the roll of the forearm in `pose`.
    #[must_use]
    pub fn with_roll_in(self, pose: &TwoBonePose) -> Self {
        let own = euler::rotation(self.angles);
        let roll = match self.space {
            // The angle about x already includes the whole turns.
            HandSpace::LowerLimb => euler::roll(own, self.angles.x),
            HandSpace::World => euler::roll(limb_rotations(pose).1.transpose() * own, self.roll),
        };
        Self { roll, ..self }
    }

    /// Converts the angles to another space. The hand keeps its orientation in `pose`.
    #[must_use]
    pub fn in_space(self, space: HandSpace, pose: &TwoBonePose) -> Self {
        self.in_space_near(space, pose, self.angles)
    }

    /// [`Self::in_space`] with the equivalent angles that are nearest to `near`.
    pub(super) fn in_space_near(self, space: HandSpace, pose: &TwoBonePose, near: Vec3) -> Self {
        if space == self.space {
            return self;
        }
        let rotation = self.rotation(pose);
        let own = match space {
            HandSpace::LowerLimb => limb_rotations(pose).1.transpose() * rotation,
            HandSpace::World => rotation,
        };
        Self { space, angles: euler::angles(own, near), ..self }.with_roll_in(pose)
    }
}
