use egui::Ui;
use glam::Vec3;

use super::slider::Slider;
use crate::session::{Action, Actions, Session};
use crate::ui::style;

pub(in crate::ui) const AXES: [&str; 3] = ["x", "y", "z"];

/// A point that is shown and set by three sliders, each of which leaves the other two coordinates as
/// they are.
pub(in crate::ui) struct PointSliders<'a> {
    /// What it is called where there is nothing else to see: "Hand", of which the first is "Hand x".
    pub name: &'a str,
    /// What stands before the rails.
    pub labels: [&'a str; 3],
    pub value: Vec3,
    pub default: Vec3,
    /// Of every coordinate, to either side.
    pub range: f32,
    pub step: f32,
    pub tooltip: &'a str,
    /// Why it cannot be set now, if it cannot.
    pub disabled: Option<&'a str>,
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
                tooltip: self.tooltip,
                value: self.value[axis],
                range: (-self.range, self.range),
                default: self.default[axis],
                unit: "",
                step: self.step,
                disabled: self.disabled,
            };
            slider.show(ui, session, actions, |coordinate| {
                let mut moved = self.value;
                moved[axis] = coordinate;
                set(moved)
            });
        }
    }
}
