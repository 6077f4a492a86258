use glam::Vec3;

use super::grip::{Drag, Dragged, Grip};
use super::point::{Constraint, PointDrag, PointHandle};
use super::tip;
use super::turn::{GripRing, TurnDrag};
use crate::document::{Channel, PathKind, Ray, Target};
use crate::kinematics::limb_ik::ElbowReference;
use crate::kinematics::skeleton::{JointId, RotationAxis};
use crate::session::keys;
use crate::session::outcome::Outcome;
use crate::session::session::Session;
use crate::session::skeleton::{path, targets};

/// Smallest slope of the view, as the height that it loses per length, for which a head is dragged on
/// its level.
const EDGE_ON: f32 = 0.1;

/// The drag that a press on a grip of the skeleton begins; `None` if it cannot be dragged.
pub(in crate::session) fn grab(
    session: &Session,
    grip: Grip,
    ray: Ray,
    forward: Vec3,
) -> Option<Drag> {
    let report = |joint| session.posed().target_report(joint);
    let (handle, at) = match grip {
        Grip::Target(joint, handle) => (handle, report(joint)?.position),
        Grip::LimbPole(joint, handle) => (handle, report(joint)?.pole?),
        Grip::Tip(joint, handle) => (handle, free_tip(session, joint)?),
        Grip::Head(joint, handle) => (handle, head(session, joint)?),
        Grip::Ring(joint, axis) => {
            let start = session.skeleton().joint(joint)?.rotation[axis.index()];
            let drag = TurnDrag::new(GripRing::of_joint(session.posed(), joint, axis)?, start, ray);
            return Some(Drag::of_ring(grip, drag));
        }
        Grip::Orientation(joint, axis) => {
            let start = target(session, joint)?.limb()?.orientation?[axis.index()];
            let drag =
                TurnDrag::new(GripRing::of_orientation(session.posed(), joint, axis)?, start, ray);
            return Some(Drag::of_ring(grip, drag));
        }
        _ => return None,
    };
    let point = PointDrag::new(handle, at, Vec3::ZERO, forward, ray)
        .with_step(session.shown().grid_cell() * PointDrag::SNAP_CELLS);
    let mut drag = Drag::of_point(grip, point);
    let is_head = matches!(grip, Grip::Head(..));
    if is_head && handle == PointHandle::Free && forward.y.abs() > EDGE_ON {
        // The head stays at its height, unless the user constrains it otherwise.
        drag.set_constraint(Some(Constraint::Plane(1)));
    }
    Some(drag)
}

/// The tip of a joint that no path poses.
fn free_tip(session: &Session, joint: JointId) -> Option<Vec3> {
    let is_there = joint.index() < session.skeleton_pose().len();
    let is_on_path = || session.skeleton_rig().is_joint_on_path(joint, session.playback().time());
    (is_there && !is_on_path()).then(|| session.skeleton_pose().tip(joint))
}

/// The base of a root that is dragged as the head of its chain.
fn head(session: &Session, joint: JointId) -> Option<Vec3> {
    let is_head = session.skeleton_rig().path_kind(joint) == Some(PathKind::Head);
    is_head.then(|| session.posed().evaluated_skeleton().fk.base(joint))
}

/// Drags the skeleton to where the mouse has a grip.
pub(in crate::session) fn drag(session: &mut Session, grip: Grip, dragged: Dragged) -> Outcome {
    match (grip, dragged) {
        (Grip::Ring(joint, axis), Dragged::Angle(angle)) => {
            Outcome::edit_joint(session.shown(), joint, |joint| {
                joint.rotation[axis.index()] = angle;
            })
        }
        (Grip::Orientation(joint, axis), Dragged::Angle(angle)) => {
            drag_orientation(session, joint, axis, angle)
        }
        (Grip::Head(root, _), Dragged::Point { .. }) => drag_head(session, root),
        (_, Dragged::Point { has_moved: false, .. }) => Outcome::default(),
        (Grip::Target(joint, _), Dragged::Point { to, .. }) => drag_target(session, joint, to),
        (Grip::LimbPole(joint, _), Dragged::Point { to, .. }) => drag_limb_pole(session, joint, to),
        (Grip::Tip(joint, _), Dragged::Point { to, moved, .. }) => {
            tip::drag(session, joint, to, moved)
        }
        _ => Outcome::default(),
    }
}

fn drag_target(session: &Session, joint: JointId, to: Vec3) -> Outcome {
    let Some(target) = target(session, joint) else {
        return Outcome::default();
    };
    let placed =
        target.placed(&session.posed().evaluated_skeleton().solved, session.playback().time(), to);
    targets::set_target(session, placed)
}

fn drag_limb_pole(session: &Session, joint: JointId, to: Vec3) -> Outcome {
    let Some(mut target) = target(session, joint) else {
        return Outcome::default();
    };
    let Some(limb) = target.limb_mut() else {
        return Outcome::default();
    };
    let pole = limb.pole_space.point_from_world(&session.posed().evaluated_skeleton().solved, to);
    limb.reference = ElbowReference::Pole(pole);
    targets::set_target(session, target)
}

/// Sets one of the angles of the orientation that the target of a joint holds.
fn drag_orientation(session: &Session, joint: JointId, axis: RotationAxis, angle: f32) -> Outcome {
    let Some(mut target) = target(session, joint) else {
        return Outcome::default();
    };
    let held = target.limb_mut().and_then(|limb| limb.orientation.as_mut());
    let Some(angles) = held else {
        return Outcome::default();
    };
    angles[axis.index()] = angle;
    targets::set_target(session, target)
}

/// Moves a head from where it was at the press through the points of its drag; back without points. A
/// head with keys gets one at the playhead.
fn drag_head(session: &mut Session, root: JointId) -> Outcome {
    let before = session.history().shown_before().skeleton_rig.clone();
    let to_skeleton = before.skeleton.transform().inverse();
    let waypoints = session.history().drag().map_or(&[][..], Drag::waypoints);
    let points: Vec<Vec3> =
        waypoints.iter().map(|point| to_skeleton.transform_point3(*point)).collect();
    let channel = Channel::Offset(root);
    let moved = path::move_head(session, root, before, &points);
    session.act(moved);
    let is_keyed = !points.is_empty() && session.document().keys.has(channel);
    is_keyed.then(|| keys::key(session, &[channel])).into()
}

/// The target of a joint; `None` if the joint has none.
fn target(session: &Session, joint: JointId) -> Option<Target> {
    let rig = session.skeleton_rig();
    Some(rig.targets[rig.target(joint)?])
}
