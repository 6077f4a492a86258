use crate::document::{Arm, Posed};
use crate::kinematics::twist::TransportedFrame;
use crate::kinematics::two_bone::Pointer;

/// Parallel transport of a frame along the Pointer's path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TransportPath {
    start: TransportedFrame,
    now: TransportedFrame,
}

impl TransportPath {
    /// A path that starts at the frame from which the arm's twist is measured.
    pub(in crate::session) fn new(posed: &Posed) -> Self {
        let start = posed.arm_solution().transported;
        Self { start, now: start }
    }

    pub(in crate::session) fn advance(&mut self, arm: &Arm) {
        let direction = Pointer::towards(arm.cursor_in_root(), arm.ik_state.pointer).direction;
        if direction != self.now.direction {
            self.now = self.now.to(direction);
        }
    }

    /// The frame transported along the path to the present Pointer, in Root space.
    pub fn transported(&self) -> TransportedFrame {
        self.now
    }

    /// Holonomy of the path: the angle about the Pointer, in radians in (−π, π], from the start
    /// frame transported straight to the present Pointer to the frame transported along the path.
    /// It equals the solid angle that the path encloses.
    pub fn holonomy(&self) -> f32 {
        self.start.turn_to(self.now)
    }
}
