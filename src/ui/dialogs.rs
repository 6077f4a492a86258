//! Windows over the others: about, shortcuts, where to save a picture.

use egui::{Align2, Grid, Key, TextEdit, Ui, Window, vec2};

use super::Machine;
use crate::session::{Action, Dialog, Session};

pub(super) fn ui(ui: &Ui, session: &Session, machine: &Machine, actions: &mut Vec<Action>) {
    match session.dialog() {
        Some(Dialog::About) => window(ui, "About ik-arm", actions, |ui, _| about(ui, machine)),
        Some(Dialog::Shortcuts) => {
            window(ui, "Shortcuts", actions, |ui, _| shortcuts(ui, session));
        }
        Some(Dialog::SavePicture { path }) => {
            window(ui, "Save picture", actions, |ui, actions| save_picture(ui, path, actions));
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
    let groups: [(&str, &[(&str, &str)]); 4] = [
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
            "While the hand is dragged",
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
    ];
    ui.set_width(430.0);
    for (title, rows) in groups {
        ui.strong(title);
        Grid::new(title).num_columns(2).min_col_width(190.0).show(ui, |ui| {
            for (what, keys) in rows {
                ui.label(*what);
                ui.weak(*keys);
                ui.end_row();
            }
        });
        ui.add_space(8.0);
    }
}

/// A path box that works on every system, with the system's own dialog behind a button.
fn save_picture(ui: &mut Ui, path: &str, actions: &mut Vec<Action>) {
    ui.set_width(440.0);
    let mut typed = path.to_owned();
    let name = ui.label("Save the viewport as PNG to");
    let edit = ui.add(TextEdit::singleline(&mut typed).desired_width(f32::INFINITY));
    let edit = edit.labelled_by(name.id);
    let entered = edit.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
    if ui.memory(|memory| memory.focused().is_none()) {
        edit.request_focus();
    }
    if edit.changed() {
        actions.push(Action::OpenDialog(Dialog::SavePicture { path: typed.clone() }));
    }
    ui.horizontal(|ui| {
        let can_save = !typed.trim().is_empty();
        let save = ui
            .add_enabled(can_save, egui::Button::new("Save"))
            .on_disabled_hover_text("There is no path yet");
        if (save.clicked() || entered) && can_save {
            actions.push(Action::SavePicture(typed.trim().to_owned()));
        }
        if ui.button("Browse…").on_hover_text("The system's own dialog, where it has one").clicked()
        {
            actions.push(Action::ChoosePicturePath(typed.clone()));
        }
        if ui.button("Cancel").clicked() {
            actions.push(Action::CloseDialog);
        }
    });
}
