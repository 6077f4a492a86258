//! Windows over the others: about, shortcuts, and what asks for a path or a name.

use std::path::Path;

use egui::{Align2, Grid, Key, ScrollArea, TextEdit, Ui, Window, vec2};

use super::{Machine, export};
use crate::session::{Action, Dialog, Export, Session};

pub(super) fn ui(ui: &Ui, session: &Session, machine: &Machine, actions: &mut Vec<Action>) {
    match session.dialog() {
        Some(Dialog::About) => window(ui, "About ik-arm", actions, |ui, _| about(ui, machine)),
        Some(Dialog::Shortcuts) => {
            window(ui, "Shortcuts", actions, |ui, _| shortcuts(ui, session));
        }
        Some(Dialog::SavePicture { path }) => {
            window(ui, "Save picture", actions, |ui, actions| {
                ask_path(ui, &SAVE_PICTURE, path, actions);
            });
        }
        Some(Dialog::Export { path, frame_rate, size }) => {
            let export = Export { path: path.into(), frame_rate: *frame_rate, size: *size };
            window(ui, "Export", actions, |ui, actions| export::ui(ui, session, &export, actions));
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
        Some(Dialog::Recover { file, .. }) => {
            window(ui, "Not saved last time", actions, |ui, actions| {
                recover(ui, file.as_deref(), actions);
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

fn shortcuts(ui: &mut Ui, session: &Session) {
    let navigation = session.preferences().navigation;
    let [turn, pan, zoom] = navigation.help();
    let view = format!("View ({})", navigation.name());
    let groups: [(&str, &[(&str, &str)]); 6] = [
        (&view, &[("Turn", turn), ("Move", pan), ("Zoom", zoom), ("Over handles too", "Alt+drag")]),
        (
            "Look",
            &[
                ("Front, right, top", "1, 3, 7"),
                ("Back, left, bottom", "Ctrl+1, 3, 7"),
                ("Perspective or orthographic", "5"),
                ("Frame the arm, all", "F, Home"),
                ("Turn, move, zoom the focused view", "arrows, Shift+arrows, + -"),
                ("First view", "double-click on the background"),
            ],
        ),
        (
            "Skeleton",
            &[
                ("Select, add to the selection", "click, Shift+click"),
                ("Add a child, at the pointer", "A, Ctrl+click"),
                ("Add or remove a target, rename, delete", "T, F2, Delete"),
                ("Run the solver, one iteration", "R, S"),
                ("Select all, none", "Ctrl+A, Esc"),
            ],
        ),
        (
            "While something is dragged",
            &[
                ("A tenth, whole steps", "Shift, Ctrl"),
                ("Along an axis, in a plane", "X Y Z, Shift+X Y Z"),
                ("Type the offset", "digits , - ."),
                ("Accept, take back", "Enter, Esc or right button"),
            ],
        ),
        (
            "Sliders",
            &[
                ("1, a tenth, 10", "arrows, Shift+arrows, Page keys"),
                ("Ends, reset", "Home End, double-click"),
                ("Take back a drag", "Esc"),
            ],
        ),
        (
            "Time and keys",
            &[
                ("Play or pause", "Space"),
                ("Key what is selected, all", "K, Shift+K"),
                ("Frame and key before, after", "arrows in the timeline"),
                ("Start, end", "Home, End in the timeline"),
                ("Select keys, more, all", "click or box, Shift, Ctrl+A"),
                ("Delete, copy, paste keys", "Delete, Ctrl+C, Ctrl+V"),
                ("Drag between frames", "Ctrl"),
                ("Zoom the time, move it", "wheel, middle drag"),
            ],
        ),
    ];
    // Beside each other, so that all is seen at once; where the window is smaller still, it scrolls.
    let room = ui.ctx().content_rect().size() - vec2(64.0, 96.0);
    let size = vec2(900.0, 432.0).min(room);
    ui.set_min_size(size);
    ScrollArea::both().max_width(size.x).max_height(size.y).show(ui, |ui| {
        ui.horizontal_top(|ui| {
            ui.spacing_mut().item_spacing.x = 24.0;
            for column in [&[1, 2, 4][..], &[0, 3, 5]] {
                ui.vertical(|ui| {
                    ui.spacing_mut().item_spacing.x = 8.0;
                    column.iter().for_each(|group| group_of_keys(ui, groups[*group]));
                });
            }
        });
    });
}

fn group_of_keys(ui: &mut Ui, (title, rows): (&str, &[(&str, &str)])) {
    ui.strong(title);
    let grid = Grid::new(title).num_columns(2).min_col_width(190.0);
    grid.min_row_height(18.0).spacing(vec2(8.0, 2.0)).show(ui, |ui| {
        for (what, keys) in rows {
            ui.label(*what);
            ui.weak(*keys);
            ui.end_row();
        }
    });
    ui.add_space(8.0);
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

fn recover(ui: &mut Ui, file: Option<&Path>, actions: &mut Vec<Action>) {
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
            actions.push(Action::Recover);
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
