//! The graph editor: keyed values over time.

use egui::{
    Color32, Id, Rect, Response, Role, ScrollArea, Sense, Stroke, Ui, UiBuilder, WidgetInfo,
};
use egui::{Rangef, Vec2b, pos2, vec2};
use egui_plot::{AxisHints, Line, LineStyle, PlotBounds, PlotPoints, Points};

use super::areas::{ROW, TimelineAreas, take_keyboard};
use super::channel_curve::ChannelCurve;
use super::drag::{self, TimelineDrag};
use super::graph_mouse::{self, GraphView};
use super::time_scale::TimeScale;
use super::{context_menu, row, ruler, text};
use crate::document::{Channel, Quantity};
use crate::kinematics::chain_ik::Method;
use crate::session::{Actions, Session};
use crate::ui::widgets::{format, plot};
use crate::ui::{labels, style};

/// Maximum number of channels shown.
const MOST: usize = 24;
/// Distance in points between samples of a curve.
const GRAIN: f32 = 2.0;
/// Width of the value axis in points.
const VALUES: f32 = 42.0;

/// Minimum distance in points between labels of the value axis.
const BETWEEN_VALUES: f32 = 15.0;

pub(in crate::ui) fn ui(
    ui: &mut Ui,
    session: &Session,
    scale: TimeScale,
    areas: &TimelineAreas,
    ruler: &Response,
    actions: &mut Actions,
) {
    let channels = shown(session);
    if channels.is_empty() {
        text::hint(ui, areas, "No curves. Add keys (K) or select a channel that has keys");
        return;
    }
    let curves: Vec<ChannelCurve> = channels
        .iter()
        .enumerate()
        .flat_map(|(index, channel)| curves(ui, session, scale, *channel, index))
        .collect();
    legend(ui, session, areas, &channels);
    let values = graph_mouse::held_values(ui).unwrap_or_else(|| values(&curves));
    plot(ui, scale, areas, &curves, values);
    let graph = GraphView { session, scale, area: areas.keys, values, curves: &curves };
    graph_mouse::paint(ui, &graph);

    let area = ui.interact(areas.keys, Id::unique("timeline curves"), Sense::click_and_drag());
    let names: Vec<String> = channels.iter().map(|it| labels::channel(session, *it)).collect();
    let said = format!("Curves of {}", names.join(", "));
    area.widget_info(|| WidgetInfo::labeled(Role::Image, true, &said));
    take_keyboard(ui, &area, ruler);
    graph_mouse::press(ui, &graph, &area, actions);
    graph_mouse::follow(ui, &graph, actions);
    context_menu::of_curves(&area, session, actions);
    if ruler::is_pressed(ui, &area) && drag::get(ui).is_none() {
        drag::grab_playhead(ui, session, actions);
        drag::follow_playhead(ui, session, scale, actions);
    }
    if area.contains_pointer() && ui.input(|input| input.pointer.button_pressed(MIDDLE)) {
        drag::set(ui, TimelineDrag::Pan);
    }
    if matches!(drag::get(ui), Some(TimelineDrag::Pan)) && drag::is_released(ui) {
        drag::clear(ui);
    }
}

const MIDDLE: egui::PointerButton = egui::PointerButton::Middle;

/// The channels whose curves are shown, at most `MOST`: the selected channels that have keys or,
/// without a selection, all channels of the shown rig that have keys.
fn shown(session: &Session) -> Vec<Channel> {
    let all = row::channels(session);
    let selected = session.selected_channels();
    let is_of_rig = |channel: &Channel| channel.rig() == Some(session.rig());
    let chosen: Vec<_> = match selected.is_empty() {
        true => all.into_iter().filter(is_of_rig).collect(),
        false => all.into_iter().filter(|channel| selected.contains(channel)).collect(),
    };
    chosen.into_iter().take(MOST).collect()
}

/// Colours, one for each component, and line style of a channel's curves. A channel with three
/// components has the axis colours, a limb's length has the limb's colour, and any other channel
/// has a colour chosen by `index`.
fn look(ui: &Ui, channel: Channel, index: usize) -> (Vec<Color32>, LineStyle) {
    let palette = style::palette(ui);
    let style = match index % 4 {
        0 => LineStyle::Solid,
        1 => LineStyle::dashed_loose(),
        2 => LineStyle::dashed_dense(),
        _ => LineStyle::dotted_dense(),
    };
    let colours = match channel {
        Channel::Upper => vec![palette.upper],
        Channel::Lower => vec![palette.lower],
        _ if channel.quantity().width() == 3 => palette.axes.to_vec(),
        _ => vec![palette.method(Method::ALL[index % Method::ALL.len()])],
    };
    (colours.into_iter().map(style::colour).collect(), style)
}

fn curves(
    ui: &Ui,
    session: &Session,
    scale: TimeScale,
    channel: Channel,
    index: usize,
) -> Vec<ChannelCurve> {
    let keys = &session.document().keys;
    let Some(track) = keys.track(channel) else {
        return Vec::new();
    };
    let unit = match channel.quantity() {
        Quantity::Angle | Quantity::Angles => 180.0 / core::f64::consts::PI,
        Quantity::Point | Quantity::Length | Quantity::Fraction | Quantity::Switch => 1.0,
    };
    let name = labels::channel(session, channel);
    let (colours, style) = look(ui, channel, index);
    let times = times(scale);
    let values: Vec<_> =
        times.iter().filter_map(|time| Some((*time, keys.value(channel, *time)?))).collect();
    let curve = |(axis, colour): (usize, Color32)| ChannelCurve {
        channel,
        axis,
        unit,
        name: format!("{name} {axis}"),
        colour,
        style,
        line: values.iter().map(|(time, value)| [*time, unit * f64::from(value[axis])]).collect(),
        knots: track
            .knots()
            .iter()
            .map(|knot| [knot.time, unit * f64::from(knot.value[axis])])
            .collect(),
    };
    colours.into_iter().enumerate().map(curve).collect()
}

/// Times in seconds at which curves are sampled: `GRAIN` points apart over the visible range.
fn times(scale: TimeScale) -> Vec<f64> {
    let (from, to) = scale.range();
    let step = f64::from(GRAIN) / scale.points_per_second();
    let count = ((to - from) / step).ceil().clamp(2.0, 10_000.0) as usize;
    (0..=count).map(|index| from + (to - from) * index as f64 / count as f64).collect()
}

/// The displayed values at the bottom and the top of the plot.
fn values(curves: &[ChannelCurve]) -> (f64, f64) {
    let values = curves.iter().flat_map(|curve| &curve.line).map(|point| point[1]);
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    });
    let room = (0.12 * (high - low)).max(1e-6 * low.abs().max(high.abs())).max(1e-6);
    // A constant value lies in the middle.
    let room = if high - low < room { 0.5 * room + 0.5 } else { room };
    (low - room, high + room)
}

fn plot(
    ui: &mut Ui,
    scale: TimeScale,
    areas: &TimelineAreas,
    curves: &[ChannelCurve],
    (low, high): (f64, f64),
) {
    let (from, to) = scale.range();
    let bounds = PlotBounds::from_min_max([from, low], [to, high]);
    let left = areas.keys.left() - VALUES;
    let rect = Rect::from_min_max(pos2(left, areas.keys.top()), areas.keys.max);
    let mut inside = ui.new_child(UiBuilder::new().max_rect(rect));
    plot::still("timeline curves", rect.height())
        .width(rect.width())
        .show_grid(Vec2b::new(false, true))
        .show_axes(Vec2b::new(false, true))
        .y_grid_spacer(egui_plot::uniform_grid_spacer(move |grid| {
            let lines = f64::from((rect.height() / BETWEEN_VALUES).max(1.0));
            let step = round_step((grid.bounds.1 - grid.bounds.0) / lines);
            [step, 5.0 * step, 10.0 * step]
        }))
        .custom_y_axes(vec![
            AxisHints::new_y()
                .formatter(|mark, _| value(mark.value, mark.step_size))
                .label_spacing(Rangef::new(13.0, 15.0))
                .min_thickness(VALUES),
        ])
        .show(&mut inside, |plot| {
            plot.set_auto_bounds(Vec2b::FALSE);
            plot.set_plot_bounds(bounds);
            for curve in curves {
                let line = Line::new(&curve.name, PlotPoints::from(curve.line.clone()));
                plot.line(line.color(curve.colour).width(1.75).style(curve.style));
                let knots = Points::new(&curve.name, PlotPoints::from(curve.knots.clone()));
                plot.points(knots.color(curve.colour).radius(3.0));
            }
        });
}

/// Formats a value with enough decimals to distinguish it from a label that is `step` away.
fn value(value: f64, step: f64) -> String {
    let digits = -step.max(1e-6).log10().floor();
    format::fixed(value, digits.max(0.0) as usize)
}

/// The smallest number that is at least `step` and is 1, 2 or 5 times a power of ten.
fn round_step(step: f64) -> f64 {
    let power = 10_f64.powf(step.max(1e-30).log10().floor());
    let steps = [1.0, 2.0, 5.0].map(|times| times * power);
    steps.into_iter().find(|it| *it >= step).unwrap_or(10.0 * power)
}

/// Shows the names of the channels, each with the colours of its curves.
fn legend(ui: &mut Ui, session: &Session, areas: &TimelineAreas, channels: &[Channel]) {
    let right = pos2(areas.names.right() - VALUES, areas.names.bottom());
    let rect = Rect::from_min_max(areas.names.min, right);
    ui.scope_builder(UiBuilder::new().max_rect(rect), |ui| {
        ScrollArea::vertical().id_salt("legend").auto_shrink(false).show(ui, |ui| {
            ui.spacing_mut().item_spacing.y = 0.0;
            for (index, channel) in channels.iter().enumerate() {
                entry(ui, session, *channel, index);
            }
        });
    });
}

fn entry(ui: &mut Ui, session: &Session, channel: Channel, index: usize) {
    const SWATCH: f32 = 6.0;
    let size = vec2(ui.available_width(), ROW);
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    let name = labels::channel(session, channel);
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, format!("Curve of {name}")));
    let (colours, _) = look(ui, channel, index);
    let width = SWATCH * colours.len() as f32;
    for (place, colour) in colours.iter().enumerate() {
        let x = rect.left() + 10.0 + SWATCH * place as f32;
        let at = pos2(x, rect.center().y);
        ui.painter().hline(x..=x + SWATCH - 1.5, at.y, Stroke::new(3.0, *colour));
    }
    let beside = Rect::from_min_max(pos2(rect.left() + width + 3.0, rect.top()), rect.max);
    text::line(ui, beside, &name, ui.visuals().text_color());
    let axes = if colours.len() == 3 { ": x, y and z in axis colours" } else { "" };
    response.on_hover_text(format!("{name}{axes}"));
}
