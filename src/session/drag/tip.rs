use glam::Vec3;

use crate::document::{Posed, Target, Track};
use crate::kinematics::angle;
use crate::kinematics::chain_ik::{self, Method, SolveError, SolverOptions, TipTarget};
use crate::kinematics::limb_ik::Limb;
use crate::kinematics::skeleton::{JointId, Skeleton};
use crate::session::drag::body::is_elbow;
use crate::session::outcome::Outcome;
use crate::session::session::Session;
use crate::session::skeleton::targets;

/// Maximum number of iterations per frame of a drag.
const ITERATIONS: u32 = 64;

/// Moves the tip of `joint` by `moved` since the press, to `to`, both in the world. The drag starts
/// from the state at the press; targets stay in force:
///
/// - a root without a bone moves;
/// - a tip with a target moves the target;
/// - an elbow that a limb's target poses turns the limb's twist;
/// - any other tip is solved for by the FK angles of the joints that no target poses alone.
pub(in crate::session) fn drag(
    session: &Session,
    joint: JointId,
    to: Vec3,
    moved: Vec3,
) -> Outcome {
    let start = session.history().posed_before();
    let before = &start.document().skeleton_rig;
    let Some(dragged) = before.skeleton.joint(joint) else {
        return Outcome::default();
    };
    if dragged.is_root_point() {
        let moved = before.skeleton.transform().inverse().transform_vector3(moved);
        let offset = dragged.offset + moved;
        return Outcome::edit_joint(session.shown(), joint, |joint| joint.offset = offset);
    }
    let target = before.target_that_turns(joint).filter(|it| it.influence >= 1.0).copied();
    match target {
        Some(target) if target.joint == joint => {
            targets::set_target(session, target.placed(start.skeleton(), start.time(), to))
        }
        Some(target) if is_elbow(&before.skeleton, &target, joint) => {
            drag_elbow(session, &start, target, moved)
        }
        _ => drag_fk(session, &start, joint, moved),
    }
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

/// Solves for the tip of `joint` and writes the angles of the joints that no target poses alone.
fn drag_fk(session: &Session, posed: &Posed, joint: JointId, moved: Vec3) -> Outcome {
    let start = fk_start(session.history().track(), posed);
    let before = &posed.document().skeleton_rig;
    let chain = before.skeleton.ancestors(joint);
    if chain.into_iter().all(|joint| start[joint].locked) {
        return Outcome::say("A target poses this bone; drag the target instead");
    }
    let target = TipTarget { joint, point: start.tip(joint) + moved, weight: 1.0 };
    let method = before.solver.method;
    let method = if method.is_closed_form() { Method::default() } else { method };
    let options = SolverOptions { method, iterations: Some(ITERATIONS), ..before.solver };
    Outcome::edit(session.shown(), |document| {
        let mut solved = start.clone();
        chain_ik::solve(&mut solved, &[target], &options)?;
        let mut skeleton = Skeleton::clone(&before.skeleton);
        for joint in start.ids() {
            let after = &solved[joint];
            if *after != start[joint] {
                skeleton.write_local(joint, |joint| {
                    (joint.rotation, joint.offset) = (after.rotation, after.offset);
                });
            }
        }
        *document.skeleton_mut() = skeleton;
        Ok::<_, SolveError>(())
    })
}

/// The pose from which a drag solves for FK angles: that of FK and of the targets with full influence,
/// with the joints that such a target turns locked.
fn fk_start(track: &Track, before: &Posed) -> Skeleton {
    let mut document = before.document().clone();
    document.skeleton_rig.targets.retain(|target| target.influence >= 1.0);
    let full = track.pose(document, before.time());
    let mut pose = Skeleton::clone(full.skeleton());
    let influences = full.document().skeleton_rig.influences();
    for (joint, influence) in pose.ids().zip(influences) {
        if influence > 0.0 {
            pose.write_local(joint, |joint| joint.locked = true);
        }
    }
    pose
}
