//! Soft limits of the arm.

use egui::Ui;

use crate::session::{Actions, EditAction, Session};
use crate::ui::widgets::soft_reach_sliders;

pub(in crate::ui) fn ui(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let soft_reach = session.arm().soft_reach;
    soft_reach_sliders(ui, session, "", soft_reach, actions, EditAction::SetSoftReach);
}
