//! Sentences about the current pose.

use crate::document::{Arm, PathKind, RigKind, ShownLength};
use crate::kinematics::soft_reach::ReachLimits;
use crate::kinematics::two_bone::{Reach, TwoBonePose};
use crate::rig::Crowd;
use crate::session::{Session, ShownIteration};
use crate::ui::labels::count_of_keys;
use crate::ui::widgets::format::{decimals_of_cell, grouped};
use crate::words;

/// One sentence about the reach of the arm.
pub(in crate::ui) fn sentence(arm: &Arm, pose: &TwoBonePose) -> String {
    if !arm.uses_ik() {
        return "FK (joint angles → hand): the angles place the hand.".to_owned();
    }
    if arm.influence == 1.0 && pose.stretch > 1.0 {
        let reached = if pose.reach == Some(Reach::Reached) { "" } else { ", the maximum" };
        return format!("Stretched: the limbs are {:.2} times as long{reached}.", pose.stretch);
    }
    arm.why(pose).unwrap_or_else(|| "Reached: the hand is at the Cursor.".to_owned())
}

/// Description of the pose for screen readers.
pub(in crate::ui) fn summary(session: &Session) -> String {
    if let Some(crowd) = session.crowd() {
        return describe_crowd(&crowd);
    }
    match session.rig() {
        RigKind::Arm => sentence(session.arm(), session.pose()),
        RigKind::Skeleton => describe_skeleton(session),
    }
}

pub(in crate::ui) fn describe(session: &Session) -> String {
    if let Some(crowd) = session.crowd() {
        return describe_crowd(&crowd);
    }
    let mut line = match session.rig() {
        RigKind::Arm => describe_pose(session),
        RigKind::Skeleton => describe_skeleton(session),
    };
    let keys = session.selection().keys().len();
    if keys > 0 {
        line += &format!(" · {} selected", count_of_keys(keys));
    }
    line
}

fn describe_crowd(crowd: &Crowd) -> String {
    match crowd.arms {
        1 => "Crowd of 1 arm".to_owned(),
        arms => format!("Crowd of {} arms", grouped(arms.into())),
    }
}

fn describe_skeleton(session: &Session) -> String {
    let rig = session.skeleton_rig();
    if let (Some(found), None) = (session.known_why().first(), session.solvers().shown_iteration())
    {
        return words::cause(rig, found);
    }
    let joints = rig.skeleton.joints();
    let count = |count: usize, one: &str| match count {
        1 => format!("1 {one}"),
        _ => format!("{count} {one}s"),
    };
    let mut line = vec![count(joints.len(), "joint"), count(rig.targets.len(), "target")];
    line.extend(describe_solver(session));
    match session.selection().active().and_then(|joint| joints.get(joint.index())) {
        Some(joint) => line.insert(
            0,
            match session.selection().joints().len() {
                1 => joint.name.clone(),
                selected => format!("{} and {} more selected", joint.name, selected - 1),
            },
        ),
        None if rig.follow_paths.iter().any(|path| path.kind == PathKind::Head) => {
            line.push("drag the circle at the head: the body follows".to_owned());
        }
        None => line.push("click a joint to select it, drag it to pose".to_owned()),
    }
    line.join(" · ")
}

/// The shown iterate of a solver run, the iteration of a race, or whether the evaluated pose
/// reaches its targets; `None` without an enabled target.
fn describe_solver(session: &Session) -> Option<String> {
    let Some(ShownIteration { number, latest, .. }) = session.solvers().shown_iteration() else {
        return Some(session.solver_status()?.state.to_string());
    };
    let iteration = format!("iteration {number} of {latest}");
    Some(match session.solvers().run() {
        Some(run) => {
            let state = session.solver_status()?.state;
            format!("{}: {iteration}, {state}", run.method().title())
        }
        None => format!("Race of all solvers: {iteration}"),
    })
}

fn describe_pose(session: &Session) -> String {
    let (arm, pose) = (session.arm(), session.pose());
    let reach = match pose.reach {
        _ if !arm.uses_ik() => "FK",
        _ if arm.influence < 1.0 => "Between FK and IK",
        Some(Reach::Reached) | None => "Reached",
        Some(_) if arm.is_softened() => "Softened",
        Some(Reach::TooFar) => "Too far",
        Some(Reach::TooClose) => "Too close",
    };
    let hand = pose.hand;
    let ReachLimits { inner, outer } = arm.reach_limits();
    let [x, y, z] = hand.to_array().map(|coordinate| arm.format_length(coordinate));
    let distance = arm.format_length(pose.distance);
    let decimals = decimals_of_cell(arm.grid_cell());
    let [inner, outer] = [inner, outer].map(|length| ShownLength { length, decimals });
    format!("{reach} · hand ({x}, {y}, {z}) · distance D {distance} of {inner}–{outer}")
}
