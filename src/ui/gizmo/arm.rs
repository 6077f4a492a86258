//! The gizmo of the arm: handles of Cursor, Pole and Root, rings of the angles, and the ring of the
//! Socket twist.

use egui::{Color32, Painter, Pos2, Ui};

use super::handles::{OUTER_RADIUS, RADIUS, RotateRing, TranslateHandles};
use super::screen::{ScreenProjection, bright};
use super::twist_ring::TwistRing;
use crate::document::{Overlay, TwistReferenceKind};
use crate::kinematics::skeleton::RotationAxis;
use crate::session::{ArmJoint, Grip, GripRing, PointHandle, Session};
use crate::ui::style;

/// Screen positions of the arm's handles. Handles that are behind the eye, or that move nothing in
/// the arm's current mode, are left out.
pub(in crate::ui) struct ArmGizmo {
    hand: Option<TranslateHandles>,
    pole: Option<TranslateHandles>,
    root: Option<TranslateHandles>,
    is_root_selected: bool,
    twist: Option<TwistRing>,
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
        let angles = RotationAxis::ALL.into_iter().map(Grip::Shoulder).chain([Grip::Bend]);
        let ring =
            |grip| RotateRing::new(screen, grip, GripRing::of_arm(session.posed(), grip)?, RADIUS);
        let is_hand_selected = session.selection().arm_joint() == Some(ArmJoint::Hand)
            && session.shown().display.shows(Overlay::Hand);
        let of_hand = RotationAxis::ALL.into_iter().map(Grip::HandRing);
        let of_hand = of_hand.filter(|_| is_hand_selected);
        let outer = |grip| {
            RotateRing::new(screen, grip, GripRing::of_arm(session.posed(), grip)?, OUTER_RADIUS)
        };
        Self {
            hand: is_led
                .then(|| TranslateHandles::new(screen, arm.cursor_in_world(), hand))
                .flatten(),
            pole: has_pole
                .then(|| TranslateHandles::new(screen, arm.root + arm.pole, None))
                .flatten(),
            root: TranslateHandles::new(screen, arm.root, None),
            is_root_selected: session.selection().arm_joint() == Some(ArmJoint::Root),
            twist: session.limb().and_then(|limb| {
                let is_selected = session.selection().arm_joint() == Some(ArmJoint::Elbow);
                TwistRing::new(screen, Grip::Twist, &limb.frames, is_selected)
            }),
            rings: angles.filter_map(ring).chain(of_hand.filter_map(outer)).collect(),
        }
    }

    /// The handle at a screen position; `None` if there is no handle.
    pub fn at(&self, mouse: Pos2) -> Option<Grip> {
        let on = |handles: &Option<TranslateHandles>| handles.as_ref()?.at(mouse);
        let of_hand = on(&self.hand).map(Grip::Hand);
        let of_pole = || on(&self.pole).map(Grip::Pole);
        of_hand
            .or_else(of_pole)
            .or_else(|| self.root_at(mouse))
            .or_else(|| self.twist.as_ref()?.at(mouse))
            .or_else(|| RotateRing::at(&self.rings, mouse))
    }

    /// The handle of the Root at a screen position. Until the Root is selected, it has no arrows
    /// and squares.
    fn root_at(&self, mouse: Pos2) -> Option<Grip> {
        let root = self.root.as_ref()?;
        let handle = if self.is_root_selected { root.at(mouse) } else { root.free_at(mouse) };
        handle.map(Grip::Root)
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
        self.paint_root(painter, ui, pointed, dragged);
        paint(self.pole.as_ref(), painter, ui, [pointed, dragged].map(of_pole), dragged);
        paint(self.hand.as_ref(), painter, ui, [pointed, dragged].map(of_hand), dragged);
        let palette = style::palette(ui);
        if let Some(twist) = &self.twist {
            let stands_out = matches!(dragged.or(pointed), Some(Grip::Twist | Grip::Limb));
            let colour = style::colour(palette.accent);
            twist.paint(painter, look(colour, stands_out, dragged.is_some()), stands_out);
        }
        for ring in &self.rings {
            let colour = style::colour(match ring.grip {
                Grip::Shoulder(axis) | Grip::HandRing(axis) => palette.axes[axis.index()],
                _ => palette.accent,
            });
            let stands_out = dragged.or(pointed) == Some(ring.grip);
            ring.paint(painter, look(colour, stands_out, dragged.is_some()), stands_out);
        }
    }
}

impl ArmGizmo {
    fn paint_root(&self, painter: &Painter, ui: &Ui, pointed: Option<Grip>, dragged: Option<Grip>) {
        let of_root = |grip: Option<Grip>| match grip {
            Some(Grip::Root(handle)) => Some(handle),
            _ => None,
        };
        let own = [pointed, dragged].map(of_root);
        match &self.root {
            Some(root) if !self.is_root_selected && dragged.is_none() && own[0].is_some() => {
                root.paint_free(painter, ui);
            }
            root => {
                let shown = root.as_ref().filter(|_| self.is_root_selected);
                paint(shown, painter, ui, own, dragged);
            }
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
