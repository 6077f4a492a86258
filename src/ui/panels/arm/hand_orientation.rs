//! How the hand is turned, and what that does to the forearm.

use egui::{RichText, Ui};

use crate::document::HandSpace;
use crate::session::{Actions, EditAction, Session};
use crate::ui::widgets::{self, euler_sliders};

pub(in crate::ui) fn ui(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let arm = session.arm();
    let spaces = [
        (HandSpace::Lower, "Follow forearm", "The hand turns with the lower limb"),
        (HandSpace::World, "Keep in world", "The hand keeps its orientation however the arm moves"),
    ];
    ui.horizontal(|ui| {
        for (space, name, tooltip) in spaces {
            if ui.radio(arm.wrist.space == space, name).on_hover_text(tooltip).clicked() {
                actions.push(EditAction::SetWristSpace(space));
            }
        }
    });
    let tooltip = match arm.wrist.space {
        HandSpace::Lower => "How the hand is turned on the forearm",
        HandSpace::World => "How the hand is turned in the world",
    };
    euler_sliders(
        ui,
        session,
        "Hand turn",
        tooltip,
        arm.wrist.angles,
        actions,
        EditAction::SetWrist,
    );
    widgets::pair(ui, "Forearm roll τ", |ui| {
        let roll = format!("{:.1}°", arm.roll(session.pose()).to_degrees());
        ui.label(RichText::new(roll).monospace()).on_hover_text(
            "How far the hand is turned about the forearm, whole turns included; spread along it, as \
             its stripes show",
        );
    });
}
