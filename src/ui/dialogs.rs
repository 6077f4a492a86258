//! Windows over the others: about, and what asks for a path, a name or a decision.

use std::path::Path;

use egui::{Align2, Grid, Key, Rect, ScrollArea, TextEdit, Ui, Window, pos2, vec2};

use super::{Machine, export, shortcuts, statistics};
use crate::document::Document;
use crate::session::{Action, Dialog, Session};

pub(super) fn ui(
    ui: &Ui,
    session: &Session,
    machine: &Machine,
    viewport: Rect,
    actions: &mut Vec<Action>,
) {
    match session.dialog() {
        Some(Dialog::About) => window(ui, "About ik-arm", actions, |ui, _| about(ui, machine)),
        Some(Dialog::Shortcuts) => {
            window(ui, "Shortcuts", actions, |ui, _| shortcuts::ui(ui, session));
        }
        Some(Dialog::Statistics) => {
            beside(ui, "Statistics", viewport, actions, |ui| statistics::ui(ui, machine));
        }
        Some(Dialog::SavePicture { path }) => {
            window(ui, "Save picture", actions, |ui, actions| {
                ask_path(ui, &SAVE_PICTURE, path, actions);
            });
        }
        Some(Dialog::Export(export)) => {
            window(ui, "Export", actions, |ui, actions| export::ui(ui, session, export, actions));
        }
        Some(Dialog::Open { path }) => {
            window(ui, "Open", actions, |ui, actions| ask_path(ui, &OPEN, path, actions));
        }
        Some(Dialog::SaveAs { path }) => {
            window(ui, "Save as", actions, |ui, actions| ask_path(ui, &SAVE_AS, path, actions));
        }
        Some(Dialog::ChooseSkeleton { path, names }) => {
            window(ui, "Choose a skeleton", actions, |ui, actions| {
                choose_skeleton(ui, path, names, actions);
            });
        }
        Some(Dialog::Rename { joint, name }) => {
            window(ui, "Rename", actions, |ui, actions| rename(ui, *joint, name, actions));
        }
        Some(Dialog::Unsaved { then }) => {
            window(ui, "Save changes?", actions, |ui, actions| unsaved(ui, session, then, actions));
        }
        Some(Dialog::Recover { document, file }) => {
            window(ui, "Not saved last time", actions, |ui, actions| {
                recover(ui, document, file.as_deref(), actions);
            });
        }
        None => {}
    }
}

fn window(
    ui: &Ui,
    title: &str,
    actions: &mut Vec<Action>,
    contents: impl FnOnce(&mut Ui, &mut Vec<Action>),
) {
    let mut open = true;
    Window::new(title)
        .collapsible(false)
        .resizable(false)
        .anchor(Align2::CENTER_CENTER, vec2(0.0, 0.0))
        .open(&mut open)
        .show(ui.ctx(), |ui| contents(ui, actions));
    if !open {
        actions.push(Action::CloseDialog);
    }
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

fn about(ui: &mut Ui, machine: &Machine) {
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
}

/// What a path box asks for.
struct Question {
    prompt: &'static str,
    accept: &'static str,
    dialog: fn(String) -> Dialog,
    action: fn(String) -> Action,
}

const SAVE_PICTURE: Question = Question {
    prompt: "Save the viewport as PNG to",
    accept: "Save",
    dialog: |path| Dialog::SavePicture { path },
    action: Action::SavePicture,
};

const OPEN: Question = Question {
    prompt: "Open a document, a .js3d scene of Scotty3D, a .bvh, .glb or .gltf",
    accept: "Open",
    dialog: |path| Dialog::Open { path },
    action: |path| Action::Open { path: path.into(), skeleton: None },
};

const SAVE_AS: Question = Question {
    prompt: "Save the document to",
    accept: "Save",
    dialog: |path| Dialog::SaveAs { path },
    action: |path| Action::SaveAs(path.into()),
};

/// A path box that works on every system, with the system's own dialog behind a button.
fn ask_path(ui: &mut Ui, question: &Question, path: &str, actions: &mut Vec<Action>) {
    ui.set_width(440.0);
    let (typed, entered) = ask(ui, question.prompt, path);
    if typed != path {
        actions.push(Action::OpenDialog((question.dialog)(typed.clone())));
    }
    ui.horizontal(|ui| {
        let can_go = !typed.trim().is_empty();
        let accept = ui
            .add_enabled(can_go, egui::Button::new(question.accept))
            .on_disabled_hover_text("There is no path yet");
        if (accept.clicked() || entered) && can_go {
            actions.push((question.action)(typed.trim().to_owned()));
        }
        if ui.button("Browse…").on_hover_text("The system's own dialog, where it has one").clicked()
        {
            actions.push(Action::ChoosePath);
        }
        if ui.button("Cancel").clicked() {
            actions.push(Action::CloseDialog);
        }
    });
}

/// A line of text that has the keyboard: what is in it, and whether it was entered.
pub(super) fn ask(ui: &mut Ui, prompt: &str, text: &str) -> (String, bool) {
    let mut typed = text.to_owned();
    let name = ui.label(prompt);
    let edit = ui.add(TextEdit::singleline(&mut typed).desired_width(f32::INFINITY));
    let edit = edit.labelled_by(name.id);
    let entered = edit.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
    if ui.memory(|memory| memory.focused().is_none()) {
        edit.request_focus();
    }
    (typed, entered)
}

fn choose_skeleton(ui: &mut Ui, path: &Path, names: &[String], actions: &mut Vec<Action>) {
    ui.set_width(360.0);
    ui.label("The file has several skeletons. The first one is open; another can be chosen:");
    ScrollArea::vertical().max_height(320.0).show(ui, |ui| {
        for name in names {
            if ui.add(egui::Button::new(name).truncate()).clicked() {
                let (path, skeleton) = (path.to_owned(), Some(name.clone()));
                actions.push(Action::Open { path, skeleton });
            }
        }
    });
    if ui.button("Keep the first").clicked() {
        actions.push(Action::CloseDialog);
    }
}

fn rename(ui: &mut Ui, joint: usize, name: &str, actions: &mut Vec<Action>) {
    ui.set_width(300.0);
    let (typed, entered) = ask(ui, "The joint's name", name);
    if typed != name {
        actions.push(Action::OpenDialog(Dialog::Rename { joint, name: typed.clone() }));
    }
    ui.horizontal(|ui| {
        let can_go = !typed.trim().is_empty();
        let accept = ui
            .add_enabled(can_go, egui::Button::new("Rename"))
            .on_disabled_hover_text("A joint needs a name");
        if (accept.clicked() || entered) && can_go {
            actions.push(Action::Rename { joint, name: typed.trim().to_owned() });
        }
        if ui.button("Cancel").clicked() {
            actions.push(Action::CloseDialog);
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
