//! Text in the timeline.

use egui::{Color32, FontId, Rect, TextStyle, Ui, UiBuilder, pos2, vec2};

use super::areas::{ROW, TimelineAreas};

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
