//! The text box for a path, and the question before a file is replaced; a line of text to type and
//! the default button, for all dialogs.

use std::path::{Path, PathBuf};

use egui::text::{CCursor, CCursorRange};
use egui::text_edit::TextEditState;
use egui::{Key, Label, RichText, TextEdit, Ui};

use crate::export::existing;
use crate::io::{FileFormat, OpenOptions, dotted, enumerated};
use crate::session::{Action, Actions, Dialog, FileAction, PathDialog, Session, ShellAction};
use crate::ui::widgets;

/// Texts and actions of a path dialog.
pub(super) struct PathPrompt {
    prompt: fn() -> String,
    accept: &'static str,
    dialog: fn(String) -> PathDialog,
    action: fn(PathBuf) -> FileAction,
}

pub(super) const SAVE_PICTURE: PathPrompt = PathPrompt {
    prompt: || "PNG file".to_owned(),
    accept: "Save",
    dialog: |path| PathDialog::SavePicture { path },
    action: |path| FileAction::SavePicture(path.display().to_string()),
};

pub(super) const OPEN: PathPrompt = PathPrompt {
    prompt: || format!("Document, {}", FileFormat::other_inputs()),
    accept: "Open",
    dialog: |path| PathDialog::Open { path, problem: None },
    action: |path| FileAction::Open { path, options: OpenOptions::default() },
};

pub(super) const SAVE_AS: PathPrompt = PathPrompt {
    prompt: || "Document file".to_owned(),
    accept: "Save",
    dialog: |path| PathDialog::SaveAs { path, problem: None },
    action: FileAction::SaveAs,
};

pub(super) const LOCATE_SKIN: PathPrompt = PathPrompt {
    prompt: || {
        let extensions: Vec<_> = FileFormat::with_skins().iter().map(dotted).collect();
        format!("File with the mesh: {}", enumerated(&extensions, "or"))
    },
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
    let (typed, entered) = prompt(ui, &(question.prompt)(), path, is_new);
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
            let path = session.files().full_path(&dialog, Path::new(typed));
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

/// Shows the folder in which the dialog's path lies, also if the path is typed without a folder. In a
/// page there is none.
pub(in crate::ui) fn folder(ui: &mut Ui, session: &Session, dialog: &PathDialog) {
    let folder = session.files().folder_of(dialog);
    let place = match folder.as_os_str() {
        none if none.is_empty() => "Among the downloads of the browser".to_owned(),
        folder => format!("In {}", folder.display()),
    };
    ui.add(Label::new(RichText::new(place).weak()).truncate());
}

/// Returns `action`, which writes the file at `path`. If that would overwrite a file other than the
/// open one, or the open one after another program has changed it, returns the action that opens a
/// dialog to ask first; cancelling that dialog leads back to `back`.
pub(in crate::ui) fn unless_there(
    session: &Session,
    path: PathBuf,
    action: FileAction,
    back: PathDialog,
) -> Action {
    let is_own = session.files().file() == Some(path.as_path()) && !session.files().has_changed();
    match existing(&path).filter(|_| !is_own) {
        Some(path) => {
            let then = Box::new(action);
            ShellAction::OpenDialog(Dialog::Replace { path, then, back }).into()
        }
        None => action.into(),
    }
}

/// Shows a text line with the label `prompt`. If `is_new`, the line takes the keyboard focus and
/// its text is selected. Returns the text, and whether Enter was pressed.
pub(in crate::ui) fn prompt(ui: &mut Ui, prompt: &str, text: &str, is_new: bool) -> (String, bool) {
    let mut typed = text.to_owned();
    let name = ui.label(prompt);
    let id = name.id.with("text");
    if is_new {
        let mut state = TextEditState::default();
        let all = CCursorRange::two(CCursor::new(0), CCursor::new(text.chars().count()));
        state.cursor.set_char_range(Some(all));
        state.store(ui.ctx(), id);
    }
    if is_new || ui.memory(|memory| memory.focused().is_none()) {
        ui.memory_mut(|memory| memory.request_focus(id));
    }
    let edit = TextEdit::singleline(&mut typed).id(id).desired_width(f32::INFINITY);
    let edit = ui.add(edit).labelled_by(name.id);
    let entered = edit.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
    (typed, entered)
}

/// Shows a button that takes the keyboard focus if no widget has it, so that Enter presses the
/// button. Returns whether the button was pressed.
pub(super) fn first_button(ui: &mut Ui, name: &str) -> bool {
    let button = widgets::primary_button(ui, name, None);
    if ui.memory(|memory| memory.focused().is_none()) {
        button.request_focus();
    }
    button.clicked()
}
