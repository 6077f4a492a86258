//! The line at the bottom: what just happened, or what the keys do now, or how the arm stands.

use egui::accesskit::Role;
use egui::{Align, Label, Layout, ProgressBar, RichText, Ui};

use super::Machine;
use super::number::grouped;
use crate::document::{Arm, RigKind};
use crate::kinematics::chain_ik::Method;
use crate::kinematics::two_bone::{Reach, TwoBonePose};
use crate::rig::Crowd;
use crate::session::{Action, Drag, Grip, Job, PointDrag, Session, SolverStatus, TurnDrag};

pub(super) fn ui(ui: &mut Ui, session: &Session, machine: &Machine, actions: &mut Vec<Action>) {
    ui.horizontal(|ui| {
        ui.set_height(24.0);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.add(Label::new(RichText::new(describe_machine(machine)).weak()).selectable(false));
            if let Some(job) = session.job() {
                show_job(ui, job, actions);
            }
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                let is_error = session.drag().is_none() && session.has_failed();
                match is_error {
                    true => error(ui, &line(session)),
                    false => {
                        ui.add(Label::new(line(session)).truncate().selectable(false));
                    }
                }
            });
        });
    });
}

/// Text in the colour of errors, which a screen reader announces.
pub(super) fn error(ui: &mut Ui, text: &str) {
    let colour = ui.visuals().error_fg_color;
    let label = Label::new(RichText::new(text).color(colour)).selectable(false);
    let response =
        ui.add(if ui.layout().is_horizontal() { label.truncate() } else { label.wrap() });
    ui.ctx().accesskit_node_builder(response.id, |node| {
        node.set_role(Role::Alert);
        node.set_label(text);
    });
}

/// How far an export is; a press stops it.
fn show_job(ui: &mut Ui, job: &Job, actions: &mut Vec<Action>) {
    ui.ctx().request_repaint_after(std::time::Duration::from_millis(100));
    if ui.small_button("Cancel").on_hover_text("Stops the export; no file is left").clicked() {
        actions.push(Action::CancelExport);
    }
    let name = job.path.file_name().unwrap_or(job.path.as_os_str()).to_string_lossy();
    let part = job.progress.part();
    let bar = ProgressBar::new(part).desired_width(140.0).text(format!("{:.0} %", part * 100.0));
    ui.add(bar).on_hover_text(format!("Exporting {}", job.path.display()));
    ui.add(Label::new(format!("Exporting {name}")).selectable(false));
}

/// One sentence on why the arm is as it is.
pub(super) fn sentence(arm: &Arm, pose: &TwoBonePose) -> String {
    let gap = arm.length_in_words(pose.hand.distance(arm.cursor()));
    if !arm.is_led_by_hand() {
        return "FK: the joints' own angles place the hand.".to_owned();
    }
    if arm.influence < 1.0 {
        return format!("Between FK and IK: the hand is {gap} from the cursor.");
    }
    if pose.stretch > 1.0 {
        let reached = if pose.reach == Reach::Reached { "" } else { " as far as they may" };
        return format!("Stretched: the limbs are {:.2} times as long{reached}.", pose.stretch);
    }
    match pose.reach {
        Reach::Reached => "Reached: the hand is at the cursor.".to_owned(),
        Reach::TooFar if arm.soft_reach.softness() > 0.0 => {
            format!("Soft: the hand lags {gap} behind the cursor, so that the elbow does not snap.")
        }
        Reach::TooClose if !arm.soft_reach.is_hard() => {
            format!("Soft: the hand keeps away from the shoulder, {gap} from the cursor.")
        }
        Reach::TooFar => {
            format!("Too far: the arm is straight and points at the cursor, {gap} short.")
        }
        Reach::TooClose => {
            format!("Too close: the arm is folded and points past the cursor, by {gap}.")
        }
    }
}

fn line(session: &Session) -> String {
    if let Some(drag) = session.drag() {
        return describe_drag(session, drag);
    }
    session.message().map_or_else(|| describe(session), ToOwned::to_owned)
}

/// How the rig stands, for those who do not see it.
pub(super) fn summary(session: &Session) -> String {
    if let Some(crowd) = session.crowd() {
        return describe_crowd(&crowd);
    }
    match session.rig() {
        RigKind::Arm => sentence(session.arm(), session.pose()),
        RigKind::Skeleton => describe_skeleton(session),
    }
}

fn describe(session: &Session) -> String {
    if let Some(crowd) = session.crowd() {
        return describe_crowd(&crowd);
    }
    match session.rig() {
        RigKind::Arm => describe_pose(session),
        RigKind::Skeleton => describe_skeleton(session),
    }
}

fn describe_crowd(crowd: &Crowd) -> String {
    match crowd.arms {
        1 => "A crowd of 1 arm".to_owned(),
        arms => format!("A crowd of {} arms", grouped(arms.into())),
    }
}

fn describe_skeleton(session: &Session) -> String {
    let rig = session.skeleton();
    let joints = rig.skeleton.joints();
    let count = |count: usize, one: &str| match count {
        1 => format!("1 {one}"),
        _ => format!("{count} {one}s"),
    };
    let mut line = vec![count(joints.len(), "joint"), count(rig.targets.len(), "target")];
    if let Some(SolverStatus { state, report }) = session.solver_status() {
        line.push(match report.iterations {
            0 => state.describe().to_owned(),
            made => format!(
                "{}: {} after {}",
                method_name(report.method),
                state.describe(),
                count(made as usize, "iteration")
            ),
        });
    }
    match session.selected().and_then(|joint| joints.get(joint)) {
        Some(joint) => line.insert(0, joint.name.clone()),
        None => line.push("click a joint to select it, drag its tip to pose it".to_owned()),
    }
    line.join(" · ")
}

fn describe_pose(session: &Session) -> String {
    let (arm, pose) = (session.arm(), session.pose());
    let reach = match pose.reach {
        _ if !arm.is_led_by_hand() => "FK",
        _ if arm.influence < 1.0 => "Between FK and IK",
        Reach::Reached => "Reached",
        Reach::TooFar => "Too far",
        Reach::TooClose => "Too close",
    };
    let hand = pose.hand;
    let (least, most) = arm.reach();
    let [x, y, z] = hand.to_array().map(|coordinate| arm.length_in_words(coordinate));
    let distance = arm.length_in_words(pose.distance);
    let digits = decimals(arm.cell());
    format!("{reach} · hand ({x}, {y}, {z}) · D {distance} of {least:.digits$}–{most:.digits$}")
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
    let verb = match grip {
        Grip::Tip(..) => "Pose",
        Grip::Target(..) => "Target",
        Grip::Pole(_) => "Pole",
        _ => "Move",
    };
    let digits = match session.rig() {
        RigKind::Arm => decimals(session.shown().cell() * 0.1),
        RigKind::Skeleton => decimals(session.shown().cell()),
    };
    format!(
        "{verb} {how}: {:+.digits$}, {:+.digits$}, {:+.digits$}{}     Shift fine · Ctrl snap · X Y Z \
         lock · digits type · Enter accept · Esc take back",
        moved.x,
        moved.y,
        moved.z,
        typed(drag.typed()),
    )
}

/// What was turned, which at a limit is less than the mouse has gone around.
fn describe_turn(session: &Session, grip: Grip, drag: &TurnDrag) -> String {
    const AT_LIMIT: f32 = 1e-5;
    let joints = session.skeleton().skeleton.joints();
    let angle = match grip {
        Grip::Ring(joint, axis) => joints.get(joint).map(|joint| joint.rotation[axis.min(2)]),
        _ => None,
    };
    let turned = angle.map_or(drag.turned(), |angle| drag.turned_to(angle));
    let limit = if (turned - drag.turned()).abs() > AT_LIMIT { ", at its limit" } else { "" };
    let verb = match grip {
        Grip::Ring(_, axis) | Grip::Shoulder(axis) => {
            format!("Turn about {}", ["x", "y", "z"][axis.min(2)])
        }
        _ => "Bend".to_owned(),
    };
    format!(
        "{verb}: {:+.1}°{limit}{}     Shift fine · Ctrl snap · digits type · Enter accept · Esc \
         take back",
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

/// How many digits behind the point tell a hundredth of a grid's cell.
pub(super) fn decimals(cell: f32) -> usize {
    (2.0 - cell.log10().round()).clamp(0.0, 6.0) as usize
}

/// As panels and pictures call a solver.
pub(super) fn method_name(method: Method) -> &'static str {
    match method {
        Method::TransposeFixed => "Jacobian transpose, fixed step",
        Method::Transpose => "Jacobian transpose",
        Method::DampedLeastSquares => "Damped least squares",
        Method::Ccd => "Cyclic coordinate descent",
        Method::Fabrik => "FABRIK",
        Method::TwoBone => "Two-bone",
    }
}

fn describe_machine(machine: &Machine) -> String {
    let adapter = machine.adapter.split(" (").next().unwrap_or_default();
    match machine.times.last() {
        Some(frame) => format!("{adapter} · {:.0} ms", frame.total().as_secs_f64() * 1e3),
        None => adapter.to_owned(),
    }
}
