//! The list of targets with their distances, and the target of the selected joint.

mod limb;
mod status;

pub(in crate::ui) use status::{height as note_height, ui as note};

use egui::{RichText, Role, Ui, WidgetInfo};

use crate::document::{Channel, SkeletonRig, Target, TargetMotion, TargetPath};
use crate::kinematics::skeleton::JointId;
use crate::rig::{TargetKind, TargetReport};
use crate::session::{Actions, PlaybackAction, SelectAction, Session, TargetEdit};
use crate::ui::labels;
use crate::ui::widgets::Choice;
use crate::ui::widgets::{self, AXES, NumberField, PointSliders, Slider, format};

const NO_INFLUENCE: &str = "Enable the target and give it influence first";

/// Shows the list of targets.
pub(in crate::ui) fn list(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let rig = session.skeleton_rig();
    if rig.targets.is_empty() {
        ui.weak("No targets. Select a joint and press T.");
    }
    for (target, report) in rig.targets.iter().zip(&session.posed().evaluated_skeleton().targets) {
        row(ui, session, target, report, actions);
    }
}

fn row(
    ui: &mut Ui,
    session: &Session,
    target: &Target,
    report: &TargetReport,
    actions: &mut Actions,
) {
    let Some((end, end_name)) = end(session.skeleton_rig(), target) else { return };
    widgets::pair(ui, "", |ui| {
        what_is_missing(ui, report, session.skeleton_rig().tolerance());
        ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
            let mut enabled = target.enabled;
            let name = format!("Target of {end_name}");
            let check = ui.checkbox(&mut enabled, "").on_hover_text("Enable this target");
            ui.ctx().accesskit_node_builder(check.id, |node| node.set_label(name.as_str()));
            if check.changed() {
                actions.push(TargetEdit::SetTarget(Target { enabled, ..*target }));
            }
            let selected = session.selection().active();
            let is_selected = selected == Some(end) || selected == Some(target.joint);
            let label = egui::Button::selectable(is_selected, end_name).truncate();
            if ui.add(label).on_hover_text("Select the joint of this target").clicked() {
                actions.push(SelectAction::Joints(vec![end]));
            }
        });
    });
}

/// Shows the distance from a tip to its target, or else the rotation that is missing; a tick if
/// nothing is.
fn what_is_missing(ui: &mut Ui, report: &TargetReport, tolerance: f32) {
    let distance = format::short(report.error);
    if report.error > tolerance {
        let missing = ui.label(RichText::new(distance).monospace());
        missing.on_hover_text("Distance from tip to target");
    } else if let Some(angle) = report.rotation_error.filter(|_| report.misses_rotation()) {
        let missing = ui.label(RichText::new(format::degrees(angle)).monospace());
        missing.on_hover_text("Rotation that is missing");
    } else {
        let tick = ui.label(RichText::new("✓").color(ui.visuals().weak_text_color()));
        tick.widget_info(|| WidgetInfo::labeled(Role::Label, true, "Reached"));
        tick.on_hover_text(format!("Reached: the tip is {distance} from the target"));
    }
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
    influence(ui, session, target, actions);
    limb::kind(ui, session, target, actions);
    place(ui, session, target, step, actions);
    limb::of_target(ui, session, &target, actions);
    match target.kind {
        TargetKind::Limb(settings) => limb::settings(ui, session, target, settings, actions),
        TargetKind::WholeBody => weight(ui, session, target, actions),
    }
    path(ui, target, actions);
    if target.motion.path != TargetPath::Still {
        motion(ui, session, target, step, actions);
    }
    matches(ui, session, &target, actions);
}

fn influence(ui: &mut Ui, session: &Session, target: Target, actions: &mut Actions) {
    let slider = Slider {
        name: "Target influence",
        label: "Influence",
        term: Some("IK influence"),
        tooltip: "Blend from the FK pose (0) to the target (1)",
        value: target.influence,
        range: (0.0, 1.0),
        default: 1.0,
        step: 0.1,
        channel: Some(Channel::TargetInfluence(target.joint)),
        ..Slider::default()
    };
    slider.show(ui, session, actions, |influence| {
        TargetEdit::SetTarget(Target { influence, ..target })
    });
}

fn place(ui: &mut Ui, session: &Session, target: Target, step: f32, actions: &mut Actions) {
    let pose = &session.posed().evaluated_skeleton().solved;
    let tip = pose.tip(target.joint);
    let place = PointSliders {
        name: "Target",
        labels: AXES,
        value: target.home,
        default: target.placed(pose, session.playback().time(), tip).home,
        range: 1.5 * session.skeleton_rig().reach(),
        step,
        tooltip: match target.space.joint() {
            None => "Move the target in world space",
            Some(_) => "Move the target in the space of the joint that it is on",
        },
        disabled: None,
        channel: Some(Channel::Target(target.joint)),
    };
    place.show(ui, session, actions, |home| TargetEdit::SetTarget(Target { home, ..target }));
}

fn weight(ui: &mut Ui, session: &Session, target: Target, actions: &mut Actions) {
    widgets::pair(ui, "Weight", |ui| {
        let tooltip = "Weigh this target against the other whole-body targets";
        let field = NumberField {
            name: "Weight",
            value: target.weight,
            unit: "",
            step: 0.1,
            digits: 2,
            tooltip,
        };
        field.show(ui, session, actions, |weight| {
            TargetEdit::SetTarget(Target { weight, ..target })
        });
    });
}

/// Shows the buttons that match the target and the FK pose.
fn matches(ui: &mut Ui, session: &Session, target: &Target, actions: &mut Actions) {
    ui.horizontal(|ui| {
        // A target that poses pulls the tip with it.
        let tooltip = if target.is_posing() {
            "Move the target to the tip's FK place; the figure follows into its FK pose"
        } else {
            "Move the target to the tip; nothing else moves"
        };
        if widgets::button(ui, "Target to FK", tooltip, None) {
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
    let now = PATHS.iter().find(|(path, ..)| *path == target.motion.path);
    let choice = Choice {
        label: "Motion",
        name: "Motion",
        tooltip: "Move the target along a path during playback",
        shown: now.map_or("", |now| now.1),
    };
    choice.show(ui, |list| {
        for (path, name, tooltip) in PATHS {
            if list.item(path == target.motion.path, name, tooltip, None) {
                let motion = TargetMotion { path, ..target.motion };
                actions.push(TargetEdit::SetTarget(Target { motion, ..target }));
                actions.push(PlaybackAction::Play(path != TargetPath::Still));
            }
        }
    });
}

/// Shows the size and the period of the path.
fn motion(ui: &mut Ui, session: &Session, target: Target, step: f32, actions: &mut Actions) {
    let set = |motion| TargetEdit::SetTarget(Target { motion, ..target });
    widgets::pair(ui, "Radius", |ui| {
        let radius = NumberField {
            name: "Radius",
            value: target.motion.radius,
            unit: "",
            step,
            digits: format::decimals(step),
            tooltip: "Set the radius of the path",
        };
        radius.show(ui, session, actions, |radius| set(TargetMotion { radius, ..target.motion }));
    });
    widgets::pair(ui, "Period", |ui| {
        let period = NumberField {
            name: "Period",
            value: target.motion.period,
            unit: " s",
            step: 0.1,
            digits: 2,
            tooltip: "Set the time for one round",
        };
        period.show(ui, session, actions, |period| set(TargetMotion { period, ..target.motion }));
    });
}
