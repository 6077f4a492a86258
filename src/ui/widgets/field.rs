//! A number field of the side panels.

use egui::{Response, Ui};

use super::format;
use super::number::{DragNumber, hover_text};
use crate::session::{Action, Actions, Session};

/// Width in points with which three fields and a name fit side by side in the narrowest panel.
const FIELD_WIDTH: f32 = 52.0;

/// A number to drag or type, without a slider.
pub(in crate::ui) struct NumberField<'a> {
    /// Accessible name, such as "Bone x".
    pub name: &'a str,
    pub value: f32,
    pub unit: &'a str,
    /// Change of the value per point that the mouse is dragged.
    pub step: f32,
    /// Number of decimals.
    pub digits: usize,
    pub tooltip: &'a str,
}

impl NumberField<'_> {
    pub fn show<A: Into<Action>>(
        self,
        ui: &mut Ui,
        session: &Session,
        actions: &mut Actions,
        set: impl Fn(f32) -> A,
    ) -> Response {
        let digits = self.digits;
        let format = |value| format::fixed(value, digits);
        self.show_as(ui, session, actions, &format, set)
    }

    /// Shows the field as [`Self::show`] does, but with the text that `format` returns.
    pub fn show_as<A: Into<Action>>(
        self,
        ui: &mut Ui,
        session: &Session,
        actions: &mut Actions,
        format: &dyn Fn(f64) -> String,
        set: impl Fn(f32) -> A,
    ) -> Response {
        let Self { name, value, unit, .. } = self;
        let number = DragNumber { name, value, unit, speed: self.step, width: FIELD_WIDTH, format };
        let response = number.show(ui, session.is_editing(), actions, set);
        hover_text(response, self.tooltip)
    }
}
