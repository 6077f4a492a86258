//! Sliders for angles in degrees.

use egui::Ui;
use glam::Vec3;

use super::point::AXES;
use super::slider::Slider;
use crate::session::{Action, Actions, Session};
use crate::ui::style;

/// A slider from −180° to 180° for an angle that is given in radians. The slider shows and sets
/// degrees.
pub(in crate::ui) fn angle_slider<'a>(name: &'a str, tooltip: &'a str, radians: f32) -> Slider<'a> {
    Slider {
        name,
        label: name,
        tooltip,
        value: radians.to_degrees(),
        range: (-180.0, 180.0),
        default: 0.0,
        unit: "°",
        step: 1.0,
        ..Slider::default()
    }
}

/// Shows three sliders for Euler angles about x, y and z. `angles` and the argument of `set` are in
/// radians.
pub(in crate::ui) fn euler_sliders<A: Into<Action>>(
    ui: &mut Ui,
    session: &Session,
    name: &str,
    tooltip: &str,
    angles: Vec3,
    actions: &mut Actions,
    set: impl Fn(Vec3) -> A,
) {
    let colours = style::palette(ui).axes;
    for (axis, label) in AXES.into_iter().enumerate() {
        let name = format!("{name} {label}");
        let slider = angle_slider(&name, tooltip, angles[axis]);
        let slider = Slider { label, colour: Some(style::colour(colours[axis])), ..slider };
        slider.show(ui, session, actions, |degrees| {
            let mut turned = angles;
            turned[axis] = degrees.to_radians();
            set(turned)
        });
    }
}
