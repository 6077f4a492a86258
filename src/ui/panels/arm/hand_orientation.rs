//! Hand orientation and forearm roll.

use egui::{RichText, Ui};

use crate::document::HandSpace;
use crate::session::{Actions, EditAction, Session};
use crate::ui::widgets::{self, euler_sliders};

pub(in crate::ui) fn ui(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let arm = session.arm();
    let spaces = [
        (HandSpace::LowerLimb, "Follow forearm", "Turn the hand with the Lower limb"),
        (HandSpace::World, "Keep in world", "Keep the world orientation of the hand"),
    ];
    ui.horizontal(|ui| {
        for (space, name, tooltip) in spaces {
            if ui.radio(arm.hand_orientation.space == space, name).on_hover_text(tooltip).clicked()
            {
                actions.push(EditAction::SetHandSpace(space));
            }
        }
    });
    let tooltip = match arm.hand_orientation.space {
        HandSpace::LowerLimb => "Rotate the hand relative to the forearm",
        HandSpace::World => "Rotate the hand in world space",
    };
    euler_sliders(
        ui,
        session,
        "Hand rotation",
        tooltip,
        arm.hand_orientation.angles,
        actions,
        EditAction::SetHandOrientation,
    );
    widgets::pair(ui, "Forearm roll τ", |ui| {
        let roll = format!("{:.1}°", arm.roll(session.pose()).to_degrees());
        ui.label(RichText::new(roll).monospace())
            .on_hover_text("Hand rotation about the forearm, spread along its stripes");
    });
}
