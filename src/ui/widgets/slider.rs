//! A slider with a label and a number; sliders that belong together: of a point, of angles in
//! degrees, and of the soft limits.

use core::f32::consts::PI;
use core::ops::RangeInclusive;

use egui::{
    Align2, Color32, CornerRadius, CursorIcon, Id, Key, Rect, Response, Sense, TextStyle, Ui, Vec2,
    WidgetInfo, accesskit, pos2, vec2,
};
use glam::Vec3;

use super::buttons::KeyButton;
use super::number::{DragNumber, hover_text};
use super::text;
use crate::document::Channel;
use crate::kinematics::soft_reach::SoftReach;
use crate::session::{Action, Actions, Session, TransactionAction};
use crate::ui::keyboard::focus;
use crate::ui::{glossary, style};

/// A slider: a label, a rail with a thumb, and the value, which can be typed.
///
/// Showing a value never changes it: a value outside the range only puts the thumb at an end of the
/// rail.
#[derive(Default)]
pub(in crate::ui) struct Slider<'a> {
    /// Accessible name, such as "Hand x".
    pub name: &'a str,
    /// Visible label; `_` starts a subscript, as in `d_1`.
    pub label: &'a str,
    pub colour: Option<Color32>,
    pub tooltip: &'a str,
    /// Term of the glossary that the label names; `None` for other labels.
    pub term: Option<&'a str>,
    pub value: f32,
    pub range: (f32, f32),
    pub default: f32,
    pub unit: &'a str,
    /// Change per press of an arrow key. With Shift the change is a tenth of the step, and with a
    /// page key ten times the step. The value is shown to a tenth of the step.
    pub step: f32,
    /// Reason shown while the slider is disabled; `None` enables the slider.
    pub disabled: Option<&'a str>,
    /// Channel that a diamond at the end of the row keys; `None` for no diamond.
    pub channel: Option<Channel>,
}

/// Width of a label, and that of a short one, such as a letter: the rail takes the rest.
const LABEL_WIDTH: f32 = 60.0;
const SHORT_WIDTH: f32 = 34.0;
const VALUE_WIDTH: f32 = 66.0;
const HEIGHT: f32 = 22.0;
const THUMB: f32 = 6.5;
const RAIL: f32 = 4.0;

/// Factor of the step for an arrow key with Shift.
const FINE: f32 = 0.1;
/// Factor of the step for a page key.
const PAGE: f32 = 10.0;

impl Slider<'_> {
    /// Shows the slider, and pushes the action that `set` returns when the user changes the value.
    /// A drag is one transaction, and ends when that transaction is cancelled.
    pub fn show<A: Into<Action>>(
        self,
        ui: &mut Ui,
        session: &Session,
        actions: &mut Actions,
        set: impl Fn(f32) -> A,
    ) {
        let label = |ui: &mut Ui, actions: &mut Actions| {
            let label = self.label(ui, actions);
            if label.double_clicked() {
                actions.push(set(self.default));
            }
            self.edit_by_label(ui, &label, session, actions, &set);
        };
        self.show_after(ui, session, actions, &set, label);
    }

    /// Shows the slider as [`Self::show`] does, but with the widgets of `head` in place of the
    /// label.
    pub fn show_after<A: Into<Action>>(
        &self,
        ui: &mut Ui,
        session: &Session,
        actions: &mut Actions,
        set: impl Fn(f32) -> A,
        head: impl FnOnce(&mut Ui, &mut Actions),
    ) {
        let row = ui.add_enabled_ui(self.disabled.is_none(), |ui| {
            ui.horizontal(|ui| {
                ui.spacing_mut().item_spacing.x = 8.0;
                head(ui, actions);
                let rail = self.rail(ui);
                self.edit_by_rail(ui, &rail, session, actions, &set);
                self.number(ui, session, actions, &set);
                if rail.double_clicked() {
                    actions.push(set(self.default));
                }
                if let Some(channel) = self.channel {
                    let button = KeyButton { channel, others: Vec::new() };
                    button.show(ui, session, self.name, actions);
                }
            });
        });
        if let Some(why) = self.disabled {
            row.response.on_disabled_hover_text(why);
        }
    }

    fn label(&self, ui: &mut Ui, actions: &mut Actions) -> Response {
        let sense = Sense::CLICK | Sense::DRAG;
        let colour = self.colour.unwrap_or(ui.visuals().text_color());
        let size = TextStyle::Body.resolve(ui.style()).size;
        let text = ui.fonts_mut(|fonts| fonts.layout_job(text::layout(self.label, size, colour)));
        let width = if text.size().x <= SHORT_WIDTH { SHORT_WIDTH } else { LABEL_WIDTH };
        let (rect, response) = ui.allocate_exact_size(vec2(width, HEIGHT), sense);
        let response = response.on_hover_cursor(CursorIcon::ResizeHorizontal);
        let at = Align2::LEFT_CENTER.anchor_size(rect.left_center(), text.size()).min;
        let text_width = text.size().x;
        ui.painter().galley(at, text, colour);
        response
            .widget_info(|| WidgetInfo::labeled(egui::Role::Label, true, text::spoken(self.label)));
        match self.term {
            Some(term) => glossary::term(ui, response.clone(), text_width, term, actions),
            None => drop(hover_text(response.clone(), self.tooltip)),
        }
        response
    }

    /// Changes the value while the mouse drags the label: by a thousandth of the range per point,
    /// with Shift by a tenth of that.
    fn edit_by_label<A: Into<Action>>(
        &self,
        ui: &Ui,
        label: &Response,
        session: &Session,
        actions: &mut Actions,
        set: &impl Fn(f32) -> A,
    ) {
        /// The value without rounding: steps that round to nothing add up.
        #[derive(Clone, Copy)]
        struct Unrounded(f32);

        if label.drag_started() {
            ui.data_mut(|data| data.insert_temp(label.id, Unrounded(self.value)));
            actions.push(TransactionAction::Begin);
        }
        let is_held = label.drag_started() || label.dragged() && is_sliding(session);
        if is_held && !ui.input(|input| input.key_pressed(Key::Escape)) {
            let fine = if ui.input(|input| input.modifiers.shift) { FINE } else { 1.0 };
            let change = label.drag_delta().x * fine * self.speed();
            let Unrounded(value) = ui.data_mut(|data| {
                let kept = data.get_temp_mut_or_insert_with(label.id, || Unrounded(self.value));
                kept.0 += change;
                *kept
            });
            if change != 0.0 {
                actions.push(set(rounded(value, fine * self.speed())));
            }
        }
        if label.drag_stopped() {
            actions.push(TransactionAction::Commit);
        }
    }

    /// Change of the value per point that the mouse drags the label or the number.
    fn speed(&self) -> f32 {
        (self.range.1 - self.range.0) / 1000.0
    }

    fn rail(&self, ui: &mut Ui) -> Response {
        let spacing = ui.spacing().item_spacing.x;
        let diamond = self.channel.map_or(0.0, |_| KeyButton::WIDTH + spacing);
        let width = ui.available_width() - VALUE_WIDTH - spacing - diamond;
        let size = vec2(width.max(40.0), HEIGHT);
        let (rect, mut response) = ui.allocate_exact_size(size, Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::slider(true, f64::from(self.value), self.name));
        set_range(ui, response.id, self.range.0.into()..=self.range.1.into(), self.step.into());
        self.paint(ui, rect, &response);
        response = response.on_hover_cursor(CursorIcon::ResizeHorizontal);
        hover_text(response, self.tooltip)
    }

    fn paint(&self, ui: &Ui, rect: Rect, response: &Response) {
        let visuals = ui.style().interact(response);
        let accent = self.colour.unwrap_or(style::accent(ui));
        let track = Self::track(rect);
        let bar = |from: f32, to: f32| {
            Rect::from_center_size(
                pos2((from + to) / 2.0, rect.center().y),
                vec2((to - from).abs(), RAIL),
            )
        };
        let round = CornerRadius::same(2);
        let painter = ui.painter();
        painter.rect_filled(
            bar(track.left() - 2.0, track.right() + 2.0),
            round,
            ui.visuals().widgets.inactive.bg_fill,
        );
        let zero = self.place(track, 0.0_f32.clamp(self.range.0, self.range.1));
        let thumb = self.place(track, self.value);
        painter.rect_filled(bar(zero, thumb), round, accent.gamma_multiply(0.7));
        let centre = pos2(thumb, rect.center().y);
        painter.circle_filled(centre, THUMB, accent);
        if response.has_focus() || response.hovered() || response.dragged() {
            painter.circle_stroke(centre, THUMB + 2.0, (1.5, visuals.fg_stroke.color));
        }
    }

    fn track(rect: Rect) -> Rect {
        rect.shrink2(Vec2::new(THUMB + 2.0, 0.0))
    }

    fn place(&self, track: Rect, value: f32) -> f32 {
        let part = (value - self.range.0) / (self.range.1 - self.range.0);
        track.left() + part.clamp(0.0, 1.0) * track.width()
    }

    fn edit_by_rail<A: Into<Action>>(
        &self,
        ui: &Ui,
        rail: &Response,
        session: &Session,
        actions: &mut Actions,
        set: &impl Fn(f32) -> A,
    ) {
        let track = Self::track(rail.rect);
        let pointed = rail.interact_pointer_pos().map(|at| {
            let part = ((at.x - track.left()) / track.width()).clamp(0.0, 1.0);
            let value = self.range.0 + part * (self.range.1 - self.range.0);
            rounded(value, (self.range.1 - self.range.0) / track.width())
        });
        // The value follows the mouse from the press on, before egui reports a drag. A click by the
        // keyboard has no position.
        let pressed = rail.contains_pointer() && ui.input(|input| input.pointer.primary_pressed());
        if pressed {
            rail.request_focus();
            actions.push(TransactionAction::Begin);
        }
        let released = (rail.clicked() && !rail.double_clicked()) || rail.drag_stopped();
        let cancelled = ui.input(|input| input.key_pressed(Key::Escape));
        let held =
            (rail.is_pointer_button_down_on() || released) && is_sliding(session) && !cancelled;
        if let (true, Some(value)) = (pressed || held, pointed) {
            actions.push(set(value));
        }
        if rail.clicked() || rail.drag_stopped() {
            actions.push(TransactionAction::Commit);
        }
        let change = self.keyed(ui, rail) + requested_steps(ui, rail.id) as f32 * self.step;
        if change != 0.0 {
            actions.push(set(self.value + change));
        }
        if let Some(end) = self.keyed_end(ui, rail) {
            actions.push(set(end));
        }
        actions.extend(requested_values(ui, rail.id).into_iter().map(|value| set(value as f32)));
    }

    /// Change of the value by the arrow and page keys that were pressed in this frame.
    fn keyed(&self, ui: &Ui, rail: &Response) -> f32 {
        if !rail.has_focus() {
            return 0.0;
        }
        focus::leave_letters(ui, rail.id);
        focus::take_arrows(ui, rail.id);
        ui.input(|input| {
            let pressed = |key: Key| input.num_presses(key) as f32;
            let step = self.step * if input.modifiers.shift { FINE } else { 1.0 };
            let arrows = pressed(Key::ArrowRight) + pressed(Key::ArrowUp)
                - pressed(Key::ArrowLeft)
                - pressed(Key::ArrowDown);
            arrows * step + (pressed(Key::PageUp) - pressed(Key::PageDown)) * PAGE * self.step
        })
    }

    fn keyed_end(&self, ui: &Ui, rail: &Response) -> Option<f32> {
        let pressed = |key| rail.has_focus() && ui.input(|input| input.key_pressed(key));
        if pressed(Key::Home) {
            Some(self.range.0)
        } else if pressed(Key::End) {
            Some(self.range.1)
        } else {
            None
        }
    }

    fn number<A: Into<Action>>(
        &self,
        ui: &mut Ui,
        session: &Session,
        actions: &mut Actions,
        set: &impl Fn(f32) -> A,
    ) {
        let number = DragNumber {
            name: &format!("{} value", self.name),
            value: self.value,
            unit: self.unit,
            speed: self.speed(),
            width: VALUE_WIDTH,
            format: &|value| text::fixed(value, text::decimals(self.step)),
        };
        let response = number.show(ui, is_sliding(session), actions, set);
        hover_text(response, "Drag, or click to type");
    }
}

/// Tells screen readers the range and the step of a slider, and that they can set and step it.
pub(in crate::ui) fn set_range(ui: &Ui, slider: Id, range: RangeInclusive<f64>, step: f64) {
    ui.ctx().accesskit_node_builder(slider, |node| {
        node.set_min_numeric_value(*range.start());
        node.set_max_numeric_value(*range.end());
        node.set_numeric_value_step(step);
        node.add_action(accesskit::Action::SetValue);
        node.add_action(accesskit::Action::Increment);
        node.add_action(accesskit::Action::Decrement);
    });
}

/// Number of steps up, negative for down, that a screen reader requested of a slider in this frame.
pub(in crate::ui) fn requested_steps(ui: &Ui, slider: Id) -> f64 {
    ui.input(|input| {
        let requests = |action| input.num_accesskit_action_requests(slider, action) as f64;
        requests(accesskit::Action::Increment) - requests(accesskit::Action::Decrement)
    })
}

/// Values that a screen reader requested of a slider in this frame.
pub(in crate::ui) fn requested_values(ui: &Ui, slider: Id) -> Vec<f64> {
    ui.input(|input| {
        let requests = input.accesskit_action_requests(slider, accesskit::Action::SetValue);
        let value = |request: &accesskit::ActionRequest| match request.data {
            Some(accesskit::ActionData::NumericValue(value)) => Some(value),
            _ => None,
        };
        requests.filter_map(value).collect()
    })
}

/// A value rounded to the largest power of ten that is at most its change per point.
fn rounded(value: f32, change: f32) -> f32 {
    let grain = 10.0_f32.powf(change.log10().floor());
    (value / grain).round() * grain
}

/// True if a transaction is open that is not a drag in the viewport, such as the drag of a slider.
fn is_sliding(session: &Session) -> bool {
    session.history().is_editing() && session.history().drag().is_none()
}

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
            let set = |coordinate| set(with_axis(self.value, axis, coordinate));
            slider.show(ui, session, actions, set);
        }
    }
}

/// The vector with another component x, y or z.
pub(in crate::ui) fn with_axis(mut vector: Vec3, axis: usize, component: f32) -> Vec3 {
    vector[axis] = component;
    vector
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

/// Shows three sliders, with a name, a tooltip and the channel of their diamonds, for Euler angles
/// about x, y and z. `angles` and the argument of `set` are in radians.
pub(in crate::ui) fn euler_sliders<A: Into<Action>>(
    ui: &mut Ui,
    session: &Session,
    (name, tooltip, channel): (&str, &str, Option<Channel>),
    angles: Vec3,
    actions: &mut Actions,
    set: impl Fn(Vec3) -> A,
) {
    let colours = style::palette(ui).axes;
    for (axis, label) in AXES.into_iter().enumerate() {
        let name = format!("{name} {label}");
        let slider = Slider {
            label,
            colour: Some(style::colour(colours[axis])),
            channel,
            ..angle_slider(&name, tooltip, angles[axis])
        };
        let set = |degrees: f32| set(with_axis(angles, axis, degrees.to_radians()));
        slider.show(ui, session, actions, set);
    }
}

const MOST_SOFT: f32 = 0.99;
const MOST_STRETCHED: f32 = 3.0;

/// Shows the sliders.
pub(in crate::ui) fn soft_reach_sliders<A: Into<Action>>(
    ui: &mut Ui,
    session: &Session,
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
    let softness_slider = Slider {
        name: "Softness",
        label: "Softness",
        term: Some("Softness"),
        tooltip: "Slow the hand near its limits so that the elbow does not snap",
        value: softness,
        range: (0.0, MOST_SOFT),
        default: default.softness(),
        step: 0.1,
        ..Slider::default()
    };
    softness_slider.show(ui, session, actions, |softness| set(softness, stretch, angle));
    let stretch_slider = Slider {
        name: "Stretch",
        label: "Stretch",
        term: Some("Stretch"),
        tooltip: "Let the limbs stretch up to this factor",
        value: stretch,
        range: (1.0, MOST_STRETCHED),
        default: default.max_stretch(),
        step: 0.1,
        ..Slider::default()
    };
    stretch_slider.show(ui, session, actions, |stretch| set(softness, stretch, angle));
    let angle_slider = Slider {
        label: "Min. angle",
        range: (0.0, 179.0),
        ..angle_slider("Minimum elbow angle", "Keep the elbow open by at least this angle", angle)
    };
    angle_slider.show(ui, session, actions, |degrees| set(softness, stretch, degrees.to_radians()));
}
