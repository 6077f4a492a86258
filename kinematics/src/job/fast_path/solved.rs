use crate::two_bone::Reach;

/// Maximum distance, in chain lengths, of a hand that counts as being at its target: the rounding of
/// the middle joint's axes and of the rotations to f32.
pub const NEAR: f64 = 7e-7;

/// Maximum distance, in chain lengths, from a target to the reach [|d₁ − d₂|, d₁ + d₂], if the target
/// still counts as reached: the rounding of these two bounds.
pub const AT_LIMIT: f64 = 2e-7;

/// The two corrections (x, y, z, w), and whether the hand reaches the target with them. Meaningless
/// if not `is_regular`.
#[derive(Clone, Copy)]
pub struct Solved {
    pub start_correction: [f32; 4],
    pub middle_correction: [f32; 4],
    pub is_reached: bool,
    /// True if the hand is farther from the start joint than the target is.
    pub is_too_close: bool,
    /// Distance from the hand to the target in model space.
    pub hand_error: f32,
    pub is_regular: bool,
}

impl Solved {
    #[inline(always)]
    pub fn reach(&self) -> Reach {
        if self.is_reached {
            Reach::Reached
        } else if self.is_too_close {
            Reach::TooClose
        } else {
            Reach::TooFar
        }
    }
}
