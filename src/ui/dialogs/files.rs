//! Questions about files: before changes or files are lost, and the choice of a file's skeletons
//! and animations.

use std::path::Path;

use egui::{Button, ScrollArea, Ui};

use super::path::first_button;
use crate::document::Document;
use crate::io::{FileAnimation, OpenOptions};
use crate::session::{Actions, FileAction, FileContents, PathDialog, Session, ShellAction};

pub(super) fn replace(ui: &mut Ui, path: &Path, then: &FileAction, actions: &mut Actions) {
    ui.set_width(380.0);
    let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
    let folder = path.parent().unwrap_or(Path::new("")).display();
    ui.label(format!("{name} already exists in {folder}."));
    ui.add_space(4.0);
    ui.horizontal(|ui| {
        // The default button is harmless, so a repeated Enter overwrites nothing.
        if first_button(ui, "Choose another name") {
            actions.push(ShellAction::CloseDialog);
        }
        if ui.button("Replace").on_hover_text("Overwrite the existing file").clicked() {
            actions.push(then.clone());
        }
    });
}

pub(super) fn file_changed(ui: &mut Ui, path: &Path, actions: &mut Actions) {
    ui.set_width(420.0);
    let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
    ui.label(format!(
        "Another program has changed {name} since it was opened or saved here. Overwriting loses \
         those changes."
    ));
    ui.add_space(4.0);
    ui.horizontal(|ui| {
        // The default button is harmless, so a repeated Enter overwrites nothing.
        if first_button(ui, "Save as…") {
            let path = path.display().to_string();
            let dialog = PathDialog::SaveAs { path, problem: None };
            actions.push(ShellAction::OpenDialog(dialog.into()));
        }
        if ui.button("Overwrite").on_hover_text("Replace the changed file").clicked() {
            actions.push(FileAction::SaveAs(path.to_owned()));
        }
        if ui.button("Cancel").clicked() {
            actions.push(ShellAction::CloseDialog);
        }
    });
}

pub(super) fn quit_during_export(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    ui.set_width(380.0);
    let path = session.files().job().map(|job| job.path.as_path());
    let name = path.and_then(Path::file_name).unwrap_or_default().to_string_lossy();
    ui.label(format!("{name} is being exported. Quitting now discards it."));
    ui.add_space(4.0);
    ui.horizontal(|ui| {
        if first_button(ui, "Continue export") {
            actions.push(ShellAction::CloseDialog);
        }
        if ui.button("Cancel export and quit").clicked() {
            actions.push(FileAction::StopExportAndQuit);
        }
    });
}

pub(super) fn unsaved(ui: &mut Ui, session: &Session, then: &FileAction, actions: &mut Actions) {
    ui.set_width(380.0);
    let name = session.files().name().unwrap_or_else(|| "The document".to_owned());
    ui.label(format!("{name} has unsaved changes."));
    ui.add_space(4.0);
    ui.horizontal(|ui| {
        if first_button(ui, "Save") {
            actions.push(FileAction::SaveAnd(Box::new(then.clone())));
        }
        if ui.button("Don't save").on_hover_text("Discard the changes").clicked() {
            actions.push(FileAction::Discard(Box::new(then.clone())));
        }
        if ui.button("Cancel").clicked() {
            actions.push(ShellAction::CloseDialog);
        }
    });
}

pub(super) fn recover(
    ui: &mut Ui,
    document: &Document,
    file: Option<&Path>,
    actions: &mut Actions,
) {
    ui.set_width(420.0);
    let name = file.and_then(Path::file_name).map(|name| name.to_string_lossy());
    ui.label(match name {
        Some(name) => {
            format!("ik-arm ended with unsaved changes to {name}. They can be recovered.")
        }
        None => "ik-arm ended with an unsaved document. It can be recovered.".to_owned(),
    });
    ui.add_space(4.0);
    ui.horizontal(|ui| {
        if first_button(ui, "Recover") {
            let (document, file) = (Box::new(document.clone()), file.map(Path::to_owned));
            actions.push(FileAction::Recover { document, file });
        }
        if ui.button("Discard").on_hover_text("Discard the changes").clicked() {
            actions.push(FileAction::DeclineRecovery);
        }
        if ui.button("Decide later").clicked() {
            actions.push(ShellAction::CloseDialog);
        }
    });
}

pub(super) fn choose(ui: &mut Ui, contents: &FileContents, actions: &mut Actions) {
    ui.set_width(380.0);
    let FileContents { path, options, skeletons, animations, animation } = contents;
    let mut open = |options| actions.push(FileAction::Open { path: path.clone(), options });
    if skeletons.len() > 1 {
        ui.strong(format!("{} skeletons", skeletons.len()));
        let first = skeletons.first();
        list(
            ui,
            "skeletons",
            skeletons
                .iter()
                .map(|name| (name.clone(), options.skeleton.as_ref().or(first) == Some(name))),
            |index| {
                open(OpenOptions { skeleton: Some(skeletons[index].clone()), ..options.clone() });
            },
        );
    }
    if animations.len() > 1 {
        ui.strong(format!("{} animations", animations.len()));
        let rows = animations.iter().enumerate();
        let rows = rows.map(|(index, it)| (describe(it), *animation == Some(index)));
        list(ui, "animations", rows, |index| {
            let name = animations[index].name.clone();
            open(OpenOptions { animation: Some(name), ..options.clone() });
        });
    }
    ui.add_space(4.0);
    if first_button(ui, "Keep what is open") {
        actions.push(ShellAction::CloseDialog);
    }
}

/// Shows a list of names, of which the open one is marked, and calls `choose` with the index of
/// another one that was pressed.
fn list(
    ui: &mut Ui,
    id: &str,
    rows: impl Iterator<Item = (String, bool)>,
    mut choose: impl FnMut(usize),
) {
    ScrollArea::vertical().id_salt(id).max_height(240.0).show(ui, |ui| {
        for (index, (name, is_open)) in rows.enumerate() {
            let button = Button::selectable(is_open, &name).truncate();
            if ui.add(button).clicked() && !is_open {
                choose(index);
            }
        }
    });
    ui.add_space(6.0);
}

fn describe(animation: &FileAnimation) -> String {
    let FileAnimation { name, start, end, moving_joints, has_morphs } = animation;
    match moving_joints {
        0 if *has_morphs => format!("{name} · {:.2} s · morph targets", end - start),
        0 => format!("{name} · moves no joint"),
        1 => format!("{name} · {:.2} s · 1 joint", end - start),
        joints => format!("{name} · {:.2} s · {joints} joints", end - start),
    }
}
