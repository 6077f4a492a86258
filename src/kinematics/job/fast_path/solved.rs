use crate::kinematics::two_bone::Reach;

/// A distance, in chain lengths, up to which a hand is at its target: the rounding of the middle
/// joint's axes and of the rotations to f32.
pub const NEAR: f64 = 7e-7;

/// A distance, in chain lengths, at which a limit may keep a hand that is at its target: the
/// rounding of the limits alone.
pub const AT_LIMIT: f64 = 2e-7;

/// Two rotations (x, y, z, w) and where they bring the hand. Meaningless if not `is_usual`.
#[derive(Clone, Copy)]
pub struct Solved {
    pub start_correction: [f32; 4],
    pub middle_correction: [f32; 4],
    pub is_reached: bool,
    /// Whether the hand is farther from the start joint than the target is.
    pub is_too_close: bool,
    pub hand_error: f32,
    pub is_usual: bool,
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
