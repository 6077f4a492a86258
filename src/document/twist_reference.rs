use serde::{Deserialize, Serialize};

/// The kinds of twist reference, the direction that the Socket twist is measured from: see
/// [`TwistReference`](crate::kinematics::twist::TwistReference).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TwistReferenceKind {
    /// The least rotation from the Limb's rest direction.
    #[default]
    Limb,
    /// The direction of a pole, a point in Root space.
    Pole,
    /// A field of directions with one singularity, behind the arm.
    Stereographic,
    /// The last direction, transported in parallel.
    Transport,
}

impl TwistReferenceKind {
    /// All kinds, in the order in which panels list them.
    pub const ALL: [Self; 4] = [Self::Limb, Self::Pole, Self::Stereographic, Self::Transport];

    /// Name on screen.
    pub fn name(self) -> &'static str {
        match self {
            Self::Limb => "Limb",
            Self::Pole => "Pole",
            Self::Stereographic => "Stereographic",
            Self::Transport => "Transport",
        }
    }
}
