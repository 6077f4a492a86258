//! The graph editor: keyed values over time.

mod legend;
mod mouse;

use egui::{
    Align2, Color32, Id, PointerButton, Rect, Response, Role, Sense, TextStyle, Ui, UiBuilder,
    Vec2b, WidgetInfo, pos2,
};
use egui_plot::{Line, LineStyle, MarkerShape, PlotBounds, PlotPoints, Points};

use super::drag::{self, TimelineDrag};
use super::rows::{self, TimelineAreas, take_keyboard};
use super::time_scale::TimeScale;
use super::value_scale::{self, ChannelCurve, Lanes, ValueKind, ValueScales};
use super::{context_menu, ruler};
use crate::document::Channel;
use crate::session::{Actions, Session};
use crate::ui::widgets::{AXES, plot};
use crate::ui::{labels, style};
use legend::LegendEntry;
use mouse::GraphView;

/// Maximum number of channels listed.
const MOST: usize = 96;
/// Maximum number of channels drawn.
const MOST_DRAWN: usize = 48;
/// Number of channels up to which all are drawn if nothing is selected. More would be a tangle.
const FEW: usize = 8;
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
        rows::hint(ui, areas.keys, hint(session));
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
    let scales = scales(ui, areas, &drawn, &curves);
    legend::ui(ui, session, (areas, scales.lanes()), &entries, ruler, actions);
    let metres = session.document().metres_per_unit();
    value_scale::axes(ui, scales, areas.keys, metres, &curves);
    plots(ui, scale, areas.keys, &curves, scales);
    letters(ui, scale, areas.keys, &curves, scales);
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

/// The channels with keys that can be shown: those of the selected joints or, if none is selected,
/// all.
fn listed(session: &Session) -> Vec<Channel> {
    let selected = session.selection().joints();
    let is_listed = |channel: &Channel| {
        let own = channel.joint().into_iter().chain(session.document().joint_of(*channel));
        let is_selected = selected.is_empty() || own.into_iter().any(|it| selected.contains(&it));
        channel.is_of_rig() && is_selected
    };
    let mut listed: Vec<Channel> = rows::channels(session).into_iter().filter(is_listed).collect();
    // Channels of one joint stand together.
    listed.sort_by_key(|channel| session.document().joint_of(*channel));
    listed.truncate(MOST);
    listed
}

/// The channels whose curves are shown: of those listed the selected ones, or all if none is
/// selected. Where no joint is selected either and there are many, those of the first joint.
fn drawn(session: &Session, listed: &[Channel]) -> Vec<Channel> {
    let selection = session.selection();
    let is_chosen = |channel: &Channel| selection.channels().contains(channel);
    let chosen: Vec<Channel> = listed.iter().copied().filter(is_chosen).collect();
    if !chosen.is_empty() {
        return chosen;
    }
    let joint = |channel: &Channel| session.document().joint_of(*channel);
    let first = listed.first().map(joint);
    let is_tangle = listed.len() > FEW && selection.joints().is_empty();
    let is_drawn = |channel: &Channel| !is_tangle || Some(joint(channel)) == first;
    listed.iter().copied().filter(is_drawn).take(MOST_DRAWN).collect()
}

fn hint(session: &Session) -> &'static str {
    if session.selection().joints().is_empty() {
        "No curves. Pose the rig and press K to add keys"
    } else {
        "No curves of the selected joints. Press K to key them, or select no joint to see all"
    }
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
        ValueScales::fitting(Lanes::of(drawn), areas.keys, |kind| {
            let curves = curves.iter().filter(move |curve| curve.kind == kind);
            curves.flat_map(|curve| &curve.line).map(|point| point[1])
        })
    };
    let mut scales = stored.unwrap_or_else(fitting);
    scales.follow_input(ui, areas.keys, drawn, drag::is_panning(ui));
    scales
}

/// Colours, one for each component, and line style of a channel's curves. A channel with three
/// components has the axis colours, any other channel a colour chosen by `index`.
fn look(ui: &Ui, channel: Channel, index: usize) -> (Vec<Color32>, LineStyle) {
    let palette = style::palette(ui);
    let has_axes = channel.quantity().width() == 3;
    let style = match index % 4 {
        _ if !has_axes => LineStyle::Solid,
        0 => LineStyle::Solid,
        1 => LineStyle::dashed_loose(),
        2 => LineStyle::dashed_dense(),
        _ => LineStyle::dotted_dense(),
    };
    let colours = match channel {
        _ if has_axes => palette.axes.to_vec(),
        // As its slider.
        Channel::TargetTwist(_) => vec![palette.accent],
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

/// Writes x, y and z on the three curves of a channel that has a lane of its own, where the curves are farthest
/// apart and no key is near.
fn letters(ui: &Ui, scale: TimeScale, area: Rect, curves: &[ChannelCurve], scales: ValueScales) {
    // Least distance of a letter from another, and from a key and the ends of the lane, in points.
    const APART: f32 = 14.0;
    const FROM_KEYS: f32 = 32.0;
    let font = TextStyle::Small.resolve(ui.style());
    for kind in scales.lanes().kinds() {
        let lane = scales.lanes().lane(kind, area);
        let of_kind = curves.iter().filter(|curve| curve.kind == kind).collect::<Vec<_>>();
        let [one, two, three] = of_kind[..] else { continue };
        if one.channel != two.channel || one.channel != three.channel {
            continue;
        }
        let curves = [one, two, three];
        let keys = || curves.into_iter().flat_map(|curve| &curve.knots);
        let is_free = |x: f32| {
            let near = |key: f64| (scale.x(key) - x).abs() < FROM_KEYS;
            lane.x_range().shrink(FROM_KEYS).contains(x) && !keys().any(|key| near(key[0]))
        };
        let gap = |at: usize| {
            let mut heights = curves.map(|curve| scales.y(kind, curve.line[at][1], area));
            heights.sort_unstable_by(f32::total_cmp);
            (heights[1] - heights[0]).min(heights[2] - heights[1])
        };
        let count = curves.map(|curve| curve.line.len()).into_iter().min().unwrap_or(0);
        let places = (0..count).filter(|at| is_free(scale.x(one.line[*at][0])));
        let best = places.map(|at| (gap(at), at)).max_by(|a, b| a.0.total_cmp(&b.0));
        let Some((_, at)) = best.filter(|(gap, _)| *gap > APART) else { continue };
        for curve in curves {
            let [time, value] = curve.line[at];
            let centre = pos2(scale.x(time), scales.y(kind, value, area));
            ui.painter().circle_filled(centre, 0.5 * APART, ui.visuals().extreme_bg_color);
            let letter = AXES[curve.axis];
            ui.painter().text(centre, Align2::CENTER_CENTER, letter, font.clone(), curve.colour);
        }
    }
}

/// Draws the curves, each in the lane of its unit.
fn plots(ui: &mut Ui, scale: TimeScale, area: Rect, curves: &[ChannelCurve], scales: ValueScales) {
    let (from, to) = scale.range();
    for kind in scales.lanes().kinds() {
        let lane = scales.lanes().lane(kind, area);
        let (low, high) = scales.range(kind);
        let mut inside = ui.new_child(UiBuilder::new().max_rect(lane));
        plot::still(("timeline curves", kind), lane.height())
            .width(lane.width())
            .show_grid(Vec2b::FALSE)
            .show_axes(Vec2b::FALSE)
            .show(&mut inside, |plot| {
                plot::show(plot, PlotBounds::from_min_max([from, low], [to, high]));
                for curve in curves.iter().filter(|curve| curve.kind == kind) {
                    let points = |points: &[[f64; 2]]| PlotPoints::from(points.to_vec());
                    let line = Line::new(&curve.name, points(&curve.line));
                    plot.line(line.color(curve.colour).width(1.75).style(curve.style));
                    let knots = Points::new(&curve.name, points(&curve.knots));
                    plot.points(knots.color(curve.colour).shape(MarkerShape::Diamond).radius(4.5));
                }
            });
    }
}
