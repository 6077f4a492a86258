//! The areas of the timeline, and text in them.

use egui::{Color32, FontId, Rect, Response, StrokeKind, TextStyle, Ui, UiBuilder, pos2, vec2};

/// Width in points of the column of channel names.
pub(super) const NAMES: f32 = 180.0;
/// Height of the ruler in points.
pub(super) const RULER: f32 = 24.0;
/// Width in points of an axis of values beside the curves.
pub(super) const VALUES: f32 = 42.0;
/// Height of a row in points.
pub(super) const ROW: f32 = 20.0;

/// Moves the keyboard focus to the ruler if the mouse is pressed or clicked in `area`. The ruler
/// has the keyboard focus for the whole timeline.
pub(super) fn take_keyboard(ui: &Ui, area: &Response, ruler: &Response) {
    let touched = ui.input(|input| input.pointer.any_pressed() || input.pointer.any_click());
    if touched && area.contains_pointer() {
        ruler.request_focus();
    }
}

/// Rectangles of the parts of the timeline.
pub(super) struct TimelineAreas {
    pub whole: Rect,
    /// The names of the channels, left of the keys.
    pub names: Rect,
    pub ruler: Rect,
    pub keys: Rect,
}

impl TimelineAreas {
    /// The areas in `whole`, with `beside` points free at the right of the keys.
    pub fn new(whole: Rect, beside: f32) -> Self {
        let split = (whole.left() + NAMES).min(whole.right());
        let top = (whole.top() + RULER).min(whole.bottom());
        let right = (whole.right() - beside).max(split);
        Self {
            whole,
            names: Rect::from_min_max(pos2(whole.left(), top), pos2(split, whole.bottom())),
            ruler: Rect::from_min_max(pos2(split, whole.top()), pos2(right, top)),
            keys: Rect::from_min_max(pos2(split, top), pos2(right, whole.bottom())),
        }
    }
}

/// Paints a row that can be clicked as selected or under the mouse, and its keyboard focus.
pub(super) fn paint_state(ui: &Ui, rect: Rect, is_selected: bool, row: &Response) {
    let visuals = ui.visuals();
    let inside = rect.shrink2(vec2(2.0, 1.0));
    if is_selected {
        ui.painter().rect_filled(inside, 4.0, visuals.selection.bg_fill);
    } else if row.hovered() {
        ui.painter().rect_filled(inside, 4.0, visuals.widgets.hovered.weak_bg_fill);
    }
    if row.has_focus() {
        ui.painter().rect_stroke(inside, 4.0, visuals.selection.stroke, StrokeKind::Inside);
    }
}

/// Shows a sentence in weak colour in the middle of an empty timeline.
pub(in crate::ui) fn hint(ui: &mut Ui, areas: &TimelineAreas, sentence: &str) {
    let rect = Rect::from_center_size(
        areas.keys.center(),
        vec2(areas.keys.width(), ROW).min(areas.keys.size()),
    );
    ui.scope_builder(UiBuilder::new().max_rect(rect), |ui| {
        ui.centered_and_justified(|ui| {
            let text = egui::RichText::new(sentence).weak();
            ui.add(egui::Label::new(text).truncate().selectable(false));
        });
    });
}

/// Draws one line of text, truncated to the width of the rectangle.
pub(in crate::ui) fn line(ui: &Ui, rect: Rect, text: &str, colour: Color32) {
    let font: FontId = TextStyle::Body.resolve(ui.style());
    let mut job = egui::text::LayoutJob::simple_singleline(text.to_owned(), font, colour);
    job.wrap = egui::text::TextWrapping::truncate_at_width((rect.width() - 14.0).max(8.0));
    let galley = ui.fonts_mut(|fonts| fonts.layout_job(job));
    let at = pos2(rect.left() + 10.0, rect.center().y - galley.size().y / 2.0);
    ui.painter().galley(at, galley, colour);
}
