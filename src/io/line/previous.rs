use crate::kinematics::ik::{IkSolution, IkState};

/// The state that a transported line passes on to the next one: the Pointer, used if the hand is at
/// the shoulder or straight above or below it, and the frame that the twist was measured in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PreviousLine(pub(super) IkState);

impl PreviousLine {
    pub(super) fn new(solved: &IkSolution) -> Self {
        Self(solved.state())
    }
}
