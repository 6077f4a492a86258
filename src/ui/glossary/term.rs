//! A term on screen: underlined with dots; hovering it tells its meaning.

use egui::{Label, Response, RichText, Shape, Stroke, Ui, pos2};

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

fn underline(ui: &Ui, label: &Response, width: f32) {
    const SPACING: f32 = 3.0;
    let y = label.rect.center().y + 0.5 * ui.text_style_height(&egui::TextStyle::Body);
    let ends = [pos2(label.rect.left(), y), pos2(label.rect.left() + width, y)];
    let colour = ui.visuals().weak_text_color();
    ui.painter().extend(Shape::dashed_line(&ends, Stroke::new(1.0, colour), 1.0, SPACING - 1.0));
}
