//! True if a target is reached and, if not, why, with what helps.

use egui::{RichText, ScrollArea, Ui};

use super::end;
use crate::document::Target;
use crate::kinematics::chain_ik::Status;
use crate::kinematics::diagnosis::Diagnosis;
use crate::kinematics::limb_ik::LimbReach;
use crate::rig::{TargetOutcome, TargetReport};
use crate::session::{Actions, Session};
use crate::ui::widgets::format;
use crate::ui::{style, why};

/// Height with the line above, in points, in a panel of a height: a fifth of it, but enough for a
/// cause and a remedy.
pub(in crate::ui) fn height(panel: f32) -> f32 {
    const RANGE: (f32, f32) = (116.0, 150.0);
    (0.2 * panel).clamp(RANGE.0, RANGE.1).round()
}

/// Shows the note on a target at constant height.
pub(in crate::ui) fn ui(ui: &mut Ui, session: &Session, target: &Target, actions: &mut Actions) {
    let Some(report) = session.target_report(target.joint) else { return };
    let (rig, is_held) =
        (session.skeleton_rig(), why::is_held(ui) || session.history().is_editing());
    let index = rig.target(target.joint);
    let why = index.map_or(&[][..], |index| {
        if is_held { session.known_why_target(index) } else { session.why_target(index) }
    });
    ui.separator();
    ScrollArea::vertical().id_salt("note").auto_shrink(false).show(ui, |ui| {
        let end = end(rig, target).map_or("", |end| end.1);
        ui.spacing_mut().item_spacing.y = 3.0;
        if why.is_empty() {
            ui.strong(format!("Target of {end}"));
            status(ui, session, target, report);
        } else {
            explain(ui, session, (end, report), why, actions);
        }
    });
}

fn status(ui: &mut Ui, session: &Session, target: &Target, report: &TargetReport) {
    let text = text(session, target, report);
    let is_reached = match &report.outcome {
        TargetOutcome::Off | TargetOutcome::Leads => true,
        _ if target.influence < 1.0 => true,
        _ if report.misses_rotation() => false,
        TargetOutcome::WholeBody(report) => report.converged(),
        TargetOutcome::Limb(limb) => limb.reach == LimbReach::Reached,
        TargetOutcome::Refused(_) | TargetOutcome::NoLimb(_) => false,
    };
    let colour = if is_reached { ui.visuals().weak_text_color() } else { style::accent(ui) };
    ui.label(RichText::new(text).color(colour));
}

/// Shows how far a target is from being reached, each cause and its remedies.
fn explain(
    ui: &mut Ui,
    session: &Session,
    (end, report): (&str, &TargetReport),
    causes: &[Diagnosis],
    actions: &mut Actions,
) {
    let text = match missing_rotation(report) {
        Some(missing) if report.error <= session.skeleton_rig().tolerance() => missing,
        _ => format!("{} away", format::short(report.error)),
    };
    let heading = RichText::new(format!("{end} not reached: {text}"));
    ui.label(heading.color(style::accent(ui)));
    for found in causes {
        why::cause(ui, session, found);
        ui.horizontal_wrapped(|ui| why::remedies(ui, session, found, usize::MAX, actions));
    }
}

fn text(session: &Session, target: &Target, report: &TargetReport) -> String {
    let gap = format::short(report.error);
    let is_blended = target.influence < 1.0;
    match &report.outcome {
        TargetOutcome::Off if !target.enabled => "Disabled: the joint angles alone pose it".into(),
        TargetOutcome::Off => "Influence 0: the joint angles alone pose it".into(),
        TargetOutcome::Leads => "Leads the head: the body follows its path".into(),
        TargetOutcome::WholeBody(_) | TargetOutcome::Limb(_) if is_blended => {
            format!("Blended with the FK pose, {gap} from the target")
        }
        TargetOutcome::WholeBody(report) => match report.status {
            Status::Converged => format!("Reached after {} iterations", report.iterations),
            Status::Iterating | Status::Stalled | Status::OutOfIterations | Status::Bounded => {
                format!("Not reached: {gap} away, {}", report.status)
            }
        },
        TargetOutcome::Limb(limb) => match limb.reach {
            LimbReach::Reached if let Some(missing) = missing_rotation(report) => {
                format!("Not reached: {missing}")
            }
            LimbReach::Reached if limb.stretch > 1.0 => {
                format!("Reached, stretched to {:.0} %", 100.0 * limb.stretch)
            }
            LimbReach::Reached => "Reached".into(),
            LimbReach::TooFar => format!("Too far away by {gap}"),
            LimbReach::TooClose => format!("Too close by {gap}"),
            LimbReach::Limited(joint) => {
                let name = session.skeleton().joint(joint).map_or("", |joint| &joint.name);
                format!("Not reached: {gap} away, at the limits of {name}")
            }
        },
        TargetOutcome::Refused(error) => format!("Not solved: {error}"),
        TargetOutcome::NoLimb(error) => format!("No limb: {error}"),
    }
}

/// The rotation that is missing, in words; `None` for a hand that is turned as its target asks.
fn missing_rotation(report: &TargetReport) -> Option<String> {
    let angle = report.rotation_error.filter(|_| report.misses_rotation())?;
    Some(format!("{} of its rotation missing", format::degrees(angle)))
}
