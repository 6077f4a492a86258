//! The visible time range and its mapping to the screen.

use egui::{Event, Id, MouseWheelUnit, Rangef, Rect, Ui, Vec2};

use crate::document::Timeline;
use crate::session::Session;

/// Margin at both ends, in points.
const MARGIN: f32 = 16.0;
/// Zoom factor of a wheel step.
pub(super) const WHEEL: f64 = 1.2;
/// Scroll distance in points that counts as one wheel step.
const POINTS_PER_STEP: f32 = 50.0;
/// Minimum length of the visible range, in frames.
const LEAST_FRAMES: f64 = 4.0;
/// Maximum length of the visible range, as a multiple of the timeline with all keys.
const WIDEST: f64 = 4.0;

/// Converts between times in seconds and x on screen in points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::ui) struct TimeScale {
    /// Horizontal range, in points.
    seen: Rangef,
    /// Time at the left margin, in seconds.
    from: f64,
    /// Time at the right margin, in seconds.
    to: f64,
}

/// The visible time range, kept while the timeline is zoomed or panned; `from` and `to` are those
/// of [`TimeScale`].
#[derive(Clone, Copy, Debug, PartialEq)]
struct StoredRange {
    of: RangeOwner,
    from: f64,
    to: f64,
}

/// The document and timeline for which a range was stored.
#[derive(Clone, Copy, Debug, PartialEq)]
struct RangeOwner {
    /// The open document.
    document: u64,
    /// Start and end of its timeline, in seconds.
    timeline: (f64, f64),
}

impl RangeOwner {
    fn of(session: &Session) -> Self {
        let Timeline { start, end, .. } = session.document().timeline;
        Self { document: session.history().first_revision(), timeline: (start, end) }
    }
}

impl TimeScale {
    /// The scale that shows the stored range or, if none is stored, or if another document was
    /// opened or the timeline's start or end has changed since, the whole timeline. `seen` is the
    /// range of x on screen in points.
    pub fn load(ui: &Ui, session: &Session, seen: Rangef) -> Self {
        let of = RangeOwner::of(session);
        let zoom = ui.data(|data| data.get_temp::<StoredRange>(id())).filter(|zoom| zoom.of == of);
        let (from, to) = zoom.map_or(of.timeline, |zoom| (zoom.from, zoom.to));
        Self { seen, from, to }
    }

    /// The scale that shows a range of times, in seconds.
    pub fn showing(seen: Rangef, from: f64, to: f64) -> Self {
        Self { seen, from, to }
    }

    /// Removes the stored range, so that the next frame shows the whole timeline.
    pub fn fit(ui: &Ui) {
        ui.data_mut(|data| data.remove::<StoredRange>(id()));
    }

    fn width(self) -> f64 {
        f64::from((self.seen.span() - 2.0 * MARGIN).max(1.0))
    }

    pub fn points_per_second(self) -> f64 {
        self.width() / (self.to - self.from)
    }

    pub fn x(self, time: f64) -> f32 {
        let x = (time - self.from) * self.points_per_second();
        // Clamped, so that far times stay finite.
        self.seen.min + MARGIN + x.clamp(-1e6, 1e6) as f32
    }

    pub fn time(self, x: f32) -> f64 {
        self.from + f64::from(x - self.seen.min - MARGIN) / self.points_per_second()
    }

    /// Start and end of the visible time range in seconds, with the margins.
    pub fn range(self) -> (f64, f64) {
        (self.time(self.seen.min), self.time(self.seen.max))
    }

    /// Zooms by the wheel about the mouse, but not by Ctrl+wheel in `values`, where that zooms
    /// values; pans by Shift+wheel and horizontal wheel, and by the mouse if `is_panning`; follows
    /// the playhead during playback. Stores a changed range.
    pub fn follow_input(
        &mut self,
        ui: &Ui,
        session: &Session,
        area: Rect,
        values: Option<Rect>,
        is_panning: bool,
    ) {
        let before = *self;
        if session.playback().is_playing() {
            self.reveal(session.playback().time());
        }
        let mouse = ui.input(|input| input.pointer.latest_pos());
        if mouse.is_some() && is_panning {
            self.pan(-ui.input(|input| input.pointer.delta().x));
        }
        let is_in_values = values.is_some_and(|values| ui.rect_contains_pointer(values));
        if let Some(mouse) = mouse.filter(|_| ui.rect_contains_pointer(area)) {
            for event in ui.input(|input| input.events.clone()) {
                match event {
                    Event::Zoom(factor) => self.zoom(mouse.x, f64::from(factor), session),
                    Event::MouseWheel { modifiers, .. } if modifiers.command && is_in_values => {}
                    Event::MouseWheel { unit, delta, modifiers, .. } => {
                        let steps = wheel_steps(unit, delta);
                        let across = if modifiers.shift { steps.x + steps.y } else { steps.x };
                        self.pan(-across * POINTS_PER_STEP);
                        if !modifiers.shift {
                            self.zoom(mouse.x, WHEEL.powf(f64::from(steps.y)), session);
                        }
                    }
                    _ => {}
                }
            }
        }
        if *self != before {
            let range = StoredRange { of: RangeOwner::of(session), from: self.from, to: self.to };
            ui.data_mut(|data| data.insert_temp(id(), range));
        }
    }

    fn pan(&mut self, points: f32) {
        let farthest = 2.0 * Timeline::MAX_TIME;
        let way = f64::from(points) / self.points_per_second();
        let by = way.clamp(-farthest - self.from, farthest - self.to);
        self.from += by;
        self.to += by;
    }

    /// Zooms in by `factor`; the time at `x` on screen keeps its position.
    fn zoom(&mut self, x: f32, factor: f64, session: &Session) {
        let least = LEAST_FRAMES / session.document().timeline.frame_rate;
        let (start, end) = span(session);
        let span = self.to - self.from;
        let most = (WIDEST * (end - start)).max(least);
        let new_span = (span / factor).clamp(least, most);
        if !new_span.is_finite() {
            return;
        }
        let fixed = self.time(x);
        self.from = fixed - (fixed - self.from) * new_span / span;
        self.to = self.from + new_span;
    }

    /// If `time` is outside the visible range, moves the range so that it starts at `time`.
    fn reveal(&mut self, time: f64) {
        let span = self.to - self.from;
        if !(self.from..=self.to).contains(&time) {
            (self.from, self.to) = (time, time + span);
        }
    }
}

/// Start and end, in seconds, of the range that contains the timeline and all keys.
pub(in crate::ui) fn span(session: &Session) -> (f64, f64) {
    let Timeline { start, end, .. } = session.document().timeline;
    session.document().keys.tracks().fold((start, end), |(start, end), (_, track)| {
        let knots = track.knots();
        let first = knots.first().map_or(start, |knot| knot.time.min(start));
        (first, knots.last().map_or(end, |knot| knot.time.max(end)))
    })
}

/// Steps of the wheel, across and up.
pub(super) fn wheel_steps(unit: MouseWheelUnit, delta: Vec2) -> Vec2 {
    match unit {
        MouseWheelUnit::Point => delta / POINTS_PER_STEP,
        MouseWheelUnit::Line => delta,
        MouseWheelUnit::Page => delta * 10.0,
    }
}

fn id() -> Id {
    Id::unique("timeline zoom")
}
