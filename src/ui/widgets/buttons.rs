//! Buttons: one that can be disabled, one that stands out, icons (painted, because the fonts lack
//! them), and the diamond that keys a value.

use egui::{
    Align, Align2, Button, Color32, Layout, Painter, Pos2, Rect, Response, RichText, Role, Sense,
    Shape, Stroke, TextStyle, Ui, Vec2, WidgetInfo, WidgetText, pos2, vec2,
};

use super::choices::explained;
use crate::document::Channel;
use crate::session::{Actions, KeysEdit, Session};
use crate::ui::style;

/// Shows a button and returns whether it was pressed. `disabled` is the reason why the button is
/// disabled, shown as its tooltip; `None` enables the button.
pub(in crate::ui) fn button(
    ui: &mut Ui,
    name: impl Into<WidgetText>,
    tooltip: &str,
    disabled: Option<&str>,
) -> bool {
    let button = ui.add_enabled(disabled.is_none(), Button::new(name.into()));
    explained(button, tooltip, disabled).clicked()
}

/// Shows a button like [`button`], as wide as the panel.
pub(in crate::ui) fn wide_button(
    ui: &mut Ui,
    name: &str,
    tooltip: &str,
    disabled: Option<&str>,
) -> bool {
    let layout = Layout::top_down_justified(Align::Center);
    ui.with_layout(layout, |ui| button(ui, name, tooltip, disabled)).inner
}

/// Shows the button that most users press, in the accent colour. `disabled` is the reason why it is
/// disabled, shown as its tooltip; `None` enables it.
pub(in crate::ui) fn primary_button(ui: &mut Ui, name: &str, disabled: Option<&str>) -> Response {
    let Some(why) = disabled else {
        let text = RichText::new(name).color(ui.visuals().panel_fill).strong();
        return ui.add(Button::new(text).fill(style::accent(ui)));
    };
    ui.add_enabled(false, Button::new(name)).on_disabled_hover_text(why)
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::ui) enum Icon {
    Play,
    Pause,
    Start,
    End,
    PreviousKey,
    NextKey,
    Loop,
    Record,
    Close,
}

/// An icon button; `disabled` is the reason shown while the button is disabled, `None` otherwise.
pub(in crate::ui) struct IconButton<'a> {
    pub icon: Icon,
    pub name: &'a str,
    pub tooltip: &'a str,
    /// State of a toggle; `None` for other buttons.
    pub on: Option<bool>,
    pub disabled: Option<&'a str>,
    /// Width in points with the name beside the icon; `None` for the icon alone.
    pub named: Option<f32>,
}

impl<'a> IconButton<'a> {
    /// Size in points.
    pub const SIZE: Vec2 = vec2(28.0, 24.0);

    /// A button that is not a toggle.
    pub fn new(icon: Icon, name: &'a str, tooltip: &'a str, disabled: Option<&'a str>) -> Self {
        Self { icon, name, tooltip, on: None, disabled, named: None }
    }

    /// Shows the button and returns whether it was pressed.
    pub fn show(self, ui: &mut Ui) -> bool {
        let enabled = self.disabled.is_none();
        let response = ui.add_enabled_ui(enabled, |ui| self.button(ui)).inner;
        match self.disabled {
            Some(why) => response.on_disabled_hover_text(why).clicked(),
            None => response.on_hover_text(self.tooltip).clicked(),
        }
    }

    fn button(&self, ui: &mut Ui) -> Response {
        let width = self.named.unwrap_or(Self::SIZE.x);
        let (rect, response) = ui.allocate_exact_size(vec2(width, Self::SIZE.y), Sense::click());
        let enabled = ui.is_enabled();
        response.widget_info(|| match self.on {
            Some(on) => WidgetInfo::selected(Role::Button, enabled, on, self.name),
            None => WidgetInfo::labeled(Role::Button, enabled, self.name),
        });
        let visuals = ui.style().interact(&response);
        let (accent, painter) = (style::accent(ui), ui.painter());
        let (stroke, icon) = match self.on {
            Some(true) => {
                (Stroke::new(if response.has_focus() { 2.0 } else { 1.0 }, accent), accent)
            }
            _ => (visuals.bg_stroke, visuals.fg_stroke.color),
        };
        let (fill, inside) = (visuals.weak_bg_fill, egui::StrokeKind::Inside);
        painter.rect(rect, visuals.corner_radius, fill, stroke, inside);
        let mut centre = rect.center();
        if self.named.is_some() {
            let font = TextStyle::Button.resolve(ui.style());
            let name = painter.layout_no_wrap(self.name.to_owned(), font, icon);
            let at = Align2::CENTER_CENTER.anchor_size(centre + vec2(8.0, 0.0), name.size());
            centre.x = at.left() - 10.0;
            painter.galley(at.min, name, icon);
        }
        self.icon.paint(painter, centre, icon, self.on == Some(true));
        response
    }
}

impl Icon {
    fn paint(self, painter: &Painter, centre: Pos2, colour: Color32, is_on: bool) {
        let at = |x: f32, y: f32| centre + vec2(x, y);
        let shape = |points: &[(f32, f32)]| {
            let points = points.iter().map(|(x, y)| at(*x, *y)).collect();
            painter.add(Shape::convex_polygon(points, colour, Stroke::NONE));
        };
        let bar = |from: f32, to: f32| {
            painter.rect_filled(Rect::from_min_max(at(from, -5.0), at(to, 5.0)), 0.5, colour);
        };
        let thin = Stroke::new(1.5, colour);
        let cross = |at: Pos2, half: f32| {
            painter.line_segment([at - Vec2::splat(half), at + Vec2::splat(half)], thin);
            painter.line_segment([at - vec2(half, -half), at + vec2(half, -half)], thin);
        };
        match self {
            Self::Play => shape(&[(-4.0, -6.0), (6.0, 0.0), (-4.0, 6.0)]),
            Self::Pause => {
                bar(-5.0, -1.5);
                bar(1.5, 5.0);
            }
            Self::Start | Self::End => {
                let side = if self == Self::Start { -1.0 } else { 1.0 };
                shape(&[(5.0 * side, 0.0), (-4.0 * side, -5.0), (-4.0 * side, 5.0)]);
                let (a, b) = (5.0 * side, 6.5 * side);
                bar(a.min(b), a.max(b));
            }
            Self::PreviousKey | Self::NextKey => {
                let side = if self == Self::PreviousKey { -1.0 } else { 1.0 };
                shape(&[(-1.5 * side, 0.0), (-8.0 * side, -5.0), (-8.0 * side, 5.0)]);
                painter.add(diamond(at(4.0 * side, 0.0), 4.5, colour, Stroke::NONE));
            }
            Self::Record if is_on => _ = painter.circle_filled(centre, 5.0, colour),
            Self::Record => _ = painter.circle_stroke(centre, 4.5, thin),
            Self::Close => cross(at(0.0, 0.0), 4.5),
            Self::Loop => {
                let place = |turn: f32| at(5.5 * turn.cos(), 5.5 * turn.sin());
                let ends = (0.35 * core::f32::consts::PI, 1.85 * core::f32::consts::PI);
                let points = (0..=20).map(|i| ends.0 + (ends.1 - ends.0) * i as f32 / 20.0);
                painter.line(points.map(place).collect(), Stroke::new(1.6, colour));
                shape(&[(7.6, -6.2), (6.6, 0.6), (1.6, -2.8)]);
            }
        }
    }
}

/// A triangle that points to the right if the row is folded, otherwise down.
pub(in crate::ui) fn fold_mark(painter: &Painter, at: Pos2, is_folded: bool, colour: Color32) {
    let corners = [vec2(-3.0, -2.0), vec2(3.0, -2.0), vec2(0.0, 3.0)];
    let turned = |it: Vec2| if is_folded { vec2(it.y, -it.x) } else { it };
    let corners = corners.map(|corner| at + turned(corner)).to_vec();
    painter.add(Shape::convex_polygon(corners, colour, Stroke::NONE));
}

/// The diamond that marks a key; `size` is the distance in points from its centre to a corner.
pub(in crate::ui) fn diamond(at: Pos2, size: f32, fill: Color32, stroke: Stroke) -> Shape {
    let corners = [(0.0, -size), (size, 0.0), (0.0, size), (-size, 0.0)];
    let points = corners.map(|(x, y)| pos2(at.x + x, at.y + y)).to_vec();
    Shape::convex_polygon(points, fill, stroke)
}

/// A diamond that adds a key of a channel at the playhead, or deletes the key that is there. It is
/// filled at a key, and has the accent colour there and while the channel has an unkeyed change.
pub(in crate::ui) struct KeyButton {
    pub channel: Channel,
    /// Channels that get keys together with `channel`.
    pub others: Vec<Channel>,
}

impl KeyButton {
    /// Width in points of the button.
    pub const WIDTH: f32 = 16.0;
    /// Distance in points from the centre of the diamond to a corner.
    const SIZE: f32 = 4.5;

    /// Shows the button, named after the value that it keys.
    pub fn show(self, ui: &mut Ui, session: &Session, name: &str, actions: &mut Actions) {
        let (channel, time) = (self.channel, session.playback().time());
        let track = session.document().keys.track(channel);
        let is_at_key = track.is_some_and(|track| track.get(time).is_some());
        let response = self.button(ui, session, name, is_at_key, track.is_some());
        if response.clicked() {
            actions.push(if is_at_key {
                KeysEdit::DeleteKeys(vec![(channel, time)])
            } else {
                KeysEdit::Key([vec![channel], self.others].concat())
            });
        }
        response.on_hover_text(if is_at_key {
            "Delete the key at the playhead"
        } else {
            "Add a key at the playhead"
        });
    }

    fn button(
        &self,
        ui: &mut Ui,
        session: &Session,
        name: &str,
        is_at_key: bool,
        is_keyed: bool,
    ) -> Response {
        let (rect, response) = ui.allocate_exact_size(vec2(Self::WIDTH, 18.0), Sense::click());
        let name = format!("Key {name}");
        response.widget_info(|| WidgetInfo::selected(Role::Button, true, is_at_key, &name));
        let is_changed = session.history().is_overridden(self.channel);
        let stands_out = response.hovered() || response.has_focus();
        let visuals = ui.visuals();
        let colour = match (is_at_key || is_changed, is_keyed || stands_out) {
            (true, _) => style::accent(ui),
            (false, true) => visuals.text_color(),
            (false, false) => visuals.weak_text_color(),
        };
        let fill = if is_at_key { colour } else { Color32::TRANSPARENT };
        let size = if stands_out { Self::SIZE + 1.0 } else { Self::SIZE };
        ui.painter().add(diamond(rect.center(), size, fill, Stroke::new(1.2, colour)));
        response
    }
}
