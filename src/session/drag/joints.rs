use glam::Vec3;

use crate::document::{Channel, Document, PathKind, Posed, Ray, Target, Track};
use crate::kinematics::angle;
use crate::kinematics::chain_ik::{ChainTarget, Root};
use crate::kinematics::limb_ik::Limb;
use crate::kinematics::skeleton::{JointId, RotationAxis, Skeleton};
use crate::rig::{Posture, TargetSpace};
use crate::session::drag::body::is_elbow;
use crate::session::drag::grip::{Drag, DragLimit, Dragged, Grip};
use crate::session::drag::limit_fan::LimitFan;
use crate::session::drag::point::{Constraint, PointDrag, PointHandle};
use crate::session::drag::turn::{GripRing, TurnDrag};
use crate::session::keys;
use crate::session::outcome::{Consequence, Outcome};
use crate::session::session::Session;
use crate::session::skeleton::targets;

/// Smallest slope of the view, as the height that it loses per length, for which a head is dragged
/// on its level.
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
        Grip::Target(joint, handle) => (handle, grabbed_target(session, joint, handle, ray)?),
        Grip::LimbPole(joint, handle) => (handle, report(joint)?.pole?),
        Grip::Aim(joint, handle) => {
            let pose = session.posed().skeleton();
            (handle, target(session, joint)?.aim_point_in_world(pose)?)
        }
        Grip::Tip(joint, handle) => (handle, free_tip(session, joint)?),
        Grip::Bone(joint) => {
            let point = point_on_bone(session.posed().skeleton(), joint, ray)?;
            if let Some(target) = Grip::turned_limb(session.posed(), joint) {
                let frames = session.posed().limb_frames(target.joint)?;
                let ring = GripRing::of_limb(&frames, point)?;
                let drag = TurnDrag::new(ring, target.limb()?.twist, ray);
                return Some(Drag::of_ring(grip, drag));
            }
            (PointHandle::Free, point)
        }
        Grip::Head(joint, handle) => (handle, head(session, joint)?),
        Grip::Ring(joint, axis) => {
            let start = session.skeleton().joint(joint)?.rotation[axis.index()];
            let drag = TurnDrag::new(GripRing::of_joint(session.posed(), joint, axis)?, start, ray);
            return Some(Drag::of_ring(grip, drag));
        }
        Grip::LimbTwist(joint) => {
            let start = target(session, joint)?.limb()?.twist;
            let ring = GripRing::of_twist(&session.posed().limb_frames(joint)?)?;
            return Some(Drag::of_ring(grip, TurnDrag::new(ring, start, ray)));
        }
        Grip::Orientation(joint, axis) => {
            let start = target(session, joint)?.orientation?[axis.index()];
            let drag =
                TurnDrag::new(GripRing::of_orientation(session.posed(), joint, axis)?, start, ray);
            return Some(Drag::of_ring(grip, drag));
        }
        Grip::Limit(joint, end) => {
            let fan = LimitFan::shown(session.posed(), joint)?;
            let start = session.skeleton().joint(joint)?.angle_of_end(end)?;
            return Some(Drag::of_ring(grip, TurnDrag::new(fan.ring(end)?, start, ray)));
        }
    };
    let step = session.shown().grid_cell() * PointDrag::SNAP_CELLS;
    let point =
        PointDrag::new(handle, at, forward, ray).with_steps(step, snapped_from(session, grip));
    let mut drag = Drag::of_point(grip, point);
    let is_head = matches!(grip, Grip::Head(..));
    if is_head && handle == PointHandle::Free && forward.y.abs() > EDGE_ON {
        // The head stays at its height, unless the user constrains it otherwise.
        drag.set_constraint(Some(Constraint::Plane(1)));
    }
    Some(drag)
}

/// The origin of the coordinates that panels show of a dragged point.
fn snapped_from(session: &Session, grip: Grip) -> Vec3 {
    let space = match grip {
        Grip::Target(joint, _) | Grip::Aim(joint, _) => {
            target(session, joint).map(|it| it.present_space())
        }
        Grip::LimbPole(joint, _) => {
            target(session, joint).and_then(|it| Some(it.limb()?.pole_space))
        }
        _ => None,
    };
    let joint = space.and_then(TargetSpace::joint);
    joint.map_or(Vec3::ZERO, |joint| session.skeleton_pose().base(joint))
}

/// The point at which the drag of a target starts: the target. If that is out of reach and the mouse
/// is nearer to the tip, a free drag starts with the target at the tip, which does not change the
/// pose.
fn grabbed_target(
    session: &Session,
    joint: JointId,
    handle: PointHandle,
    ray: Ray,
) -> Option<Vec3> {
    let at = session.posed().target_report(joint)?.position;
    let aside = |point: Vec3| (point - ray.origin).cross(ray.direction).length();
    let is_full = target(session, joint)?.influence >= 1.0;
    let tip = session.posed().skeleton().tip(joint);
    let is_at_tip = handle == PointHandle::Free && is_full && aside(tip) < aside(at);
    Some(if is_at_tip { tip } else { at })
}

/// The tip of a joint that no path poses.
fn free_tip(session: &Session, joint: JointId) -> Option<Vec3> {
    let is_there = joint.index() < session.skeleton_pose().len();
    let is_on_path = || session.rig().is_joint_on_path(joint, session.playback().time());
    (is_there && !is_on_path()).then(|| session.skeleton_pose().tip(joint))
}

/// Smallest distance from a bone's base of a point by which the bone is dragged, as a fraction of its
/// length: nearer to the base, a small way of the mouse would be a large turn.
const NEAREST: f32 = 0.1;

/// The point of a joint's bone that is nearest to a ray.
fn point_on_bone(pose: &Skeleton, joint: JointId, ray: Ray) -> Option<Vec3> {
    pose.joint(joint)?;
    let ends = [pose.base(joint), pose.tip(joint)];
    Some(ends[0].lerp(ends[1], ray.nearest_on_segment(ends).max(NEAREST)))
}

/// The base of a root that is dragged as the head of its chain.
fn head(session: &Session, joint: JointId) -> Option<Vec3> {
    let is_head = session.rig().path_kind(joint) == Some(PathKind::Head);
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
        (Grip::Limit(joint, end), Dragged::Angle(angle)) => {
            Outcome::edit_joint(session.shown(), joint, |joint| {
                joint.limits = joint.limits.with_end(end, angle);
            })
        }
        (Grip::LimbTwist(joint), Dragged::Angle(angle)) => drag_twist(session, joint, angle),
        (Grip::Bone(joint), Dragged::Angle(angle)) => {
            let target = session.rig().target_that_turns(joint).map(|target| target.joint);
            target.map_or_else(Outcome::default, |target| drag_twist(session, target, angle))
        }
        (Grip::Head(root, _), Dragged::Point { .. }) => drag_head(session, root),
        (_, Dragged::Point { has_moved: false, .. }) => {
            let (camera, before) = (session.shown().camera, session.history().shown_before());
            let posture = Consequence::ChoosePosture(before.rig.posture.clone());
            Outcome::from(posture).and(Outcome::write(Document { camera, ..before.clone() }))
        }
        (Grip::Target(joint, _), Dragged::Point { to, .. }) => drag_target(session, joint, to),
        (Grip::LimbPole(joint, _), Dragged::Point { to, .. }) => drag_limb_pole(session, joint, to),
        (Grip::Aim(joint, _), Dragged::Point { to, .. }) => drag_aim(session, joint, to),
        (Grip::Tip(joint, _), Dragged::Point { to, moved, .. }) => {
            drag_tip(session, joint, to, moved)
        }
        (Grip::Bone(joint), Dragged::Point { to, moved, .. }) => {
            drag_bone(session, joint, to - moved, moved)
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
    limb.pole = Some(pole);
    targets::set_target(session, target)
}

/// Moves the point at which the target of a joint aims the joint.
fn drag_aim(session: &Session, joint: JointId, to: Vec3) -> Outcome {
    let Some(mut target) = target(session, joint) else {
        return Outcome::default();
    };
    let space = target.present_space();
    if let Some(aim) = &mut target.aim {
        aim.point = space.point_from_world(&session.posed().evaluated_skeleton().solved, to);
    }
    targets::set_target(session, target)
}

/// Sets the twist of the limb of a joint's target.
fn drag_twist(session: &Session, joint: JointId, angle: f32) -> Outcome {
    let Some(mut target) = target(session, joint) else {
        return Outcome::default();
    };
    if let Some(limb) = target.limb_mut() {
        limb.twist = angle;
    }
    targets::set_target(session, target)
}

/// Sets one of the angles of the orientation that the target of a joint holds.
fn drag_orientation(session: &Session, joint: JointId, axis: RotationAxis, angle: f32) -> Outcome {
    let Some(mut target) = target(session, joint) else {
        return Outcome::default();
    };
    let Some(angles) = &mut target.orientation else {
        return Outcome::default();
    };
    angles[axis.index()] = angle;
    targets::set_target(session, target)
}

/// Moves a head from where it was at the press through the points of its drag; back without points.
/// A head with keys gets one at the playhead.
fn drag_head(session: &mut Session, root: JointId) -> Outcome {
    let before = session.history().shown_before().rig.clone();
    let to_skeleton = before.skeleton.transform().inverse();
    let waypoints = session.history().drag().map_or(&[][..], Drag::waypoints);
    let points: Vec<Vec3> =
        waypoints.iter().map(|point| to_skeleton.transform_point3(*point)).collect();
    let channel = Channel::Offset(root);
    let moved = targets::move_head(session, root, before, &points);
    session.act(moved);
    let is_keyed = !points.is_empty() && session.document().keys.has(channel);
    is_keyed.then(|| keys::key(session, &[channel])).into()
}

/// The target of a joint; `None` if the joint has none.
fn target(session: &Session, joint: JointId) -> Option<Target> {
    let rig = session.rig();
    Some(rig.targets[rig.target(joint)?])
}

/// Moves the tip of `joint` by `moved` since the press, to `to`, both in the world. The drag starts
/// from the state at the press; targets stay in force:
///
/// - a root without a bone moves, a free one as far as targets let it;
/// - a tip with a target moves the target;
/// - an elbow that a limb's target poses turns the limb's twist;
/// - any other tip goes where the targets let it.
fn drag_tip(session: &Session, joint: JointId, to: Vec3, moved: Vec3) -> Outcome {
    let start = session.history().posed_before();
    let before = &start.document().rig;
    let Some(dragged) = before.skeleton.joint(joint) else {
        return Outcome::default();
    };
    let is_held = before.solver.root == Root::Free && before.holds_body();
    if dragged.is_root_point() && !is_held {
        let moved = before.skeleton.transform().inverse().transform_vector3(moved);
        let offset = dragged.offset + moved;
        return Outcome::edit_joint(session.shown(), joint, |joint| joint.offset = offset);
    }
    let target = before.target_that_turns(joint).filter(|it| it.influence >= 1.0).copied();
    match target {
        Some(target) if target.joint == joint && !target.has_free_place() => {
            targets::set_target(session, target.placed(start.skeleton(), start.time(), to))
        }
        Some(target) if is_elbow(&before.skeleton, &target, joint) => {
            drag_elbow(session, &start, target, moved)
        }
        _ => {
            let start = session.history().pressed_pose();
            let tip = start.skeleton().tip(joint);
            drag_point(session, start, ChainTarget::at(joint, tip + moved))
        }
    }
}

/// Moves a point of the bone of `joint` by `moved` since the press, when it was at `pressed`, both
/// in the world.
fn drag_bone(session: &Session, joint: JointId, pressed: Vec3, moved: Vec3) -> Outcome {
    let start = session.history().pressed_pose();
    let grip = start.skeleton().full_transform(joint).inverse().transform_point3(pressed);
    drag_point(session, start, ChainTarget::at(joint, pressed + moved).with_grip(grip))
}

/// Turns a limb about the line from its base to its tip, as far as the elbow moves around it.
fn drag_elbow(session: &Session, before: &Posed, mut target: Target, moved: Vec3) -> Outcome {
    let pose = before.skeleton();
    let Ok(limb) = Limb::ending_at(pose, target.joint) else {
        return Outcome::default();
    };
    let to_skeleton = pose.transform().inverse();
    let [base, elbow, tip, to] = [
        pose.base(limb.upper),
        pose.base(limb.lower),
        pose.tip(limb.lower),
        pose.base(limb.lower) + moved,
    ]
    .map(|point| to_skeleton.transform_point3(point));
    let Some(axis) = (tip - base).try_normalize() else {
        return Outcome::default();
    };
    let [from, to] = [elbow, to].map(|elbow| (elbow - base).reject_from_normalized(axis));
    let turned = axis.dot(from.cross(to)).atan2(from.dot(to));
    match target.limb_mut().filter(|_| turned.is_finite()) {
        Some(limb) => limb.twist = angle::nearest(limb.twist + turned, limb.twist),
        None => return Outcome::default(),
    }
    targets::set_target(session, target)
}

/// Moves a point of a body while all that its targets hold stays, from the state at the press. Joints
/// that no whole-body target turns get their angles, with keys if they have some; the others keep
/// the pose as posture, or get angles, too, if the document has a motion.
fn drag_point(session: &Session, start: &Posed, dragged: ChainTarget) -> Outcome {
    let full = full_influence(start);
    let rig = &full.document().rig;
    if !rig.can_drag(dragged.joint) {
        return Outcome::say("A target poses this bone; drag the target instead");
    }
    let (drag, report) = match rig.drag(full.evaluated_skeleton(), full.time(), dragged) {
        Ok(dragged) => dragged,
        Err(error) => return Outcome::fail(error.to_string()),
    };
    let limit = DragLimit { short: report.distance, freedom: drag.freedom() };
    let mut posed = Skeleton::clone(full.skeleton());
    drag.write(&mut posed);
    let document = start.document();
    let has_motion = document.is_animated();
    let mut skeleton = Skeleton::clone(&document.rig.skeleton);
    for joint in drag.joints() {
        let (own, before) = (&posed[joint], &full.skeleton()[joint]);
        let has_moved = (own.rotation, own.offset) != (before.rotation, before.offset);
        if has_moved && (has_motion || !rig.is_turned_by_body_target(joint)) {
            skeleton.write_local(joint, |joint| {
                (joint.rotation, joint.offset) = (own.rotation, own.offset);
            });
        }
    }
    let posture = posture_with(&full, &posed).filter(|_| !has_motion);
    let chosen = posture.map(|posture| Consequence::ChoosePosture(Some(posture.into())));
    let written = Outcome::change(session.shown(), |document| *document.skeleton_mut() = skeleton);
    Outcome::from(chosen).and(Consequence::LimitDrag(Box::new(limit))).and(written)
}

/// The posture of a pose with the joints of its body as another pose has them; `None` for a pose
/// without a body that targets move.
fn posture_with(full: &Posed, posed: &Skeleton) -> Option<Posture> {
    let before = full.carried()?;
    let (_, carried) = full.document().rig.step(full.time(), &before);
    let mut posture = carried.to_posture();
    for (joint, of) in &mut posture.joints {
        let own = posed.joint(*joint)?;
        of.rotation = of.rotation.map(|_| own.rotation);
        of.offset = of.offset.map(|_| own.offset);
    }
    (!posture.joints.is_empty()).then_some(posture)
}

/// The pose from which a point is dragged: that of FK and of the targets with full influence.
fn full_influence(before: &Posed) -> Posed {
    if before.document().rig.targets.iter().all(|target| !target.is_blended()) {
        return before.clone();
    }
    let mut document = before.document().clone();
    document.rig.targets.retain(|target| target.influence >= 1.0);
    Track::new(&document).pose(document, before.time())
}
