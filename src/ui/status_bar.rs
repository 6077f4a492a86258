//! The status bar: the offset and shortcuts of a drag, the current message, or a description of the
//! pose; and what the mouse buttons do.

use std::time::Duration;

use egui::{Align, Id, Label, Layout, ProgressBar, Ui};

use super::widgets::{self, format};
use super::{labels, mouse_hints, pose_summary};
use crate::document::RigKind;
use crate::kinematics::skeleton::Joint;
use crate::kinematics::swing::Swing;
use crate::session::{
    Actions, Drag, ExportJob, FileAction, Grip, JointEdit, PointDrag, Session, ShellAction,
    TurnDrag, WiggleTarget, WiggleView,
};

/// Height in points.
pub(in crate::ui) const HEIGHT: f32 = 24.0;

/// Seconds for which a message stays, and for which an error does.
const MESSAGE_SECONDS: f64 = 12.0;
const ERROR_SECONDS: f64 = 30.0;

/// A message with the time at which it was first shown, in seconds.
#[derive(Clone, Default, PartialEq)]
struct ShownMessage {
    text: String,
    since: f64,
}

pub(in crate::ui) fn ui(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    expire(ui, session, actions);
    ui.horizontal(|ui| {
        ui.set_height(HEIGHT);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            // The keys of a drag need the whole line.
            if session.history().drag().is_none() {
                mouse_hints::ui(ui, session);
            }
            if let Some(job) = session.files().job() {
                show_job(ui, job, actions);
            }
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                if session.files().seems_z_up() && session.history().drag().is_none() {
                    offer_turn(ui, actions);
                }
                let is_error = session.history().drag().is_none() && session.shell().has_failed();
                if is_error {
                    widgets::error_label(ui, &line(session));
                } else {
                    ui.add(Label::new(line(session)).truncate().selectable(false));
                }
            });
        });
    });
}

/// Removes the message once its time is over.
fn expire(ui: &Ui, session: &Session, actions: &mut Actions) {
    let (id, now) = (Id::unique("shown message"), ui.input(|input| input.time));
    let Some(text) = session.shell().message() else {
        return ui.data_mut(|data| data.remove::<ShownMessage>(id));
    };
    let shown: ShownMessage = ui.data(|data| data.get_temp(id)).unwrap_or_default();
    if shown.text != text {
        let shown = ShownMessage { text: text.to_owned(), since: now };
        ui.data_mut(|data| data.insert_temp(id, shown));
        return expire(ui, session, actions);
    }
    let stays = if session.shell().has_failed() { ERROR_SECONDS } else { MESSAGE_SECONDS };
    let left = shown.since + stays - now;
    if left > 0.0 {
        ui.ctx().request_repaint_after(Duration::from_secs_f64(left));
    } else {
        actions.push(ShellAction::ClearMessage);
    }
}

/// Offers to turn a skeleton that stands along z.
fn offer_turn(ui: &mut Ui, actions: &mut Actions) {
    ui.add(Label::new("z seems to point up:").selectable(false));
    let tooltip = "Turn the skeleton by −90° about x";
    if ui.small_button("Turn to y up").on_hover_text(tooltip).clicked() {
        actions.push(JointEdit::TurnYUp);
    }
    if ui.small_button("Leave").on_hover_text("Keep the axes of the file").clicked() {
        actions.push(FileAction::DeclineTurn);
    }
    ui.separator();
}

/// Shows the progress of an export, and a button that cancels it.
fn show_job(ui: &mut Ui, job: &ExportJob, actions: &mut Actions) {
    ui.ctx().request_repaint_after(Duration::from_millis(100));
    if ui.small_button("Cancel").on_hover_text("Cancel the export; no file is written").clicked() {
        actions.push(FileAction::CancelExport);
    }
    let name = job.path.file_name().unwrap_or(job.path.as_os_str()).to_string_lossy();
    let part = job.progress.part();
    let bar = ProgressBar::new(part).desired_width(140.0).text(format!("{:.0} %", part * 100.0));
    ui.add(bar).on_hover_text(format!("Exporting {}", job.path.display()));
    ui.add(Label::new(format!("Exporting {name}")).selectable(false));
}

fn line(session: &Session) -> String {
    if let Some(drag) = session.history().drag() {
        return describe_drag(session, drag);
    }
    if let Some(wiggle) = session.wiggle_view() {
        return describe_wiggle(session, &wiggle);
    }
    session.shell().message().map_or_else(|| pose_summary::describe(session), ToOwned::to_owned)
}

/// Describes the angle that swings, and how the residual changes with it.
fn describe_wiggle(session: &Session, wiggle: &WiggleView) -> String {
    let Swing { joint, axis, .. } = wiggle.swing;
    let name = session.skeleton().joint(joint).map_or("", |joint| &joint.name);
    let by = wiggle.by.to_degrees();
    let turn = format!("Wiggle {name} about {axis}: {by:+.1}°");
    match wiggle.target {
        Some(WiggleTarget { before, now, predicted, .. }) => format!(
            "{turn}, error {:+.4}; the Jacobian predicts {:+.4}",
            now - before,
            predicted - before
        ),
        None => turn,
    }
}

fn describe_drag(session: &Session, drag: &Drag) -> String {
    match (drag.point(), drag.turn()) {
        (Some(point), _) => describe_move(session, drag.grip(), point),
        (_, Some(turn)) => describe_turn(session, drag.grip(), turn),
        (None, None) => String::new(),
    }
}

fn describe_move(session: &Session, grip: Grip, drag: &PointDrag) -> String {
    let moved = drag.moved();
    let how = drag.constraint().map_or("freely".to_owned(), |constraint| constraint.to_string());
    let name = labels::grip(session, grip);
    let verb = match grip {
        Grip::Tip(joint, _)
            if session.skeleton().joint(joint).is_some_and(Joint::is_root_point) =>
        {
            format!("Move {name}")
        }
        Grip::Tip(..) => format!("Pose {name}"),
        Grip::Target(..) => "Target".to_owned(),
        Grip::Head(..) => "Head".to_owned(),
        Grip::Pole(_) => "Pole".to_owned(),
        Grip::Root(_) => "Root".to_owned(),
        Grip::UpperLimb => "Upper limb".to_owned(),
        _ => "Move".to_owned(),
    };
    let digits = match session.rig() {
        RigKind::Arm => format::decimals_of_cell(session.shown().grid_cell() * 0.1),
        RigKind::Skeleton => format::decimals_of_cell(session.shown().grid_cell()),
    };
    let [x, y, z] = moved.to_array().map(|way| {
        if format::has_overflowed(way.into()) {
            format::OVERFLOW.to_owned()
        } else {
            format!("{way:+.digits$}")
        }
    });
    format!(
        "{verb} {how}: {x}, {y}, {z}{}     Shift precise · Ctrl snap · X Y Z lock · digits type · Enter accept · Esc cancel",
        typed(drag.typed()),
    )
}

/// Describes a rotation: the applied angle, which at a joint limit is less than the angle of the
/// mouse, and the shortcuts of the drag.
fn describe_turn(session: &Session, grip: Grip, drag: &TurnDrag) -> String {
    const AT_LIMIT: f32 = 1e-5;
    let joints = session.skeleton().joints();
    let angle = match grip {
        Grip::Ring(joint, axis) => {
            joints.get(joint.index()).map(|joint| joint.rotation[axis.index()])
        }
        _ => None,
    };
    let turned = angle.map_or(drag.turned(), |angle| drag.turned_to(angle));
    let limit = if (turned - drag.turned()).abs() > AT_LIMIT { ", at its limit" } else { "" };
    let verb = match grip {
        Grip::Ring(_, axis)
        | Grip::Shoulder(axis)
        | Grip::HandRing(axis)
        | Grip::Orientation(_, axis) => {
            format!("Rotate about {axis}")
        }
        Grip::Twist | Grip::Limb => "Socket twist".to_owned(),
        _ => "Bend".to_owned(),
    };
    format!(
        "{verb}: {:+.1}°{limit}{}     Shift precise · Ctrl snap · digits type · Enter accept · Esc cancel",
        turned.to_degrees(),
        typed(drag.typed()),
    )
}

fn typed(typed: &str) -> String {
    match typed {
        "" => String::new(),
        typed => format!(" · typed {typed}"),
    }
}
