//! Sentences about the current pose.

use egui::{Label, RichText, Ui};

use crate::document::{PathKind, ShownLength};
use crate::kinematics::diagnosis::{Cause, Diagnosis, Remedy, TriedRemedy};
use crate::kinematics::soft_reach::ReachLimits;
use crate::kinematics::two_bone::Reach;
use crate::rig::{Crowd, SkeletonRig};
use crate::session::{Actions, Session, ShownIteration, ShownLimb, TargetEdit};
use crate::ui::labels::count_of_keys;
use crate::ui::widgets::text::{decimals_of_cell, grouped};
use crate::ui::widgets::{self, text};
use crate::words;

/// One sentence about the reach of a limb.
pub(in crate::ui) fn sentence_on_limb(session: &Session, limb: &ShownLimb) -> String {
    let (rig, joint, end) = (session.rig(), limb.target, limb.words.end);
    let (posed, pose) = (&limb.frames.posed, limb.frames.pose());
    if posed.influence == 0.0 {
        return format!("FK (joint angles → {end}): the angles place the {end}.");
    }
    let why = rig.target(joint).map_or(&[][..], |index| session.why_target(index, true));
    if let Some(found) = why.first() {
        return words::cause(rig, found) + ".";
    }
    if pose.stretch > 1.0 {
        return format!("Stretched: the limbs are {:.2} times as long.", pose.stretch);
    }
    match pose.reach {
        Some(Reach::TooFar) => "Too far: the limb points at its target.".to_owned(),
        Some(Reach::TooClose) => "Too close: the limb is folded.".to_owned(),
        Some(Reach::Reached) | None => format!("The {end} is at its target."),
    }
}

/// Description of the pose for screen readers.
pub(in crate::ui) fn summary(session: &Session) -> String {
    if let Some(crowd) = session.crowd() {
        return describe_crowd(&crowd);
    }
    match sole_limb(session) {
        Some(limb) => sentence_on_limb(session, limb),
        None => describe_skeleton(session),
    }
}

/// The limb of a figure that is nothing else, while no joint is selected.
fn sole_limb(session: &Session) -> Option<&ShownLimb> {
    let is_shown = session.selection().joints().is_empty() && session.rig().sole_limb().is_some();
    session.limb().filter(|_| is_shown)
}

pub(in crate::ui) fn describe(session: &Session) -> String {
    if let Some(crowd) = session.crowd() {
        return describe_crowd(&crowd);
    }
    let mut line = match sole_limb(session) {
        Some(limb) => describe_limb(session, limb),
        None => describe_skeleton(session),
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
    let rig = session.rig();
    if let (Some(found), None) = (session.why(false).first(), session.solvers().shown_iteration()) {
        return words::cause(rig, found);
    }
    let joints = rig.skeleton.joints();
    let count = |count: usize, one: &str| match count {
        1 => format!("1 {one}"),
        _ => format!("{count} {one}s"),
    };
    let off = rig.targets.iter().filter(|target| !target.is_posing()).count();
    let off = if off == 0 { String::new() } else { format!(", {off} off") };
    let mut line = vec![count(joints.len(), "joint"), count(rig.targets.len(), "target") + &off];
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
        return Some(session.solvers().status(session.posed())?.state.to_string());
    };
    let iteration = format!("iteration {number} of {latest}");
    Some(match session.solvers().run() {
        Some(run) => {
            let state = session.solvers().status(session.posed())?.state;
            format!("{}: {iteration}, {state}", run.method().title())
        }
        None => format!("Race of all solvers: {iteration}"),
    })
}

fn describe_limb(session: &Session, limb: &ShownLimb) -> String {
    let (frames, pose) = (&limb.frames, limb.frames.pose());
    let soft_reach = frames.posed.ik.soft_reach;
    let ReachLimits { inner, outer } = frames.limits;
    let is_softened =
        soft_reach.softness() > 0.0 && (inner..=outer).contains(&frames.posed.cursor.length());
    let reach = match pose.reach {
        _ if !frames.uses_ik() => "FK",
        _ if frames.posed.influence < 1.0 => "Between FK and IK",
        Some(Reach::Reached) | None => "Reached",
        Some(_) if is_softened => "Softened",
        Some(Reach::TooFar) => "Too far",
        Some(Reach::TooClose) => "Too close",
    };
    let lengths = limb.lengths();
    let [x, y, z] = pose.hand.to_array().map(|coordinate| lengths.show(coordinate));
    let distance = lengths.show(pose.distance);
    let decimals = decimals_of_cell(session.shown().grid_cell());
    let [inner, outer] = [inner, outer].map(|length| ShownLength { length, decimals });
    let end = limb.words.end;
    format!("{reach} · {end} ({x}, {y}, {z}) · distance D {distance} of {inner}–{outer}")
}

/// Why the target is not reached that the session examines. While a mouse button is down nothing is
/// found out that is not known, so that scrubbing does not wait.
pub(in crate::ui) fn found<'a>(ui: &Ui, session: &'a Session) -> &'a [Diagnosis] {
    if is_held(ui) { session.why(false) } else { session.why(true) }
}

pub(in crate::ui) fn is_held(ui: &Ui) -> bool {
    ui.input(|input| input.pointer.any_down())
}

/// Shows the cause of a diagnosis as a sentence.
pub(in crate::ui) fn cause(ui: &mut Ui, session: &Session, found: &Diagnosis) {
    let sentence = words::cause(session.rig(), found);
    ui.add(Label::new(RichText::new(sentence)).wrap());
}

/// Shows the first `most` remedies of a diagnosis as buttons that apply them.
pub(in crate::ui) fn remedies(
    ui: &mut Ui,
    session: &Session,
    found: &Diagnosis,
    most: usize,
    actions: &mut Actions,
) {
    for tried in found.remedies.iter().take(most) {
        let remedy = &tried.remedy;
        let name = words::remedy(session.rig(), remedy);
        let tooltip = format!("Apply this; {}", left(session, found, tried));
        if widgets::button(ui, &name, &tooltip, None) {
            let (target, remedy) = (found.target, remedy.clone());
            actions.push(TargetEdit::ApplyRemedy { target, remedy });
        }
    }
}

/// The error that a remedy of a diagnosis leaves between the tip or the hand and its target.
fn left(session: &Session, found: &Diagnosis, tried: &TriedRemedy) -> String {
    let TriedRemedy { residual, rotation_residual, .. } = *tried;
    let is_about_turn = matches!(found.cause, Cause::RotationLimits { .. })
        || matches!(tried.remedy, Remedy::FreePlace(_));
    if is_about_turn {
        return if rotation_residual <= SkeletonRig::ROTATION_TOLERANCE {
            "it is then turned as its target asks".to_owned()
        } else {
            format!("{} are then missing", text::degrees(rotation_residual))
        };
    }
    if residual <= session.rig().tolerance() {
        "the tip is then at its target".to_owned()
    } else {
        format!("the tip is then {} away", text::short(residual))
    }
}
