use serde::{Deserialize, Serialize};

use crate::document::RigKind;

/// A page of the panel on the right.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PanelTab {
    /// The arm's triangle with its angles and lengths.
    Triangle,
    /// The four twist references compared.
    Twist,
    /// The distances that the hand can have.
    Reach,
    /// The jumps of the elbow, their causes and their fixes.
    Pops,
    /// The solver: for a skeleton its settings and iterations, for an arm why there are none.
    Solver,
    /// All solvers at once, on the same targets.
    Race,
    /// The cross-section of the skin for each way of blending joints.
    Skin,
}

impl PanelTab {
    const ARM: [Self; 5] = [Self::Triangle, Self::Twist, Self::Reach, Self::Pops, Self::Solver];
    const SKELETON: [Self; 3] = [Self::Solver, Self::Race, Self::Skin];

    /// The tabs for a rig, in the order of the panel.
    pub fn of(rig: RigKind) -> &'static [Self] {
        match rig {
            RigKind::Arm => &Self::ARM,
            RigKind::Skeleton => &Self::SKELETON,
        }
    }

    /// Name on the tab.
    pub fn name(self) -> &'static str {
        match self {
            Self::Triangle => "Triangle",
            Self::Twist => "Twist",
            Self::Reach => "Reach",
            Self::Pops => "Pops",
            Self::Solver => "Solver",
            Self::Race => "Race",
            Self::Skin => "Skin",
        }
    }
}
