//! The line at the bottom: what just happened, or what the keys do now, or how the arm stands.

use egui::{Align, Label, Layout, RichText, Ui};

use super::Machine;
use crate::document::Arm;
use crate::kinematics::two_bone::{Pose, Reach};
use crate::session::{HandDrag, Session};

pub(super) fn ui(ui: &mut Ui, session: &Session, machine: &Machine) {
    ui.horizontal(|ui| {
        ui.set_height(24.0);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.add(Label::new(RichText::new(describe_machine(machine)).weak()).selectable(false));
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                ui.add(Label::new(line(session)).truncate().selectable(false));
            });
        });
    });
}

/// One sentence on why the arm is as it is.
pub(super) fn sentence(arm: &Arm, pose: &Pose) -> String {
    let gap = pose.hand.distance(arm.cursor);
    match pose.reach {
        Reach::Reached => "Reached: the hand is at the cursor.".to_owned(),
        Reach::TooFar => {
            format!("Too far: the arm is straight and points at the cursor, {gap:.1} short.")
        }
        Reach::TooClose => {
            format!("Too close: the arm is folded and points past the cursor, by {gap:.1}.")
        }
    }
}

fn line(session: &Session) -> String {
    if let Some(drag) = session.hand_drag() {
        return describe_drag(drag);
    }
    session.message().map_or_else(|| describe_pose(session), ToOwned::to_owned)
}

fn describe_pose(session: &Session) -> String {
    let (arm, pose) = (session.arm(), session.pose());
    let reach = match pose.reach {
        Reach::Reached => "Reached",
        Reach::TooFar => "Too far",
        Reach::TooClose => "Too close",
    };
    let hand = pose.hand;
    format!(
        "{reach} · hand ({:.1}, {:.1}, {:.1}) · D {:.1} of {:.0}–{:.0}",
        hand.x,
        hand.y,
        hand.z,
        pose.distance,
        arm.bones.inner_limit(),
        arm.bones.outer_limit(),
    )
}

fn describe_drag(drag: &HandDrag) -> String {
    let moved = drag.moved();
    let how = drag.constraint().map_or("freely".to_owned(), |constraint| constraint.to_string());
    let typed = match drag.typed() {
        "" => String::new(),
        typed => format!(" · typed {typed}"),
    };
    format!(
        "Move {how}: {:+.1}, {:+.1}, {:+.1}{typed}     Shift fine · Ctrl snap · X Y Z lock · \
         digits type · Enter accept · Esc take back",
        moved.x, moved.y, moved.z,
    )
}

fn describe_machine(machine: &Machine) -> String {
    let adapter = machine.adapter.split(" (").next().unwrap_or_default();
    match machine.frame_ms {
        Some(frame_ms) => format!("{adapter} · {frame_ms:.0} ms"),
        None => adapter.to_owned(),
    }
}
