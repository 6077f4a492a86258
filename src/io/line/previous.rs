use crate::kinematics::ik::Solved;
use crate::kinematics::twist::TransportedFrame;
use crate::kinematics::two_bone::Facing;

/// The state that a transported line passes on to the next one: the direction in which the arm faced,
/// used if the hand is at the shoulder or straight above or below it, and the frame that the twist was
/// measured in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PreviousLine {
    pub(super) facing: Facing,
    pub(super) transported: TransportedFrame,
}

impl PreviousLine {
    pub(super) fn new(solved: &Solved) -> Self {
        Self { facing: solved.pose.facing, transported: solved.transported }
    }
}
