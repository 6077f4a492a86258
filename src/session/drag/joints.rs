use glam::{Quat, Vec3, Vec3A};

use super::grip::{Drag, Dragged, Grip};
use super::point::{Constraint, PointDrag, PointHandle};
use super::tip;
use super::turn::{GripRing, TurnDrag};
use crate::document::{Channel, Overlay, PathKind, Ray, Target};
use crate::kinematics::limb_ik::{ElbowReference, Limb};
use crate::kinematics::skeleton::{JointId, RotationAxis};
use crate::rig::EvaluatedSkeleton;
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
    let report = |joint| session.target_report(joint);
    let (handle, at) = match grip {
        Grip::Target(joint, handle) => (handle, report(joint)?.position),
        Grip::LimbPole(joint, handle) => (handle, report(joint)?.pole?),
        Grip::Tip(joint, handle) => (handle, free_tip(session, joint)?),
        Grip::Head(joint, handle) => (handle, head(session, joint)?),
        Grip::Ring(joint, axis) => {
            let start = session.skeleton().joint(joint)?.rotation[axis.index()];
            let drag = TurnDrag::new(session.ring(joint, axis)?, start, ray);
            return Some(Drag::of_ring(grip, drag));
        }
        Grip::Orientation(joint, axis) => {
            let start = session.held_orientation(joint)?[axis.index()];
            let drag = TurnDrag::new(session.orientation_ring(joint, axis)?, start, ray);
            return Some(Drag::of_ring(grip, drag));
        }
        _ => return None,
    };
    let point = PointDrag::new(handle, at, Vec3::ZERO, forward, ray).with_step(session.snap());
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
    let is_on_path = || session.skeleton_rig().is_joint_on_path(joint, session.time());
    (is_there && !is_on_path()).then(|| session.skeleton_pose().tip(joint))
}

/// The base of a root that is dragged as the head of its chain.
fn head(session: &Session, joint: JointId) -> Option<Vec3> {
    let is_head = session.skeleton_rig().path_kind(joint) == Some(PathKind::Head);
    is_head.then(|| session.evaluated_skeleton().fk.base(joint))
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
    let Some(target) = session.target(joint) else {
        return Outcome::default();
    };
    let placed = target.placed(&session.evaluated_skeleton().solved, session.time(), to);
    targets::set_target(session, placed)
}

fn drag_limb_pole(session: &Session, joint: JointId, to: Vec3) -> Outcome {
    let Some(mut target) = session.target(joint) else {
        return Outcome::default();
    };
    let Some(limb) = target.limb_mut() else {
        return Outcome::default();
    };
    let pole = limb.pole_space.point_from_world(&session.evaluated_skeleton().solved, to);
    limb.reference = ElbowReference::Pole(pole);
    targets::set_target(session, target)
}

/// Sets one of the angles of the orientation that the target of a joint holds.
fn drag_orientation(session: &Session, joint: JointId, axis: RotationAxis, angle: f32) -> Outcome {
    let Some(mut target) = session.target(joint) else {
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
    let before = session.shown_before().skeleton_rig.clone();
    let to_skeleton = before.skeleton.transform().inverse();
    let waypoints = session.drag().map_or(&[][..], Drag::waypoints);
    let points: Vec<Vec3> =
        waypoints.iter().map(|point| to_skeleton.transform_point3(*point)).collect();
    let channel = Channel::Offset(root);
    let moved = path::move_head(session, root, before, &points);
    session.act(moved);
    let is_keyed = !points.is_empty() && session.document().keys.has(channel);
    is_keyed.then(|| keys::key(session, &[channel])).into()
}

/// Rings of the skeleton.
impl Session {
    /// The ring, at the target of a joint and in world space, of the angle about x, y or z of the
    /// orientation that the target holds. `None` if it holds none, or if there is no hand or foot.
    pub fn orientation_ring(&self, joint: JointId, axis: RotationAxis) -> Option<GripRing> {
        let angles = self.held_orientation(joint)?;
        let rig = self.skeleton_rig();
        Limb::ending_at(&rig.skeleton, joint).ok()?.hand?;
        let space = rig.targets[rig.target(joint)?].space;
        let turn = Quat::from_rotation_z(angles.z);
        let local = match axis {
            RotationAxis::X => turn * (Quat::from_rotation_y(angles.y) * Vec3::X),
            RotationAxis::Y => turn * Vec3::Y,
            RotationAxis::Z => Vec3::Z,
        };
        let axis = space.rotation(&self.evaluated_skeleton().solved) * local;
        Some(GripRing { centre: self.target_report(joint)?.position, axis })
    }

    /// The angles about x, y and z in radians that the target of a joint holds; `None` if it holds
    /// none.
    fn held_orientation(&self, joint: JointId) -> Option<Vec3> {
        let rig = self.skeleton_rig();
        rig.targets[rig.target(joint)?].limb()?.orientation
    }

    /// The ring, in world space, of a joint's FK angle about x, y or z. `None` if a limit fixes the
    /// angle, if there is no such joint, or if a target alone poses the joint and the FK pose is
    /// hidden.
    pub fn ring(&self, joint: JointId, axis: RotationAxis) -> Option<GripRing> {
        let rig = self.skeleton_rig();
        let own = rig.skeleton.joint(joint)?;
        if own.limits.is_fixed(axis) {
            return None;
        }
        let EvaluatedSkeleton { fk, solved, .. } = self.evaluated_skeleton();
        // A hand that follows the bone above it keeps its own angles.
        let is_following = |target: &Target| {
            let follows = target.limb().is_some_and(|limb| limb.orientation.is_none());
            follows && target.joint != joint && rig.end_of(target) == joint
        };
        let posing = rig.target_that_turns(joint).filter(|it| it.influence >= 1.0);
        let is_solved = posing.is_some_and(|target| !is_following(target));
        let pose = match is_solved {
            false => solved,
            true if self.shown().display.shows(Overlay::FkPose) => fk,
            true => return None,
        };
        let above = own.parent.map_or(pose.transform(), |parent| pose.full_transform(parent));
        let local = own.rotation_axis(axis);
        // A mirrored transform reverses every rotation.
        let sign = above.matrix3.determinant().signum();
        let axis = (Vec3::from(above.matrix3 * Vec3A::from(local)) * sign).try_normalize()?;
        Some(GripRing { centre: pose.base(joint), axis })
    }

    /// Step of snapping in world units: a tenth of a cell of the grid.
    pub(in crate::session) fn snap(&self) -> f32 {
        self.shown().grid_cell() * 0.1
    }

    /// The target of a joint; `None` if the joint has none.
    fn target(&self, joint: JointId) -> Option<Target> {
        let rig = self.skeleton_rig();
        Some(rig.targets[rig.target(joint)?])
    }
}
