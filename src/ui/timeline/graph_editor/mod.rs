//! The graph editor: keyed values over time.

mod legend;
mod mouse;

use egui::{Color32, Id, PointerButton, Response, Role, Sense, Ui, UiBuilder, Vec2b, WidgetInfo};
use egui_plot::{Line, LineStyle, PlotBounds, PlotPoints, Points};

use super::drag::{self, TimelineDrag};
use super::rows::{self, TimelineAreas, VALUES, take_keyboard};
use super::time_scale::TimeScale;
use super::value_scale::{self, AxisSides, ChannelCurve, ValueKind, ValueScales};
use super::{context_menu, ruler};
use crate::document::Channel;
use crate::session::{Actions, Session};
use crate::ui::widgets::plot;
use crate::ui::{labels, style};
use legend::LegendEntry;
use mouse::GraphView;

/// Maximum number of channels listed.
const MOST: usize = 96;
/// Maximum number of channels drawn.
const MOST_DRAWN: usize = 48;
/// Distance in points between samples of a curve.
const GRAIN: f32 = 2.0;

pub(in crate::ui) fn ui(
    ui: &mut Ui,
    session: &Session,
    scale: TimeScale,
    areas: &TimelineAreas,
    ruler: &Response,
    actions: &mut Actions,
) {
    let listed = listed(session);
    if listed.is_empty() {
        rows::hint(ui, areas, hint(session));
        return;
    }
    let drawn = drawn(session, &listed);
    let look = |channel: Channel| {
        let index = listed.iter().position(|other| *other == channel).unwrap_or_default();
        look(ui, channel, index)
    };
    let curves: Vec<ChannelCurve> =
        drawn.iter().flat_map(|channel| curves(session, scale, *channel, look(*channel))).collect();
    let entry = |channel: &Channel| LegendEntry {
        channel: *channel,
        colours: look(*channel).0,
        is_drawn: drawn.contains(channel),
    };
    let entries: Vec<LegendEntry> = listed.iter().map(entry).collect();
    legend::ui(ui, session, areas, &entries, ruler, actions);
    let scales = scales(ui, areas, &drawn, &curves);
    let metres = session.document().metres_per_unit();
    value_scale::axes(ui, scales, sides(&drawn), areas.keys, metres, &curves);
    plot(ui, scale, areas, &curves, scales);
    let graph = GraphView { session, scale, area: areas.keys, scales, curves: &curves };
    mouse::paint(ui, &graph);

    let area = ui.interact(areas.keys, Id::unique("timeline curves"), Sense::click_and_drag());
    let names: Vec<String> = drawn.iter().map(|it| labels::channel(session, *it)).collect();
    let said = format!("Curves of {}", names.join(", "));
    area.widget_info(|| WidgetInfo::labeled(Role::Image, true, &said));
    take_keyboard(ui, &area, ruler);
    mouse::press(ui, &graph, &area, actions);
    mouse::follow(ui, &graph, actions);
    context_menu::of_curves(&area, session, actions);
    if ruler::is_pressed(ui, &area) && drag::get(ui).is_none() {
        drag::grab_playhead(ui, session, actions);
        drag::follow_playhead(ui, session, scale, actions);
    }
    let is_middle = ui.input(|input| input.pointer.button_pressed(PointerButton::Middle));
    if area.contains_pointer() && is_middle {
        drag::set(ui, TimelineDrag::Pan);
    }
    if drag::is_panning(ui) && drag::is_released(ui) {
        drag::clear(ui);
    }
}

/// Width in points of the axis at the right of the curves, if there is one.
pub(super) fn width_at_right(session: &Session) -> f32 {
    match sides(&drawn(session, &listed(session))).right {
        Some(_) => VALUES,
        None => 0.0,
    }
}

/// The channels with keys that can be shown: those of the selected joints or, if none is selected,
/// all.
fn listed(session: &Session) -> Vec<Channel> {
    let selected = session.selection().joints();
    let is_listed = |channel: &Channel| {
        let own = channel.joint().into_iter().chain(labels::joint_of_channel(session, *channel));
        let is_selected = selected.is_empty() || own.into_iter().any(|it| selected.contains(&it));
        channel.is_of_rig() && is_selected
    };
    let mut listed: Vec<Channel> = rows::channels(session).into_iter().filter(is_listed).collect();
    // Channels of one joint stand together.
    listed.sort_by_key(|channel| labels::joint_of_channel(session, *channel));
    listed.truncate(MOST);
    listed
}

/// The channels whose curves are shown: of those listed the selected ones, or all if none is
/// selected.
fn drawn(session: &Session, listed: &[Channel]) -> Vec<Channel> {
    let selected = session.selection().channels();
    let is_chosen = |channel: &Channel| selected.contains(channel);
    let chosen: Vec<Channel> = listed.iter().copied().filter(is_chosen).collect();
    if chosen.is_empty() { listed.iter().copied().take(MOST_DRAWN).collect() } else { chosen }
}

fn hint(session: &Session) -> &'static str {
    if session.selection().joints().is_empty() {
        "No curves. Pose the rig and press K to add keys"
    } else {
        "No curves of the selected joints. Press K to key them, or select no joint to see all"
    }
}

fn sides(drawn: &[Channel]) -> AxisSides {
    AxisSides::new(|kind| drawn.iter().any(|channel| ValueKind::of(*channel) == kind))
}

/// The scales of a drag, or those that the user has set, or those that fit.
fn scales(
    ui: &Ui,
    areas: &TimelineAreas,
    drawn: &[Channel],
    curves: &[ChannelCurve],
) -> ValueScales {
    if let Some(held) = mouse::held_scales(ui) {
        return held;
    }
    let stored = ValueScales::load(ui, drawn);
    let fitting = || {
        ValueScales::fitting(|kind| {
            let curves = curves.iter().filter(move |curve| curve.kind == kind);
            curves.flat_map(|curve| &curve.line).map(|point| point[1])
        })
        .with_level_zeros(sides(drawn))
    };
    let mut scales = stored.unwrap_or_else(fitting);
    scales.follow_input(ui, areas.keys, drawn, drag::is_panning(ui));
    scales
}

/// Colours, one for each component, and line style of a channel's curves. A channel with three
/// components has the axis colours, any other channel a colour chosen by `index`.
fn look(ui: &Ui, channel: Channel, index: usize) -> (Vec<Color32>, LineStyle) {
    let palette = style::palette(ui);
    let style = match index % 4 {
        0 => LineStyle::Solid,
        1 => LineStyle::dashed_loose(),
        2 => LineStyle::dashed_dense(),
        _ => LineStyle::dotted_dense(),
    };
    let colours = match channel {
        _ if channel.quantity().width() == 3 => palette.axes.to_vec(),
        _ => vec![palette.series(index)],
    };
    (colours.into_iter().map(style::colour).collect(), style)
}

fn curves(
    session: &Session,
    scale: TimeScale,
    channel: Channel,
    (colours, style): (Vec<Color32>, LineStyle),
) -> Vec<ChannelCurve> {
    let keys = &session.document().keys;
    let Some(track) = keys.track(channel) else {
        return Vec::new();
    };
    let kind = ValueKind::of(channel);
    let unit = kind.factor();
    let name = labels::channel(session, channel);
    let times = times(scale);
    let values: Vec<_> =
        times.iter().filter_map(|time| Some((*time, keys.value(channel, *time)?))).collect();
    let curve = |(axis, colour): (usize, Color32)| ChannelCurve {
        channel,
        axis,
        kind,
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

fn plot(
    ui: &mut Ui,
    scale: TimeScale,
    areas: &TimelineAreas,
    curves: &[ChannelCurve],
    scales: ValueScales,
) {
    let (from, to) = scale.range();
    let rect = areas.keys;
    let mut inside = ui.new_child(UiBuilder::new().max_rect(rect));
    plot::still("timeline curves", rect.height())
        .width(rect.width())
        .show_grid(Vec2b::FALSE)
        .show_axes(Vec2b::FALSE)
        .show(&mut inside, |plot| {
            // From the bottom to the top, because each kind of value has a scale of its own.
            plot::show(plot, PlotBounds::from_min_max([from, 0.0], [to, 1.0]));
            for curve in curves {
                let placed = |points: &[[f64; 2]]| -> PlotPoints<'_> {
                    let points = points.iter();
                    points.map(|[time, value]| [*time, scales.part(curve.kind, *value)]).collect()
                };
                let line = Line::new(&curve.name, placed(&curve.line));
                plot.line(line.color(curve.colour).width(1.75).style(curve.style));
                let knots = Points::new(&curve.name, placed(&curve.knots));
                plot.points(knots.color(curve.colour).radius(3.0));
            }
        });
}
