use super::arm::Arm;
use super::display::Overlay;
use super::hand_orientation::HandOrientation;
use super::rig_kind::RigKind;
use crate::kinematics::skeleton::{JointId, JointRemap};
use crate::kinematics::twist::TwistReferenceKind;

/// A value of a document that keys animate.
///
/// All values are vectors, so that they are handled alike: a number is in x, with y and z 0, and a
/// switch is 0 or 1 in x.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Channel {
    /// The Cursor in Root space, while it is not pinned.
    Hand,
    /// Socket twist in radians, unwrapped; with Transport it is measured from the stereographic
    /// direction.
    Twist,
    /// Position of the shoulder in the world.
    Root,
    /// Length of the upper limb.
    Upper,
    /// Length of the lower limb.
    Lower,
    /// The Cursor in the world, while it is pinned.
    Pin,
    /// The point in Root space that the elbow turns to.
    Pole,
    /// Influence of IK over FK, from 0 to 1.
    Influence,
    /// Angles of the shoulder by FK in radians, unwrapped.
    Shoulder,
    /// Bend of the elbow by FK in radians, unwrapped.
    Bend,
    /// Length of the limbs by FK, as a multiple of their length at rest.
    Stretch,
    /// Angles of the hand in radians, unwrapped.
    HandOrientation,
    /// Position of the skeleton's origin in the world.
    Translation,
    /// Euler angles of a joint in radians, unwrapped.
    Rotation(JointId),
    /// Offset of a joint from its parent's base.
    Offset(JointId),
    /// Position of a joint's target at time 0, in the world.
    Target(JointId),
    /// Whether a joint's target is enabled.
    Enabled(JointId),
    /// Whether an overlay is shown.
    Overlay(Overlay),
}

/// The kind of a channel's values: how many numbers they have, their unit and their range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// A point or vector, in units of the rig.
    Point,
    /// A length above 0, in units of the rig.
    Length,
    /// A number from 0 to 1.
    Fraction,
    /// An angle in radians.
    Angle,
    /// Three angles in radians.
    Angles,
    /// 0 or 1, not interpolated.
    Switch,
}

impl Quantity {
    /// Number of components in use: 1 or 3.
    pub fn width(self) -> usize {
        match self {
            Self::Point | Self::Angles => 3,
            Self::Length | Self::Fraction | Self::Angle | Self::Switch => 1,
        }
    }
}

impl Channel {
    /// All channels of the arm.
    pub const ARM: [Self; 12] = [
        Self::Hand,
        Self::Pin,
        Self::Twist,
        Self::Pole,
        Self::Root,
        Self::Upper,
        Self::Lower,
        Self::Influence,
        Self::Shoulder,
        Self::Bend,
        Self::Stretch,
        Self::HandOrientation,
    ];

    /// The channels that pose the arm by IK.
    pub const IK: [Self; 3] = [Self::Hand, Self::Pin, Self::Twist];

    /// The channels that pose the arm by FK, and the influence of IK.
    pub const FK: [Self; 4] = [Self::Influence, Self::Shoulder, Self::Bend, Self::Stretch];

    /// The kind of its values.
    pub fn quantity(self) -> Quantity {
        match self {
            Self::Hand
            | Self::Root
            | Self::Pin
            | Self::Pole
            | Self::Translation
            | Self::Offset(_)
            | Self::Target(_) => Quantity::Point,
            Self::Upper | Self::Lower | Self::Stretch => Quantity::Length,
            Self::Influence => Quantity::Fraction,
            Self::Twist | Self::Bend => Quantity::Angle,
            Self::Shoulder | Self::HandOrientation | Self::Rotation(_) => Quantity::Angles,
            Self::Enabled(_) | Self::Overlay(_) => Quantity::Switch,
        }
    }

    /// Whether its values are 0 or 1.
    pub fn is_switch(self) -> bool {
        self.quantity() == Quantity::Switch
    }

    /// Whether it changes the pose of an arm with these settings.
    pub fn shapes(self, arm: &Arm) -> bool {
        match self {
            Self::Hand => !arm.is_pinned(),
            Self::Pin => arm.is_pinned(),
            Self::Pole => arm.twist_reference == TwistReferenceKind::Pole,
            Self::Influence | Self::Shoulder | Self::Bend => arm.influence < 1.0,
            Self::Stretch => arm.influence < 1.0 && arm.is_stretching(),
            Self::HandOrientation => arm.hand_orientation != HandOrientation::default(),
            other => other.rig() == Some(RigKind::Arm),
        }
    }

    /// The rig that it belongs to; `None` for overlays.
    pub fn rig(self) -> Option<RigKind> {
        match self {
            Self::Hand
            | Self::Twist
            | Self::Root
            | Self::Upper
            | Self::Lower
            | Self::Pin
            | Self::Pole
            | Self::Influence
            | Self::Shoulder
            | Self::Bend
            | Self::Stretch
            | Self::HandOrientation => Some(RigKind::Arm),
            Self::Translation
            | Self::Rotation(_)
            | Self::Offset(_)
            | Self::Target(_)
            | Self::Enabled(_) => Some(RigKind::Skeleton),
            Self::Overlay(_) => None,
        }
    }

    /// Whether it changes the pose of a rig; targets do so through a solver only.
    pub fn poses(self, rig: RigKind) -> bool {
        self.rig() == Some(rig) && !matches!(self, Self::Target(_) | Self::Enabled(_))
    }

    /// The joint that it belongs to.
    pub fn joint(self) -> Option<JointId> {
        match self {
            Self::Rotation(joint)
            | Self::Offset(joint)
            | Self::Target(joint)
            | Self::Enabled(joint) => Some(joint),
            _ => None,
        }
    }

    /// The same channel after joints are renumbered; `None` if its joint is removed.
    #[must_use]
    pub fn remapped(self, remap: &JointRemap) -> Option<Self> {
        Some(match self {
            Self::Rotation(joint) => Self::Rotation(remap.get(joint)?),
            Self::Offset(joint) => Self::Offset(remap.get(joint)?),
            Self::Target(joint) => Self::Target(remap.get(joint)?),
            Self::Enabled(joint) => Self::Enabled(remap.get(joint)?),
            other => other,
        })
    }
}
