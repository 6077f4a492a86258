//! Dialogs about joints and skeletons.

use egui::Ui;

use super::path::{first_button, prompt};
use crate::kinematics::skeleton::JointId;
use crate::session::{Actions, Dialog, JointEdit, Session, ShellAction};
use crate::ui::widgets;

pub(super) fn rename(
    ui: &mut Ui,
    session: &Session,
    joint: JointId,
    name: &str,
    is_new: bool,
    actions: &mut Actions,
) {
    ui.set_width(300.0);
    let (typed, entered) = prompt(ui, "Joint name", name, is_new);
    if typed != name {
        actions.push(ShellAction::OpenDialog(Dialog::Rename { joint, name: typed.clone() }));
    }
    let other = session.skeleton().find(typed.trim()).filter(|other| *other != joint);
    let why_not = match other {
        _ if typed.trim().is_empty() => Some("A joint needs a name"),
        Some(_) => Some("Another joint has this name"),
        None => None,
    };
    if let Some(why_not) = why_not {
        widgets::error_label(ui, why_not);
    }
    ui.add_space(4.0);
    ui.horizontal(|ui| {
        let accept = widgets::primary_button(ui, "Rename", why_not);
        if (accept.clicked() || entered) && why_not.is_none() {
            actions.push(JointEdit::RenameJoint { joint, name: typed.trim().to_owned() });
        }
        if ui.button("Cancel").clicked() {
            actions.push(ShellAction::CloseDialog);
        }
    });
}

pub(super) fn delete_joints(
    ui: &mut Ui,
    session: &Session,
    joints: &[JointId],
    actions: &mut Actions,
) {
    ui.set_width(360.0);
    let skeleton = &session.skeleton();
    let what = match joints {
        [joint] => skeleton.joint(*joint).map_or("The joint", |joint| joint.name.as_str()),
        _ => "The selected joints",
    };
    let verb = if joints.len() == 1 { "has" } else { "have" };
    ui.label(format!("{what} {verb} children. Kept children do not move."));
    ui.add_space(4.0);
    ui.horizontal(|ui| {
        if first_button(ui, "Keep children") {
            actions.push(JointEdit::DissolveJoints(joints.to_vec()));
        }
        if ui.button("Delete children too").clicked() {
            actions.push(JointEdit::DeleteJoints(joints.to_vec()));
        }
        if ui.button("Cancel").clicked() {
            actions.push(ShellAction::CloseDialog);
        }
    });
}
