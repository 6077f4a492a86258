use glam::{DMat3, DQuat, Vec3};

use super::edits::{self, ArmEdit};
use crate::document::{Arm, Ray, TwistReferenceKind};
use crate::kinematics::angle;
use crate::kinematics::skeleton::RotationAxis;
use crate::session::drag::grip::{Drag, Dragged, Grip};
use crate::session::drag::point::{PointDrag, PointHandle};
use crate::session::drag::turn::{GripRing, TurnDrag};
use crate::session::outcome::Outcome;
use crate::session::parts::BodyPart;
use crate::session::session::Session;

/// The drag that a press on a grip of the arm begins; `None` if it cannot be dragged.
pub(in crate::session) fn grab(
    session: &Session,
    grip: Grip,
    ray: Ray,
    forward: Vec3,
) -> Option<Drag> {
    match grip {
        Grip::Hand(handle) => grab_hand(session, handle, ray, forward),
        Grip::Pole(handle) => grab_pole(session, handle, ray, forward),
        Grip::Root(handle) => {
            let at = session.arm().root;
            Some(point_drag(session, grip, PointDrag::new(handle, at, Vec3::ZERO, forward, ray)))
        }
        Grip::Limb => grab_limb(session, ray),
        Grip::UpperLimb => grab_upper_limb(session, ray, forward),
        _ => grab_ring(session, grip, ray),
    }
}

/// Drags the arm to where the mouse has a grip, from the arm `before` the drag.
pub(in crate::session) fn drag(
    session: &Session,
    grip: Grip,
    dragged: Dragged,
    before: &Arm,
) -> Outcome {
    let edit = match (grip, dragged) {
        (Grip::Hand(_), Dragged::Point { to, has_moved: true, .. }) => ArmEdit::SetHand(to),
        (Grip::Hand(_), Dragged::Point { .. }) => {
            return edits::replace(session, Arm { cursor: before.cursor, ..*session.arm() });
        }
        (Grip::Pole(_), Dragged::Point { to, has_moved, .. }) => {
            ArmEdit::SetPole(if has_moved { to } else { before.pole })
        }
        (Grip::Root(_), Dragged::Point { to, has_moved, .. }) => {
            ArmEdit::SetRoot(if has_moved { to } else { before.root })
        }
        (Grip::UpperLimb, Dragged::Point { to, has_moved, .. }) => {
            let angles = before.fk.shoulder;
            ArmEdit::SetShoulder(if has_moved { aimed(angles, to) } else { angles })
        }
        (Grip::Twist | Grip::Limb, Dragged::Angle(angle)) => ArmEdit::SetTwist(angle),
        (Grip::Bend, Dragged::Angle(angle)) => ArmEdit::SetBend(angle),
        (Grip::Shoulder(axis), Dragged::Angle(angle)) => {
            ArmEdit::SetShoulder(with_angle(before.fk.shoulder, axis, angle))
        }
        (Grip::HandRing(axis), Dragged::Angle(angle)) => {
            let angles = before.hand_orientation.angles;
            ArmEdit::SetHandOrientation(with_angle(angles, axis, angle))
        }
        _ => return Outcome::default(),
    };
    edit.apply(session)
}

fn with_angle(mut angles: Vec3, axis: RotationAxis, angle: f32) -> Vec3 {
    angles[axis.index()] = angle;
    angles
}

fn point_drag(session: &Session, grip: Grip, drag: PointDrag) -> Drag {
    Drag::of_point(grip, drag.with_step(session.shown().grid_cell() * PointDrag::SNAP_CELLS))
}

/// Begins to drag the Cursor. If the Cursor is out of reach and the mouse is nearer to the hand, a
/// free drag (not along an axis or in a plane) starts with the Cursor at the hand, which does not
/// change the pose.
fn grab_hand(session: &Session, handle: PointHandle, ray: Ray, forward: Vec3) -> Option<Drag> {
    let (arm, hand) = (*session.arm(), session.pose().hand);
    if !arm.uses_ik() {
        return None;
    }
    let aside = |point: Vec3| (arm.root + point - ray.origin).cross(ray.direction).length();
    let is_free = handle == PointHandle::Free && arm.influence == 1.0;
    let is_at_hand = is_free && aside(hand) < aside(arm.cursor_in_root());
    let start = if is_at_hand { hand } else { arm.cursor_in_root() };
    let drag = PointDrag::new(handle, start, arm.root, forward, ray);
    Some(point_drag(session, Grip::Hand(handle), drag))
}

fn grab_pole(session: &Session, handle: PointHandle, ray: Ray, forward: Vec3) -> Option<Drag> {
    let arm = session.arm();
    let drag = PointDrag::new(handle, arm.pole, arm.root, forward, ray);
    let has_pole = arm.twist_reference == TwistReferenceKind::Pole;
    has_pole.then(|| point_drag(session, Grip::Pole(handle), drag))
}

fn grab_ring(session: &Session, grip: Grip, ray: Ray) -> Option<Drag> {
    let Arm { twist, fk, hand_orientation, .. } = *session.arm();
    let start = match grip {
        Grip::Twist => twist,
        Grip::Shoulder(axis) => fk.shoulder[axis.index()],
        Grip::HandRing(axis) => hand_orientation.angles[axis.index()],
        _ => fk.bend,
    };
    Some(Drag::of_ring(grip, TurnDrag::new(GripRing::of_arm(session.posed(), grip)?, start, ray)))
}

/// Begins to turn the elbow about the Pointer, by the point of a limb at the mouse: it moves on a
/// circle around the Pointer as the elbow does.
fn grab_limb(session: &Session, ray: Ray) -> Option<Drag> {
    let Arm { root, twist, .. } = *session.arm();
    if !session.arm().uses_ik() {
        return None;
    }
    let [shoulder, elbow, hand] = joints_in_world(session);
    let limb = match BodyPart::of_arm_at(session.posed(), ray) {
        Some(BodyPart::UpperLimb) => [shoulder, elbow],
        _ => [elbow, hand],
    };
    let point = limb[0].lerp(limb[1], ray.nearest_on_segment(limb));
    let axis = session.pose().pointer.direction;
    let ring = GripRing { centre: root + axis * (point - root).dot(axis), axis };
    Some(Drag::of_ring(Grip::Limb, TurnDrag::new(ring, twist, ray)))
}

/// Begins to turn the shoulder in FK, by the point of the Upper limb at the mouse.
fn grab_upper_limb(session: &Session, ray: Ray, forward: Vec3) -> Option<Drag> {
    // Nearer to the shoulder a point has no direction from it.
    const NEAREST: f32 = 0.1;
    if session.arm().uses_ik() {
        return None;
    }
    let [shoulder, elbow, _] = joints_in_world(session);
    let part = ray.nearest_on_segment([shoulder, elbow]).max(NEAREST);
    let start = session.pose().elbow * part;
    let drag = PointDrag::new(PointHandle::Free, start, shoulder, forward, ray);
    Some(point_drag(session, Grip::UpperLimb, drag))
}

/// Shoulder, elbow and hand in the world.
fn joints_in_world(session: &Session) -> [Vec3; 3] {
    let (root, pose) = (session.arm().root, session.pose());
    [Vec3::ZERO, pose.elbow, pose.hand].map(|point| root + point)
}

/// Angles of the shoulder after the least rotation that points the Upper limb at a point of Root
/// space. They do not change for a point at the shoulder.
fn aimed(angles: Vec3, point: Vec3) -> Vec3 {
    let before = angle::euler_rotation(angles);
    let Some(to) = point.as_dvec3().try_normalize() else {
        return angles;
    };
    let turn = DQuat::from_rotation_arc(before.x_axis, to);
    angle::euler_angles(DMat3::from_quat(turn) * before, angles)
}
