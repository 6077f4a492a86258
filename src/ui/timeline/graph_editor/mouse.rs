//! The mouse in the graph editor: moves keys in time and value, and turns their tangents.

use egui::{Event, PointerButton, Pos2, Rect, Response, Stroke, Ui, Vec2, pos2};
use glam::Vec3;

use crate::document::{Channel, Quantity};
use crate::kinematics::spline::{Knot, Slopes, Spline};
use crate::session::{
    Actions, Edit, Key, KeysEdit, SelectAction, Session, ShellAction, TransactionAction,
};
use crate::ui::timeline::drag::{
    self, DraggedValues, KeyDrag, KeyShift, Press, TangentDrag, TimelineDrag,
};
use crate::ui::timeline::time_scale::TimeScale;
use crate::ui::timeline::value_scale::{ChannelCurve, ValueKind, ValueScales};
use crate::ui::{labels, style};

/// Hit radius of a key or a handle, in points.
const REACH: f32 = 8.0;
/// Length of a tangent handle, in points.
const HANDLE: f32 = 40.0;

/// The graph editor as it lies on screen.
pub(in crate::ui::timeline) struct GraphView<'a> {
    pub session: &'a Session,
    pub scale: TimeScale,
    pub area: Rect,
    pub scales: ValueScales,
    pub curves: &'a [ChannelCurve],
}

/// A tangent handle on screen.
struct Handle<'a> {
    curve: &'a ChannelCurve,
    key: Key,
    is_leaving: bool,
    from: Pos2,
    at: Pos2,
}

impl GraphView<'_> {
    fn points_per_value(&self, kind: ValueKind) -> f64 {
        self.scales.points_per_value(kind, self.area)
    }

    fn place(&self, time: f64, kind: ValueKind, value: f64) -> Pos2 {
        pos2(self.scale.x(time), self.scales.y(kind, value, self.area))
    }

    fn track(&self, channel: Channel) -> Option<&Spline<Vec3>> {
        self.session.document().keys.track(channel)
    }

    fn values(&self, curve: &ChannelCurve) -> DraggedValues {
        DraggedValues { axis: curve.axis, kind: curve.kind, scales: self.scales }
    }

    /// The places of the keys of a curve that are on screen.
    fn keys<'a>(&'a self, curve: &'a ChannelCurve) -> impl Iterator<Item = (&'a Knot<Vec3>, Pos2)> {
        let knots = self.track(curve.channel).map_or(&[][..], Spline::knots);
        let lane = self.scales.lanes().lane(curve.kind, self.area);
        knots.iter().filter_map(move |knot| {
            let at = self.place(
                knot.time,
                curve.kind,
                curve.kind.factor() * f64::from(knot.value[curve.axis]),
            );
            lane.expand(REACH).contains(at).then_some((knot, at))
        })
    }

    /// The key nearest to a screen position, within `REACH`. Selected keys come first.
    fn key_at(&self, mouse: Pos2) -> Option<(&ChannelCurve, Key)> {
        let selected = self.session.selection().keys();
        let all = self.curves.iter().flat_map(|curve| {
            self.keys(curve).map(move |(knot, at)| (curve, (curve.channel, knot.time), at))
        });
        let near = all.filter(|(.., at)| at.distance(mouse) <= REACH);
        let rank = |key: &Key, at: &Pos2| (!selected.contains(key), at.distance(mouse));
        let nearest = near.min_by(|(_, one, one_at), (_, other, other_at)| {
            let (one, other) = (rank(one, one_at), rank(other, other_at));
            one.0.cmp(&other.0).then(one.1.total_cmp(&other.1))
        });
        nearest.map(|(curve, key, _)| (curve, key))
    }

    /// The handles of the selected keys: one before each key with a cubic curve before it, and one
    /// after each key with a cubic curve after it.
    fn handles(&self) -> Vec<Handle<'_>> {
        let selected = self.session.selection().keys();
        let has_tangents = |curve: &&ChannelCurve| curve.channel.quantity() != Quantity::Switch;
        let of_curve = |curve| {
            let keys = self.keys(curve);
            let is_selected =
                |(knot, _): &(&Knot<Vec3>, Pos2)| selected.contains(&(curve.channel, knot.time));
            keys.filter(is_selected)
                .flat_map(move |(knot, from)| self.handles_of(curve, knot, from))
        };
        self.curves.iter().filter(has_tangents).flat_map(of_curve).collect()
    }

    fn handles_of<'a>(
        &self,
        curve: &'a ChannelCurve,
        knot: &Knot<Vec3>,
        from: Pos2,
    ) -> Vec<Handle<'a>> {
        let Some(track) = self.track(curve.channel) else { return Vec::new() };
        let Some(slopes) = track.slopes(knot.time) else { return Vec::new() };
        let index = track.knots().partition_point(|other| other.time < knot.time);
        let is_cubic = |knot: &Knot<Vec3>| knot.interpolation.is_cubic();
        let before = index.checked_sub(1).map(|before| &track.knots()[before]);
        let is_last = index + 1 == track.knots().len();
        let sides = [
            (false, before.is_some_and(is_cubic), slopes.arriving),
            (true, is_cubic(knot) && !is_last, slopes.leaving),
        ];
        let shown = sides.into_iter().filter(|(_, is_shown, _)| *is_shown);
        let handle = |(is_leaving, _, slope): (bool, bool, Vec3)| {
            let side = if is_leaving { 1.0 } else { -1.0 };
            let across = self.scale.points_per_second();
            let up = curve.kind.factor()
                * f64::from(slope[curve.axis])
                * self.points_per_value(curve.kind);
            let direction = egui::vec2(across as f32, -up as f32).normalized();
            let at = from + side * HANDLE * direction;
            Handle { curve, key: (curve.channel, knot.time), is_leaving, from, at }
        };
        shown.map(handle).collect()
    }
}

/// The scales of the plot when the drag in it began; `None` without one.
pub(in crate::ui::timeline) fn held_scales(ui: &Ui) -> Option<ValueScales> {
    match drag::get(ui)? {
        TimelineDrag::Keys(drag) => Some(drag.values?.scales),
        TimelineDrag::Tangent(drag) => Some(drag.value.scales),
        _ => None,
    }
}

/// Draws the selected keys and their handles.
pub(in crate::ui::timeline) fn paint(ui: &Ui, graph: &GraphView<'_>) {
    let painter = ui.painter().with_clip_rect(graph.area);
    let (accent, strong) = (style::accent(ui), ui.visuals().strong_text_color());
    for handle in graph.handles() {
        painter.line_segment([handle.from, handle.at], Stroke::new(1.0, accent));
        painter.circle(handle.at, 3.5, ui.visuals().panel_fill, Stroke::new(1.5, accent));
    }
    let selected = graph.session.selection().keys();
    for curve in graph.curves {
        for (knot, at) in graph.keys(curve) {
            if selected.contains(&(curve.channel, knot.time)) {
                painter.circle_stroke(at, 5.5, Stroke::new(1.5, strong));
            }
        }
    }
}

/// Handles presses: of a handle, of a key, and of the right button on a key, which selects it.
pub(in crate::ui::timeline) fn press(
    ui: &Ui,
    graph: &GraphView<'_>,
    area: &Response,
    actions: &mut Actions,
) {
    if !area.contains_pointer() || graph.session.history().is_editing() || drag::get(ui).is_some() {
        return;
    }
    for event in ui.input(|input| input.events.clone()) {
        let Event::PointerButton { pos, button, pressed: true, modifiers } = event else {
            continue;
        };
        match button {
            PointerButton::Primary => {
                let adds = modifiers.shift || modifiers.command;
                if !press_handle(ui, graph, pos) {
                    press_key(ui, graph, Press { at: pos, adds }, actions);
                }
            }
            PointerButton::Secondary => {
                if let Some((_, key)) = graph.key_at(pos)
                    && !graph.session.selection().keys().contains(&key)
                {
                    actions.push(SelectAction::Keys(vec![key]));
                }
            }
            _ => {}
        }
    }
}

fn press_handle(ui: &Ui, graph: &GraphView<'_>, at: Pos2) -> bool {
    let handles = graph.handles();
    let off = |handle: &&Handle<'_>| handle.at.distance(at);
    let near = handles.iter().filter(|handle| off(handle) <= REACH);
    let Some(handle) = near.min_by(|one, other| off(one).total_cmp(&off(other))) else {
        return false;
    };
    let Handle { curve, key, is_leaving, .. } = *handle;
    let drag = TangentDrag { key, value: graph.values(curve), is_leaving, moved: false };
    drag::set(ui, TimelineDrag::Tangent(drag));
    true
}

fn press_key(ui: &Ui, graph: &GraphView<'_>, press: Press, actions: &mut Actions) {
    let Some((curve, key)) = graph.key_at(press.at) else { return };
    let values = Some(graph.values(curve));
    drag::press_keys(ui, graph.session, vec![key], key.1, press, values, actions);
}

/// Continues a drag of keys or of a handle until the release of the mouse button or Esc.
pub(in crate::ui::timeline) fn follow(ui: &Ui, graph: &GraphView<'_>, actions: &mut Actions) {
    let Some(mouse) = ui.input(|input| input.pointer.latest_pos()) else { return };
    match drag::get(ui) {
        Some(TimelineDrag::Keys(drag)) => {
            let shift = |drag: &KeyDrag, way| shift(ui, graph, drag, way);
            drag::follow_keys(ui, graph.session, drag, mouse, actions, shift);
        }
        Some(TimelineDrag::Tangent(drag)) => turn_tangent(ui, graph, drag, mouse, actions),
        _ => {}
    }
}

/// The shift of dragged keys for the way of the mouse, in points.
fn shift(ui: &Ui, graph: &GraphView<'_>, drag: &KeyDrag, way: Vec2) -> KeyShift {
    // Shift keeps to the direction in which the mouse has moved more.
    let is_locked = ui.input(|input| input.modifiers.shift);
    let is_level = way.x.abs() > way.y.abs();
    let x = if is_locked && !is_level { 0.0 } else { way.x };
    let y = if is_locked && is_level { 0.0 } else { way.y };
    let later = drag.time + f64::from(x) / graph.scale.points_per_second();
    let by = match x {
        0.0 => 0.0,
        _ => drag::snapped(ui, graph.session.document().timeline, later) - drag.time,
    };
    let (mut raise, mut shown) = (Vec3::ZERO, 0.0);
    if let Some(DraggedValues { axis, kind, .. }) = drag.values {
        shown = -f64::from(y) / graph.points_per_value(kind);
        raise[axis] = (shown / kind.factor()) as f32;
    }
    let count = labels::count_of_keys(drag.keys.len());
    let said = if drag::is_released(ui) {
        format!("Moved {count} by {by:+.2} s, {shown:+.2}")
    } else {
        format!(
            "Move {count}: {by:+.2} s, {shown:+.2}     Shift one direction · Ctrl off the frame grid · Esc cancel"
        )
    };
    KeyShift { by, raise, said }
}

fn turn_tangent(
    ui: &Ui,
    graph: &GraphView<'_>,
    mut drag: TangentDrag,
    mouse: Pos2,
    actions: &mut Actions,
) {
    if drag::is_cancelled(ui) || drag.moved && !graph.session.history().is_editing() {
        return drag::clear(ui);
    }
    if !drag.moved {
        actions.push(TransactionAction::Begin);
        drag.moved = true;
        drag::set(ui, TimelineDrag::Tangent(drag));
    }
    actions.extend(turned(ui, graph, drag, mouse));
    let said = if drag::is_released(ui) {
        "Turned the tangent"
    } else {
        "Turn the tangent     Alt this side only · Esc cancel"
    };
    actions.push(ShellAction::Report(said.to_owned()));
    if drag::is_released(ui) {
        actions.push(TransactionAction::Commit);
        drag::clear(ui);
    }
}

/// The action that turns the tangent so that its handle points to the mouse; with Alt, only on the
/// side of the handle.
fn turned(ui: &Ui, graph: &GraphView<'_>, drag: TangentDrag, mouse: Pos2) -> Option<Edit> {
    /// Least distance of the mouse from the key in time, in points, so that slopes stay finite.
    const LEAST: f32 = 2.0;
    let (channel, time) = drag.key;
    let DraggedValues { axis, kind, .. } = drag.value;
    let track = graph.track(channel)?;
    let value = kind.factor() * f64::from(track.get(time)?[axis]);
    let key = graph.place(time, kind, value);
    let side = if drag.is_leaving { 1.0 } else { -1.0 };
    let across = (side * (mouse.x - key.x)).max(LEAST);
    let seconds = f64::from(across) / graph.scale.points_per_second();
    let rise = f64::from(key.y - mouse.y) / graph.points_per_value(kind);
    let slope = (f64::from(side) * rise / (kind.factor() * seconds)) as f32;
    let Slopes { mut arriving, mut leaving } = track.slopes(time)?;
    let is_alone = ui.input(|input| input.modifiers.alt);
    if drag.is_leaving || !is_alone {
        leaving[axis] = slope;
    }
    if !drag.is_leaving || !is_alone {
        arriving[axis] = slope;
    }
    Some(KeysEdit::SetSlopes(vec![drag.key], Some(Slopes { arriving, leaving })).into())
}
