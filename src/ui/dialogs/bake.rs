//! The bake dialog.

use std::time::Duration;

use egui::{DragValue, Grid, ProgressBar, Ui};

use super::path::first_button;
use crate::document::{Bake, BakeError, Timeline};
use crate::session::{Actions, BakeAction, BakeJob, Dialog, Session, ShellAction};
use crate::ui::widgets;

pub(in crate::ui) fn ui(
    ui: &mut Ui,
    session: &Session,
    settings: &Bake,
    job: Option<&BakeJob>,
    actions: &mut Actions,
) {
    ui.set_width(360.0);
    if let Some(job) = job {
        return running(ui, job, actions);
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
fn running(ui: &mut Ui, job: &BakeJob, actions: &mut Actions) {
    ui.ctx().request_repaint_after(Duration::from_millis(100));
    let part = job.progress.part();
    ui.add(ProgressBar::new(part).text(format!("{:.0} %", part * 100.0)));
    ui.add_space(4.0);
    if first_button(ui, "Cancel") {
        actions.push(ShellAction::CloseDialog);
    }
}
