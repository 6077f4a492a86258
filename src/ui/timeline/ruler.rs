//! The ruler: seconds, frames and the playhead.

use egui::{
    Align2, Area, Color32, CursorIcon, Event, Frame, Id, Order, PointerButton, Rect, Response,
    Sense, Shape, Stroke, TextStyle, Ui, WidgetInfo, pos2,
};

use super::drag;
use super::time_scale::TimeScale;
use super::value_scale::ValueScales;
use crate::document::{LostSpan, Timeline};
use crate::rig::RigPop;
use crate::session::{Actions, PlaybackAction, Session};
use crate::ui::widgets::text;
use crate::ui::{style, widgets};
use crate::words;

/// Minimum distance in points between labels.
const LABEL: f64 = 64.0;
/// Minimum distance in points between lines.
const LINE: f64 = 7.0;

/// Id of the ruler, which has the keyboard focus for the whole timeline.
pub(in crate::ui) fn id() -> Id {
    Id::unique("timeline ruler")
}

/// Shows the ruler, with lines or empty; a drag on it scrubs.
pub(in crate::ui) fn ui(
    ui: &Ui,
    session: &Session,
    scale: TimeScale,
    (rect, has_lines): (Rect, bool),
    actions: &mut Actions,
) -> Response {
    let response = ui.interact(rect, id(), Sense::click_and_drag());
    let time = session.playback().time();
    response.widget_info(|| WidgetInfo::slider(true, time, "Timeline ruler"));
    let timeline = session.document().timeline;
    let step = 1.0 / timeline.frame_rate;
    widgets::set_range(ui, response.id, timeline.start..=timeline.end, step);
    if has_lines {
        paint(ui, scale, timeline, rect);
    }
    if response.has_focus() {
        let stroke = Stroke::new(2.0, style::accent(ui));
        ui.painter().hline(rect.x_range(), rect.bottom() - 1.0, stroke);
    }
    if response.double_clicked() {
        TimeScale::fit(ui);
        ValueScales::fit(ui);
        ui.request_repaint();
    } else if is_pressed(ui, &response) {
        response.request_focus();
        drag::grab_playhead(ui, session, actions);
    }
    drag::follow_playhead(ui, session, scale, actions);
    step_by_accesskit(ui, session, actions);
    let response = response.on_hover_cursor(CursorIcon::ResizeHorizontal);
    let ticks = fault_ticks(session);
    paint_faults(ui, scale, rect, &ticks);
    let mouse = response.hover_pos().filter(|_| !response.dragged());
    let hovered = mouse.and_then(|mouse| {
        const NEAR: f32 = 4.0;
        let away = |tick: &FaultTick<'_>| (scale.x(tick.time) - mouse.x).abs();
        let nearest = ticks.iter().min_by(|one, other| away(one).total_cmp(&away(other)))?;
        (away(nearest) <= NEAR).then_some(nearest)
    });
    match hovered {
        Some(tick) => {
            let sentence = tick.fault.sentence(session);
            response.on_hover_text(format!("{:.2} s: {sentence}", tick.time))
        }
        None => response.on_hover_text(
            "Drag to scrub, Ctrl off the frame grid. Wheel zooms, middle drag pans, double-click \
             shows all",
        ),
    }
}

/// A fault of the motion: a pop, or a target that is lost.
struct FaultTick<'a> {
    /// In seconds.
    time: f64,
    /// The end of a span, in seconds.
    until: f64,
    fault: Fault<'a>,
}

enum Fault<'a> {
    Pop(&'a RigPop),
    Lost(&'a LostSpan),
}

impl Fault<'_> {
    fn sentence(&self, session: &Session) -> String {
        let rig = session.rig();
        match self {
            Self::Pop(pop) => words::pop(rig, pop),
            Self::Lost(span) => words::lost(rig, span.target, span.miss),
        }
    }
}

fn fault_ticks(session: &Session) -> Vec<FaultTick<'_>> {
    let Some(found) = session.inspection() else { return Vec::new() };
    let pops = found.peaks.iter().map(|peak| FaultTick {
        time: peak.time,
        until: peak.time,
        fault: Fault::Pop(&peak.pop),
    });
    let lost = found.lost.iter().map(|span| FaultTick {
        time: span.from,
        until: span.to,
        fault: Fault::Lost(span),
    });
    pops.chain(lost).collect()
}

/// Draws triangles at pops, and bars where targets are lost.
fn paint_faults(ui: &Ui, scale: TimeScale, rect: Rect, ticks: &[FaultTick<'_>]) {
    const SIZE: f32 = 4.0;
    let painter = ui.painter().with_clip_rect(rect);
    let (warn, error) = (ui.visuals().warn_fg_color, ui.visuals().error_fg_color);
    for tick in ticks {
        let (x, until, bottom) = (scale.x(tick.time), scale.x(tick.until), rect.bottom());
        if let Fault::Lost(_) = tick.fault {
            let bar = Rect::from_x_y_ranges(x..=until.max(x + 2.0), bottom - 3.0..=bottom);
            painter.rect_filled(bar, 0.0, error);
        } else {
            let at = |dx: f32, dy: f32| pos2(x + dx * SIZE, bottom - dy * SIZE);
            let points = vec![at(-1.0, 0.0), at(0.0, 2.0), at(1.0, 0.0)];
            painter.add(Shape::convex_polygon(points, warn, Stroke::NONE));
        }
    }
}

/// True if the left mouse button was pressed on the widget of `response` in this frame.
pub(in crate::ui) fn is_pressed(ui: &Ui, response: &Response) -> bool {
    let is_press = |event: &Event| {
        matches!(event, Event::PointerButton { button: PointerButton::Primary, pressed: true, .. })
    };
    response.contains_pointer() && ui.input(|input| input.events.iter().any(is_press))
}

/// Handles requests of screen readers to step or set the time.
fn step_by_accesskit(ui: &Ui, session: &Session, actions: &mut Actions) {
    let timeline = session.document().timeline;
    let frames = widgets::requested_steps(ui, id());
    if frames != 0.0 {
        let time = timeline.snapped(session.playback().time()) + frames / timeline.frame_rate;
        actions.push(PlaybackAction::SetTime(timeline.snapped(time)));
    }
    actions.extend(widgets::requested_values(ui, id()).into_iter().map(PlaybackAction::SetTime));
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
    let digits = ticks.major.digits(timeline);
    for (x, time) in ticks.lines(scale, timeline, ticks.major) {
        painter.vline(x, rect.bottom() - 7.0..=rect.bottom(), Stroke::new(1.0, strong));
        let label = format!("{} s", text::fixed(time, digits));
        painter.text(pos2(x, rect.top() + 1.0), Align2::CENTER_TOP, label, font.clone(), strong);
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
    let (x, accent) = (scale.x(session.playback().time()), style::accent(ui));
    painter.vline(x, ruler.bottom() - 8.0..=bottom, Stroke::new(1.5, accent));
    let place = |dx: f32, dy: f32| pos2(x + dx, ruler.bottom() + dy);
    let points = [(-5.0, -9.5), (5.0, -9.5), (5.0, -5.0), (0.0, 0.0), (-5.0, -5.0)]
        .map(|(x, y)| place(x, y));
    let rim = Stroke::new(1.0, Color32::from_black_alpha(90));
    painter.add(Shape::convex_polygon(points.to_vec(), accent, rim));
}

/// Says above the playhead that the first key has turned auto-key on, until the user answers or an
/// edit sets a key.
pub(in crate::ui) fn auto_key_note(
    ui: &Ui,
    session: &Session,
    scale: TimeScale,
    ruler: Rect,
    actions: &mut Actions,
) {
    /// Distance from the ruler, in points.
    const GAP: f32 = 6.0;
    if !session.playback().is_auto_key_news() {
        return;
    }
    let x = scale.x(session.playback().time()).clamp(ruler.left(), ruler.right());
    let area = Area::new(Id::unique("auto-key is on"))
        .order(Order::Middle)
        .pivot(Align2::CENTER_BOTTOM)
        .fixed_pos(pos2(x, ruler.top() - GAP))
        .constrain_to(ui.ctx().content_rect());
    area.show(ui.ctx(), |ui| {
        Frame::popup(ui.style()).show(ui, |ui| {
            ui.horizontal(|ui| {
                ui.label("Auto-key is on: every edit sets keys at the playhead");
                if widgets::button(ui, "Turn off", "Set keys by K alone", None) {
                    actions.push(PlaybackAction::SetAutoKey(false));
                }
                if widgets::button(ui, "Keep on", "Hide this note", None) {
                    actions.push(PlaybackAction::SetAutoKey(true));
                }
            });
        });
    });
}

/// Spacing of the ruler's lines.
struct RulerTicks {
    /// From one labelled line to the next.
    major: RulerStep,
    /// From any line to the next.
    minor: RulerStep,
}

#[derive(Clone, Copy, PartialEq)]
enum RulerStep {
    Frames(i64),
    Seconds(i64),
}

impl RulerStep {
    fn seconds(self, timeline: Timeline) -> f64 {
        match self {
            Self::Frames(frames) => frames as f64 / timeline.frame_rate,
            Self::Seconds(seconds) => seconds as f64,
        }
    }

    /// Decimals with which the times of lines in a row differ, in seconds: all that a round step has.
    fn digits(self, timeline: Timeline) -> usize {
        let span = self.seconds(timeline);
        let is_exact = |digits: &usize| {
            let parts = span * 10_f64.powi(*digits as i32);
            (parts - parts.round()).abs() < 1e-6 * parts
        };
        let rounded = -span.log10();
        (0..3).find(is_exact).unwrap_or(rounded.ceil().max(0.0) as usize)
    }

    /// True if every line of `other` is a line of this step, too.
    fn divides(self, other: Self, timeline: Timeline) -> bool {
        match (self, other) {
            (Self::Frames(own), Self::Frames(other)) => other % own == 0,
            (Self::Seconds(own), Self::Seconds(other)) => other % own == 0,
            (Self::Frames(own), Self::Seconds(seconds)) => {
                frames_per_second(timeline).is_some_and(|rate| seconds * rate % own == 0)
            }
            (Self::Seconds(_), Self::Frames(_)) => false,
        }
    }
}

/// The frame rate if every second is at a frame.
fn frames_per_second(timeline: Timeline) -> Option<i64> {
    let rate = timeline.frame_rate;
    (rate.fract() == 0.0 && timeline.number(0.0).fract() == 0.0).then_some(rate as i64)
}

/// Numbers of frames, ascending, from one line to the next, within a second: one, two, and those whose
/// times are round.
fn frame_steps(timeline: Timeline) -> Vec<i64> {
    const PARTS: [i64; 5] = [20, 10, 5, 4, 2];
    let mut steps = vec![1, 2];
    match frames_per_second(timeline) {
        Some(rate) => {
            steps.retain(|frames| rate % frames == 0);
            steps.extend(PARTS.iter().filter(|part| rate % **part == 0).map(|part| rate / part));
        }
        None => steps.extend([5, 10]),
    }
    steps.retain(|frames| (*frames as f64) < timeline.frame_rate);
    steps.sort_unstable();
    steps
}

impl RulerTicks {
    fn new(scale: TimeScale, timeline: Timeline) -> Self {
        const SECONDS: [i64; 16] =
            [1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 1800, 3600, 7200, 21_600, 43_200, 86_400];
        let frames = frame_steps(timeline).into_iter().map(RulerStep::Frames);
        let steps: Vec<RulerStep> = frames.chain(SECONDS.map(RulerStep::Seconds)).collect();
        let points = |step: RulerStep| step.seconds(timeline) * scale.points_per_second();
        let labelled = steps.iter().copied().find(|step| points(*step) >= LABEL);
        let major = labelled.unwrap_or(RulerStep::Seconds(86_400));
        let finer = |step: &RulerStep| step.divides(major, timeline) && points(*step) >= LINE;
        let minor = steps.iter().copied().find(finer).unwrap_or(major);
        Self { major, minor }
    }

    /// The x on screen and the time in seconds of each visible line of a step.
    fn lines(
        &self,
        scale: TimeScale,
        timeline: Timeline,
        step: RulerStep,
    ) -> impl Iterator<Item = (f32, f64)> + use<> {
        let (from, to) = scale.range();
        let shift = match step {
            RulerStep::Frames(_) => timeline.time_of_number(0.0),
            RulerStep::Seconds(_) => 0.0,
        };
        let span = step.seconds(timeline);
        let index = |time: f64| (time - shift) / span;
        let (first, last) = (index(from).ceil() as i64, index(to).floor() as i64);
        (first..=last).map(move |index| {
            let time = index as f64 * span + shift;
            (scale.x(time), time)
        })
    }
}

#[cfg(test)]
mod tests {
    use egui::Rangef;

    use super::*;

    #[test]
    fn lines_are_never_closer_than_can_be_told_apart_and_times_never_overlap() {
        for frame_rate in [0.01, 1.0, 7.0, 24.0, 29.97, 30.0, 33.33, 60.0, 1000.0] {
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

    #[test]
    fn labels_in_a_row_differ_and_short_ones_are_exact() {
        let label = |frame_rate: f64, step: RulerStep, index: i64| {
            let timeline = Timeline { start: 0.0, end: 9.0, frame_rate };
            text::fixed(index as f64 * step.seconds(timeline), step.digits(timeline))
        };
        assert_eq!(label(30.0, RulerStep::Seconds(2), 3), "6");
        assert_eq!(label(30.0, RulerStep::Frames(15), 3), "1.5");
        assert_eq!(label(24.0, RulerStep::Frames(6), 3), "0.75");
        for frame_rate in [1.0, 7.0, 24.0, 29.97, 30.0, 60.0, 1000.0] {
            let times: Vec<String> =
                (0..50).map(|frame| label(frame_rate, RulerStep::Frames(1), frame)).collect();
            assert!(times.windows(2).all(|pair| pair[0] != pair[1]), "{times:?}");
        }
    }
}
