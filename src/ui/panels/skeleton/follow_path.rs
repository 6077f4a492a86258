//! Path following: the joints follow their head along a wavy ring.

use egui::Ui;

use crate::document::FollowPath;
use crate::session::{Actions, EditAction, Session};
use crate::ui::widgets::Slider;

pub(in crate::ui) fn ui(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    follows_path(ui, session, actions);
    if let Some(follow_path) = session.skeleton_rig().follow_path {
        sliders(ui, session, follow_path, actions);
    }
}

fn follows_path(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let mut follows_path = session.skeleton_rig().follow_path.is_some();
    let tooltip = "Move the first chain along a wavy ring, like a snake";
    if ui.checkbox(&mut follows_path, "Follow path").on_hover_text(tooltip).changed() {
        let follow_path = first(session.skeleton_rig().reach());
        actions.push(EditAction::SetFollowPath(follows_path.then_some(follow_path)));
    }
}

/// Default path of a skeleton with this reach.
fn first(reach: f32) -> FollowPath {
    FollowPath { radius: 0.6 * reach, amplitude: 0.1 * reach, waves: 5, period: 20.0 }
}

fn sliders(ui: &mut Ui, session: &Session, follow_path: FollowPath, actions: &mut Actions) {
    let reach = session.skeleton_rig().reach();
    let first = first(reach);
    let step = session.shown().grid_cell() * 0.1;
    let set = |follow_path| EditAction::SetFollowPath(Some(follow_path));
    let slider = |name, label, tooltip, value, range, default, unit, step| Slider {
        name,
        label,
        tooltip,
        value,
        range,
        default,
        unit,
        step,
        ..Slider::default()
    };
    let tooltip = "Set the radius of the ring";
    slider(
        "Radius",
        "Radius",
        tooltip,
        follow_path.radius,
        (0.0, 2.0 * reach),
        first.radius,
        "",
        step,
    )
    .show(ui, session, actions, |radius| set(FollowPath { radius, ..follow_path }));
    let tooltip = "Set the height of the waves";
    let range = (0.0, 0.5 * reach);
    slider(
        "Amplitude",
        "Amplitude",
        tooltip,
        follow_path.amplitude,
        range,
        first.amplitude,
        "",
        step,
    )
    .show(ui, session, actions, |amplitude| set(FollowPath { amplitude, ..follow_path }));
    let tooltip = "Set the number of waves around the ring";
    let waves = follow_path.waves as f32;
    slider("Waves", "Waves", tooltip, waves, (0.0, 16.0), first.waves as f32, "", 1.0).show(
        ui,
        session,
        actions,
        |waves| set(FollowPath { waves: waves.round().clamp(0.0, 1000.0) as u32, ..follow_path }),
    );
    let tooltip = "Set the time for one round";
    slider("Period", "Period", tooltip, follow_path.period, (1.0, 60.0), first.period, " s", 1.0)
        .show(ui, session, actions, |period| set(FollowPath { period, ..follow_path }));
}
