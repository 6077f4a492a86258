//! What poses the arm: the hand (IK), the joints' own angles (FK), or something between.

use egui::{Ui, vec2};
use glam::Vec3;

use crate::session::{Actions, EditAction, PoseMode, Session, TransactionAction};
use crate::ui::style;
use crate::ui::widgets::{self, Slider, angle_slider};

/// Of each of the two buttons.
const WIDTH: f32 = 33.0;

/// IK or FK, and how much of each.
pub(in crate::ui) fn switch(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let weight = session.arm().influence;
    let leads = [
        (PoseMode::Hand, "IK", 1.0, "The hand leads: the joints are solved for. The pose stays"),
        (
            PoseMode::Angles,
            "FK",
            0.0,
            "The joints' own angles lead, and place the hand. The pose stays",
        ),
    ];
    let blend = Slider {
        name: "IK weight",
        label: "IK weight",
        tooltip: "How far the hand leads: 1 is IK, 0 is FK, and between them limbs and elbow turn \
                  part of the way and keep their lengths",
        value: weight,
        range: (0.0, 1.0),
        default: 1.0,
        step: 0.1,
        ..Slider::default()
    };
    blend.show_after(ui, session, actions, EditAction::SetInfluence, |ui, actions| {
        ui.spacing_mut().item_spacing.x = 2.0;
        for (lead, name, whole, tooltip) in leads {
            let chosen = weight == whole;
            let button = egui::Button::selectable(chosen, name).frame_when_inactive(true);
            let button = button.min_size(vec2(WIDTH, 0.0));
            if ui.add(button).on_hover_text(tooltip).clicked() && !chosen {
                actions.push(EditAction::SwitchPoseMode(lead));
            }
        }
        ui.spacing_mut().item_spacing.x = 8.0;
    });
}

/// The shoulder's three and the elbow's one.
pub(in crate::ui) fn angles(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let fk = session.arm().fk;
    let shoulder = [
        (1, "Shoulder yaw", "Turns the upper limb about the vertical, first"),
        (2, "Shoulder pitch", "Raises the upper limb, second"),
        (0, "Shoulder twist", "Turns it about itself, third: it takes the elbow's hinge around"),
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
        let label = ["Twist x", "Yaw y", "Pitch z"][axis];
        let slider = Slider { label, colour: Some(colour), ..slider };
        let set = |radians| {
            let mut angles = fk.shoulder;
            angles[axis] = radians;
            EditAction::SetShoulder(angles)
        };
        slide(ui, slider, actions, &set);
    }
    let bend = angle_slider("Elbow bend", "At the elbow: 0° straight, 180° folded", fk.bend);
    let bend = Slider { label: "Bend β", range: (0.0, 180.0), ..bend };
    slide(ui, bend, actions, &EditAction::SetBend);
    ui.add_space(2.0);
    if widgets::button(ui, "Straighten", "All four angles to 0", None) {
        actions.push(TransactionAction::Begin);
        actions.push(EditAction::SetShoulder(Vec3::ZERO));
        actions.push(EditAction::SetBend(0.0));
        actions.push(TransactionAction::Commit);
    }
}
