//! The joints that a target moves: the whole body or a limb.

use egui::Ui;

use super::super::choice::Choice;
use crate::document::Target;
use crate::kinematics::limb_ik::Limb;
use crate::rig::{LimbSettings, TargetKind};
use crate::session::{Actions, EditAction, Session};

pub(super) fn ui(ui: &mut Ui, session: &Session, target: Target, actions: &mut Actions) {
    let no_limb = Limb::ending_at(session.skeleton(), target.joint).err();
    let no_limb = no_limb.map(|reason| format!("No limb: {reason}"));
    let choice = Choice {
        label: "Moves",
        name: "Target kind",
        tooltip: "Choose the joints that the target moves",
        shown: if target.limb().is_some() { "Limb" } else { "Whole body" },
    };
    choice.show(ui, |list| {
        let is_limb = target.limb().is_some();
        let tooltip = "Solve from the root, together with the other whole-body targets";
        if list.item(!is_limb, "Whole body", tooltip, None) {
            let kind = TargetKind::WholeBody;
            actions.push(EditAction::SetTarget(Target { kind, ..target }));
        }
        let tooltip = "Solve the two bones above the tip in closed form";
        if list.item(is_limb, "Limb", tooltip, no_limb.as_deref()) {
            let kind = TargetKind::Limb(LimbSettings::default());
            actions.push(EditAction::SetTarget(Target { kind, ..target }));
        }
    });
}
