//! Shortcuts of the viewport and the outliner.

use egui::{Event, Key, Ui};
use glam::Vec2;

use crate::document::AxisView;
use crate::session::{
    Actions, Constraint, JointEdit, PointDrag, SelectAction, Session, SolverAction,
    TransactionAction, ViewAction,
};
use crate::ui::commands;

/// Handles shortcuts of single keys, for use while the viewport, the outliner, the timeline or no
/// widget has the keyboard focus.
pub(in crate::ui) fn viewport(ui: &Ui, session: &Session, actions: &mut Actions) {
    if session.shell().is_asking() {
        return;
    }
    if session.history().drag().is_some() {
        drag(ui, session, actions);
    } else {
        view(ui, session, actions);
        joints(ui, session, actions);
    }
}

/// True if the key was pressed without modifiers in this frame.
pub(in crate::ui) fn pressed(ui: &Ui, key: Key) -> bool {
    ui.input(|input| input.key_pressed(key) && input.modifiers.is_none())
}

fn joints(ui: &Ui, session: &Session, actions: &mut Actions) {
    let pressed = |key| pressed(ui, key);
    let selected = session.selection().active();
    if ui.input(|input| input.key_pressed(Key::A) && input.modifiers.command_only()) {
        actions.push(SelectAction::Joints(session.skeleton_pose().ids().collect()));
    }
    if pressed(Key::A) {
        actions.push(JointEdit::AddJoint { tip: None });
    }
    if pressed(Key::T) {
        actions.extend(commands::toggle_target(session));
    }
    if let Some(joint) = selected.filter(|_| pressed(Key::F2)) {
        actions.push(commands::rename(session, joint));
    }
    if selected.is_some() && (pressed(Key::Delete) || pressed(Key::Backspace)) {
        actions.push(commands::delete(session));
    }
    if pressed(Key::R) {
        actions.push(SolverAction::Run(!session.solvers().is_running()));
    }
    if pressed(Key::S) {
        actions.push(SolverAction::Step);
    }
    if let Some(shown) = session.solvers().shown_iteration() {
        let previous = shown.previous.filter(|_| pressed(Key::Comma));
        let next = shown.next.filter(|_| pressed(Key::Period));
        actions.extend(previous.or(next).map(SolverAction::Show));
    }
    let shifted = |key| ui.input(|input| input.key_pressed(key) && input.modifiers.shift_only());
    if shifted(Key::Comma) {
        actions.extend(commands::previous_part(session));
    }
    if shifted(Key::Period) {
        actions.extend(commands::next_part(session));
    }
}

fn view(ui: &Ui, session: &Session, actions: &mut Actions) {
    axis_views(ui, session, actions);
    if pressed(ui, Key::F) {
        actions.push(commands::frame_selection(session));
    }
    if pressed(ui, Key::Home) {
        actions.push(commands::frame_all(session));
    }
}

/// Handles the digits that choose a view along an axis or the other projection, for use also while
/// a widget has the keyboard focus that makes no use of digits.
pub(in crate::ui) fn axis_views(ui: &Ui, session: &Session, actions: &mut Actions) {
    let camera = session.settled_camera();
    let along = |view| ViewAction::GlideTo(camera.along(view));
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
        if input.key_pressed(Key::Num5) && !other_side {
            actions.push(commands::toggle_projection(session));
        }
    });
}

/// Moves the camera while the viewport has the keyboard focus: arrow keys orbit, arrow keys with
/// Shift pan, plus and minus zoom. `aspect` is the ratio of the viewport's width to its height.
pub(in crate::ui) fn turn(ui: &Ui, session: &Session, aspect: f32, actions: &mut Actions) {
    const TURN: f32 = 5.0 * core::f32::consts::PI / 180.0;
    const PAN: f32 = 0.1;
    const ZOOM: f32 = 1.15;
    let camera = session.settled_camera();
    let moved = ui.input(|input| {
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
    if moved != camera && session.history().drag().is_none() {
        actions.push(ViewAction::SetCamera(moved));
    }
}

fn drag(ui: &Ui, session: &Session, actions: &mut Actions) {
    let Some(drag) = session.history().drag() else {
        return;
    };
    let mut typed = drag.typed().to_owned();
    ui.input(|input| {
        for (axis, key) in [Key::X, Key::Y, Key::Z].into_iter().enumerate() {
            if input.key_pressed(key) {
                let constraint = if input.modifiers.shift {
                    Constraint::Plane(axis)
                } else {
                    Constraint::Axis(axis)
                };
                let released = drag.point().and_then(PointDrag::constraint) == Some(constraint);
                actions.push(TransactionAction::Constrain((!released).then_some(constraint)));
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
            actions.push(TransactionAction::Commit);
        }
    });
    if typed != drag.typed() {
        actions.push(TransactionAction::TypeOffset(typed));
    }
}
