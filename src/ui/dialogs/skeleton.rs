//! Dialogs about a skeleton: names of joints, children of deleted joints, and baking to keys.

use std::time::Duration;

use egui::{DragValue, Grid, ProgressBar, Ui};

use super::path::{first_button, prompt};
use crate::document::{Bake, BakeError, Timeline};
use crate::kinematics::skeleton::JointId;
use crate::session::{Actions, BakeAction, BakeJob, Dialog, JointEdit, Session, ShellAction};
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

/// Shows the bake dialog.
pub(super) fn bake(
    ui: &mut Ui,
    session: &Session,
    settings: &Bake,
    job: Option<&BakeJob>,
    actions: &mut Actions,
) {
    ui.set_width(360.0);
    if let Some(job) = job {
        return baking(ui, job, actions);
    }
    ui.label("Keys the pose of every frame, so that targets and path are not needed.");
    ui.add_space(4.0);
    let mut changed = *settings;
    let Bake { frames, tolerance } = &mut changed;
    Grid::new("bake").num_columns(2).show(ui, |ui| {
        let seconds = |value| DragValue::new(value).speed(0.01).max_decimals(3).suffix(" s");
        let limit = Timeline::MAX_TIME;
        row(ui, "Start", seconds(&mut frames.start).range(-limit..=limit));
        row(ui, "End", seconds(&mut frames.end).range(-limit..=limit));
        let rate = widgets::frame_rate(&mut frames.frame_rate);
        row(ui, "Frames per second", rate);
        let tolerance = DragValue::new(tolerance).speed(1e-4).max_decimals(5);
        row(ui, "Tolerance (of the reach)", tolerance.range(BakeError::TOLERANCES));
    });
    if changed != *settings {
        actions.push(ShellAction::OpenDialog(Dialog::Bake { settings: changed, job: None }));
    }
    let error = changed.check(session.document()).err().map(|error| error.to_string());
    match &error {
        Some(error) => widgets::error_label(ui, error),
        None => {
            ui.weak(format!("{} frames", changed.frames.frames()));
        }
    }
    ui.add_space(4.0);
    ui.horizontal(|ui| {
        if let Some(error) = &error {
            widgets::primary_button(ui, "Bake", Some(error));
        } else if first_button(ui, "Bake") {
            actions.push(BakeAction::Start(changed));
        }
        if ui.button("Cancel").clicked() {
            actions.push(ShellAction::CloseDialog);
        }
    });
}

/// Shows a number with its name to the left.
fn row(ui: &mut Ui, name: &str, number: DragValue<'_>) {
    let name = ui.label(name);
    ui.add(number).labelled_by(name.id);
    ui.end_row();
}

/// Shows the progress of a bake, and a button that cancels it.
fn baking(ui: &mut Ui, job: &BakeJob, actions: &mut Actions) {
    ui.ctx().request_repaint_after(Duration::from_millis(100));
    let part = job.progress.part();
    ui.add(ProgressBar::new(part).text(format!("{:.0} %", part * 100.0)));
    ui.add_space(4.0);
    if first_button(ui, "Cancel") {
        actions.push(ShellAction::CloseDialog);
    }
}
