use crate::two_bone::TwoBone;

/// Bone lengths of a batch.
#[derive(Clone, Copy, Debug)]
pub enum BatchBones<'a> {
    /// The same bones for all arms.
    Same(TwoBone),
    /// Lengths of each arm, finite and above 0.
    Each {
        /// d₁ of each arm.
        upper: &'a [f32],
        /// d₂ of each arm.
        lower: &'a [f32],
    },
}

/// Twists of a batch: angles ψ about the Pointer from the Limb frame's +y to the elbow.
#[derive(Clone, Copy, Debug)]
pub enum BatchTwist<'a> {
    /// ψ in radians.
    Angle(&'a [f32]),
    /// Cosine and sine of ψ: several times as fast, and the same on every machine.
    CosSin {
        /// cos ψ of each arm.
        cos: &'a [f32],
        /// sin ψ of each arm.
        sin: &'a [f32],
    },
}
