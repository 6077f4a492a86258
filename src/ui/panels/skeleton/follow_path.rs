//! The path that the first chain follows: a wavy ring, or the path of its head.

use egui::Ui;
use glam::Vec3;

use super::choice::Choice;
use crate::document::{Channel, FollowPath, WavyRing};
use crate::session::{Actions, EditAction, Session};
use crate::ui::widgets::{AXES, PointSliders, Slider};

pub(in crate::ui) fn ui(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    choice(ui, session, actions);
    match session.skeleton_rig().follow_path {
        Some(FollowPath::Ring(ring)) => sliders(ui, session, ring, actions),
        Some(FollowPath::Head) => head(ui, session, actions),
        None => {}
    }
}

fn choice(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let now = session.skeleton_rig().follow_path;
    let (is_ring, is_head) =
        (matches!(now, Some(FollowPath::Ring(_))), now == Some(FollowPath::Head));
    let ring = FollowPath::Ring(default_ring(session.skeleton_rig().reach()));
    let choices = [
        (now.is_none(), "None", "Pose all joints by their own angles", None),
        (
            is_head,
            "Head",
            "Drag and key the head; the body follows its path",
            Some(FollowPath::Head),
        ),
        (is_ring, "Wavy ring", "Move along a wavy ring without keys", Some(ring)),
    ];
    let shown = choices.iter().find(|(is_now, ..)| *is_now).map_or("", |(_, name, ..)| name);
    let tooltip = "Let the first chain of joints follow a path, like a snake";
    Choice { label: "Follow", name: "Follow path", tooltip, shown }.show(ui, |list| {
        for (is_now, name, tooltip, path) in choices {
            if list.item(is_now, name, tooltip, None) {
                actions.push(EditAction::SetFollowPath(path));
            }
        }
    });
}

/// Default ring of a skeleton with this reach.
fn default_ring(reach: f32) -> WavyRing {
    WavyRing { radius: 0.6 * reach, amplitude: 0.1 * reach, waves: 5, period: 20.0 }
}

fn head(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let rig = session.skeleton_rig();
    let Some(head) = rig.head() else { return };
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
    place.show(ui, session, actions, EditAction::SetHead);
    if rig.head_track.is_none() {
        ui.weak("Drag the circle at the head, or key the head: the body follows.");
    }
}

fn sliders(ui: &mut Ui, session: &Session, ring: WavyRing, actions: &mut Actions) {
    let reach = session.skeleton_rig().reach();
    let default = default_ring(reach);
    let step = session.shown().grid_cell() * 0.1;
    let set = |ring| EditAction::SetFollowPath(Some(FollowPath::Ring(ring)));
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
