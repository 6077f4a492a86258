//! A number beside its name, without a rail.

use egui::{Response, Ui};

use super::format;
use super::number::DragNumber;
use crate::session::{Action, Actions, Session};

/// Three of them stand beside a name in the narrowest panel.
const FIELD_WIDTH: f32 = 52.0;

/// A number that is dragged or typed, without a rail.
pub(in crate::ui) struct NumberField<'a> {
    /// What it is called where there is nothing else to see: "Bone x".
    pub name: &'a str,
    pub value: f32,
    pub unit: &'a str,
    /// What a point of the pointer's way adds.
    pub step: f32,
    /// Behind the point.
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

    /// Shows it in letters of its own.
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
        response.on_hover_text(self.tooltip)
    }
}
