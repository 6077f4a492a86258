//! A term on screen: underlined with dots; hovering it tells its meaning.

use egui::{Label, Response, RichText, Ui, pos2};

use super::entry::Entry;
use crate::session::Actions;

/// Width of the explanation, in points.
const WIDTH: f32 = 260.0;

/// Shows the name of a term as a label.
pub(in crate::ui) fn term_label(ui: &mut Ui, name: &str, of: &str, actions: &mut Actions) {
    let label = ui.add(Label::new(name).selectable(false));
    let width = label.rect.width();
    term(ui, label, width, of, actions);
}

/// Underlines a label, whose text is `width` points wide, and shows the meaning of the term `of` while
/// the mouse is over it. A term that the glossary lacks stays a plain label.
pub(in crate::ui) fn term(ui: &Ui, label: Response, width: f32, of: &str, actions: &mut Actions) {
    let Some(entry) = Entry::find(of) else { return };
    underline(ui, &label, width);
    label.on_hover_ui(|ui| {
        ui.set_max_width(WIDTH);
        ui.label(RichText::new(&entry.term).strong());
        ui.label(&entry.text);
        if let Some(show_me) = entry.show_me()
            && ui.link("Show me").clicked()
        {
            actions.push(show_me);
        }
    });
}

/// Draws dots below the text. They are discs, since egui rounds lines and rectangles of one point to no
/// length.
fn underline(ui: &Ui, label: &Response, width: f32) {
    const RADIUS: f32 = 0.8;
    const SPACING: f32 = 4.0;
    let y = label.rect.center().y + 0.5 * ui.text_style_height(&egui::TextStyle::Body);
    let colour = ui.visuals().weak_text_color();
    for nth in 0..(width / SPACING).ceil() as u32 {
        let x = label.rect.left() + SPACING * nth as f32;
        // In the middle of a pixel, so that all dots look the same.
        ui.painter().circle_filled(pos2(x.round() + 0.5, y.round() - 0.5), RADIUS, colour);
    }
}
