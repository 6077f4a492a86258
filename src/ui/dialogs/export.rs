//! The export dialog.

use std::path::{Path, PathBuf};

use egui::{DragValue, Grid, Id, Ui};

use super::path::{browse, folder, prompt, unless_there};
use crate::export::{ExportFormat, ExportOptions};
use crate::io::{ExportFrames, ExportKind, ExportOption};
use crate::session::{Actions, DisplayEdit, Export, FileAction, PathDialog, Session, ShellAction};
use crate::ui::widgets::{self, NumberField};

/// The formats in the order of their buttons: motions before single pictures.
fn choices() -> Vec<ExportKind> {
    let kinds = ExportFormat::all().map(|format| format.kind);
    let (mut pictures, mut choices): (Vec<_>, Vec<_>) =
        kinds.partition(|kind| kind.takes(ExportOption::Picture));
    pictures.reverse();
    choices.append(&mut pictures);
    choices
}

/// The kind of file that a path selects.
fn kind(path: &Path) -> Option<ExportKind> {
    ExportFormat::of(path).ok().map(|format| format.kind)
}

pub(in crate::ui) fn ui(
    ui: &mut Ui,
    session: &Session,
    export: &Export,
    is_new: bool,
    actions: &mut Actions,
) {
    ui.set_width(488.0);
    let path = export.path.to_string_lossy();
    let change = |export: Export| ShellAction::OpenDialog(PathDialog::Export(export).into());
    let ending = ending(ui, export, is_new);
    let chosen = kind(&with_ending(&export.path, ending));
    let takes = |option| chosen.is_some_and(|kind| kind.takes(option));
    ui.horizontal_wrapped(|ui| {
        for choice in choices() {
            let ExportKind { name, ending, tooltip, .. } = choice;
            let is_chosen = chosen == Some(choice);
            let button = egui::Button::selectable(is_chosen, name).frame_when_inactive(true);
            if ui.add(button).on_hover_text(tooltip).clicked() && !is_chosen {
                let path = format!("{}{}", stem(&path), ending).into();
                actions.push(change(Export { path, ..export.clone() }));
            }
        }
    });
    ui.weak(chosen.map_or("The file extension chooses the format", |choice| choice.tooltip));
    ui.add_space(4.0);
    Grid::new("export").num_columns(2).show(ui, |ui| {
        let mut changed = export.clone();
        if takes(ExportOption::FrameRate) {
            let name = ui.label("Frames per second");
            ui.add(widgets::frame_rate(&mut changed.frame_rate)).labelled_by(name.id);
            ui.end_row();
            length(ui, session, export.frame_rate, takes(ExportOption::Picture));
        }
        if takes(ExportOption::Picture) {
            let name = ui.label("Size in pixels");
            ui.horizontal(|ui| {
                ui.add(DragValue::new(&mut changed.size.0).range(16..=ExportOptions::MAX_SIDE))
                    .labelled_by(name.id);
                ui.label("×");
                ui.add(DragValue::new(&mut changed.size.1).range(16..=ExportOptions::MAX_SIDE))
                    .labelled_by(name.id);
            });
            ui.end_row();
        }
        if takes(ExportOption::Metres) {
            ui.label("Metres per unit");
            let tooltip = "Set the scale for other programs";
            let value = session.document().metres_per_unit();
            NumberField {
                name: "Metres per unit",
                value,
                unit: "",
                step: 0.001,
                digits: 4,
                tooltip,
            }
            .show(ui, session, actions, |metres| DisplayEdit::SetMetres(Some(metres)));
            ui.end_row();
        }
        if changed != *export {
            actions.push(change(changed));
        }
    });
    ui.add_space(4.0);
    let (typed, entered) = prompt(ui, "File", &path, is_new);
    if typed != path {
        actions.push(change(Export { path: typed.clone().into(), ..export.clone() }));
    }
    let path = with_ending(Path::new(typed.trim()), ending);
    let export = Export { path, ..export.clone() };
    folder(ui, session, &PathDialog::Export(export.clone()));
    ui.add_space(4.0);
    buttons(ui, session, &export, entered, actions);
}

/// The ending of the format that was chosen last, which a name without an extension gets.
fn ending(ui: &Ui, export: &Export, is_new: bool) -> &'static str {
    let id = Id::unique("ending of the export");
    let before = || if is_new { None } else { ui.data(|data| data.get_temp(id)) };
    let first = || choices().first().map(|kind| kind.ending);
    let named = kind(&export.path).map(|kind| kind.ending);
    let ending = named.or_else(before).or_else(first).unwrap_or_default();
    ui.data_mut(|data| data.insert_temp(id, ending));
    ending
}

/// The path with the ending if its name has no extension.
fn with_ending(path: &Path, ending: &str) -> PathBuf {
    let has_extension = path.extension().is_some_and(|extension| !extension.is_empty());
    match path.file_name().filter(|_| !has_extension) {
        Some(name) => {
            let name = name.to_string_lossy();
            path.with_file_name(format!("{}{ending}", name.trim_end_matches('.')))
        }
        None => path.to_owned(),
    }
}

/// Shows the length of the motion, if there is any.
fn length(ui: &mut Ui, session: &Session, frame_rate: f64, is_picture: bool) {
    ui.label("Length");
    let document = session.document();
    let timeline = document.timeline;
    let frames = if is_picture {
        ExportFrames::of_picture(document, Some(frame_rate))
    } else {
        ExportFrames::of_pose(document, Some(frame_rate))
    };
    ui.label(if frames.is_ok_and(|frames| frames.count() > 1) {
        format!("{:.2} s, from {:.2} s", timeline.duration(), timeline.start)
    } else {
        "One frame, no motion".to_owned()
    });
    ui.end_row();
}

fn buttons(ui: &mut Ui, session: &Session, export: &Export, entered: bool, actions: &mut Actions) {
    let why_not = if session.files().job().is_some() {
        Some("Another export is running")
    } else if ExportFormat::of(&export.path).is_err() {
        Some("The file extension must name a format")
    } else {
        None
    };
    ui.horizontal(|ui| {
        let accept = widgets::primary_button(ui, "Export", why_not);
        if (accept.clicked() || entered) && why_not.is_none() {
            let back = PathDialog::Export(export.clone());
            let path = session.files().full_path(&back, &export.path);
            let action = FileAction::Export(Export { path: path.clone(), ..export.clone() });
            actions.push(unless_there(session, path, action, back));
        }
        browse(ui, actions);
        if ui.button("Cancel").clicked() {
            actions.push(ShellAction::CloseDialog);
        }
    });
}

/// The path without the extension of a format and without the placeholder of the frame number,
/// `_####`.
fn stem(path: &str) -> String {
    let path = Path::new(path);
    let has_format = ExportFormat::of(path).is_ok();
    let without = if has_format { path.with_extension("") } else { path.to_owned() };
    let without = without.to_string_lossy();
    without.trim_end_matches('#').trim_end_matches('_').to_owned()
}
