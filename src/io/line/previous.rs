use crate::kinematics::ik::{IkSolution, IkState};

/// State that a line with the transport reference passes on to the next line: its Pointer, and the
/// frame in which its twist was measured. The Pointer is used if the hand of the next line is at
/// the shoulder, or straight above or below the shoulder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PreviousLine(pub(super) IkState);

impl PreviousLine {
    pub(super) fn new(solved: &IkSolution) -> Self {
        Self(solved.state())
    }
}
