//! Mathematical symbols: `θ_e` is shown with a subscript and read out as "theta e".

use egui::text::{LayoutJob, TextFormat};
use egui::{Align, Color32, FontFamily, FontId, Label, Response, Role, Ui, WidgetInfo};

/// Lays out text of `size` points. The letters and digits after an underscore become a subscript,
/// and the underscore is omitted.
pub(in crate::ui) fn layout(text: &str, size: f32, colour: Color32) -> LayoutJob {
    let mut job = LayoutJob::default();
    let format = |size, valign| TextFormat {
        font_id: FontId::new(size, FontFamily::Proportional),
        color: colour,
        valign,
        ..Default::default()
    };
    for (part, lowered) in parts(text) {
        let (size, align) =
            if lowered { (size * 0.72, Align::BOTTOM) } else { (size, Align::Center) };
        job.append(part, 0.0, format(size, align));
    }
    job
}

/// The text that screen readers read out: Greek letters as words, and underscores as spaces.
pub(in crate::ui) fn spoken(text: &str) -> String {
    let mut spoken = String::new();
    for letter in text.chars() {
        match letter {
            'θ' => spoken.push_str("theta"),
            'φ' => spoken.push_str("phi"),
            'ψ' => spoken.push_str("psi"),
            'β' => spoken.push_str("beta"),
            'λ' => spoken.push_str("lambda"),
            'τ' => spoken.push_str("tau"),
            'δ' => spoken.push_str("delta"),
            '_' => spoken.push(' '),
            _ => spoken.push(letter),
        }
    }
    spoken
}

/// Shows `text` with subscripts; screen readers get the result of [`spoken`].
pub(in crate::ui) fn label(ui: &mut Ui, text: &str, size: f32, colour: Color32) -> Response {
    let response = ui.add(Label::new(layout(text, size, colour)).selectable(false));
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, spoken(text)));
    response
}

/// Splits the text into parts without the underscores; the flag of a part is true for a subscript.
fn parts(text: &str) -> impl Iterator<Item = (&str, bool)> {
    text.split('_').enumerate().flat_map(|(index, part)| {
        let lowered = if index == 0 {
            0
        } else {
            part.find(|c: char| !c.is_alphabetic() && !c.is_ascii_digit()).unwrap_or(part.len())
        };
        let (low, rest) = part.split_at(lowered);
        [(low, true), (rest, false)].into_iter().filter(|(part, _)| !part.is_empty())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_follows_an_underscore_is_lowered_up_to_its_end() {
        let found: Vec<_> = parts("θ_e = atan2(o_e, h_e)").collect();
        let expected = [
            ("θ", false),
            ("e", true),
            (" = atan2(o", false),
            ("e", true),
            (", h", false),
            ("e", true),
            (")", false),
        ];
        assert_eq!(found, expected);
    }

    #[test]
    fn symbols_are_read_out_as_words() {
        assert_eq!(spoken("θ_e"), "theta e");
        assert_eq!(spoken("d_1 − d_2 = δ"), "d 1 − d 2 = delta");
    }
}
