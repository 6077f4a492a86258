//! Sliders for a point.

use egui::Ui;
use glam::Vec3;

use super::slider::Slider;
use crate::document::Channel;
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
