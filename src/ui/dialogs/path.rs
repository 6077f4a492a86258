//! The text box for a path, and the question before a file is replaced.

use std::path::{Path, PathBuf};

use egui::{Label, RichText, Ui};

use super::prompt::prompt;
use crate::export::existing;
use crate::io::OpenOptions;
use crate::session::{Action, Actions, Dialog, FileAction, PathDialog, Session, ShellAction};
use crate::ui::widgets;

/// Texts and actions of a path dialog.
pub(super) struct PathPrompt {
    prompt: &'static str,
    accept: &'static str,
    dialog: fn(String) -> PathDialog,
    action: fn(PathBuf) -> FileAction,
}

pub(super) const SAVE_PICTURE: PathPrompt = PathPrompt {
    prompt: "PNG file",
    accept: "Save",
    dialog: |path| PathDialog::SavePicture { path },
    action: |path| FileAction::SavePicture(path.display().to_string()),
};

pub(super) const OPEN: PathPrompt = PathPrompt {
    prompt: "Document, Scotty3D scene (.js3d), .bvh, .glb or .gltf",
    accept: "Open",
    dialog: |path| PathDialog::Open { path, problem: None },
    action: |path| FileAction::Open { path, options: OpenOptions::default() },
};

pub(super) const SAVE_AS: PathPrompt = PathPrompt {
    prompt: "Document file",
    accept: "Save",
    dialog: |path| PathDialog::SaveAs { path, problem: None },
    action: FileAction::SaveAs,
};

pub(super) const LOCATE_SKIN: PathPrompt = PathPrompt {
    prompt: "File with the mesh: .glb, .gltf or .js3d",
    accept: "Locate",
    dialog: |path| PathDialog::LocateSkin { path, problem: None },
    action: FileAction::LocateSkin,
};

/// Shows a text box that contains `path`, the `problem` with the path, if any, and the buttons of
/// the dialog, one of which opens the system's file dialog.
pub(super) fn ask_path(
    ui: &mut Ui,
    session: &Session,
    question: &PathPrompt,
    (path, problem): (&str, Option<&str>),
    is_new: bool,
    actions: &mut Actions,
) {
    ui.set_width(440.0);
    let (typed, entered) = prompt(ui, question.prompt, path, is_new);
    let dialog = (question.dialog)(typed.clone());
    if typed != path {
        actions.push(ShellAction::OpenDialog(dialog.clone().into()));
    }
    folder(ui, session, &dialog);
    if let Some(problem) = problem {
        widgets::error_label(ui, problem);
    }
    ui.add_space(4.0);
    ui.horizontal(|ui| {
        let typed = typed.trim();
        let why_not = typed.is_empty().then_some("Enter a path first");
        let accepted = widgets::primary_button(ui, question.accept, why_not).clicked();
        if (accepted || entered) && !typed.is_empty() {
            let path = session.full_path(&dialog, Path::new(typed));
            let action = (question.action)(path.clone());
            actions.push(match dialog {
                PathDialog::Open { .. } | PathDialog::LocateSkin { .. } => action.into(),
                _ => unless_there(session, path, action, dialog),
            });
        }
        browse(ui, actions);
        if ui.button("Cancel").clicked() {
            actions.push(ShellAction::CloseDialog);
        }
    });
}

pub(in crate::ui) fn browse(ui: &mut Ui, actions: &mut Actions) {
    let tooltip = "Choose in the system file dialog";
    if ui.button("Browse…").on_hover_text(tooltip).clicked() {
        actions.push(FileAction::ChoosePath);
    }
}

/// Shows the folder in which the dialog's path lies, also if the path is typed without a folder.
pub(in crate::ui) fn folder(ui: &mut Ui, session: &Session, dialog: &PathDialog) {
    let folder = session.folder_of(dialog);
    ui.add(Label::new(RichText::new(format!("In {}", folder.display())).weak()).truncate());
}

/// Returns `action`, which writes the file at `path`. If that would overwrite a file other than the
/// open one, or the open one after another program has changed it, returns the action that opens a dialog to ask first; cancelling that dialog leads back
/// to `back`.
pub(in crate::ui) fn unless_there(
    session: &Session,
    path: PathBuf,
    action: FileAction,
    back: PathDialog,
) -> Action {
    let is_own = session.file() == Some(path.as_path()) && !session.has_changed_file();
    match existing(&path).filter(|_| !is_own) {
        Some(path) => {
            let then = Box::new(action);
            ShellAction::OpenDialog(Dialog::Replace { path, then, back }).into()
        }
        None => action.into(),
    }
}
