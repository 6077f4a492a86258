//! The list of targets with their distances, and the selected target.

use egui::{ComboBox, RichText, Ui};

use crate::document::{Target, TargetMotion, TargetPath};
use crate::kinematics::limb_ik::{ElbowReference, Limb};
use crate::kinematics::twist::Stereographic;
use crate::rig::{LimbSettings, TargetKind};
use crate::session::{Actions, EditAction, PlaybackAction, SelectAction, Session};
use crate::ui::widgets::{self, AXES, NumberField, PointSliders, Slider, format};

const PATHS: [(TargetPath, &str); 3] = [
    (TargetPath::Still, "Still"),
    (TargetPath::Circle, "Circle"),
    (TargetPath::FigureEight, "Figure eight"),
];

/// Shows the list of targets.
pub(in crate::ui) fn list(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let rig = session.skeleton_rig();
    if rig.targets.is_empty() {
        ui.weak("No targets. Select a joint and press T.");
    }
    for target in &rig.targets {
        let Some(joint) = rig.skeleton.joint(target.joint) else { continue };
        widgets::pair(ui, "", |ui| {
            let residual = residual(session, target);
            ui.label(RichText::new(format::short(residual)).monospace())
                .on_hover_text("Distance from tip to target");
            ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
                let mut enabled = target.enabled;
                let name = format!("Target of {}", joint.name);
                let check = ui.checkbox(&mut enabled, "").on_hover_text("Enable this target");
                ui.ctx().accesskit_node_builder(check.id, |node| node.set_label(name.as_str()));
                if check.changed() {
                    actions.push(EditAction::SetTarget(Target { enabled, ..*target }));
                }
                let selected = session.selected() == Some(target.joint);
                let label = egui::Button::selectable(selected, &joint.name).truncate();
                if ui.add(label).on_hover_text("Select the joint of this target").clicked() {
                    actions.push(SelectAction::Joints(vec![target.joint]));
                }
            });
        });
    }
}

fn residual(session: &Session, target: &Target) -> f32 {
    session.target_report(target.joint).map_or(0.0, |report| report.error)
}

/// Shows the settings of the selected joint's target.
pub(in crate::ui) fn selected(
    ui: &mut Ui,
    session: &Session,
    target: Target,
    actions: &mut Actions,
) {
    let step = session.shown().grid_cell() * 0.1;
    place(ui, session, target, step, actions);
    influence(ui, session, target, actions);
    solved_as(ui, session, target, actions);
    if let TargetKind::Limb(settings) = target.kind {
        return limb(ui, session, target, settings, actions);
    }
    widgets::pair(ui, "Weight", |ui| {
        let tooltip = "Weigh this target against the others";
        let field = NumberField {
            name: "Weight",
            value: target.weight,
            unit: "",
            step: 0.1,
            digits: 2,
            tooltip,
        };
        field.show(ui, session, actions, |weight| {
            EditAction::SetTarget(Target { weight, ..target })
        });
    });
    moves(ui, target, actions);
    if target.motion.path != TargetPath::Still {
        motion(ui, session, target, step, actions);
    }
}

fn influence(ui: &mut Ui, session: &Session, target: Target, actions: &mut Actions) {
    let slider = Slider {
        name: "Target influence",
        label: "Influence",
        tooltip: "Blend from the FK pose (0) to the target (1)",
        value: target.influence,
        range: (0.0, 1.0),
        default: 1.0,
        step: 0.1,
        ..Slider::default()
    };
    slider.show(ui, session, actions, |influence| {
        EditAction::SetTarget(Target { influence, ..target })
    });
}

fn solved_as(ui: &mut Ui, session: &Session, target: Target, actions: &mut Actions) {
    let is_limb = matches!(target.kind, TargetKind::Limb(_));
    let limb = Limb::ending_at(session.skeleton(), target.joint);
    widgets::pair(ui, "Moves", |ui| {
        let choices = [
            (false, "Whole body", "Solve from the root, together with the other targets"),
            (true, "Limb", "Solve the two bones above the tip in closed form"),
        ];
        let shown = if is_limb { "Limb" } else { "Whole body" };
        let combo = ComboBox::from_id_salt("target kind").selected_text(shown);
        let response = combo.show_ui(ui, |ui| {
            for (as_limb, name, tooltip) in choices {
                let choice = egui::Button::selectable(as_limb == is_limb, name);
                let reason = limb.err().filter(|_| as_limb);
                let response = ui.add_enabled(reason.is_none(), choice).on_hover_text(tooltip);
                let response = match reason {
                    Some(reason) => response.on_disabled_hover_text(format!("No limb: {reason}")),
                    None => response,
                };
                if response.clicked() && as_limb != is_limb {
                    let settings = LimbSettings::default();
                    let kind =
                        if as_limb { TargetKind::Limb(settings) } else { TargetKind::WholeBody };
                    actions.push(EditAction::SetTarget(Target { kind, ..target }));
                }
            }
        });
        let response = response.response;
        ui.ctx().accesskit_node_builder(response.id, |node| node.set_label("Target kind"));
        response.on_hover_text("Choose the joints that the target moves");
    });
}

fn limb(
    ui: &mut Ui,
    session: &Session,
    target: Target,
    settings: LimbSettings,
    actions: &mut Actions,
) {
    let set =
        |settings| EditAction::SetTarget(Target { kind: TargetKind::Limb(settings), ..target });
    let tip = session.skeleton_pose().tip(target.joint);
    let references = [
        (ElbowReference::Fk, "FK", "Keep the side that the joint angles give"),
        (ElbowReference::Limb, "Limb", "Measure from up"),
        (ElbowReference::Pole(tip), "Pole", "Measure from the direction to a point"),
        (
            ElbowReference::Stereographic(Stereographic::default()),
            "Stereographic",
            "Measure from a stereographic map",
        ),
    ];
    let is_same = |reference: &ElbowReference| {
        core::mem::discriminant(reference) == core::mem::discriminant(&settings.reference)
    };
    widgets::pair(ui, "Elbow from", |ui| {
        let now = references.iter().find(|(reference, ..)| is_same(reference));
        let combo = ComboBox::from_id_salt("elbow").selected_text(now.map_or("", |now| now.1));
        let response = combo.show_ui(ui, |ui| {
            for (reference, name, tooltip) in references {
                let choice = ui.selectable_label(is_same(&reference), name).on_hover_text(tooltip);
                if choice.clicked() && !is_same(&reference) {
                    actions.push(set(LimbSettings { reference, ..settings }));
                }
            }
        });
        let response = response.response;
        ui.ctx().accesskit_node_builder(response.id, |node| node.set_label("Elbow reference"));
        response.on_hover_text("Choose the direction of the elbow or knee at twist 0");
    });
    let twist = Slider {
        name: "Limb twist",
        label: "Twist",
        tooltip: "Turn the elbow or knee about the line to the target",
        value: settings.twist.to_degrees(),
        range: (-180.0, 180.0),
        default: 0.0,
        unit: "°",
        step: 1.0,
        ..Slider::default()
    };
    twist.show(ui, session, actions, |degrees| {
        set(LimbSettings { twist: degrees.to_radians(), ..settings })
    });
    if let ElbowReference::Pole(pole) = settings.reference {
        let sliders = PointSliders {
            name: "Limb pole",
            labels: ["Pole x", "Pole y", "Pole z"],
            value: pole,
            default: tip,
            range: 1.5 * session.skeleton_rig().reach(),
            step: session.shown().grid_cell() * 0.1,
            tooltip: "Move the pole in world space",
            disabled: None,
        };
        sliders.show(ui, session, actions, |pole| {
            set(LimbSettings { reference: ElbowReference::Pole(pole), ..settings })
        });
    }
}

fn place(ui: &mut Ui, session: &Session, target: Target, step: f32, actions: &mut Actions) {
    let place = PointSliders {
        name: "Target",
        labels: AXES,
        value: target.home,
        default: session.skeleton_pose().tip(target.joint),
        range: 1.5 * session.skeleton_rig().reach(),
        step,
        tooltip: "Move the target in world space",
        disabled: None,
    };
    place.show(ui, session, actions, |home| EditAction::SetTarget(Target { home, ..target }));
}

fn moves(ui: &mut Ui, target: Target, actions: &mut Actions) {
    widgets::pair(ui, "Motion", |ui| {
        let now = PATHS.iter().find(|(path, _)| *path == target.motion.path);
        let combo = ComboBox::from_id_salt("moves").selected_text(now.map_or("", |now| now.1));
        let response = combo.show_ui(ui, |ui| {
            for (path, name) in PATHS {
                if ui.selectable_label(path == target.motion.path, name).clicked() {
                    let motion = TargetMotion { path, ..target.motion };
                    actions.push(EditAction::SetTarget(Target { motion, ..target }));
                    actions.push(PlaybackAction::Play(path != TargetPath::Still));
                }
            }
        });
        let response = response.response;
        ui.ctx().accesskit_node_builder(response.id, |node| node.set_label("Motion"));
        response.on_hover_text("Move the target along a path during playback");
    });
}

fn motion(ui: &mut Ui, session: &Session, target: Target, step: f32, actions: &mut Actions) {
    let set = |motion| EditAction::SetTarget(Target { motion, ..target });
    widgets::pair(ui, "Radius", |ui| {
        let (value, tooltip) = (target.motion.radius, "Set the radius of the path");
        NumberField {
            name: "Radius",
            value,
            unit: "",
            step,
            digits: format::decimals(step),
            tooltip,
        }
        .show(ui, session, actions, |radius| set(TargetMotion { radius, ..target.motion }));
    });
    widgets::pair(ui, "Period", |ui| {
        let (value, tooltip) = (target.motion.period, "Set the time for one round");
        NumberField { name: "Period", value, unit: " s", step: 0.1, digits: 2, tooltip }.show(
            ui,
            session,
            actions,
            |period| set(TargetMotion { period, ..target.motion }),
        );
    });
}
