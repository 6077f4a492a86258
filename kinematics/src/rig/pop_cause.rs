/// Cause of a pop of a rig.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum RigPopCause {
    /// The target moves by more than a tenth of the chain in the step.
    TargetJump,
    /// The FK pose moves by more than a tenth of the chain in the step.
    FkJump,
    /// A target begins or ceases to pose the joints.
    Switched,
    /// The target is not reached any more, by the pose to which the motion has come.
    Lost,
    /// The target is reached again, or comes nearer after it was lost.
    Found,
    /// Each frame is solved by itself, and neighbouring frames find different poses.
    ByItself,
    /// An angle comes to an end of its range.
    LimitMet,
    /// An angle leaves an end of its range.
    LimitLeft,
    /// The chain or limb is nearly straight.
    Straight,
    /// The tip is near the base of the chain or limb.
    Folded,
    /// The limb's twist reference is near a direction in which it is singular.
    Singular,
    /// The FK pose of the limb passes through straight.
    StraightFk,
    /// The method needs many iterations, because bones are nearly in line with the way of the tip,
    /// and turns them over.
    TurnsOver,
    /// Joints swing back towards the FK pose, for as far as the targets leave them free.
    Returns,
    /// Angles at the ends of their ranges leave other joints to make up for them.
    AtLimit,
    /// The motion starts again from its first frame.
    Seam,
    /// None of these.
    Unknown,
}

impl RigPopCause {
    /// All causes.
    pub const ALL: [Self; 17] = [
        Self::TargetJump,
        Self::FkJump,
        Self::Switched,
        Self::Lost,
        Self::Found,
        Self::ByItself,
        Self::LimitMet,
        Self::LimitLeft,
        Self::Straight,
        Self::Folded,
        Self::Singular,
        Self::StraightFk,
        Self::TurnsOver,
        Self::Returns,
        Self::AtLimit,
        Self::Seam,
        Self::Unknown,
    ];

    /// Name of the cause in machine-readable output.
    pub fn name(self) -> &'static str {
        match self {
            Self::TargetJump => "target_jump",
            Self::FkJump => "fk_jump",
            Self::Switched => "switched",
            Self::Lost => "lost",
            Self::Found => "found",
            Self::ByItself => "by_itself",
            Self::LimitMet => "limit_met",
            Self::LimitLeft => "limit_left",
            Self::Straight => "straight",
            Self::Folded => "folded",
            Self::Singular => "singular",
            Self::StraightFk => "straight_fk",
            Self::TurnsOver => "turns_over",
            Self::Returns => "returns",
            Self::AtLimit => "at_limit",
            Self::Seam => "seam",
            Self::Unknown => "unknown",
        }
    }
}
