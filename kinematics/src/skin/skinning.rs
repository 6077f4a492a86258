use core::fmt;
use core::str::FromStr;

/// How the joints of a vertex are blended. See [the module](super).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Skinning {
    /// Weighted sum of the joints' matrices.
    Linear,
    /// Weighted sum of the joints' unit dual quaternions, after their scales.
    #[default]
    DualQuaternion,
    /// Linear, with each bone's roll spread along the bone.
    SpreadTwist,
}

impl Skinning {
    /// All methods.
    pub const ALL: [Self; 3] = [Self::Linear, Self::DualQuaternion, Self::SpreadTwist];

    /// Name on screen.
    pub fn title(self) -> &'static str {
        match self {
            Self::Linear => "Linear",
            Self::DualQuaternion => "Dual quaternions",
            Self::SpreadTwist => "Spread twist",
        }
    }
}

impl fmt::Display for Skinning {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(match self {
            Self::Linear => "linear",
            Self::DualQuaternion => "dual-quaternion",
            Self::SpreadTwist => "spread-twist",
        })
    }
}

/// A text names no way to blend joints.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("skinning must be linear, dual-quaternion or spread-twist, got {0}")]
pub struct UnknownSkinning(pub String);

impl FromStr for Skinning {
    type Err = UnknownSkinning;

    fn from_str(text: &str) -> Result<Self, UnknownSkinning> {
        let named = Self::ALL.into_iter().find(|skinning| skinning.to_string() == text);
        named.ok_or_else(|| UnknownSkinning(text.to_owned()))
    }
}
