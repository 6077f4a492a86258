//! The gizmo of the arm: handles of Cursor and Pole, and rings of the joint angles.

use egui::{Color32, Painter, Pos2, Ui};

use super::rotate::RotateRing;
use super::shape::bright;
use super::translate::TranslateHandles;
use crate::document::TwistReferenceKind;
use crate::session::{Grip, PointHandle, Session};
use crate::ui::style;
use crate::ui::viewport::projection::ScreenProjection;

/// Screen positions of the arm's handles. Handles that are behind the eye, or that move nothing in
/// the arm's current mode, are left out.
pub(in crate::ui) struct ArmGizmo {
    hand: Option<TranslateHandles>,
    pole: Option<TranslateHandles>,
    rings: Vec<RotateRing>,
}

impl ArmGizmo {
    pub fn new(screen: &ScreenProjection, session: &Session) -> Self {
        let (arm, pose) = (session.arm(), session.pose());
        // In a blend of IK and FK the hand is away from the Cursor, so the hand is no handle of the
        // Cursor.
        let hand = (arm.influence == 1.0).then(|| arm.root + pose.hand);
        let is_led = arm.uses_ik();
        let has_pole = is_led && arm.twist_reference == TwistReferenceKind::Pole;
        let angles = (0..3).map(Grip::Shoulder).chain([Grip::Bend]);
        let ring = |grip| RotateRing::new(screen, grip, session.arm_ring(grip)?);
        Self {
            hand: is_led
                .then(|| TranslateHandles::new(screen, arm.cursor_in_world(), hand))
                .flatten(),
            pole: has_pole
                .then(|| TranslateHandles::new(screen, arm.root + arm.pole, None))
                .flatten(),
            rings: angles.filter_map(ring).collect(),
        }
    }

    /// The handle at a screen position; `None` if there is no handle.
    pub fn at(&self, mouse: Pos2) -> Option<Grip> {
        let on = |handles: &Option<TranslateHandles>| handles.as_ref()?.at(mouse);
        let of_hand = on(&self.hand).map(Grip::Hand);
        let of_pole = || on(&self.pole).map(Grip::Pole);
        of_hand.or_else(of_pole).or_else(|| RotateRing::at(&self.rings, mouse))
    }

    pub fn paint(&self, painter: &Painter, ui: &Ui, pointed: Option<Grip>, dragged: Option<Grip>) {
        let of_hand = |grip: Option<Grip>| match grip {
            Some(Grip::Hand(handle)) => Some(handle),
            _ => None,
        };
        let of_pole = |grip: Option<Grip>| match grip {
            Some(Grip::Pole(handle)) => Some(handle),
            _ => None,
        };
        paint(self.pole.as_ref(), painter, ui, [pointed, dragged].map(of_pole), dragged);
        paint(self.hand.as_ref(), painter, ui, [pointed, dragged].map(of_hand), dragged);
        let palette = style::palette(ui);
        for ring in &self.rings {
            let colour = style::colour(match ring.grip {
                Grip::Shoulder(axis) => palette.axes[axis.min(2)],
                _ => palette.accent,
            });
            let stands_out = dragged.or(pointed) == Some(ring.grip);
            ring.paint(painter, look(colour, stands_out, dragged.is_some()), stands_out);
        }
    }
}

/// Paints the handles of one point, unless a handle of something else is dragged. `pointed` and
/// `own` are the hovered and the dragged handle of this point.
fn paint(
    handles: Option<&TranslateHandles>,
    painter: &Painter,
    ui: &Ui,
    [pointed, own]: [Option<PointHandle>; 2],
    dragged: Option<Grip>,
) {
    if let Some(handles) = handles.filter(|_| dragged.is_none() || own.is_some()) {
        handles.paint(painter, ui, pointed, own);
    }
}

fn look(colour: Color32, stands_out: bool, is_held: bool) -> Color32 {
    match (stands_out, is_held) {
        (true, _) => bright(colour),
        (false, true) => colour.gamma_multiply(0.25),
        (false, false) => colour,
    }
}
