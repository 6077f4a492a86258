//! The joints, targets and path of the skeleton.

mod follow_path;
mod joint;
mod outliner;
mod skin;
mod targets;

pub(in crate::ui) use targets::note_height;

use egui::Ui;
use glam::Vec3;

use crate::document::{Channel, RigKind, Target};
use crate::session::{Actions, JointEdit, Session};
use crate::ui::widgets::{self, AXES, PointSliders};

/// The target of the selected joint, of which the panel has a note; `None` without one.
pub(in crate::ui) fn noted(session: &Session) -> Option<Target> {
    let selected = session.selection().active().filter(|_| session.rig() == RigKind::Skeleton)?;
    let rig = session.skeleton_rig();
    rig.target_of_end(selected).map(|index| rig.targets[index])
}

/// Shows whether a target is reached and, if not, why, with what helps. It stands at the foot of
/// the panel, always as high, so that no row moves under the mouse when a slider is let go.
pub(in crate::ui) fn note(ui: &mut Ui, session: &Session, target: Target, actions: &mut Actions) {
    targets::note(ui, session, &target, actions);
}

pub(in crate::ui) fn ui(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let rig = session.skeleton_rig();
    widgets::section(ui, "Joints", |ui| outliner::ui(ui, session, actions));
    if let Some(selected) = session.selection().active()
        && let Some(joint) = rig.skeleton.joint(selected)
    {
        let title = format!("Joint: {}", joint.name);
        widgets::named_section(ui, "joint", &title, |ui| joint::ui(ui, session, selected, actions));
        if let Some(target) = noted(session)
            && let Some((_, end)) = targets::end(rig, &target)
        {
            let title = format!("Target of {end}");
            widgets::named_section(ui, "target", &title, |ui| {
                targets::selected(ui, session, target, actions);
            });
        }
    }
    widgets::section(ui, "Targets", |ui| targets::list(ui, session, actions));
    widgets::section(ui, "Skin", |ui| skin::ui(ui, session, actions));
    widgets::section(ui, "Translation", |ui| place(ui, session, actions));
    widgets::section(ui, "Path", |ui| follow_path::ui(ui, session, actions));
}

fn place(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let rig = session.skeleton_rig();
    let place = PointSliders {
        name: "Skeleton",
        labels: AXES,
        value: rig.skeleton.transform().translation.into(),
        default: Vec3::ZERO,
        range: 0.3 * rig.reach(),
        step: session.shown().grid_cell() * 0.1,
        tooltip: "Move the skeleton in world space; targets stay",
        disabled: None,
        channel: Some(Channel::Translation),
    };
    place.show(ui, session, actions, JointEdit::SetTranslation);
}
