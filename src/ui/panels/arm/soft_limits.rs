//! Soft limits: softness, stretch and minimum elbow angle.

use core::f32::consts::PI;

use egui::Ui;

use crate::kinematics::soft_reach::SoftReach;
use crate::session::{Actions, EditAction, Session};
use crate::ui::widgets::{Slider, angle_slider};

const MOST_SOFT: f32 = 0.99;
const MOST_STRETCHED: f32 = 3.0;

pub(in crate::ui) fn ui(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let soft_reach = session.arm().soft_reach;
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
        EditAction::SetSoftReach(soft_reach.unwrap_or(default))
    };
    let slider = Slider {
        name: "Softness",
        label: "Softness",
        tooltip: "Slow the hand near its limits so that the elbow does not snap",
        value: softness,
        range: (0.0, MOST_SOFT),
        default: default.softness(),
        step: 0.1,
        ..Slider::default()
    };
    slider.show(ui, session, actions, |softness| set(softness, stretch, angle));
    let slider = Slider {
        name: "Stretch",
        label: "Stretch",
        tooltip: "Let the limbs stretch up to this factor",
        value: stretch,
        range: (1.0, MOST_STRETCHED),
        default: default.max_stretch(),
        step: 0.1,
        ..Slider::default()
    };
    slider.show(ui, session, actions, |stretch| set(softness, stretch, angle));
    let tooltip = "Keep the elbow open by at least this angle";
    let slider = Slider {
        label: "Min. φ",
        range: (0.0, 179.0),
        ..angle_slider("Minimum elbow angle", tooltip, angle)
    };
    slider.show(ui, session, actions, |degrees| set(softness, stretch, degrees.to_radians()));
}
