//! The Socket twist and its reference.

use core::f32::consts::TAU;

use egui::{Color32, ComboBox, TextStyle, Ui};

use super::disabled::ANGLES_LEAD;
use crate::document::{Arm, TwistReferenceKind};
use crate::session::{Actions, EditAction, Session};
use crate::ui::widgets::{self, PointSliders, Slider};
use crate::ui::{glossary, labels};

/// Least width of the combo box's text, in points.
const COMBO: f32 = 36.0;

pub(in crate::ui) fn ui(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let arm = session.arm();
    let slider = Slider {
        name: "Socket twist",
        label: "Twist",
        tooltip: "Turn the elbow about the Pointer; the hand stays",
        term: Some("Socket twist"),
        value: arm.twist.to_degrees(),
        range: (0.0, TAU.to_degrees()),
        default: 0.0,
        unit: "°",
        step: 1.0,
        disabled: (!arm.uses_ik()).then_some(ANGLES_LEAD),
        ..Slider::default()
    };
    slider
        .show(ui, session, actions, |degrees| EditAction::SetTwist((degrees % 360.0).to_radians()));
    if arm.twist_reference == TwistReferenceKind::Pole {
        pole(ui, session, actions);
    }
}

/// Shows the combo box of the twist references, for the title row of the section, with a label if there
/// is room for both.
pub(in crate::ui) fn reference(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    /// Width in points of the section's title with its triangle.
    const TITLE: f32 = 104.0;
    const LABEL: &str = "reference";
    let chosen = session.arm().twist_reference;
    let spacing = ui.spacing();
    let around = 2.0 * (spacing.button_padding.x + spacing.item_spacing.x);
    let icon = spacing.icon_spacing + spacing.icon_width;
    let needed = TITLE + width(ui, LABEL) + width(ui, chosen.name()).max(COMBO) + icon + around;
    let has_room = ui.available_width() > needed;
    widgets::at_right(ui, |ui| {
        if has_room {
            glossary::term_label(ui, LABEL, "Twist reference", actions);
        }
        choice(ui, chosen, actions);
    });
}

/// Width of a text, in points.
fn width(ui: &Ui, text: &str) -> f32 {
    let font = TextStyle::Body.resolve(ui.style());
    ui.painter().layout_no_wrap(text.to_owned(), font, Color32::PLACEHOLDER).size().x
}

fn choice(ui: &mut Ui, chosen: TwistReferenceKind, actions: &mut Actions) {
    let combo = ComboBox::from_id_salt("twist reference").width(60.0).selected_text(chosen.name());
    let response = combo.show_ui(ui, |ui| {
        for twist_reference in TwistReferenceKind::ALL {
            let item = ui.selectable_label(twist_reference == chosen, twist_reference.name());
            let item = item.on_hover_text(labels::twist_reference(twist_reference));
            if item.clicked() && twist_reference != chosen {
                actions.push(EditAction::SetTwistReference(twist_reference));
            }
        }
    });
    let response = response.response;
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_label("Twist reference"));
    response.on_hover_text(labels::twist_reference(chosen));
}

fn pole(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let arm = session.arm();
    let pole = PointSliders {
        name: "Pole",
        labels: ["Pole x", "Pole y", "Pole z"],
        value: arm.pole,
        default: Arm::default().pole,
        range: arm.bones.outer_limit(),
        step: session.arm_unit(),
        tooltip: "Move the Pole, the point that the elbow turns towards",
        disabled: (!arm.uses_ik()).then_some(ANGLES_LEAD),
        channel: None,
    };
    pole.show(ui, session, actions, EditAction::SetPole);
}
