use core::fmt;
use core::str::FromStr;

use thiserror::Error;

/// Kind of a [`TwistReference`](super::TwistReference), without its pole or map; for choices and
/// names.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum TwistReferenceKind {
    /// Up: the Limb frame's +y.
    #[default]
    #[cfg_attr(feature = "serde", serde(alias = "limb"))]
    Up,
    /// Direction towards a point of Root space.
    Pole,
    /// Stereographic map of directions.
    Stereographic,
    /// The previous direction, parallel-transported.
    Transport,
}

/// Error for a text that is not the name of a twist reference.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("twist reference must be up, pole, stereographic or transport")]
pub struct UnknownTwistReference;

impl TwistReferenceKind {
    /// All kinds, in the order in which panels list them.
    pub const ALL: [Self; 4] = [Self::Up, Self::Pole, Self::Stereographic, Self::Transport];

    /// Name for labels, and the name in files and on the command line.
    fn names(self) -> (&'static str, &'static str) {
        match self {
            Self::Up => ("Up", "up"),
            Self::Pole => ("Pole", "pole"),
            Self::Stereographic => ("Stereographic", "stereographic"),
            Self::Transport => ("Transport", "transport"),
        }
    }

    /// Name for labels, such as "Up".
    pub fn name(self) -> &'static str {
        self.names().0
    }
}

impl fmt::Display for TwistReferenceKind {
    /// The name in lower case, as in files and on the command line.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.names().1)
    }
}

impl FromStr for TwistReferenceKind {
    type Err = UnknownTwistReference;

    /// Reads the name in lower case: the inverse of [`Display`](fmt::Display). `limb`, the former name
    /// of `up`, is read too.
    fn from_str(text: &str) -> Result<Self, UnknownTwistReference> {
        let name = if text == "limb" { "up" } else { text };
        Self::ALL.into_iter().find(|kind| kind.names().1 == name).ok_or(UnknownTwistReference)
    }
}
