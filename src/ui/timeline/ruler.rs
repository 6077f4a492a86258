//! The ruler: seconds, frames and the playhead.

use egui::{
    Align2, Color32, CursorIcon, Event, Id, PointerButton, Rect, Response, Sense, Shape, Stroke,
    TextStyle, Ui, WidgetInfo, accesskit, pos2,
};

use super::drag;
use super::time_scale::TimeScale;
use crate::document::Timeline;
use crate::session::{Actions, PlaybackAction, Session};
use crate::ui::style;

/// Minimum distance in points between labels.
const LABEL: f64 = 64.0;
/// Minimum distance in points between lines.
const LINE: f64 = 7.0;

/// Id of the ruler, which has the keyboard focus for the whole timeline.
pub(in crate::ui) fn id() -> Id {
    Id::unique("timeline ruler")
}

/// Shows the ruler; a drag on it scrubs.
pub(in crate::ui) fn ui(
    ui: &Ui,
    session: &Session,
    scale: TimeScale,
    rect: Rect,
    actions: &mut Actions,
) -> Response {
    let response = ui.interact(rect, id(), Sense::click_and_drag());
    let time = session.time();
    response.widget_info(|| WidgetInfo::slider(true, time, "Timeline ruler"));
    let timeline = session.document().timeline;
    ui.ctx().accesskit_node_builder(response.id, |node| {
        node.set_min_numeric_value(timeline.start);
        node.set_max_numeric_value(timeline.end);
        node.set_numeric_value_step(1.0 / f64::from(timeline.frame_rate));
        node.add_action(accesskit::Action::SetValue);
        node.add_action(accesskit::Action::Increment);
        node.add_action(accesskit::Action::Decrement);
    });
    paint(ui, scale, timeline, rect);
    if response.has_focus() {
        let stroke = Stroke::new(1.0, ui.visuals().weak_text_color());
        ui.painter().rect_stroke(rect.shrink(0.5), 2.0, stroke, egui::StrokeKind::Inside);
    }
    if response.double_clicked() {
        TimeScale::fit(ui);
        ui.request_repaint();
    } else if is_pressed(ui, &response) {
        response.request_focus();
        drag::grab_playhead(ui, session, actions);
    }
    drag::follow_playhead(ui, session, scale, actions);
    step_by_accesskit(ui, session, actions);
    let response = response.on_hover_cursor(CursorIcon::ResizeHorizontal);
    response.on_hover_text(
        "Drag to scrub, Ctrl off the frame grid. Wheel zooms, middle drag pans, double-click shows all",
    )
}

/// Whether the left mouse button was pressed on the widget of `response` in this frame.
pub(in crate::ui) fn is_pressed(ui: &Ui, response: &Response) -> bool {
    let is_press = |event: &Event| {
        matches!(event, Event::PointerButton { button: PointerButton::Primary, pressed: true, .. })
    };
    response.contains_pointer() && ui.input(|input| input.events.iter().any(is_press))
}

/// Handles requests of screen readers to step or set the time.
fn step_by_accesskit(ui: &Ui, session: &Session, actions: &mut Actions) {
    let timeline = session.document().timeline;
    let frames = ui.input(|input| {
        let count = |action| input.num_accesskit_action_requests(id(), action) as f64;
        count(accesskit::Action::Increment) - count(accesskit::Action::Decrement)
    });
    if frames != 0.0 {
        let time = timeline.snapped(session.time()) + frames / f64::from(timeline.frame_rate);
        actions.push(PlaybackAction::SetTime(timeline.snapped(time)));
    }
    let values: Vec<f64> = ui.input(|input| {
        let requests = input.accesskit_action_requests(id(), accesskit::Action::SetValue);
        let value = |request: &accesskit::ActionRequest| match request.data {
            Some(accesskit::ActionData::NumericValue(value)) => Some(value),
            _ => None,
        };
        requests.filter_map(value).collect()
    });
    actions.extend(values.into_iter().map(PlaybackAction::SetTime));
}

fn paint(ui: &Ui, scale: TimeScale, timeline: Timeline, rect: Rect) {
    let painter = ui.painter().with_clip_rect(rect);
    let visuals = ui.visuals();
    let (strong, weak) = (visuals.text_color(), visuals.weak_text_color());
    let font = TextStyle::Small.resolve(ui.style());
    let ticks = RulerTicks::new(scale, timeline);
    for (x, _) in ticks.lines(scale, timeline, ticks.minor) {
        painter.vline(x, rect.bottom() - 4.0..=rect.bottom(), Stroke::new(1.0, weak));
    }
    for (x, frame) in ticks.lines(scale, timeline, ticks.major) {
        painter.vline(x, rect.bottom() - 7.0..=rect.bottom(), Stroke::new(1.0, strong));
        let rate = i64::from(timeline.frame_rate.max(1));
        let (text, colour) = match frame % rate {
            0 => (format!("{} s", frame / rate), strong),
            _ => (format!("f {frame}"), weak),
        };
        let at = pos2(x, rect.top() + 1.0);
        painter.text(at, Align2::CENTER_TOP, text, font.clone(), colour);
    }
}

/// Draws the ruler's labelled lines through `rect`, the area of the keys.
pub(in crate::ui) fn grid(ui: &Ui, scale: TimeScale, timeline: Timeline, rect: Rect) {
    let painter = ui.painter().with_clip_rect(rect);
    let line = ui.visuals().widgets.noninteractive.bg_stroke;
    let ticks = RulerTicks::new(scale, timeline);
    for (x, _) in ticks.lines(scale, timeline, ticks.major) {
        painter.vline(x, rect.y_range(), Stroke::new(1.0, line.color.gamma_multiply(0.5)));
    }
}

/// Highlights the range from the timeline's start to its end.
pub(in crate::ui) fn ground(ui: &Ui, scale: TimeScale, timeline: Timeline, rect: Rect) {
    let x = |time| scale.x(time).clamp(rect.left(), rect.right());
    let played = Rect::from_x_y_ranges(x(timeline.start)..=x(timeline.end), rect.y_range());
    ui.painter().rect_filled(played, 0.0, ui.visuals().extreme_bg_color);
}

/// Draws the playhead: a handle in the ruler and a line through all rows down to `bottom`.
pub(in crate::ui) fn playhead(
    ui: &Ui,
    session: &Session,
    scale: TimeScale,
    ruler: Rect,
    bottom: f32,
) {
    let whole = Rect::from_min_max(ruler.min, pos2(ruler.right(), bottom));
    let painter = ui.painter().with_clip_rect(whole);
    let (x, accent) = (scale.x(session.time()), style::accent(ui));
    painter.vline(x, ruler.bottom() - 8.0..=bottom, Stroke::new(1.5, accent));
    let place = |dx: f32, dy: f32| pos2(x + dx, ruler.bottom() + dy);
    let points = [(-5.0, -11.0), (5.0, -11.0), (5.0, -5.0), (0.0, 0.0), (-5.0, -5.0)]
        .map(|(x, y)| place(x, y));
    let rim = Stroke::new(1.0, Color32::from_black_alpha(90));
    painter.add(Shape::convex_polygon(points.to_vec(), accent, rim));
}

/// Spacing of the ruler's lines, in frames.
struct RulerTicks {
    /// Frames from one labelled line to the next.
    major: i64,
    /// Frames from any line to the next.
    minor: i64,
}

impl RulerTicks {
    fn new(scale: TimeScale, timeline: Timeline) -> Self {
        const SECONDS: [i64; 16] =
            [1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 1800, 3600, 7200, 21_600, 43_200, 86_400];
        let rate = i64::from(timeline.frame_rate.max(1));
        let frames = [1, 2, 3, 5, 6, 10, 15].into_iter().filter(|it| *it < rate && rate % it == 0);
        let steps: Vec<i64> = frames.chain(SECONDS.map(|seconds| seconds * rate)).collect();
        let points = |step: i64| step as f64 * scale.points_per_second() / rate as f64;
        let last = 86_400 * rate;
        let major = steps.iter().copied().find(|step| points(*step) >= LABEL).unwrap_or(last);
        let finer = |step: &i64| *step < major && major % step == 0 && points(*step) >= LINE;
        let minor = steps.iter().copied().find(finer).unwrap_or(major);
        Self { major, minor }
    }

    /// The x on screen and the number of each visible frame whose number is a multiple of `step`.
    fn lines(
        &self,
        scale: TimeScale,
        timeline: Timeline,
        step: i64,
    ) -> impl Iterator<Item = (f32, i64)> + use<> {
        let rate = f64::from(timeline.frame_rate.max(1));
        let (from, to) = scale.range();
        let index = |time: f64| time * rate / step as f64;
        let (first, last) = (index(from).ceil() as i64, index(to).floor() as i64);
        (first..=last).map(move |index| {
            let frame = index * step;
            (scale.x(frame as f64 / rate), frame)
        })
    }
}

#[cfg(test)]
mod tests {
    use egui::Rangef;

    use super::*;

    #[test]
    fn lines_are_never_closer_than_can_be_told_apart_and_times_never_overlap() {
        for frame_rate in [1, 7, 24, 30, 60, 1000] {
            for end in [0.01, 0.5, 1.0, 8.0, 100.0, 3600.0, 86_400.0] {
                let timeline = Timeline { start: 0.0, end, frame_rate };
                let scale = TimeScale::showing(Rangef::new(0.0, 800.0), 0.0, end);
                let ticks = RulerTicks::new(scale, timeline);
                for (step, least) in [(ticks.major, LABEL), (ticks.minor, LINE)] {
                    let xs: Vec<f32> = ticks.lines(scale, timeline, step).map(|it| it.0).collect();
                    for pair in xs.windows(2) {
                        let gap = f64::from(pair[1] - pair[0]);
                        assert!(gap >= least - 0.01, "{frame_rate}/s, {end} s: {gap}");
                    }
                    assert!(xs.len() <= 120, "{frame_rate}/s, {end} s: {} lines", xs.len());
                }
            }
        }
    }
}
