use glam::{EulerRot, Quat, Vec3};

use super::target_space::TargetSpace;
use crate::limb_ik::ElbowReference;
use crate::skeleton::Skeleton;
use crate::soft_reach::SoftReach;

/// Settings of a limb target.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LimbSettings {
    /// Direction of the elbow at twist 0.
    pub reference: ElbowReference,
    /// Angle in radians by which the elbow is turned about the axis from the limb's base to the target.
    pub twist: f32,
    /// Behaviour near the limits of the reach.
    pub soft_reach: SoftReach,
    /// Euler angles in radians of the hand or foot in the target's space, R_z · R_y · R_x; `None` for
    /// a hand that follows the lower bone.
    pub orientation: Option<Vec3>,
    /// The space of the point of [`ElbowReference::Pole`].
    pub pole_space: TargetSpace,
}

impl LimbSettings {
    /// The space and the position of the pole; `None` for another reference.
    pub fn pole(&self) -> Option<(TargetSpace, Vec3)> {
        match self.reference {
            ElbowReference::Pole(pole) => Some((self.pole_space, pole)),
            _ => None,
        }
    }

    /// Position of the pole in the world, for a pose of the skeleton; `None` for another reference.
    pub fn pole_in_world(&self, pose: &Skeleton) -> Option<Vec3> {
        self.pole().map(|(space, pole)| space.to_world(pose).transform_point3(pole))
    }

    /// The reference with its pole in the world, for a pose of the skeleton.
    pub(super) fn reference_in_world(&self, pose: &Skeleton) -> ElbowReference {
        self.pole_in_world(pose).map_or(self.reference, ElbowReference::Pole)
    }

    /// Rotation of the hand in the world, for a pose of the skeleton and the space of the target;
    /// `None` for a hand that follows the lower bone.
    pub fn hand_in_world(&self, pose: &Skeleton, space: TargetSpace) -> Option<Quat> {
        let turned = |Vec3 { x, y, z }| Quat::from_euler(EulerRot::ZYX, z, y, x);
        self.orientation.map(|angles| space.rotation(pose) * turned(angles))
    }

    /// Whether all numbers are finite.
    pub(super) fn is_finite(&self) -> bool {
        self.pole().is_none_or(|(_, pole)| pole.is_finite())
            && self.twist.is_finite()
            && self.orientation.is_none_or(Vec3::is_finite)
    }
}
