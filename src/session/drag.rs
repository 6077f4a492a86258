use super::point_drag::{Constraint, DragInput, PointDrag, PointHandle};
use super::turn_drag::TurnDrag;
use crate::kinematics::skeleton::JointId;

/// What can be taken hold of in the viewport.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Grip {
    /// The arm's hand.
    Hand(PointHandle),
    /// What the arm's elbow points at.
    Pole(PointHandle),
    /// The ring about which the shoulder's angle x, y or z (0, 1, 2) turns.
    Shoulder(usize),
    /// The ring about which the elbow bends.
    Bend,
    /// The target of a joint.
    Target(JointId, PointHandle),
    /// The tip of a joint's bone.
    Tip(JointId, PointHandle),
    /// The ring about which a joint's angle x, y or z (0, 1, 2) turns.
    Ring(JointId, usize),
}

impl Grip {
    /// Whether what it says of axes are three.
    pub(super) fn is_possible(self) -> bool {
        match self {
            Self::Hand(handle)
            | Self::Pole(handle)
            | Self::Target(_, handle)
            | Self::Tip(_, handle) => handle.is_possible(),
            Self::Shoulder(axis) | Self::Ring(_, axis) => axis < 3,
            Self::Bend => true,
        }
    }
}

/// What is held, and where it has been taken.
#[derive(Clone, Debug, PartialEq)]
pub struct Drag {
    pub(super) grip: Grip,
    pub(super) kind: DragKind,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum DragKind {
    Point(PointDrag),
    Turn(TurnDrag),
}

impl Drag {
    pub fn grip(&self) -> Grip {
        self.grip
    }

    /// The point that is held, unless it is a ring.
    pub fn point(&self) -> Option<&PointDrag> {
        match &self.kind {
            DragKind::Point(drag) => Some(drag),
            DragKind::Turn(_) => None,
        }
    }

    /// The ring that is held, unless it is a point.
    pub fn turn(&self) -> Option<&TurnDrag> {
        match &self.kind {
            DragKind::Turn(drag) => Some(drag),
            DragKind::Point(_) => None,
        }
    }

    /// What is typed while it is held.
    pub fn typed(&self) -> &str {
        match &self.kind {
            DragKind::Point(drag) => drag.typed(),
            DragKind::Turn(drag) => drag.typed(),
        }
    }

    pub(super) fn set_input(&mut self, input: DragInput) {
        match &mut self.kind {
            DragKind::Point(drag) => drag.set_input(input),
            DragKind::Turn(drag) => drag.set_input(input),
        }
    }

    pub(super) fn set_typed(&mut self, typed: String) {
        match &mut self.kind {
            DragKind::Point(drag) => drag.set_typed(typed),
            DragKind::Turn(drag) => drag.set_typed(typed),
        }
    }

    /// Rings have nothing to be held to.
    pub(super) fn set_constraint(&mut self, constraint: Option<Constraint>) {
        if let DragKind::Point(drag) = &mut self.kind {
            drag.set_constraint(constraint);
        }
    }
}
