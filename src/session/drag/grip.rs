use glam::Vec3;

use super::point::{Constraint, DragInput, PointDrag, PointHandle};
use super::turn::TurnDrag;
use crate::kinematics::chain_ik::Ellipsoid;
use crate::kinematics::skeleton::{JointId, LimitEnd, RotationAxis};

/// A part of a gizmo that can be dragged in the viewport.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Grip {
    /// The target of a joint.
    Target(JointId, PointHandle),
    /// The pole of a limb's target, by the target's joint.
    LimbPole(JointId, PointHandle),
    /// The point at which the target of a joint aims the joint.
    Aim(JointId, PointHandle),
    /// The ring of the twist of a limb's target, about the Pointer, by the target's joint.
    LimbTwist(JointId),
    /// The head of a skeleton that follows a path; dragging it pulls the chain.
    Head(JointId, PointHandle),
    /// The tip of a joint's bone.
    Tip(JointId, PointHandle),
    /// The point of a joint's bone that the mouse pressed.
    Bone(JointId),
    /// The ring of a joint's angle about x, y or z.
    Ring(JointId, RotationAxis),
    /// The ring of the angle about x, y or z of the orientation that the target of a
    /// joint holds.
    Orientation(JointId, RotationAxis),
    /// An end of a joint's limits.
    Limit(JointId, LimitEnd),
}

impl Grip {
    /// True if the axis of the grip's handle, if it has one, is 0, 1 or 2.
    pub(in crate::session) fn has_valid_axis(self) -> bool {
        match self {
            Self::Target(_, handle)
            | Self::LimbPole(_, handle)
            | Self::Aim(_, handle)
            | Self::Head(_, handle)
            | Self::Tip(_, handle) => handle.has_valid_axis(),
            Self::Bone(_)
            | Self::Ring(..)
            | Self::Orientation(..)
            | Self::Limit(..)
            | Self::LimbTwist(_) => true,
        }
    }

    /// Label of the undo step of a drag of this part.
    pub(in crate::session) fn label(self) -> &'static str {
        match self {
            Self::LimbTwist(_) => "Set Socket twist",
            Self::Target(..) => "Move target",
            Self::LimbPole(..) => "Move pole",
            Self::Aim(..) => "Move aim",
            Self::Head(..) => "Move head",
            Self::Tip(..) | Self::Bone(_) => "Pose joints",
            Self::Ring(..) => "Turn joint",
            Self::Orientation(..) => "Turn target",
            Self::Limit(..) => "Move limit",
        }
    }
}

/// A drag in the viewport.
#[derive(Clone, Debug, PartialEq)]
pub struct Drag {
    grip: Grip,
    kind: DragKind,
    /// Points in the world through which the head of a skeleton was dragged.
    waypoints: Vec<Vec3>,
    limit: Option<DragLimit>,
}

/// What the targets of a body leave to a drag of one of its points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DragLimit {
    /// Distance in the world from the point to where it is dragged.
    pub short: f32,
    /// Velocities that the point can have.
    pub freedom: Ellipsoid,
}

#[derive(Clone, Debug, PartialEq)]
enum DragKind {
    Point(PointDrag),
    Turn(TurnDrag),
}

/// Where a drag has moved its grip.
#[derive(Clone, Copy, Debug)]
pub(in crate::session) enum Dragged {
    Point {
        /// The point, in world space.
        to: Vec3,
        /// Offset since the press.
        moved: Vec3,
        /// True if the mouse has moved, or an offset was typed.
        has_moved: bool,
    },
    /// The angle of a ring, in radians.
    Angle(f32),
}

impl Drag {
    pub(in crate::session) fn of_point(grip: Grip, drag: PointDrag) -> Self {
        Self { grip, kind: DragKind::Point(drag), waypoints: Vec::new(), limit: None }
    }

    pub(in crate::session) fn of_ring(grip: Grip, drag: TurnDrag) -> Self {
        Self { grip, kind: DragKind::Turn(drag), waypoints: Vec::new(), limit: None }
    }

    /// Computes where the grip is now. The path of a head keeps points that are `spacing` apart.
    pub(in crate::session) fn dragged(&mut self, spacing: f32) -> Dragged {
        if matches!(self.grip, Grip::Head(..)) {
            self.add_waypoint(spacing);
        }
        match &mut self.kind {
            DragKind::Turn(turn) => Dragged::Angle(turn.angle()),
            DragKind::Point(point) => {
                let to = point.point();
                Dragged::Point { to, moved: point.moved(), has_moved: point.has_moved() }
            }
        }
    }

    /// Points in the world through which the head of a skeleton was dragged.
    pub(in crate::session) fn waypoints(&self) -> &[Vec3] {
        &self.waypoints
    }

    /// Adds the dragged point to [`Drag::waypoints`]; it replaces the last one if that was nearer
    /// than `spacing` to the one before it. A typed offset discards the others: the head moves
    /// straight to its point. There are none before the mouse moves.
    fn add_waypoint(&mut self, spacing: f32) {
        let DragKind::Point(drag) = &mut self.kind else {
            return;
        };
        if !drag.typed().is_empty() || !drag.has_moved() {
            self.waypoints.clear();
        } else if let [.., before, last] = self.waypoints[..]
            && before.distance(last) < spacing
        {
            self.waypoints.pop();
        }
        if drag.has_moved() {
            self.waypoints.push(drag.point());
        }
    }

    /// What the targets of the body leave to the drag; `None` for a drag that they do not limit.
    pub fn limit(&self) -> Option<&DragLimit> {
        self.limit.as_ref()
    }

    pub(in crate::session) fn set_limit(&mut self, limit: DragLimit) {
        self.limit = Some(limit);
    }

    /// The part of a gizmo that is dragged.
    pub fn grip(&self) -> Grip {
        self.grip
    }

    /// The drag of a point; `None` for a ring.
    pub fn point(&self) -> Option<&PointDrag> {
        match &self.kind {
            DragKind::Point(drag) => Some(drag),
            DragKind::Turn(_) => None,
        }
    }

    /// The drag of a ring; `None` for a point.
    pub fn turn(&self) -> Option<&TurnDrag> {
        match &self.kind {
            DragKind::Turn(drag) => Some(drag),
            DragKind::Point(_) => None,
        }
    }

    /// The offset as typed, in degrees for a ring; empty while the mouse sets the offset.
    pub fn typed(&self) -> &str {
        match &self.kind {
            DragKind::Point(drag) => drag.typed(),
            DragKind::Turn(drag) => drag.typed(),
        }
    }

    pub(in crate::session) fn set_input(&mut self, input: DragInput) {
        match &mut self.kind {
            DragKind::Point(drag) => drag.set_input(input),
            DragKind::Turn(drag) => drag.set_input(input),
        }
    }

    pub(in crate::session) fn set_typed(&mut self, typed: String) {
        match &mut self.kind {
            DragKind::Point(drag) => drag.set_typed(typed),
            DragKind::Turn(drag) => drag.set_typed(typed),
        }
    }

    /// Constrains the drag of a point; does nothing to a ring.
    pub(in crate::session) fn set_constraint(&mut self, constraint: Option<Constraint>) {
        if let DragKind::Point(drag) = &mut self.kind {
            drag.set_constraint(constraint);
            self.waypoints.clear();
        }
    }
}
