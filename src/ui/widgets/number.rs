//! Numbers to drag or type, also as an expression.

use std::cell::Cell;

use egui::emath::Numeric;
use egui::{Align, DragValue, Key, Layout, Response, TextWrapMode, Ui, vec2};

use super::choices::name;
use super::section::pair;
use super::text;
use crate::document::Timeline;
use crate::session::{Action, Actions, Session, ShellAction, TransactionAction};
use crate::ui::keyboard::focus;

const HEIGHT: f32 = 22.0;
const NOT_UNDERSTOOD: &str =
    "the value must be a number or an expression such as 2*50 or (100+23)/2; it is unchanged";

/// A number to drag or type.
pub(in crate::ui) struct DragNumber<'a, N = f32> {
    /// Accessible name.
    pub name: &'a str,
    pub value: N,
    pub unit: &'a str,
    /// Change of the value per point that the mouse is dragged.
    pub speed: f32,
    pub width: f32,
    pub format: &'a dyn Fn(f64) -> String,
}

impl<N: Numeric> DragNumber<'_, N> {
    /// Shows the number at constant width, and pushes the action that `set` returns when the user
    /// changes the number. A drag is one transaction, and ends when that transaction is cancelled.
    /// `is_editing` says whether a transaction is open.
    pub fn show<A: Into<Action>>(
        &self,
        ui: &mut Ui,
        is_editing: bool,
        actions: &mut Actions,
        set: impl Fn(N) -> A,
    ) -> Response {
        let mut value = self.value;
        let refused = Cell::new(false);
        let number = DragValue::new(&mut value)
            .speed(self.speed)
            .suffix(self.unit)
            .custom_formatter(|value, _| (self.format)(value))
            .custom_parser(|text| {
                let parsed = self.parse(text);
                refused.set(parsed.is_none());
                parsed
            })
            .clip_text(true)
            .update_while_editing(false);
        let size = vec2(self.width, HEIGHT);
        let right = Layout::right_to_left(Align::Center).with_main_justify(true);
        let row = ui.allocate_ui_with_layout(size, right, |ui| {
            ui.style_mut().wrap_mode = Some(TextWrapMode::Truncate);
            ui.spacing_mut().button_padding = vec2(5.0, 1.0);
            ui.add(number)
        });
        let response = row.inner;
        name(ui, &response, self.name);
        focus::list_number(ui, &response);
        if response.drag_started() {
            actions.push(TransactionAction::Begin);
        }
        // egui reports the typed value one pass after Esc; the mark makes that pass discard it.
        let was_left = ui.data_mut(|data| data.remove_temp::<LeftByEscape>(response.id)).is_some();
        if response.lost_focus() && ui.input(|input| input.key_pressed(Key::Escape)) {
            ui.data_mut(|data| data.insert_temp(response.id, LeftByEscape));
            ui.request_repaint();
        }
        let is_escape = was_left || ui.input(|input| input.key_pressed(Key::Escape));
        if refused.get() && response.lost_focus() && !is_escape {
            actions.push(ShellAction::Fail(NOT_UNDERSTOOD.to_owned()));
        }
        let dropped = response.dragged() && !response.drag_started() && !is_editing;
        if response.changed() && was_left {
            ui.request_repaint();
        } else if response.changed() && !dropped {
            actions.push(set(value));
        }
        if response.drag_stopped() {
            actions.push(TransactionAction::Commit);
        }
        response
    }

    /// Evaluates text with or without the unit, such as `2*50`; `None` if the result is not a
    /// finite number. Unchanged text returns the value itself, with the digits that are not shown.
    fn parse(&self, text: &str) -> Option<f64> {
        let number = text.trim().trim_end_matches(self.unit.trim()).trim_end();
        let text = number.replace('\u{2212}', "-");
        let value = self.value.to_f64();
        if text == (self.format)(value) {
            return Some(value);
        }
        let parsed = text.parse().ok().or_else(|| exmex::eval_str::<f64>(&text).ok());
        parsed.filter(|value| (*value as f32).is_finite())
    }
}

/// Shows a tooltip while the mouse is over a widget. After a press of the widget it stays away
/// until the mouse leaves: it would cover the rows below, where the effect of the press shows.
pub(in crate::ui) fn hover_text(response: Response, tooltip: &str) -> Response {
    let id = response.id.with("pressed");
    let ctx = response.ctx.clone();
    if response.is_pointer_button_down_on() {
        ctx.data_mut(|data| data.insert_temp(id, WasPressed));
    } else if !response.contains_pointer() {
        ctx.data_mut(|data| data.remove::<WasPressed>(id));
    }
    match ctx.data(|data| data.get_temp::<WasPressed>(id)) {
        Some(WasPressed) => response,
        None => response.on_hover_text(tooltip),
    }
}

/// Marks a widget that was pressed and that the mouse has not left since.
#[derive(Clone, Copy, Default)]
struct WasPressed;

/// Marks a number in which Esc ended the typing in the previous pass.
#[derive(Clone, Copy, Default)]
struct LeftByEscape;

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
        let format = |value| text::fixed(value, digits);
        self.show_as(ui, session, actions, &format, set)
    }

    /// Shows the field in a row with a label on its left.
    pub fn row<A: Into<Action>>(
        self,
        ui: &mut Ui,
        session: &Session,
        label: &str,
        actions: &mut Actions,
        set: impl Fn(f32) -> A,
    ) {
        pair(ui, label, |ui| self.show(ui, session, actions, set));
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
        let response = number.show(ui, session.history().is_editing(), actions, set);
        hover_text(response, self.tooltip)
    }
}

/// A field for a number of frames per second, which need not be whole.
pub(in crate::ui) fn frame_rate(rate: &mut f64) -> DragValue<'_> {
    let range = Timeline::MIN_FRAME_RATE..=Timeline::MAX_FRAME_RATE;
    DragValue::new(rate).speed(0.25).max_decimals(3).range(range)
}
