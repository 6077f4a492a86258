use crate::document::Arm;
use crate::kinematics::twist::TransportedFrame;
use crate::kinematics::two_bone::Pointer;

/// What is carried along with the Pointer on its way: what transport would measure the elbow from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TransportPath {
    start: TransportedFrame,
    now: TransportedFrame,
}

impl TransportPath {
    /// From where the arm's spin is measured now.
    pub(super) fn new(arm: &Arm) -> Self {
        let start = arm.solve().transported;
        Self { start, now: start }
    }

    pub(super) fn go_on(&mut self, arm: &Arm) {
        let direction = Pointer::towards(arm.cursor_in_root(), arm.ik_state.pointer).direction;
        if direction != self.now.direction {
            self.now = self.now.to(direction);
        }
    }

    /// What has been carried to here.
    pub fn transported(&self) -> TransportedFrame {
        self.now
    }

    /// How far it came out turned against what goes straight from the start to here, radians in
    /// (−π, π]: the solid angle that the way goes around.
    pub fn holonomy(&self) -> f32 {
        self.start.turn_to(self.now)
    }
}
