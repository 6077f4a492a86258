//! The list of targets with their distances; the target of the selected joint, and a note on
//! whether it is reached and, if not, why, with what helps.

pub(in crate::ui) mod space;
mod turn;

use std::borrow::Cow;

use egui::{Align, Layout, RichText, ScrollArea, Ui, vec2};

use crate::document::{Channel, SkeletonRig, Target, TargetMotion, TargetPath};
use crate::kinematics::chain_ik::{Root, Status};
use crate::kinematics::diagnosis::Diagnosis;
use crate::kinematics::limb_ik::LimbReach;
use crate::kinematics::skeleton::JointId;
use crate::rig::{TargetOutcome, TargetReport};
use crate::session::{Actions, PlaybackAction, SelectAction, Session, TargetEdit};
use crate::ui::panels::limb;
use crate::ui::widgets::{self, AXES, Choice, NumberField, PointSliders, Slider, text};
use crate::ui::{labels, pose_summary, style};

const NO_INFLUENCE: &str = "Enable the target and give it influence first";

/// Tooltip of the button and the item that add targets to a person.
pub(in crate::ui) const ADD_TARGETS: &str = "Add targets to the hands, feet and head of a person";

/// True if a figure has enough joints for two arms and two legs.
pub(in crate::ui) fn may_be_person(session: &Session) -> bool {
    const LIMBS: usize = 4;
    session.skeleton().joints().len() > LIMBS * 3
}

/// Distance between the rows of the list, in points.
const BETWEEN: f32 = 0.0;

/// Shows the list of targets.
pub(in crate::ui) fn list(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let rig = session.rig();
    if rig.targets.is_empty() {
        ui.weak("No targets. Select a joint and press T.");
        if may_be_person(session) && widgets::wide_button(ui, "Add targets", ADD_TARGETS, None) {
            actions.push(TargetEdit::AddHumanoidTargets);
        }
    }
    let reports = &session.posed().evaluated_skeleton().targets;
    ui.scope(|ui| {
        ui.spacing_mut().item_spacing.y = BETWEEN;
        for (target, report) in rig.targets.iter().zip(reports) {
            row(ui, session, target, report, actions);
        }
    });
}

fn row(
    ui: &mut Ui,
    session: &Session,
    target: &Target,
    report: &TargetReport,
    actions: &mut Actions,
) {
    let Some((end, end_name)) = end(session.rig(), target) else { return };
    let shown = target_name(target, end_name);
    let [to_left, to_right] =
        [Layout::right_to_left(Align::Center), Layout::left_to_right(Align::Center)];
    let height = ui.spacing().interact_size.y;
    ui.allocate_ui_with_layout(vec2(ui.available_width(), height), to_left, |ui| {
        what_is_missing(ui, report, session.rig().tolerance());
        ui.with_layout(to_right, |ui| {
            // In one line with the check boxes below.
            ui.spacing_mut().item_spacing.x = 0.0;
            ui.spacing_mut().icon_spacing = 1.0;
            ui.spacing_mut().button_padding.x = 0.0;
            ui.spacing_mut().interact_size.y = ui.spacing().icon_width;
            let mut enabled = target.enabled;
            let verb = if enabled { "Disable" } else { "Enable" };
            let switch = ui.checkbox(&mut enabled, "").on_hover_text(format!("{verb} this target"));
            widgets::name(ui, &switch, &format!("Target of {end_name}"));
            if switch.changed() {
                actions.push(TargetEdit::SetTarget(Target { enabled, ..*target }));
            }
            ui.spacing_mut().interact_size.y = height;
            ui.spacing_mut().button_padding.x = 3.0;
            let selected = session.selection().active();
            let is_selected = selected == Some(end) || selected == Some(target.joint);
            let label = egui::Button::selectable(is_selected, shown.as_ref()).truncate();
            if ui.add(label).on_hover_text("Select the joint of this target").clicked() {
                actions.push(SelectAction::Joints(vec![end]));
            }
        });
    });
}

/// Shows the distance from a tip to its target, or else the rotation that is missing; nothing for a
/// target that is reached. A target that poses nothing is off, wherever it is.
fn what_is_missing(ui: &mut Ui, report: &TargetReport, tolerance: f32) {
    if matches!(report.outcome, TargetOutcome::Off) {
        ui.weak("off").on_hover_text("The joint angles alone pose it");
    } else if report.error > tolerance {
        let missing = ui.label(RichText::new(text::short(report.error)).monospace());
        missing.on_hover_text("Distance from tip to target");
    } else if let Some(angle) = report.rotation_error.filter(|_| report.misses_rotation()) {
        let missing = ui.label(RichText::new(text::degrees(angle)).monospace());
        missing.on_hover_text("Rotation that is missing");
    }
}

/// Name of a target, after the joint at its end.
pub(in crate::ui) fn target_name<'a>(target: &Target, end: &'a str) -> Cow<'a, str> {
    if target.aim.is_some() { format!("{end} aim").into() } else { end.into() }
}

/// The joint that a target is named after, and its name: the hand of a limb, or the target's joint.
pub(super) fn end<'a>(rig: &'a SkeletonRig, target: &Target) -> Option<(JointId, &'a str)> {
    let joint = rig.end_of(target);
    Some((joint, rig.skeleton.joint(joint)?.name.as_str()))
}

/// Shows the settings of a target.
pub(in crate::ui) fn selected(
    ui: &mut Ui,
    session: &Session,
    target: Target,
    actions: &mut Actions,
) {
    let step = session.shown().grid_cell() * 0.1;
    limb::influence(ui, session, &target, actions);
    space::kind(ui, session, target, actions);
    if !target.has_free_place() {
        place(ui, session, target, step, actions);
    }
    ui.horizontal(|ui| limb::pin(ui, session, &target, actions));
    space::of_target(ui, session, &target, actions);
    if target.limb().is_none() {
        turn::show(ui, session, target, step, actions);
        if !target.has_free_place() {
            weight(ui, session, target, actions);
            softness(ui, session, target, actions);
        }
    } else if session.rig().pulls_body(&target) {
        weight(ui, session, target, actions);
    }
    path(ui, target, actions);
    if target.motion.path != TargetPath::Still {
        motion(ui, session, target, step, actions);
    }
    matches(ui, session, &target, actions);
}

fn place(ui: &mut Ui, session: &Session, target: Target, step: f32, actions: &mut Actions) {
    let pose = &session.posed().evaluated_skeleton().solved;
    let tip = pose.tip(target.joint);
    let place = PointSliders {
        name: "Target",
        labels: AXES,
        value: target.present_home(),
        default: target.placed(pose, session.playback().time(), tip).present_home(),
        range: 1.5 * session.rig().reach(),
        step,
        tooltip: match target.present_space().joint() {
            None => "Move the target in world space",
            Some(_) => "Move the target in the space of the joint that it is on",
        },
        disabled: None,
        channel: Some(Channel::of_point(&target)),
    };
    place.show(ui, session, actions, |home| TargetEdit::SetTarget(target.with_home(home)));
}

fn weight(ui: &mut Ui, session: &Session, target: Target, actions: &mut Actions) {
    let weight = NumberField {
        name: "Weight",
        value: target.weight,
        unit: "",
        step: 0.1,
        digits: 2,
        tooltip: "Weigh this target against the others that pose the body",
    };
    let set = |weight| TargetEdit::SetTarget(Target { weight, ..target });
    weight.row(ui, session, "Weight", actions, set);
}

fn softness(ui: &mut Ui, session: &Session, target: Target, actions: &mut Actions) {
    let softness = Slider {
        name: "Target softness",
        label: "Softness",
        term: Some("Softness"),
        tooltip: "Slow the tip before the chain is straight, so that no joint snaps",
        value: target.softness,
        range: (0.0, 0.9),
        default: 0.0,
        step: 0.1,
        disabled: (session.rig().solver.root == Root::Free)
            .then_some("A root that moves freely is never too far away"),
        ..Slider::default()
    };
    softness.show(ui, session, actions, |softness| {
        TargetEdit::SetTarget(Target { softness: softness.clamp(0.0, 0.99), ..target })
    });
}

/// Shows the buttons that match the target and the FK pose.
fn matches(ui: &mut Ui, session: &Session, target: &Target, actions: &mut Actions) {
    ui.horizontal(|ui| {
        // A target that poses pulls the tip with it.
        let to_fk = if target.is_posing() {
            "Move the target to the tip's FK place; the figure follows into its FK pose"
        } else {
            "Move the target to the tip; nothing else moves"
        };
        if widgets::button(ui, "Target to FK", to_fk, None) {
            actions.push(TargetEdit::MatchTargetToFk(target.joint));
        }
        let tooltip = "Write the shown pose to the joint angles; nothing moves";
        let disabled = labels::why_on_path(session, target.joint)
            .or((!target.is_posing()).then_some(NO_INFLUENCE));
        if widgets::button(ui, "FK to pose", tooltip, disabled) {
            actions.push(TargetEdit::MatchFkToPose(target.joint));
        }
    });
}

const PATHS: [(TargetPath, &str, &str); 3] = [
    (TargetPath::Still, "Still", "Stay in place, or where keys put it"),
    (TargetPath::Circle, "Circle", "Go around a circle"),
    (TargetPath::FigureEight, "Figure eight", "Go around an eight"),
];

/// Shows the choice of the path.
fn path(ui: &mut Ui, target: Target, actions: &mut Actions) {
    let tooltip = "Move the target along a path during playback";
    let choice = Choice { label: "Motion", name: "Motion", tooltip, shown: "" };
    if let Some(path) = choice.pick(ui, &PATHS, |path| *path == target.motion.path) {
        let motion = TargetMotion { path, ..target.motion };
        actions.push(TargetEdit::SetTarget(Target { motion, ..target }));
        actions.push(PlaybackAction::Play(path != TargetPath::Still));
    }
}

/// Shows the size and the period of the path.
fn motion(ui: &mut Ui, session: &Session, target: Target, step: f32, actions: &mut Actions) {
    let set = |motion| TargetEdit::SetTarget(Target { motion, ..target });
    let radius = NumberField {
        name: "Radius",
        value: target.motion.radius,
        unit: "",
        step,
        digits: text::decimals(step),
        tooltip: "Set the radius of the path",
    };
    radius.row(ui, session, "Radius", actions, |radius| {
        set(TargetMotion { radius, ..target.motion })
    });
    let period = NumberField {
        name: "Period",
        value: target.motion.period,
        unit: " s",
        step: 0.1,
        digits: 2,
        tooltip: "Set the time for one round",
    };
    period.row(ui, session, "Period", actions, |period| {
        set(TargetMotion { period, ..target.motion })
    });
}

/// Height with the line above, in points, in a panel of a height: a fifth of it, but enough for a
/// cause and a remedy.
pub(in crate::ui) fn note_height(panel: f32) -> f32 {
    const RANGE: (f32, f32) = (116.0, 150.0);
    (0.2 * panel).clamp(RANGE.0, RANGE.1).round()
}

/// Shows the note on a target at constant height.
pub(in crate::ui) fn note(ui: &mut Ui, session: &Session, target: &Target, actions: &mut Actions) {
    let Some(report) = session.posed().target_report(target.joint) else { return };
    let (rig, is_held) =
        (session.rig(), pose_summary::is_held(ui) || session.history().is_editing());
    let index = rig.target(target.joint);
    let why = index.map_or(&[][..], |index| session.why_target(index, !is_held));
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
    let away = || format!("{} away", text::short(report.error));
    let text = match missing_rotation(report) {
        Some(missing) if report.error <= session.rig().tolerance() => missing,
        Some(missing) => format!("{}, {missing}", away()),
        None => away(),
    };
    let heading = RichText::new(format!("{end} not reached: {text}"));
    ui.label(heading.color(style::accent(ui)));
    for found in causes {
        pose_summary::cause(ui, session, found);
        ui.horizontal_wrapped(|ui| pose_summary::remedies(ui, session, found, usize::MAX, actions));
    }
}

fn text(session: &Session, target: &Target, report: &TargetReport) -> String {
    let gap = text::short(report.error);
    let is_blended = target.influence < 1.0;
    match &report.outcome {
        TargetOutcome::Off if !target.enabled => "Disabled: the joint angles alone pose it".into(),
        TargetOutcome::Off => "Influence 0: the joint angles alone pose it".into(),
        TargetOutcome::Leads => "Leads the head: the body follows its path".into(),
        TargetOutcome::WholeBody(_) | TargetOutcome::Limb(_) if is_blended => {
            format!("Blended with the FK pose, {gap} from the target")
        }
        TargetOutcome::WholeBody(_)
            if report.error <= session.rig().tolerance()
                && let Some(missing) = missing_rotation(report) =>
        {
            format!("Not reached: {missing}")
        }
        TargetOutcome::WholeBody(report) => match report.status {
            Status::Converged if report.iterations == 0 => "Reached".to_owned(),
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
            LimbReach::Reached if limb.turned_aside != 0.0 => {
                let upper = session.rig().limb_joints(target.joint).next();
                let name = upper.map_or("", |upper| &session.skeleton()[upper].name);
                let aside = text::degrees(limb.turned_aside.abs());
                format!("Reached; the limits of {name} turn the elbow aside by {aside}")
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

/// The rotation that is missing, in words; `None` for a joint that is turned as its target asks.
fn missing_rotation(report: &TargetReport) -> Option<String> {
    let angle = report.rotation_error.filter(|_| report.misses_rotation())?;
    Some(format!("{} of its rotation missing", text::degrees(angle)))
}
