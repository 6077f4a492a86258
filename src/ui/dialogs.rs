//! Windows over the others: about, and those that ask for a path, a name or a decision.

use std::path::{Path, PathBuf};

use egui::text::{CCursor, CCursorRange};
use egui::text_edit::TextEditState;
use egui::{
    Align2, Button, Frame, Grid, Id, Key, Label, Modal, Rect, RichText, Role, ScrollArea, TextEdit,
    Ui, WidgetInfo, Window, pos2,
};

use super::{Machine, export, shortcuts, statistics, status};
use crate::document::Document;
use crate::export::existing;
use crate::session::{Action, Dialog, Session};

pub(super) fn ui(
    ui: &Ui,
    session: &Session,
    machine: &Machine,
    viewport: Rect,
    actions: &mut Vec<Action>,
) {
    let is_new = is_new(ui, session.dialog());
    let Some(dialog) = session.dialog() else { return };
    if is_new && dialog.is_modal() {
        // What had the keyboard until now would have the first key, too.
        ui.memory_mut(egui::Memory::stop_text_input);
    }
    let title = match dialog {
        Dialog::About => "About ik-arm",
        Dialog::Shortcuts => "Shortcuts",
        Dialog::Statistics => "Statistics",
        Dialog::Recover { .. } => "Not saved last time",
        Dialog::Unsaved { .. } => "Save changes?",
        Dialog::Exporting => "Quit during the export?",
        Dialog::Replace { .. } => "Replace the file?",
        Dialog::SavePicture { .. } => "Save picture",
        Dialog::Export(_) => "Export",
        Dialog::Open { .. } => "Open",
        Dialog::SaveAs { .. } => "Save as",
        Dialog::ChooseSkeleton { .. } => "Choose a skeleton",
        Dialog::Rename { .. } => "Rename",
        Dialog::DeleteJoints { .. } => "Delete joints",
    };
    if !dialog.is_modal() {
        return beside(ui, title, viewport, actions, |ui| statistics::ui(ui, machine));
    }
    modal(ui, title, |ui| match dialog {
        Dialog::About => about(ui, machine, actions),
        Dialog::Shortcuts => shortcuts(ui, session, actions),
        Dialog::Recover { document, file } => recover(ui, document, file.as_deref(), actions),
        Dialog::Unsaved { then } => unsaved(ui, session, then, actions),
        Dialog::Exporting => quit_during_export(ui, session, actions),
        Dialog::Replace { path, then, .. } => replace(ui, path, then, actions),
        Dialog::SavePicture { path } => {
            ask_path(ui, session, &SAVE_PICTURE, (path, None), is_new, actions);
        }
        Dialog::Export(export) => export::ui(ui, session, export, is_new, actions),
        Dialog::Open { path, problem } => {
            ask_path(ui, session, &OPEN, (path, problem.as_deref()), is_new, actions);
        }
        Dialog::SaveAs { path, problem } => {
            ask_path(ui, session, &SAVE_AS, (path, problem.as_deref()), is_new, actions);
        }
        Dialog::ChooseSkeleton { path, names } => choose_skeleton(ui, path, names, actions),
        Dialog::Rename { joint, name } => rename(ui, session, *joint, name, is_new, actions),
        Dialog::DeleteJoints { joints } => delete_joints(ui, session, joints, actions),
        Dialog::Statistics => {}
    });
}

/// Whether another dialog was open in the last pass, or none.
fn is_new(ui: &Ui, dialog: Option<&Dialog>) -> bool {
    let now = dialog.map(std::mem::discriminant);
    let id = Id::unique("open dialog");
    let before = ui.data_mut(|data| *data.get_temp_mut_or_default::<Option<_>>(id));
    ui.data_mut(|data| data.insert_temp(id, now));
    now != before
}

/// A window that dims and stops all behind it.
fn modal(ui: &Ui, title: &str, contents: impl FnOnce(&mut Ui)) {
    let style = ui.global_style();
    let frame = Frame::window(&style).inner_margin(16.0);
    let id = Id::unique(("dialog", title.to_owned()));
    let area = Modal::default_area(id).fade_in(false);
    let modal = Modal::new(id).area(area).frame(frame);
    modal.show(ui.ctx(), |ui| {
        ui.response().widget_info(|| WidgetInfo::labeled(Role::Dialog, true, title));
        ui.heading(title);
        ui.add_space(6.0);
        contents(ui);
    });
}

/// One that is looked at while the rest goes on: at the right, where it hides the least of the
/// viewport, until it is moved.
fn beside(
    ui: &Ui,
    title: &str,
    viewport: Rect,
    actions: &mut Vec<Action>,
    contents: impl FnOnce(&mut Ui),
) {
    let mut open = true;
    let right = ui.ctx().content_rect().right();
    Window::new(title)
        .collapsible(false)
        .resizable(false)
        .default_width(statistics::WIDTH)
        .pivot(Align2::RIGHT_TOP)
        .default_pos(pos2(right - 8.0, viewport.top() + 8.0))
        .open(&mut open)
        .show(ui.ctx(), contents);
    if !open {
        actions.push(Action::CloseDialog);
    }
}

fn about(ui: &mut Ui, machine: &Machine, actions: &mut Vec<Action>) {
    ui.set_width(360.0);
    ui.heading(concat!("ik-arm ", env!("CARGO_PKG_VERSION")));
    ui.label("A 3D inverse-kinematics arm to pose, look into and understand.");
    ui.add_space(8.0);
    Grid::new("about").num_columns(2).show(ui, |ui| {
        ui.weak("Graphics");
        ui.label(&machine.adapter);
        ui.end_row();
        ui.weak("Licence");
        ui.label("MIT or Apache-2.0");
        ui.end_row();
    });
    close(ui, actions);
}

fn shortcuts(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    shortcuts::ui(ui, session);
    close(ui, actions);
}

fn close(ui: &mut Ui, actions: &mut Vec<Action>) {
    ui.add_space(8.0);
    if first_button(ui, "Close") {
        actions.push(Action::CloseDialog);
    }
}

/// What a path box asks for.
struct Question {
    prompt: &'static str,
    accept: &'static str,
    dialog: fn(String) -> Dialog,
    action: fn(PathBuf) -> Action,
}

const SAVE_PICTURE: Question = Question {
    prompt: "Save the viewport as PNG to",
    accept: "Save",
    dialog: |path| Dialog::SavePicture { path },
    action: |path| Action::SavePicture(path.display().to_string()),
};

const OPEN: Question = Question {
    prompt: "Open a document, a .js3d scene of Scotty3D, a .bvh, .glb or .gltf",
    accept: "Open",
    dialog: |path| Dialog::Open { path, problem: None },
    action: |path| Action::Open { path, skeleton: None },
};

const SAVE_AS: Question = Question {
    prompt: "Save the document to",
    accept: "Save",
    dialog: |path| Dialog::SaveAs { path, problem: None },
    action: Action::SaveAs,
};

/// A path box that works on every system, with the system's own dialog behind a button.
fn ask_path(
    ui: &mut Ui,
    session: &Session,
    question: &Question,
    (path, problem): (&str, Option<&str>),
    is_new: bool,
    actions: &mut Vec<Action>,
) {
    ui.set_width(440.0);
    let (typed, entered) = ask(ui, question.prompt, path, is_new);
    let dialog = (question.dialog)(typed.clone());
    if typed != path {
        actions.push(Action::OpenDialog(dialog.clone()));
    }
    folder(ui, session, &dialog);
    if let Some(problem) = problem {
        status::error(ui, problem);
    }
    ui.add_space(4.0);
    ui.horizontal(|ui| {
        let typed = typed.trim();
        let accept = ui
            .add_enabled(!typed.is_empty(), Button::new(question.accept))
            .on_disabled_hover_text("There is no path yet");
        if (accept.clicked() || entered) && !typed.is_empty() {
            let path = session.full_path(&dialog, Path::new(typed));
            let action = (question.action)(path.clone());
            actions.push(match dialog {
                Dialog::Open { .. } => action,
                _ => unless_there(session, path, action, dialog),
            });
        }
        browse(ui, actions);
        if ui.button("Cancel").clicked() {
            actions.push(Action::CloseDialog);
        }
    });
}

pub(super) fn browse(ui: &mut Ui, actions: &mut Vec<Action>) {
    let tooltip = "Open the system's file dialog, where it has one";
    if ui.button("Browse…").on_hover_text(tooltip).clicked() {
        actions.push(Action::ChoosePath);
    }
}

/// Says in which folder a path is that is typed without one.
pub(super) fn folder(ui: &mut Ui, session: &Session, dialog: &Dialog) {
    let Some(typed) = dialog.path() else { return };
    let full = session.full_path(dialog, typed);
    let full = std::path::absolute(&full).unwrap_or(full);
    let folder = full.parent().map(|folder| folder.display().to_string()).unwrap_or_default();
    ui.add(Label::new(RichText::new(format!("In {folder}")).weak()).truncate());
}

/// The action, or a question before it if it would overwrite a file that is not the open one.
pub(super) fn unless_there(
    session: &Session,
    path: PathBuf,
    action: Action,
    back: Dialog,
) -> Action {
    let is_own = session.file() == Some(path.as_path());
    match existing(&path).filter(|_| !is_own) {
        Some(path) => {
            let (then, back) = (Box::new(action), Box::new(back));
            Action::OpenDialog(Dialog::Replace { path, then, back })
        }
        None => action,
    }
}

/// A line of text that takes the keyboard when it is new, all of it selected: what is in it, and
/// whether it was entered.
pub(super) fn ask(ui: &mut Ui, prompt: &str, text: &str, is_new: bool) -> (String, bool) {
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

fn choose_skeleton(ui: &mut Ui, path: &Path, names: &[String], actions: &mut Vec<Action>) {
    ui.set_width(360.0);
    ui.label("The file has several skeletons. The first one is open; another can be chosen:");
    ScrollArea::vertical().max_height(320.0).show(ui, |ui| {
        for name in names {
            if ui.add(Button::new(name).truncate()).clicked() {
                let (path, skeleton) = (path.to_owned(), Some(name.clone()));
                actions.push(Action::Open { path, skeleton });
            }
        }
    });
    if first_button(ui, "Keep the first") {
        actions.push(Action::CloseDialog);
    }
}

fn rename(
    ui: &mut Ui,
    session: &Session,
    joint: usize,
    name: &str,
    is_new: bool,
    actions: &mut Vec<Action>,
) {
    ui.set_width(300.0);
    let (typed, entered) = ask(ui, "The joint's name", name, is_new);
    if typed != name {
        actions.push(Action::OpenDialog(Dialog::Rename { joint, name: typed.clone() }));
    }
    let other = session.skeleton().skeleton.find(typed.trim()).filter(|other| *other != joint);
    let why_not = match other {
        _ if typed.trim().is_empty() => Some("A joint needs a name"),
        Some(_) => Some("Another joint has this name"),
        None => None,
    };
    if let Some(why_not) = why_not {
        status::error(ui, why_not);
    }
    ui.add_space(4.0);
    ui.horizontal(|ui| {
        let accept = ui
            .add_enabled(why_not.is_none(), Button::new("Rename"))
            .on_disabled_hover_text(why_not.unwrap_or_default());
        if (accept.clicked() || entered) && why_not.is_none() {
            actions.push(Action::Rename { joint, name: typed.trim().to_owned() });
        }
        if ui.button("Cancel").clicked() {
            actions.push(Action::CloseDialog);
        }
    });
}

fn delete_joints(ui: &mut Ui, session: &Session, joints: &[usize], actions: &mut Vec<Action>) {
    ui.set_width(360.0);
    let skeleton = &session.skeleton().skeleton;
    let what = match joints {
        [joint] => skeleton.joint(*joint).map_or("The joint", |joint| joint.name.as_str()),
        _ => "The selected joints",
    };
    let verb = if joints.len() == 1 { "has" } else { "have" };
    ui.label(format!("{what} {verb} children. Kept, they stay where they are."));
    ui.add_space(4.0);
    ui.horizontal(|ui| {
        if first_button(ui, "Keep children") {
            actions.push(Action::Dissolve(joints.to_vec()));
        }
        if ui.button("Delete children too").clicked() {
            actions.push(Action::Delete(joints.to_vec()));
        }
        if ui.button("Cancel").clicked() {
            actions.push(Action::CloseDialog);
        }
    });
}

fn replace(ui: &mut Ui, path: &Path, then: &Action, actions: &mut Vec<Action>) {
    ui.set_width(380.0);
    let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
    let folder = path.parent().unwrap_or(Path::new("")).display();
    ui.label(format!("{name} is there already, in {folder}."));
    ui.add_space(4.0);
    ui.horizontal(|ui| {
        // Enter that is pressed twice, or held, overwrites nothing.
        if first_button(ui, "Choose another name") {
            actions.push(Action::CloseDialog);
        }
        if ui.button("Replace").on_hover_text("The file that is there is lost").clicked() {
            actions.push(then.clone());
        }
    });
}

fn quit_during_export(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    ui.set_width(380.0);
    let path = session.job().map(|job| job.path.as_path());
    let name = path.and_then(Path::file_name).unwrap_or_default().to_string_lossy();
    ui.label(format!("{name} is being exported. If the program quits now, no file is left."));
    ui.add_space(4.0);
    ui.horizontal(|ui| {
        if first_button(ui, "Go on exporting") {
            actions.push(Action::CloseDialog);
        }
        if ui.button("Stop the export and quit").clicked() {
            actions.push(Action::StopExportAndQuit);
        }
    });
}

fn unsaved(ui: &mut Ui, session: &Session, then: &Action, actions: &mut Vec<Action>) {
    ui.set_width(380.0);
    let name = session.file().and_then(Path::file_name);
    let name = name.map_or("The document".into(), |name| name.to_string_lossy());
    ui.label(format!("{name} has changes that are not saved."));
    ui.add_space(4.0);
    ui.horizontal(|ui| {
        if first_button(ui, "Save") {
            actions.push(Action::SaveAnd(Box::new(then.clone())));
        }
        if ui.button("Don't save").on_hover_text("The changes are lost").clicked() {
            actions.push(Action::Discard(Box::new(then.clone())));
        }
        if ui.button("Cancel").clicked() {
            actions.push(Action::CloseDialog);
        }
    });
}

fn recover(ui: &mut Ui, document: &Document, file: Option<&Path>, actions: &mut Vec<Action>) {
    ui.set_width(420.0);
    let name = file.and_then(Path::file_name).map(|name| name.to_string_lossy());
    ui.label(match name {
        Some(name) => {
            format!("ik-arm ended before the changes of {name} were saved. They are kept.")
        }
        None => "ik-arm ended before the document was saved. It is kept.".to_owned(),
    });
    ui.add_space(4.0);
    ui.horizontal(|ui| {
        if first_button(ui, "Open it") {
            let (document, file) = (Box::new(document.clone()), file.map(Path::to_owned));
            actions.push(Action::Recover { document, file });
        }
        if ui.button("Discard it").on_hover_text("The changes are lost").clicked() {
            actions.push(Action::ForgetRecovered);
        }
        if ui.button("Ask again next time").clicked() {
            actions.push(Action::CloseDialog);
        }
    });
}

/// The button that Enter presses.
fn first_button(ui: &mut Ui, name: &str) -> bool {
    let button = ui.button(name);
    if ui.memory(|memory| memory.focused().is_none()) {
        button.request_focus();
    }
    button.clicked()
}
