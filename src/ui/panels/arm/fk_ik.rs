//! IK (hand → joint angles), FK (joint angles → hand), or a blend.

use egui::{Ui, vec2};
use glam::Vec3;

use crate::session::{Actions, EditAction, PoseMode, Session, TransactionAction};
use crate::ui::style;
use crate::ui::widgets::{self, Slider, angle_slider};

/// Width in points of each of the two buttons.
const WIDTH: f32 = 33.0;

/// Shows the switch between IK and FK and, if FK has a part in the pose, the joint angles.
pub(in crate::ui) fn ui(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    switch(ui, session, actions);
    if session.arm().influence < 1.0 {
        angles(ui, session, actions);
    }
}

/// Shows buttons for IK and FK, and the slider that blends between them.
fn switch(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let influence = session.arm().influence;
    let modes = [
        (PoseMode::Hand, "IK", 1.0, "Pose by IK (hand → joint angles)"),
        (PoseMode::Angles, "FK", 0.0, "Pose by FK (joint angles → hand)"),
    ];
    let blend = Slider {
        name: "IK influence",
        label: "IK influence",
        tooltip: "Blend from FK at 0 to IK at 1",
        value: influence,
        range: (0.0, 1.0),
        default: 1.0,
        step: 0.1,
        ..Slider::default()
    };
    blend.show_after(ui, session, actions, EditAction::SetInfluence, |ui, actions| {
        ui.spacing_mut().item_spacing.x = 2.0;
        for (mode, name, whole, tooltip) in modes {
            let chosen = influence == whole;
            let button = egui::Button::selectable(chosen, name).frame_when_inactive(true);
            let button = button.min_size(vec2(WIDTH, 0.0));
            if ui.add(button).on_hover_text(tooltip).clicked() && !chosen {
                actions.push(EditAction::SwitchPoseMode(mode));
            }
        }
        ui.spacing_mut().item_spacing.x = 8.0;
    });
}

/// Shows sliders of the three shoulder angles and the elbow bend, and a button that sets all to 0.
fn angles(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let fk = session.arm().fk;
    let shoulder = [
        (1, "Shoulder yaw", "Turn the Upper limb about the vertical, first"),
        (2, "Shoulder pitch", "Raise the Upper limb, second"),
        (0, "Shoulder roll", "Turn the Upper limb about itself, third"),
    ];
    let slide = |ui: &mut Ui,
                 slider: Slider<'_>,
                 actions: &mut Actions,
                 set: &dyn Fn(f32) -> EditAction| {
        slider.show(ui, session, actions, |degrees| set(degrees.to_radians()));
    };
    for (axis, name, tooltip) in shoulder {
        let slider = angle_slider(name, tooltip, fk.shoulder[axis]);
        let colour = style::colour(style::palette(ui).axes[axis]);
        let label = ["Roll x", "Yaw y", "Pitch z"][axis];
        let slider = Slider { label, colour: Some(colour), ..slider };
        let set = |radians| {
            let mut angles = fk.shoulder;
            angles[axis] = radians;
            EditAction::SetShoulder(angles)
        };
        slide(ui, slider, actions, &set);
    }
    let bend = angle_slider("Elbow bend", "Bend the elbow: 0° straight, 180° folded", fk.bend);
    let bend = Slider { label: "Bend β", range: (0.0, 180.0), ..bend };
    slide(ui, bend, actions, &EditAction::SetBend);
    ui.add_space(2.0);
    if widgets::button(ui, "Straighten", "Set all four angles to 0", None) {
        actions.push(TransactionAction::Begin);
        actions.push(EditAction::SetShoulder(Vec3::ZERO));
        actions.push(EditAction::SetBend(0.0));
        actions.push(TransactionAction::Commit);
    }
}
