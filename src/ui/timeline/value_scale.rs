//! The lanes of the graph editor: one for angles, one for lengths and one for ratios, each with a
//! scale and an axis of its own; a channel's curve.

use egui::{
    Align2, Color32, Event, Id, Pos2, Rect, Role, Sense, Stroke, TextStyle, Ui, WidgetInfo, pos2,
};
use egui_plot::LineStyle;

use super::rows::VALUES;
use super::time_scale::{WHEEL, wheel_steps};
use crate::document::{Channel, Quantity};

use crate::ui::labels;
use crate::ui::widgets::text;

/// Part of the height that is left free above the highest number and below the lowest, so that they
/// can be written whole.
const ROOM: f64 = 0.1;

/// Height in points between two lanes, so that the lowest number of one is apart from the highest of
/// the next.
const APART: f32 = 8.0;

/// The unit of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum ValueKind {
    Angle,
    Length,
    /// A number without a unit.
    Ratio,
}

impl ValueKind {
    pub const ALL: [Self; 3] = [Self::Angle, Self::Length, Self::Ratio];

    pub fn of(channel: Channel) -> Self {
        match (channel, channel.quantity()) {
            (Channel::Stretch(_), _) => Self::Ratio,
            (_, Quantity::Angle | Quantity::Rotation) => Self::Angle,
            (_, Quantity::Point | Quantity::Length) => Self::Length,
            (_, Quantity::Fraction | Quantity::Number | Quantity::Numbers | Quantity::Switch) => {
                Self::Ratio
            }
        }
    }

    /// Displayed values per value: degrees per radian for angles.
    pub fn factor(self) -> f64 {
        match self {
            Self::Angle => 180.0 / core::f64::consts::PI,
            Self::Length | Self::Ratio => 1.0,
        }
    }

    /// Name and sign of the unit, in a document with these metres in a unit.
    pub fn unit(self, metres_per_unit: f32) -> (&'static str, &'static str) {
        match (self, metres_per_unit) {
            (Self::Angle, _) => ("degrees", "deg"),
            (Self::Length, metres) => labels::unit_of_length(metres),
            (Self::Ratio, _) => ("parts of the whole", "0–1"),
        }
    }

    fn index(self) -> usize {
        match self {
            Self::Angle => 0,
            Self::Length => 1,
            Self::Ratio => 2,
        }
    }
}

/// The number of curves of each kind of values. Each kind that is shown has a lane of its own, so that
/// no two units share a height. Lanes with several curves are higher.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Lanes([usize; 3]);

impl Lanes {
    pub fn of(channels: &[Channel]) -> Self {
        Self(ValueKind::ALL.map(|kind| {
            let channels = channels.iter().filter(|it| ValueKind::of(**it) == kind);
            channels.map(|channel| channel.quantity().width()).sum()
        }))
    }

    /// The kinds with a lane, from the top.
    pub fn kinds(self) -> impl Iterator<Item = ValueKind> {
        ValueKind::ALL.into_iter().filter(move |kind| self.0[kind.index()] > 0)
    }

    /// The lane of a kind in a plot; the whole plot for a kind that is not shown.
    pub fn lane(self, kind: ValueKind, plot: Rect) -> Rect {
        if !self.kinds().any(|it| it == kind) {
            return plot;
        }
        let above: Vec<ValueKind> = self.kinds().take_while(|it| *it != kind).collect();
        let parts: f32 = self.kinds().map(|it| self.weight(it)).sum();
        let gaps = APART * self.kinds().skip(1).count() as f32;
        let height = (plot.height() - gaps).max(0.0) / parts;
        let top = plot.top()
            + height * above.iter().map(|it| self.weight(*it)).sum::<f32>()
            + APART * above.len() as f32;
        Rect::from_x_y_ranges(plot.x_range(), top..=top + height * self.weight(kind))
    }

    /// Height of a lane, relative to the others: 8 from three curves on, 6 with one.
    fn weight(self, kind: ValueKind) -> f32 {
        const MOST: usize = 3;
        5.0 + self.0[kind.index()].min(MOST) as f32
    }
}

/// The displayed values at the bottom and the top of the lane of each [`ValueKind`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ValueScales {
    ranges: [(f64, f64); 3],
    lanes: Lanes,
}

/// Scales that the user has set, for these curves.
#[derive(Clone, PartialEq)]
struct StoredScales {
    channels: Vec<Channel>,
    scales: ValueScales,
}

impl ValueScales {
    /// The scales that show all displayed values of each kind between two numbers of the axis.
    pub fn fitting<I: Iterator<Item = f64>>(
        lanes: Lanes,
        plot: Rect,
        values: impl Fn(ValueKind) -> I,
    ) -> Self {
        let height = |kind| lanes.lane(kind, plot).height();
        Self { ranges: ValueKind::ALL.map(|kind| fitted(values(kind), height(kind))), lanes }
    }

    /// The scales that the user has set for the curves of `channels`; `None` if there are none.
    pub fn load(ui: &Ui, channels: &[Channel]) -> Option<Self> {
        let stored = ui.data(|data| data.get_temp::<StoredScales>(id()))?;
        (stored.channels == channels).then_some(stored.scales)
    }

    /// Removes the scales that the user has set, so that all curves are shown again.
    pub fn fit(ui: &Ui) {
        ui.data_mut(|data| data.remove::<StoredScales>(id()));
    }

    /// Zooms the lane under the mouse by Ctrl+wheel, and pans the lane in which a drag began by
    /// `is_panning`, which is vertical only after a zoom. Stores changed scales for the curves of
    /// `channels`.
    pub fn follow_input(&mut self, ui: &Ui, plot: Rect, channels: &[Channel], is_panning: bool) {
        let before = *self;
        let Some(mouse) = ui.input(|input| input.pointer.latest_pos()) else { return };
        if is_panning
            && Self::load(ui, channels).is_some()
            && let Some(origin) = ui.input(|input| input.pointer.press_origin())
            && let Some((kind, lane)) = self.lane_at(origin, plot)
        {
            let up = f64::from(ui.input(|input| input.pointer.delta().y) / lane.height().max(1.0));
            self.change(kind, |low, high| (low + up * (high - low), high + up * (high - low)));
        }
        if ui.rect_contains_pointer(plot)
            && let Some((kind, lane)) = self.lane_at(mouse, plot)
        {
            let height = f64::from((lane.bottom() - mouse.y) / lane.height().max(1.0));
            for event in ui.input(|input| input.events.clone()) {
                if let Event::MouseWheel { unit, delta, modifiers, .. } = event
                    && modifiers.command
                {
                    let factor = WHEEL.powf(-f64::from(wheel_steps(unit, delta).y));
                    self.change(kind, |low, high| {
                        let still = low + height * (high - low);
                        (still + (low - still) * factor, still + (high - still) * factor)
                    });
                }
            }
        }
        if *self != before {
            let stored = StoredScales { channels: channels.to_vec(), scales: *self };
            ui.data_mut(|data| data.insert_temp(id(), stored));
        }
    }

    fn lane_at(self, at: Pos2, plot: Rect) -> Option<(ValueKind, Rect)> {
        let mut lanes = self.lanes.kinds().map(|kind| (kind, self.lanes.lane(kind, plot)));
        lanes.find(|(_, lane)| lane.y_range().contains(at.y))
    }

    /// Changes the bottom and top of a lane, as far as they stay finite and apart.
    fn change(&mut self, kind: ValueKind, change: impl Fn(f64, f64) -> (f64, f64)) {
        /// Greatest value, and least distance between top and bottom relative to them.
        const LIMITS: (f64, f64) = (1e30, 1e-6);
        let range = &mut self.ranges[kind.index()];
        let (low, high) = change(range.0, range.1);
        let size = low.abs().max(high.abs());
        if size < LIMITS.0 && high - low > LIMITS.1 * size.max(LIMITS.1) {
            *range = (low, high);
        }
    }

    pub fn lanes(self) -> Lanes {
        self.lanes
    }

    /// The displayed values at the bottom and the top of a lane.
    pub fn range(self, kind: ValueKind) -> (f64, f64) {
        self.ranges[kind.index()]
    }

    pub fn points_per_value(self, kind: ValueKind, plot: Rect) -> f64 {
        let (low, high) = self.range(kind);
        f64::from(self.lanes.lane(kind, plot).height()) / (high - low)
    }

    /// Screen y of a displayed value.
    pub fn y(self, kind: ValueKind, value: f64, plot: Rect) -> f32 {
        let up = (value - self.range(kind).0) * self.points_per_value(kind, plot);
        self.lanes.lane(kind, plot).bottom() - up as f32
    }
}

/// A range with all values and the numbers of an axis of this height next to them, and free room on
/// both sides.
fn fitted(values: impl Iterator<Item = f64>, height: f32) -> (f64, f64) {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    });
    if low > high {
        return (0.0, 1.0);
    }
    let least = (1e-6 * low.abs().max(high.abs())).max(1e-6);
    if high - low < least {
        // A constant value lies in the middle.
        let room = least + 0.5;
        return (low - room, high + room);
    }
    // A greater range may need numbers that are farther apart, which may make it greater still.
    const MOST_TRIES: usize = 8;
    let mut range = (low, high);
    for _ in 0..MOST_TRIES {
        let step = step(range, height);
        let [first, last] = [(low / step).floor() * step, (high / step).ceil() * step];
        let room = ROOM * (last - first);
        let next = (first - room, last + room);
        if next == range {
            break;
        }
        range = next;
    }
    range
}

fn id() -> Id {
    Id::unique("timeline value scales")
}

/// The curve of one component of a channel.
pub(super) struct ChannelCurve {
    pub channel: Channel,
    /// Component of the channel's values: 0, 1 or 2.
    pub axis: usize,
    pub kind: ValueKind,
    pub name: String,
    pub colour: Color32,
    pub style: LineStyle,
    /// Times in seconds and displayed values of the samples.
    pub line: Vec<[f64; 2]>,
    /// Times in seconds and displayed values of the keys.
    pub knots: Vec<[f64; 2]>,
}

/// Minimum distance in points between labels.
const BETWEEN: f32 = 18.0;
/// Least distance in points between a label and the upper and lower end of its lane.
const FROM_END: f32 = 6.0;
/// Distance in points between the plot and the labels.
const GAP: f32 = 5.0;

/// Draws an axis at the left of each lane, lines through the lane at round values, and a line
/// between the lanes.
pub(in crate::ui::timeline) fn axes(
    ui: &Ui,
    scales: ValueScales,
    plot: Rect,
    metres_per_unit: f32,
    curves: &[ChannelCurve],
) {
    let line = ui.visuals().widgets.noninteractive.bg_stroke;
    for kind in scales.lanes.kinds() {
        let lane = scales.lanes.lane(kind, plot);
        let beside = Rect::from_x_y_ranges(plot.left() - VALUES..=plot.left(), lane.y_range());
        if lane.top() > plot.top() {
            let y = lane.top() - 0.5 * APART;
            ui.painter().hline(beside.left()..=plot.right(), y, line);
        }
        let (name, unit) = kind.unit(metres_per_unit);
        let shared = shared_colour(curves, kind);
        let x = plot.left() - GAP;
        let marks = marks(scales.range(kind), lane.height());
        let colour = shared.unwrap_or(ui.visuals().weak_text_color());
        let font = TextStyle::Small.resolve(ui.style());
        for mark in marks.values() {
            let y = scales.y(kind, mark, plot);
            let across = Stroke::new(1.0, line.color.gamma_multiply(0.5));
            ui.painter().with_clip_rect(lane).hline(lane.x_range(), y, across);
            if y > lane.top() + FROM_END && y < lane.bottom() - FROM_END {
                let sign = if kind == ValueKind::Angle { "°" } else { "" };
                let text = written(mark, marks.step) + sign;
                ui.painter().text(pos2(x, y), Align2::RIGHT_CENTER, text, font.clone(), colour);
            }
        }
        let response = ui.interact(beside, Id::unique(("timeline axis", unit)), Sense::click());
        response.widget_info(|| {
            WidgetInfo::labeled(Role::Label, true, format!("Axis in {name} ({unit})"))
        });
        if response.double_clicked() {
            ValueScales::fit(ui);
            ui.request_repaint();
        }
        response
            .on_hover_text(format!("Values in {name}. Ctrl+wheel zooms, double-click shows all"));
    }
}

/// The colour of all curves of a kind; `None` if they differ.
fn shared_colour(curves: &[ChannelCurve], kind: ValueKind) -> Option<Color32> {
    let mut colours = curves.iter().filter(|curve| curve.kind == kind).map(|curve| curve.colour);
    let first = colours.next()?;
    colours.all(|colour| colour == first).then_some(first)
}

/// Round values within a range.
#[derive(Clone, Copy)]
struct Marks {
    first: f64,
    step: f64,
    count: usize,
}

fn marks((low, high): (f64, f64), height: f32) -> Marks {
    let step = step((low, high), height);
    let first = (low / step).ceil();
    let count = ((high / step).floor() - first + 1.0).clamp(0.0, 1_000.0) as usize;
    Marks { first, step, count }
}

/// Distance between the numbers on an axis of this range and height.
fn step((low, high): (f64, f64), height: f32) -> f64 {
    round_step((high - low) * f64::from((BETWEEN / height.max(1.0)).min(1.0)))
}

impl Marks {
    fn values(self) -> impl Iterator<Item = f64> {
        (0..self.count).map(move |index| (self.first + index as f64) * self.step)
    }
}

/// Formats a value with enough decimals to distinguish it from a label that is `step` away.
fn written(value: f64, step: f64) -> String {
    let power = step.max(1e-6).log10().floor();
    let is_quarter = (step / 10_f64.powf(power) - 2.5).abs() < 1e-6;
    let digits = if is_quarter { 1.0 - power } else { -power };
    text::fixed(value, digits.max(0.0) as usize)
}

/// The smallest number that is at least `step` and is 1, 2, 2.5 or 5 times a power of ten.
fn round_step(step: f64) -> f64 {
    let power = 10_f64.powf(step.max(1e-30).log10().floor());
    let steps = [1.0, 2.0, 2.5, 5.0].map(|times| times * power);
    steps.into_iter().find(|it| *it >= step).unwrap_or(10.0 * power)
}
