//! The ring of the Socket twist: the circle around the Pointer on which the elbow moves.

use egui::{Color32, Painter, Pos2, Stroke};

use super::rotate::RotateRing;
use crate::session::{ArmJoint, Grip, Session};
use crate::ui::viewport::projection::ScreenProjection;

/// Radius in points, around the elbow, of the handle that is always there.
const ELBOW: f32 = 14.0;

/// Screen positions of the ring. Until the elbow is selected, only the elbow can be dragged, and
/// the ring is shown only under the mouse.
pub(in crate::ui) struct TwistRing {
    ring: RotateRing,
    elbow: Pos2,
    is_selected: bool,
}

impl TwistRing {
    /// The ring of the shown arm. `None` in FK, if a part of the ring is behind the eye, or if the
    /// arm is so straight or folded that the ring is smaller on screen than the handle.
    pub fn new(screen: &ScreenProjection, session: &Session) -> Option<Self> {
        let ring = session.arm_ring(Grip::Twist)?;
        let elbow = session.arm().root + session.pose().elbow;
        if session.pose().out < ELBOW * screen.units_per_point(ring.centre) {
            return None;
        }
        Some(Self {
            ring: RotateRing::through(screen, Grip::Twist, ring, elbow)?,
            elbow: screen.place(elbow)?,
            is_selected: session.selected_arm_joint() == Some(ArmJoint::Elbow),
        })
    }

    /// The handle at a screen position; `None` if there is no handle.
    pub fn at(&self, mouse: Pos2) -> Option<Grip> {
        let on_elbow = self.elbow.distance(mouse) <= ELBOW;
        let on_ring = || RotateRing::at(core::slice::from_ref(&self.ring), mouse);
        if on_elbow {
            return Some(Grip::Twist);
        }
        self.is_selected.then(on_ring).flatten()
    }

    /// Draws the ring, and a small circle around the elbow.
    pub fn paint(&self, painter: &Painter, colour: Color32, stands_out: bool) {
        if stands_out || self.is_selected {
            self.ring.paint(painter, colour, stands_out);
            painter.circle_stroke(self.elbow, ELBOW - 2.0, Stroke::new(1.5, colour));
        }
    }
}
