use core::fmt;
use core::str::FromStr;

use thiserror::Error;

/// A [`TwistReference`](super::TwistReference) without its pole or map, for choices and names.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum TwistReferenceKind {
    /// The Limb frame's +y.
    #[default]
    Limb,
    /// Direction towards a point of Root space.
    Pole,
    /// Stereographic map.
    Stereographic,
    /// The previous direction, parallel-transported.
    Transport,
}

/// A text that names no twist reference.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("twist reference must be limb, pole, stereographic or transport")]
pub struct UnknownTwistReference;

impl TwistReferenceKind {
    /// All kinds, in the order of panels.
    pub const ALL: [Self; 4] = [Self::Limb, Self::Pole, Self::Stereographic, Self::Transport];

    /// Name as a label.
    pub fn name(self) -> &'static str {
        match self {
            Self::Limb => "Limb",
            Self::Pole => "Pole",
            Self::Stereographic => "Stereographic",
            Self::Transport => "Transport",
        }
    }
}

impl fmt::Display for TwistReferenceKind {
    /// The name in lower case, as in files and on the command line.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Limb => "limb",
            Self::Pole => "pole",
            Self::Stereographic => "stereographic",
            Self::Transport => "transport",
        })
    }
}

impl FromStr for TwistReferenceKind {
    type Err = UnknownTwistReference;

    /// Inverse of [`Display`](fmt::Display).
    fn from_str(text: &str) -> Result<Self, UnknownTwistReference> {
        match text {
            "limb" => Ok(Self::Limb),
            "pole" => Ok(Self::Pole),
            "stereographic" => Ok(Self::Stereographic),
            "transport" => Ok(Self::Transport),
            _ => Err(UnknownTwistReference),
        }
    }
}
