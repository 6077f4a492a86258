//! Names of channels, as in files and on the command line.

use core::fmt;
use core::str::FromStr;

use thiserror::Error;

use super::channel::{Access, Channel};
use super::display::Overlay;
use crate::kinematics::skeleton::JointId;

/// A text that names no channel.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error(
    "channel must be a name such as twist, a name and a joint's index such as \"rotation 3\", or \
     \"overlay\" and an overlay's name, got {0:?}"
)]
pub struct UnknownChannel(String);

impl Channel {
    /// The channel that has this [`name`](Self::name), for the given joint or overlay if the
    /// channel belongs to one. `None` if the name is unknown, or the joint or overlay is missing.
    pub fn named(name: &str, joint: Option<JointId>, overlay: Option<Overlay>) -> Option<Self> {
        let of_rigs = Self::ARM.into_iter().chain([Self::Translation]);
        let of_joint = joint.into_iter().flat_map(Self::of_joint);
        let mut channels = of_rigs.chain(of_joint).chain(overlay.map(Self::Overlay));
        channels.find(|channel| channel.name() == name)
    }
}

/// Writes the name and, if the channel belongs to a joint or an overlay, a space and the joint's
/// index or the overlay's name.
impl fmt::Display for Channel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())?;
        match self.access() {
            Access::Joint { joint, .. } | Access::Target { joint, .. } => write!(f, " {joint}"),
            Access::Overlay(overlay) => write!(f, " {}", overlay.name()),
            Access::Arm { .. } | Access::Skeleton { .. } => Ok(()),
        }
    }
}

/// Inverse of [`Display`](fmt::Display).
impl FromStr for Channel {
    type Err = UnknownChannel;

    fn from_str(text: &str) -> Result<Self, UnknownChannel> {
        let (name, owner) = text.split_once(' ').unwrap_or((text, ""));
        let joint = owner.parse().ok().map(JointId::new);
        let channel = Self::named(name, joint, Overlay::from_name(owner));
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
        for channel in Channel::ARM.into_iter().chain([Channel::Translation]).chain(of_owners) {
            assert_eq!(channel.to_string().parse(), Ok(channel), "{channel}");
        }
        assert_eq!(Channel::Rotation(joint).to_string(), "rotation 12");
        assert_eq!(Channel::Overlay(Overlay::GridXy).to_string(), "overlay grid_xy");
    }

    #[test]
    fn texts_that_name_no_channel_are_refused() {
        for text in [
            "",
            "Twist",
            "rotation",
            "rotation x",
            "rotation -1",
            "twist 1",
            "overlay",
            "hand ",
            "offset +1",
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
