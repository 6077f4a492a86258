//! Sliders that belong together: of a point, of angles in degrees, and of the soft limits.

use core::f32::consts::PI;

use egui::Ui;
use glam::Vec3;

use super::slider::Slider;
use crate::document::Channel;
use crate::kinematics::soft_reach::SoftReach;
use crate::session::{Action, Actions, Session};
use crate::ui::style;

pub(in crate::ui) const AXES: [&str; 3] = ["x", "y", "z"];

/// Three sliders for the coordinates of a point.
pub(in crate::ui) struct PointSliders<'a> {
    /// Start of the accessible names: with "Hand" the sliders are "Hand x", "Hand y" and "Hand z".
    pub name: &'a str,
    /// Visible labels of the sliders for x, y and z.
    pub labels: [&'a str; 3],
    pub value: Vec3,
    pub default: Vec3,
    /// Each coordinate ranges from −`range` to `range`.
    pub range: f32,
    pub step: f32,
    pub tooltip: &'a str,
    /// Reason shown while the sliders are disabled; `None` enables the sliders.
    pub disabled: Option<&'a str>,
    /// Channel that a diamond at the end of each row keys; `None` for no diamonds.
    pub channel: Option<Channel>,
}

impl PointSliders<'_> {
    pub fn show<A: Into<Action>>(
        &self,
        ui: &mut Ui,
        session: &Session,
        actions: &mut Actions,
        set: impl Fn(Vec3) -> A,
    ) {
        let colours = style::palette(ui).axes;
        for (axis, label) in self.labels.into_iter().enumerate() {
            let slider = Slider {
                name: &format!("{} {}", self.name, AXES[axis]),
                label,
                colour: Some(style::colour(colours[axis])),
                term: None,
                tooltip: self.tooltip,
                value: self.value[axis],
                range: (-self.range, self.range),
                default: self.default[axis],
                unit: "",
                step: self.step,
                disabled: self.disabled,
                channel: self.channel,
            };
            slider.show(ui, session, actions, |coordinate| {
                let mut moved = self.value;
                moved[axis] = coordinate;
                set(moved)
            });
        }
    }
}

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
