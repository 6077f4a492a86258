//! Actions shared by menus, keys and buttons.

use crate::document::{AxisView, Camera};
use crate::io::ExampleGroup;
use crate::kinematics::skeleton::JointId;
use crate::session::{
    Action, Dialog, Edit, FileAction, JointEdit, PathDialog, Session, ShellAction, SolverAction,
    TargetEdit, ViewAction,
};

pub(in crate::ui) fn open() -> FileAction {
    FileAction::AskPath(PathDialog::open())
}

pub(in crate::ui) fn save_as(session: &Session) -> FileAction {
    FileAction::AskPath(session.files().save_as_dialog())
}

pub(in crate::ui) fn save_picture(session: &Session) -> FileAction {
    FileAction::AskPath(session.files().save_picture_dialog())
}

pub(in crate::ui) fn show_examples() -> ShellAction {
    ShellAction::OpenDialog(Dialog::Examples(ExampleGroup::Basics))
}

pub(in crate::ui) const AXIS_VIEWS: [(AxisView, &str, &str); 6] = [
    (AxisView::Front, "Front", "1"),
    (AxisView::Right, "Right", "3"),
    (AxisView::Top, "Top", "7"),
    (AxisView::Back, "Back", "Ctrl+1"),
    (AxisView::Left, "Left", "Ctrl+3"),
    (AxisView::Bottom, "Bottom", "Ctrl+7"),
];

/// The action that changes between perspective and orthographic projection.
pub(in crate::ui) fn toggle_projection(session: &Session) -> ViewAction {
    let camera = session.settled_camera();
    ViewAction::SetCamera(Camera { orthographic: !camera.orthographic, ..camera })
}

pub(in crate::ui) fn frame_selection(session: &Session) -> ViewAction {
    ViewAction::GlideTo(session.framing_selection())
}

pub(in crate::ui) fn frame_all(session: &Session) -> ViewAction {
    ViewAction::GlideTo(session.framing_all())
}

/// The action that deletes the selected joints. If a selected joint has a child that is not
/// selected, the action opens a dialog that asks what to do with the children.
pub(in crate::ui) fn delete(session: &Session) -> Action {
    let joints = session.selection().joints().to_vec();
    let is_left = |parent: Option<JointId>| parent.is_some_and(|parent| joints.contains(&parent));
    let skeleton = session.skeleton();
    let leaves_children =
        skeleton.iter().any(|(child, joint)| is_left(joint.parent) && !joints.contains(&child));
    if leaves_children {
        ShellAction::OpenDialog(Dialog::DeleteJoints { joints }).into()
    } else {
        JointEdit::DeleteJoints(joints).into()
    }
}

/// The action that opens the dialog to rename `joint`.
pub(in crate::ui) fn rename(session: &Session, joint: JointId) -> ShellAction {
    let name = session.skeleton().joint(joint).map(|joint| joint.name.clone());
    ShellAction::OpenDialog(Dialog::Rename { joint, name: name.unwrap_or_default() })
}

/// The action that adds or removes the target of the selected joint; `None` if no joint is
/// selected.
pub(in crate::ui) fn toggle_target(session: &Session) -> Option<Edit> {
    let joint = session.selection().active()?;
    let rig = session.rig();
    Some(match rig.target_of_end(joint) {
        Some(target) => TargetEdit::RemoveTarget(rig.targets[target].joint).into(),
        None => TargetEdit::AddTarget(joint).into(),
    })
}

/// Shows the part before the shown one: in the shown iteration, or the last part of the one before.
/// `None` at the first part of the first iteration, or without a solver run.
pub(in crate::ui) fn previous_part(session: &Session) -> Option<SolverAction> {
    let run = session.solvers().run()?;
    let iteration = run.shown().iteration;
    match run.shown_part() {
        Some(0) => {
            let before = run.iterates().at(iteration.checked_sub(1)?).iteration;
            let part = Some(usize::MAX);
            (before > 0).then_some(SolverAction::ShowPart { iteration: before, part })
        }
        Some(part) => Some(SolverAction::ShowPart { iteration, part: Some(part - 1) }),
        None if iteration > 0 => Some(SolverAction::ShowPart { iteration, part: Some(usize::MAX) }),
        None => None,
    }
}

/// Shows the next part: of the shown iteration, or the first part of the next one, which is made if
/// need be. Empty at the end of a run that is over.
pub(in crate::ui) fn next_part(session: &Session) -> Vec<SolverAction> {
    let first_of = |iteration| SolverAction::ShowPart { iteration, part: Some(0) };
    let Some(run) = session.solvers().run() else { return vec![SolverAction::Step, first_of(1)] };
    let iteration = run.shown().iteration;
    let next = run.shown_part().map_or(0, |part| part + 1);
    if next < run.parts().len() {
        return vec![SolverAction::ShowPart { iteration, part: Some(next) }];
    }
    match run.iterates().after(iteration) {
        Some(after) => vec![first_of(after.iteration)],
        None if run.is_over() => Vec::new(),
        None => vec![SolverAction::Step, first_of(run.report().iterations + 1)],
    }
}
