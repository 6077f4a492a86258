use super::arm::Arm;
use super::display::Overlay;
use super::hand_orientation::HandOrientation;
use super::rig_kind::RigKind;
use crate::kinematics::skeleton::{JointId, JointRemap};
use crate::kinematics::twist::TwistReferenceKind;

/// A value of a document that keys can animate.
///
/// Every channel has a vector as its value, so that all channels are handled alike: a number is in
/// x, with y and z 0, and a switch is 0 or 1 in x.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Channel {
    /// The Cursor in Root space while it is not pinned.
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
    /// The Cursor in the world while it is pinned.
    Pin,
    /// Whether the Cursor is pinned to the world.
    Pinned,
    /// The pole: the point in Root space towards which the elbow turns.
    Pole,
    /// Influence of IK, from 0 (FK alone) to 1 (IK alone).
    Influence,
    /// FK angles of the shoulder in radians, unwrapped.
    Shoulder,
    /// FK bend of the elbow in radians, unwrapped.
    Bend,
    /// FK stretch: the length of the limbs as a multiple of their unstretched length.
    Stretch,
    /// Angles of the hand in radians, unwrapped.
    HandOrientation,
    /// Position of the skeleton's origin in the world.
    Translation,
    /// Euler angles of a joint in radians, unwrapped.
    Rotation(JointId),
    /// Vector from the base of a joint's parent to the joint's base, in the parent's space; from
    /// the skeleton's origin for a root.
    Offset(JointId),
    /// Position of a joint's target at time 0, in the target's space.
    Target(JointId),
    /// Influence of a joint's target, from 0 (FK pose) to 1 (solved pose).
    TargetInfluence(JointId),
    /// Euler angles in radians, unwrapped, of the hand in the space of a limb's target.
    TargetOrientation(JointId),
    /// Angle in radians, unwrapped, by which the elbow of a limb's target is turned.
    TargetTwist(JointId),
    /// The pole of a limb's target, in the pole's space.
    TargetPole(JointId),
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
    pub const ARM: [Self; 13] = [
        Self::Hand,
        Self::Pinned,
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
    pub const IK: [Self; 4] = [Self::Hand, Self::Pinned, Self::Pin, Self::Twist];

    /// The channels that pose the arm by FK, and the influence of IK.
    pub const FK: [Self; 4] = [Self::Influence, Self::Shoulder, Self::Bend, Self::Stretch];

    /// The kind of the channel's values.
    pub fn quantity(self) -> Quantity {
        match self {
            Self::Hand
            | Self::Root
            | Self::Pin
            | Self::Pole
            | Self::Translation
            | Self::Offset(_)
            | Self::Target(_)
            | Self::TargetPole(_) => Quantity::Point,
            Self::Upper | Self::Lower | Self::Stretch => Quantity::Length,
            Self::Influence | Self::TargetInfluence(_) => Quantity::Fraction,
            Self::Twist | Self::Bend | Self::TargetTwist(_) => Quantity::Angle,
            Self::Shoulder
            | Self::HandOrientation
            | Self::Rotation(_)
            | Self::TargetOrientation(_) => Quantity::Angles,
            Self::Pinned | Self::Enabled(_) | Self::Overlay(_) => Quantity::Switch,
        }
    }

    /// Whether the channel's values are switches, 0 or 1.
    pub fn is_switch(self) -> bool {
        self.quantity() == Quantity::Switch
    }

    /// Whether the channel's values are the angles of a joint, R_z · R_y · R_x, so that keys can turn it
    /// the shortest way: see [`Interpolation::Slerp`](crate::kinematics::spline::Interpolation::Slerp).
    pub fn is_rotation(self) -> bool {
        matches!(self, Self::Rotation(_) | Self::TargetOrientation(_))
    }

    /// The channel of the point that the Cursor of `arm` has: in the world if it is pinned, else in
    /// Root space.
    pub fn of_cursor(arm: &Arm) -> Self {
        if arm.is_pinned() { Self::Pin } else { Self::Hand }
    }

    /// Whether the channel is the point that the Cursor of `arm` does not have at present.
    pub fn is_idle(self, arm: &Arm) -> bool {
        matches!(self, Self::Hand | Self::Pin) && self != Self::of_cursor(arm)
    }

    /// Whether the channel affects the pose of `arm` with its present settings.
    pub fn shapes(self, arm: &Arm) -> bool {
        match self {
            Self::Hand | Self::Pin => self == Self::of_cursor(arm),
            Self::Pinned => arm.is_pinned(),
            Self::Pole => arm.twist_reference == TwistReferenceKind::Pole,
            Self::Influence | Self::Shoulder | Self::Bend => arm.influence < 1.0,
            Self::Stretch => arm.influence < 1.0 && arm.is_stretching(),
            Self::HandOrientation => arm.hand_orientation != HandOrientation::default(),
            other => other.rig() == Some(RigKind::Arm),
        }
    }

    /// The rig that the channel belongs to; `None` for overlays.
    pub fn rig(self) -> Option<RigKind> {
        match self {
            Self::Hand
            | Self::Twist
            | Self::Root
            | Self::Upper
            | Self::Lower
            | Self::Pin
            | Self::Pinned
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
            | Self::TargetInfluence(_)
            | Self::TargetOrientation(_)
            | Self::TargetTwist(_)
            | Self::TargetPole(_)
            | Self::Enabled(_) => Some(RigKind::Skeleton),
            Self::Overlay(_) => None,
        }
    }

    /// The joint that the channel belongs to; `None` if it belongs to no joint.
    pub fn joint(self) -> Option<JointId> {
        match self {
            Self::Rotation(joint) | Self::Offset(joint) => Some(joint),
            other => other.target(),
        }
    }

    /// The joint whose target the channel belongs to; `None` if it belongs to no target.
    pub fn target(self) -> Option<JointId> {
        match self {
            Self::Target(joint)
            | Self::TargetInfluence(joint)
            | Self::TargetOrientation(joint)
            | Self::TargetTwist(joint)
            | Self::TargetPole(joint)
            | Self::Enabled(joint) => Some(joint),
            _ => None,
        }
    }

    /// The channels of a joint and of its target.
    pub fn of_joint(joint: JointId) -> impl Iterator<Item = Self> {
        let own = [Self::Rotation(joint), Self::Offset(joint)];
        own.into_iter().chain(Self::of_target(joint))
    }

    /// The channels of the target of a joint.
    pub fn of_target(joint: JointId) -> [Self; 6] {
        [
            Self::Target(joint),
            Self::TargetInfluence(joint),
            Self::TargetOrientation(joint),
            Self::TargetTwist(joint),
            Self::TargetPole(joint),
            Self::Enabled(joint),
        ]
    }

    /// The same channel after its joint was renumbered; `None` if its joint was removed.
    #[must_use]
    pub fn remapped(self, remap: &JointRemap) -> Option<Self> {
        Some(match self {
            Self::Rotation(joint) => Self::Rotation(remap.get(joint)?),
            Self::Offset(joint) => Self::Offset(remap.get(joint)?),
            Self::Target(joint) => Self::Target(remap.get(joint)?),
            Self::TargetInfluence(joint) => Self::TargetInfluence(remap.get(joint)?),
            Self::TargetOrientation(joint) => Self::TargetOrientation(remap.get(joint)?),
            Self::TargetTwist(joint) => Self::TargetTwist(remap.get(joint)?),
            Self::TargetPole(joint) => Self::TargetPole(remap.get(joint)?),
            Self::Enabled(joint) => Self::Enabled(remap.get(joint)?),
            other => other,
        })
    }
}
