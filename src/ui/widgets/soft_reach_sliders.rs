//! Sliders for soft limits: softness, stretch and minimum elbow angle.

use core::f32::consts::PI;

use egui::Ui;

use super::angle_slider::angle_slider;
use super::slider::Slider;
use crate::kinematics::soft_reach::SoftReach;
use crate::session::{Action, Actions, Session};

const MOST_SOFT: f32 = 0.99;
const MOST_STRETCHED: f32 = 3.0;

/// Shows the sliders. `prefix` is the start of their accessible names.
pub(in crate::ui) fn soft_reach_sliders<A: Into<Action>>(
    ui: &mut Ui,
    session: &Session,
    prefix: &str,
    soft_reach: SoftReach,
    actions: &mut Actions,
    set: impl Fn(SoftReach) -> A,
) {
    let [softness, stretch, angle] =
        [soft_reach.softness(), soft_reach.max_stretch(), soft_reach.min_elbow_angle()];
    let default = SoftReach::default();
    // Clamped to the nearest valid values.
    let set = |softness: f32, stretch: f32, angle: f32| {
        let widest = PI - 1e-3;
        let soft_reach = SoftReach::new(
            softness.clamp(0.0, MOST_SOFT),
            stretch.max(1.0),
            angle.clamp(0.0, widest),
        );
        set(soft_reach.unwrap_or(default))
    };
    let slider = Slider {
        name: &format!("{prefix}Softness"),
        label: "Softness",
        term: Some("Softness"),
        tooltip: "Slow the hand near its limits so that the elbow does not snap",
        value: softness,
        range: (0.0, MOST_SOFT),
        default: default.softness(),
        step: 0.1,
        ..Slider::default()
    };
    slider.show(ui, session, actions, |softness| set(softness, stretch, angle));
    let slider = Slider {
        name: &format!("{prefix}Stretch"),
        label: "Stretch",
        term: Some("Stretch"),
        tooltip: "Let the limbs stretch up to this factor",
        value: stretch,
        range: (1.0, MOST_STRETCHED),
        default: default.max_stretch(),
        step: 0.1,
        ..Slider::default()
    };
    slider.show(ui, session, actions, |stretch| set(softness, stretch, angle));
    let name = format!("{prefix}Minimum elbow angle");
    let slider = Slider {
        label: "Min. angle",
        range: (0.0, 179.0),
        ..angle_slider(&name, "Keep the elbow open by at least this angle", angle)
    };
    slider.show(ui, session, actions, |degrees| set(softness, stretch, degrees.to_radians()));
}
