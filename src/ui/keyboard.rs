//! What the keys do when no widget has them.

use egui::{Event, Key, KeyboardShortcut, Modifiers, Ui};
use glam::Vec2;

use super::{menu, outliner, timeline};
use crate::document::{AxisView, RigKind};
use crate::session::{Action, Constraint, Dialog, PointDrag, Session};

/// Keys that act wherever the keyboard is; while a dialog has it, only Esc does.
pub(super) fn global(ui: &Ui, session: &Session, actions: &mut Vec<Action>) {
    if session.is_asking() {
        let escapes = ui.input(|input| input.key_pressed(Key::Escape));
        if escapes && !egui::Popup::is_any_open(ui.ctx()) {
            actions.push(Action::CloseDialog);
        }
        return;
    }
    let pressed = |modifiers, key| {
        ui.input_mut(|input| input.consume_shortcut(&KeyboardShortcut::new(modifiers, key)))
    };
    if pressed(Modifiers::COMMAND, Key::Q) {
        actions.push(Action::Quit);
    }
    // A text that is typed has steps of its own.
    if !ui.text_edit_focused() {
        let redo = Modifiers::COMMAND.plus(Modifiers::SHIFT);
        if pressed(redo, Key::Z) || pressed(Modifiers::COMMAND, Key::Y) {
            actions.push(Action::Redo);
        } else if pressed(Modifiers::COMMAND, Key::Z) {
            actions.push(Action::Undo);
        }
    }
    if pressed(Modifiers::COMMAND, Key::O) {
        actions.push(menu::open());
    }
    if pressed(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::S) {
        actions.push(menu::save_as());
    }
    if pressed(Modifiers::COMMAND, Key::S) {
        actions.push(Action::Save);
    }
    let dropped = ui.input(|input| input.raw.dropped_files.first().map(|it| it.path().to_owned()));
    if let Some(path) = dropped {
        actions.push(Action::Open { path, skeleton: None });
    }
    if pressed(Modifiers::COMMAND, Key::E) {
        actions.push(Action::OpenDialog(session.export_dialog()));
    }
    if pressed(Modifiers::COMMAND, Key::P) {
        actions.push(menu::save_picture());
    }
    if pressed(Modifiers::NONE, Key::F1) {
        actions.push(Action::OpenDialog(Dialog::Shortcuts));
    }
    if ui.input(|input| input.key_pressed(Key::Escape)) {
        if timeline::holds(ui) && !session.is_editing() {
            // It lets go of what it holds.
        } else if session.is_editing() {
            actions.push(Action::CancelEdit);
        } else if session.view_drag().is_some() {
            actions.push(Action::CancelView);
        } else if session.dialog().is_some() {
            actions.push(Action::CloseDialog);
        } else if was_typing(ui) || egui::Popup::is_any_open(ui.ctx()) {
            // It leaves the text, or closes the list.
        } else if session.is_running() {
            actions.push(Action::CancelRun);
        } else if session.comparison().is_some() {
            actions.push(Action::Comparison(false));
        } else if !session.selection().is_empty() {
            actions.push(Action::Select(Vec::new()));
        } else if !session.selected_keys().is_empty() {
            actions.push(Action::SelectKeys(Vec::new()));
        }
    }
    timeline::everywhere(ui, session, actions);
    let copied = ui.input(|input| input.events.contains(&Event::Copy));
    if copied && !ui.text_edit_focused() {
        let is_of_keys = timeline::has_the_word(ui, session);
        actions.push(if is_of_keys { Action::CopyKeys } else { Action::CopyPose });
    }
}

/// Marks whether a text has the keyboard.
#[derive(Clone, Copy, Default)]
struct Typing(bool);

/// Notes at the end of a frame whether a text has the keyboard: Esc takes it away before the next
/// one begins.
pub(super) fn remember(ui: &Ui) {
    let typing = Typing(ui.text_edit_focused());
    ui.data_mut(|data| data.insert_temp(egui::Id::NULL, typing));
}

fn was_typing(ui: &Ui) -> bool {
    ui.data(|data| data.get_temp::<Typing>(egui::Id::NULL)).is_some_and(|typing| typing.0)
}

/// Single keys, while no widget or the viewport or the tree of joints has the keyboard.
pub(super) fn viewport(ui: &Ui, session: &Session, actions: &mut Vec<Action>) {
    if session.is_asking() {
        return;
    }
    if session.drag().is_some() {
        drag(ui, session, actions);
    } else {
        view(ui, session, actions);
        if session.rig() == RigKind::Skeleton {
            skeleton(ui, session, actions);
        }
    }
}

fn skeleton(ui: &Ui, session: &Session, actions: &mut Vec<Action>) {
    let pressed = |key| ui.input(|input| input.key_pressed(key) && input.modifiers.is_none());
    let selected = session.selected();
    if ui.input(|input| input.key_pressed(Key::A) && input.modifiers.command_only()) {
        actions.push(Action::Select((0..session.skeleton_pose().len()).collect()));
    }
    if pressed(Key::A) {
        actions.push(Action::AddJoint { tip: None });
    }
    if pressed(Key::T) {
        actions.extend(outliner::toggle_target(session));
    }
    if let Some(joint) = selected.filter(|_| pressed(Key::F2)) {
        actions.push(outliner::rename(session, joint));
    }
    if selected.is_some() && (pressed(Key::Delete) || pressed(Key::Backspace)) {
        actions.push(outliner::delete(session));
    }
    if pressed(Key::R) {
        actions.push(Action::Run(!session.is_running()));
    }
    if pressed(Key::S) {
        actions.push(Action::Step);
    }
}

fn view(ui: &Ui, session: &Session, actions: &mut Vec<Action>) {
    let camera = session.settled_camera();
    let along = |view| Action::GlideTo(camera.along(view));
    ui.input(|input| {
        let other_side = input.modifiers.command;
        if !(input.modifiers.is_none() || input.modifiers.command_only()) {
            return;
        }
        for (key, view, opposite) in [
            (Key::Num1, AxisView::Front, AxisView::Back),
            (Key::Num3, AxisView::Right, AxisView::Left),
            (Key::Num7, AxisView::Top, AxisView::Bottom),
        ] {
            if input.key_pressed(key) {
                actions.push(along(if other_side { opposite } else { view }));
            }
        }
        if other_side {
            return;
        }
        if input.key_pressed(Key::Num5) {
            actions.push(Action::SetCamera(menu::with_other_projection(camera)));
        }
        if input.key_pressed(Key::F) {
            actions.push(menu::frame_selection(session));
        }
        if input.key_pressed(Key::Home) {
            actions.push(menu::frame_all(session));
        }
    });
}

/// Arrow keys, while the viewport has the keyboard: they turn the view, with Shift they move it;
/// plus and minus zoom.
pub(super) fn turn(ui: &Ui, session: &Session, aspect: f32, actions: &mut Vec<Action>) {
    const TURN: f32 = 5.0 * core::f32::consts::PI / 180.0;
    const PAN: f32 = 0.1;
    const ZOOM: f32 = 1.15;
    let camera = session.settled_camera();
    let asked = ui.input(|input| {
        if input.modifiers.command {
            return camera;
        }
        let presses = |key| input.num_presses(key) as f32;
        let across = presses(Key::ArrowRight) - presses(Key::ArrowLeft);
        let up = presses(Key::ArrowUp) - presses(Key::ArrowDown);
        let nearer = presses(Key::Plus) + presses(Key::Equals) - presses(Key::Minus);
        let moved = Vec2::new(across / aspect, up) * PAN;
        let view = match (across, up) {
            (0.0, 0.0) => camera,
            _ if input.modifiers.shift => camera.panned(moved, Vec2::ZERO, aspect),
            _ => camera.orbited(across * TURN, up * TURN),
        };
        if nearer == 0.0 { view } else { view.zoomed(ZOOM.powf(-nearer), Vec2::ZERO, aspect) }
    });
    if asked != camera && session.drag().is_none() {
        actions.push(Action::SetCamera(asked));
    }
}

fn drag(ui: &Ui, session: &Session, actions: &mut Vec<Action>) {
    let Some(drag) = session.drag() else {
        return;
    };
    let mut typed = drag.typed().to_owned();
    ui.input(|input| {
        for (axis, key) in [Key::X, Key::Y, Key::Z].into_iter().enumerate() {
            if input.key_pressed(key) {
                let asked = if input.modifiers.shift {
                    Constraint::Plane(axis)
                } else {
                    Constraint::Axis(axis)
                };
                let released = drag.point().and_then(PointDrag::constraint) == Some(asked);
                actions.push(Action::ConstrainDrag((!released).then_some(asked)));
            }
        }
        for event in &input.events {
            if let Event::Text(text) = event {
                typed.extend(text.chars().filter(|c| c.is_ascii_digit() || "-.,".contains(*c)));
            }
        }
        if input.key_pressed(Key::Backspace) {
            typed.pop();
        }
        if input.key_pressed(Key::Enter) {
            actions.push(Action::CommitEdit);
        }
    });
    if typed != drag.typed() {
        actions.push(Action::TypeOffset(typed));
    }
}
