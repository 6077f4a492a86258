use crate::skeleton::JointId;

/// The reason why a tip is not at its target, or a hand not turned as its target asks, with its
/// evidence. Lengths are in world units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cause {
    /// The target is farther from the chain's base than the bones reach, or closer than they fold.
    OutOfReach {
        /// The joint at the chain's base.
        base: JointId,
        /// Distance from the chain's base to the target.
        distance: f32,
        /// The nearest distance of the tip from the base.
        shortest: f32,
        /// The farthest distance of the tip from the base.
        longest: f32,
        /// What bounds the reach.
        boundary: Boundary,
    },
    /// The joints are at limits, and the target pulls them outwards.
    Limits,
    /// The limits of a hand's joint keep it from the rotation that the target asks for.
    RotationLimits {
        /// Angle in radians that is missing.
        missing: f32,
        /// The angles of the joint, x, y and z, whose limits are in the way.
        axes: [bool; 3],
    },
    /// The target pulls joints that are locked.
    Locked,
    /// The tip reaches its target alone, but not together with the tip of another joint.
    Conflict {
        /// The joint of the other target.
        with: JointId,
    },
    /// No small change of the angles brings the tip nearer, but another pose is at the target.
    Stalled,
    /// No joint moves the tip in the direction in which the target is.
    Singular {
        /// Speed of the tip towards the target, as a fraction of its speed in the direction in which
        /// it moves best, for the same angular speed of all joints.
        mobility: f32,
    },
    /// The tip was still coming nearer when the solver stopped.
    OutOfIterations {
        /// Number of iterations after which the solver stopped.
        iterations: u32,
    },
    /// The pose is a mix of the FK pose and the solved one, which reaches the target.
    Influence {
        /// Fraction of the way from the FK pose to the solved one.
        influence: f32,
    },
}

/// What bounds the reach of a chain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Boundary {
    /// The lengths of the bones.
    Bones,
    /// A soft limit, which slows the tip down before the bones are straight or folded.
    SoftLimit,
    /// The smallest elbow angle.
    ElbowAngle,
}

impl Cause {
    /// Name on the command line, such as `out_of_reach`.
    pub fn name(self) -> &'static str {
        match self {
            Self::OutOfReach { .. } => "out_of_reach",
            Self::Limits => "limits",
            Self::RotationLimits { .. } => "rotation_limits",
            Self::Locked => "locked",
            Self::Conflict { .. } => "conflict",
            Self::Stalled => "stalled",
            Self::Singular { .. } => "singular",
            Self::OutOfIterations { .. } => "out_of_iterations",
            Self::Influence { .. } => "influence",
        }
    }
}
