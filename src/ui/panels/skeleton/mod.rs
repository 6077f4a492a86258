//! The joints, targets, skin and path of the skeleton. A path is a wavy ring, or the path of the
//! chain's head or of the head's target.

mod balance;
mod joint;
mod outliner;
mod skin;
mod targets;

use core::mem::discriminant;

use egui::Ui;
use glam::Vec3;

use crate::document::{Channel, PathKind, Target, WavyRing};
use crate::kinematics::skeleton::JointId;
use crate::session::{Actions, JointEdit, PathEdit, Session, SolverEdit};
use crate::ui::panels::limb::{self, LimbTarget};
use crate::ui::style;
use crate::ui::widgets::{self, AXES, Choice, PointSliders, Slider};

pub(super) use outliner::panel as outliner;
pub(in crate::ui) use skin::BIND;
pub(super) use skin::{areas as skin_areas, section as skin_section};
pub(in crate::ui) use targets::{ADD_TARGETS, may_be_person, target_name};
pub(super) use targets::{note, note_height, space};

/// The target of the selected joint or of its limb, of which the panel has a note; `None` without
/// one, and for a figure that is one limb.
pub(in crate::ui) fn noted(session: &Session) -> Option<Target> {
    let selected = session.selection().active()?;
    let rig = session.rig();
    if rig.sole_limb().is_some() {
        return None;
    }
    let index = rig.target_of_end(selected).or_else(|| rig.limb_target_of(selected))?;
    Some(rig.targets[index])
}

pub(in crate::ui) fn ui(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    widgets::section(ui, "Targets", |ui| {
        targets::list(ui, session, actions);
        body_follows(ui, session, actions);
        balance::ui(ui, session, actions);
    });
    skin::section(ui, session, actions);
    let has_path = !session.rig().follow_paths.is_empty();
    let id = if has_path { "Skeleton with a path" } else { "Skeleton" };
    let contents = |ui: &mut Ui| {
        widgets::folded_section(ui, "Translation", |ui| place(ui, session, actions));
        widgets::section(ui, "Path", |ui| path(ui, session, actions));
    };
    widgets::named_section_with(ui, id, "Skeleton", has_path, |_| (), contents);
}

/// Shows the switch that lets the body follow limb targets, for a figure with such a body.
fn body_follows(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let rig = session.rig();
    if !rig.has_body_to_follow() {
        return;
    }
    let tooltip = "Let the rest of the body follow a hand or foot that its target takes beyond the \
                   limb's reach";
    let changed = widgets::check_box(ui, "Whole body follows", tooltip, rig.body_follows, None);
    actions.extend(changed.map(SolverEdit::SetBodyFollows));
    if let Some(error) = &session.posed().evaluated_skeleton().body_refused {
        ui.colored_label(style::accent(ui), format!("Not solved: {error}"));
    }
}

/// Shows the settings of the selected joint and of its target.
pub(in crate::ui) fn selected(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let rig = session.rig();
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
            if let Some(limb) = LimbTarget::new(session, &target) {
                limb::of_figure(ui, limb, actions);
            }
        }
    }
}

fn place(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let rig = session.rig();
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

/// Shows the path that the chain of a root follows.
fn path(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let rig = session.rig();
    let Some(root) = shown_root(session) else { return };
    choice(ui, session, root, actions);
    match rig.path_kind(root) {
        Some(PathKind::Ring(ring)) => sliders(ui, session, root, ring, actions),
        Some(PathKind::Head) => head(ui, session, root, actions),
        Some(PathKind::Target) if rig.target(root).is_none() => {
            ui.weak("Add a target to the head: the body follows its path.");
        }
        Some(PathKind::Target) | None => {}
    }
}

/// The root above the selected joint; without a selection the first with a path, else the first
/// root.
fn shown_root(session: &Session) -> Option<JointId> {
    let rig = session.rig();
    let selected = session.selection().active().and_then(|joint| rig.root_of(joint));
    let with_path = rig.follow_paths.first().map(|path| path.root);
    selected.or(with_path).or_else(|| rig.skeleton.ids().next())
}

fn choice(ui: &mut Ui, session: &Session, root: JointId, actions: &mut Actions) {
    let rig = session.rig();
    let ring = PathKind::Ring(default_ring(rig.reach()));
    let choices = [
        (None, "None", "Pose all joints by their own angles"),
        (Some(PathKind::Head), "Head", "Drag and key the head; the body follows its path"),
        (Some(PathKind::Target), "Target", "Move the head's target; the body follows its path"),
        (Some(ring), "Wavy ring", "Move along a wavy ring without keys"),
    ];
    let name = &rig.skeleton[root].name;
    let tooltip = &format!("Let the chain of {name} follow a path, like a snake");
    let of_kind = |kind: &Option<PathKind>| kind.as_ref().map(discriminant);
    let now = of_kind(&rig.path_kind(root));
    let choice = Choice { label: "Follow", name: "Follow path", tooltip, shown: "" };
    let chosen = choice.pick(ui, &choices, |kind| of_kind(kind) == now);
    actions.extend(chosen.map(|kind| PathEdit::SetFollowPath { root, kind }));
}

/// Default ring of a skeleton with this reach.
fn default_ring(reach: f32) -> WavyRing {
    WavyRing { radius: 0.6 * reach, amplitude: 0.1 * reach, waves: 5, period: 20.0 }
}

fn head(ui: &mut Ui, session: &Session, head: JointId, actions: &mut Actions) {
    let rig = session.rig();
    let place = PointSliders {
        name: "Head",
        labels: AXES,
        value: rig.skeleton[head].offset,
        default: Vec3::ZERO,
        range: 2.0 * rig.reach(),
        step: session.shown().grid_cell() * 0.1,
        tooltip: "Move the head in skeleton space; the body follows",
        disabled: None,
        channel: Some(Channel::Offset(head)),
    };
    place.show(ui, session, actions, |to| PathEdit::SetHead { root: head, to });
    if !rig.head_tracks.contains_key(&head) {
        ui.weak("Drag the circle at the head, or key the head: the body follows.");
    }
}

fn sliders(ui: &mut Ui, session: &Session, root: JointId, ring: WavyRing, actions: &mut Actions) {
    let reach = session.rig().reach();
    let default = default_ring(reach);
    let step = session.shown().grid_cell() * 0.1;
    let set = |ring| PathEdit::SetFollowPath { root, kind: Some(PathKind::Ring(ring)) };
    let slider = |name, tooltip, value, range, default| Slider {
        name,
        label: name,
        tooltip,
        value,
        range,
        default,
        step,
        ..Slider::default()
    };
    let (tooltip, range) = ("Set the radius of the ring", (0.0, 2.0 * reach));
    slider("Radius", tooltip, ring.radius, range, default.radius).show(
        ui,
        session,
        actions,
        |radius| set(WavyRing { radius, ..ring }),
    );
    let (tooltip, range) = ("Set the height of the waves", (0.0, 0.5 * reach));
    slider("Amplitude", tooltip, ring.amplitude, range, default.amplitude).show(
        ui,
        session,
        actions,
        |amplitude| set(WavyRing { amplitude, ..ring }),
    );
    let (tooltip, range) = ("Set the number of waves around the ring", (0.0, 16.0));
    let waves = slider("Waves", tooltip, ring.waves as f32, range, default.waves as f32);
    Slider { step: 1.0, ..waves }.show(ui, session, actions, |waves| {
        set(WavyRing { waves: waves.round().clamp(0.0, 1000.0) as u32, ..ring })
    });
    let (tooltip, range) = ("Set the time for one revolution", (1.0, 60.0));
    let period = slider("Period", tooltip, ring.period, range, default.period);
    Slider { step: 1.0, unit: " s", ..period }
        .show(ui, session, actions, |period| set(WavyRing { period, ..ring }));
}
