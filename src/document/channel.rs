use core::fmt;
use core::mem::discriminant;
use core::str::FromStr;

use glam::Vec3;
use thiserror::Error;

use super::display::Overlay;
use crate::kinematics::skeleton::{JointId, JointRemap};

/// A value of a document that keys can animate.
///
/// Every channel has a vector as its value, so that all channels are handled alike: a number is in
/// x, with y and z 0, and a switch is 0 or 1 in x.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Channel {
    /// Position of the skeleton's origin in the world.
    Translation,
    /// Influence of the balance, from 0 (without) to 1 (balanced).
    BalanceInfluence,
    /// Weight of a morph target of the skin, by its index: 0 without it, 1 in its shape.
    Morph(u16),
    /// Euler angles of a joint in radians, unwrapped.
    Rotation(JointId),
    /// Vector from the base of a joint's parent to the joint's base, in the parent's space; from
    /// the skeleton's origin for a root.
    Offset(JointId),
    /// Length of a joint's bone, in units of the skeleton; children at its tip move with it.
    Length(JointId),
    /// Factors by which a joint scales the skin along the axes of its frame.
    SkinScale(JointId),
    /// How far a joint shears the skin, see
    /// [`SkinStretch::shear`](crate::kinematics::skeleton::SkinStretch::shear).
    SkinShear(JointId),
    /// Position of a joint's target at time 0, in the target's space, while it is not pinned.
    Target(JointId),
    /// Position of a joint's target at time 0, in the world, while it is pinned.
    Pin(JointId),
    /// Switch: a joint's target is pinned to the world.
    Pinned(JointId),
    /// Influence of a joint's target, from 0 (FK pose) to 1 (solved pose).
    TargetInfluence(JointId),
    /// Euler angles in radians, unwrapped, of the hand of a limb or of the joint of a whole-body
    /// target, in the target's space.
    TargetOrientation(JointId),
    /// The point at which a joint's target aims the joint, in the target's space.
    TargetAim(JointId),
    /// Angle in radians, unwrapped, by which the elbow of a limb's target is turned.
    TargetTwist(JointId),
    /// The pole of a limb's target, in the pole's space.
    TargetPole(JointId),
    /// Factor by which the bones of a limb's target are lengthened in the FK pose.
    Stretch(JointId),
    /// Switch: a joint's target is enabled.
    Enabled(JointId),
    /// Switch: an overlay is shown.
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
    /// Any number without a unit.
    Number,
    /// Any three numbers without a unit.
    Numbers,
    /// An angle in radians.
    Angle,
    /// Euler angles in radians of a rotation, R_z · R_y · R_x. Keys can turn it the shortest way:
    /// see [`Interpolation::Slerp`](crate::kinematics::spline::Interpolation::Slerp).
    Rotation,
    /// 0 or 1, not interpolated.
    Switch,
}

impl Quantity {
    /// Number of components in use: 1 or 3.
    pub fn width(self) -> usize {
        match self {
            Self::Point | Self::Numbers | Self::Rotation => 3,
            Self::Length | Self::Fraction | Self::Number | Self::Angle | Self::Switch => 1,
        }
    }
}

/// True if the value of a switch is on.
pub(super) fn is_on(value: Vec3) -> bool {
    value.x >= 0.5
}

/// Lists of channels. A new channel must be in one of them, or files cannot name it.
impl Channel {
    /// The channels of a joint and of its target.
    pub fn of_joint(joint: JointId) -> impl Iterator<Item = Self> {
        let own = [Self::Rotation(joint), Self::Offset(joint), Self::Length(joint)];
        let of_skin = [Self::SkinScale(joint), Self::SkinShear(joint)];
        own.into_iter().chain(of_skin).chain(Self::of_target(joint))
    }

    /// The channels of the target of a joint.
    pub fn of_target(joint: JointId) -> [Self; 10] {
        [
            Self::Target(joint),
            Self::Pinned(joint),
            Self::Pin(joint),
            Self::TargetInfluence(joint),
            Self::TargetOrientation(joint),
            Self::TargetAim(joint),
            Self::TargetTwist(joint),
            Self::TargetPole(joint),
            Self::Stretch(joint),
            Self::Enabled(joint),
        ]
    }

    /// The channel that has this [`name`](Self::name), for the given joint, overlay or morph target
    /// if the channel belongs to one. `None` if the name is unknown, or its owner is missing.
    pub fn named(
        name: &str,
        joint: Option<JointId>,
        overlay: Option<Overlay>,
        morph: Option<u16>,
    ) -> Option<Self> {
        let of_joint = joint.into_iter().flat_map(Self::of_joint);
        let of_rig = [Self::Translation, Self::BalanceInfluence].into_iter();
        let of_skin = morph.map(Self::Morph);
        let mut channels = of_rig.chain(of_joint).chain(overlay.map(Self::Overlay)).chain(of_skin);
        channels.find(|channel| channel.name() == name)
    }

    /// True if the channel's values are switches, 0 or 1.
    pub fn is_switch(self) -> bool {
        self.quantity() == Quantity::Switch
    }

    /// True if the channel's values are the Euler angles of one rotation.
    pub fn is_rotation(self) -> bool {
        self.quantity() == Quantity::Rotation
    }

    /// The same channel after its joint was renumbered; `None` if its joint was removed.
    #[must_use]
    pub fn remapped(self, remap: &JointRemap) -> Option<Self> {
        let Some(joint) = self.joint() else { return Some(self) };
        let is_same = |other: &Self| discriminant(other) == discriminant(&self);
        Self::of_joint(remap.get(joint)?).find(is_same)
    }
}

/// A text that names no channel.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error(
    "channel must be translation, balance_influence, a name and a joint's index such as \"rotation 3\", \
     \"morph\" and a morph target's index, or \"overlay\" and an overlay's name, got {0:?}"
)]
pub struct UnknownChannel(String);

/// Writes the name and, if the channel belongs to a joint, a morph target or an overlay, a space and
/// the index or the overlay's name.
impl fmt::Display for Channel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())?;
        if let Self::Overlay(overlay) = self {
            write!(f, " {}", overlay.name())?;
        }
        if let Self::Morph(morph) = self {
            write!(f, " {morph}")?;
        }
        self.joint().map_or(Ok(()), |joint| write!(f, " {joint}"))
    }
}

/// Inverse of [`Display`](fmt::Display).
impl FromStr for Channel {
    type Err = UnknownChannel;

    fn from_str(text: &str) -> Result<Self, UnknownChannel> {
        let (name, owner) = text.split_once(' ').unwrap_or((text, ""));
        let joint = owner.parse().ok().map(JointId::new);
        let (overlay, morph) = (Overlay::from_name(owner), owner.parse().ok());
        let channel = Self::named(name, joint, overlay, morph);
        // Refuses an owner of a channel that has none, and joints such as "+1".
        let channel = channel.filter(|channel| channel.to_string() == text);
        channel.ok_or_else(|| UnknownChannel(text.to_owned()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_channel_reads_back_from_its_text() {
        let joint = JointId::new(12);
        let of_owners = Overlay::all().map(Channel::Overlay).chain(Channel::of_joint(joint));
        let of_rig = [Channel::Translation, Channel::BalanceInfluence, Channel::Morph(7)];
        for channel in of_rig.into_iter().chain(of_owners) {
            assert_eq!(channel.to_string().parse(), Ok(channel), "{channel}");
        }
        assert_eq!(Channel::Rotation(joint).to_string(), "rotation 12");
        assert_eq!(Channel::Overlay(Overlay::GridXy).to_string(), "overlay grid_xy");
    }

    #[test]
    fn texts_that_name_no_channel_are_refused() {
        for text in [
            "",
            "Translation",
            "rotation",
            "rotation x",
            "rotation -1",
            "translation 1",
            "overlay",
            "translation ",
            "offset +1",
            "morph",
            "morph 70000",
        ] {
            let error = text.parse::<Channel>().expect_err(text);
            assert!(error.to_string().ends_with(&format!("got {text:?}")), "{error}");
        }
    }

    #[test]
    fn overlays_have_the_names_of_files() {
        for overlay in Overlay::all() {
            let in_file = serde_json::to_value(overlay).expect("a name");
            assert_eq!(in_file, overlay.name());
        }
    }
}
