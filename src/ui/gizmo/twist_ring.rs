//! The ring of a limb's twist, about its Pointer.

use egui::{Color32, Painter, Pos2, Stroke};

use super::handles::RotateRing;
use super::screen::ScreenProjection;
use crate::rig::LimbFrames;
use crate::session::{Grip, GripRing};

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
    /// The ring of a limb, with the grip that drags it. `None` where FK alone poses the limb, if a
    /// part of the ring is behind the eye, or if the limb is so straight or folded that the ring is
    /// smaller on screen than the handle.
    pub fn new(
        screen: &ScreenProjection,
        grip: Grip,
        limb: &LimbFrames,
        is_selected: bool,
    ) -> Option<Self> {
        let ring = GripRing::of_twist(limb)?;
        let elbow = limb.in_world(limb.pose().elbow);
        if limb.pose().out < ELBOW * screen.units_per_point(ring.centre) {
            return None;
        }
        let elbow_on_screen = screen.place(elbow)?;
        let ring = RotateRing::through(screen, grip, ring, elbow)?;
        Some(Self { ring, elbow: elbow_on_screen, is_selected })
    }

    /// The grip that drags the ring.
    pub fn grip(&self) -> Grip {
        self.ring.grip
    }

    /// The handle at a screen position; `None` if there is no handle.
    pub fn at(&self, mouse: Pos2) -> Option<Grip> {
        let on_elbow = self.elbow.distance(mouse) <= ELBOW;
        let on_ring = || RotateRing::at(core::slice::from_ref(&self.ring), mouse);
        if on_elbow {
            return Some(self.ring.grip);
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
