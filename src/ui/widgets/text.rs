//! Texts: numbers, mathematical symbols and errors.

use egui::text::{LayoutJob, TextFormat};
use egui::{
    Align, Color32, FontFamily, FontId, Label, Response, RichText, Role, Ui, WidgetInfo, accesskit,
};

use crate::words::significant;

/// Stands for a number that is not finite, or that was clamped to the largest one.
pub(in crate::ui) const OVERFLOW: &str = "overflow";

/// True if the number is not finite or was clamped to ±`f32::MAX`.
pub(in crate::ui) fn has_overflowed(value: f64) -> bool {
    !value.is_finite() || value.abs() >= f64::from(f32::MAX)
}

/// Formats a number in about six characters: with at most three decimals, or in scientific notation
/// below 0.001 and from 100,000.
pub(in crate::ui) fn short(value: f32) -> String {
    match value.abs() {
        _ if has_overflowed(value.into()) => OVERFLOW.to_owned(),
        0.0 => "0".to_owned(),
        ..0.001 => format!("{value:.1e}"),
        ..10.0 => format!("{value:.3}"),
        ..1_000.0 => format!("{value:.1}"),
        ..100_000.0 => format!("{value:.0}"),
        _ => format!("{value:.1e}"),
    }
}

/// Formats an angle in radians as degrees, with three significant digits: "34.2°".
pub(in crate::ui) fn degrees(radians: f32) -> String {
    format!("{}°", significant(radians.to_degrees()))
}

/// Formats a whole number with thousands separators: "1,000,000".
pub(in crate::ui) fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut grouped = String::new();
    for (at, digit) in digits.chars().enumerate() {
        if at > 0 && (digits.len() - at).is_multiple_of(3) {
            grouped.push(',');
        }
        grouped.push(digit);
    }
    grouped
}

/// Number of decimals with which a change by a tenth of `step` is visible.
pub(in crate::ui) fn decimals(step: f32) -> usize {
    (1.0 - step.log10().floor()).clamp(0.0, 12.0) as usize
}

/// Formats a number in about seven characters: with `decimals` decimals, with fewer if the number
/// is large, and in scientific notation from 999,999.5 or if `decimals` is above 4.
pub(in crate::ui) fn fixed(value: f64, decimals: usize) -> String {
    const MOST: usize = 4;
    // Small negative numbers would be formatted as "-0".
    let value = if value.abs() < 0.5 * 0.1_f64.powi(decimals as i32) { 0.0 } else { value };
    match value.abs() {
        _ if has_overflowed(value) => OVERFLOW.to_owned(),
        0.0 if decimals > MOST => "0".to_owned(),
        _ if decimals > MOST => format!("{value:.2e}"),
        ..99.995 => format!("{value:.decimals$}"),
        ..9_999.95 => format!("{value:.0$}", decimals.min(1)),
        ..999_999.5 => format!("{value:.0}"),
        _ => format!("{value:.1e}"),
    }
}

/// Number of decimals with which a hundredth of `cell`, the width of a grid cell, is visible.
pub(in crate::ui) fn decimals_of_cell(cell: f32) -> usize {
    (2.0 - cell.log10().round()).clamp(0.0, 6.0) as usize
}

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

/// Shows text in the error colour; screen readers announce it as an alert.
pub(in crate::ui) fn error_label(ui: &mut Ui, text: &str) {
    let colour = ui.visuals().error_fg_color;
    let label = Label::new(RichText::new(text).color(colour)).selectable(false);
    let response =
        ui.add(if ui.layout().is_horizontal() { label.truncate() } else { label.wrap() });
    ui.ctx().accesskit_node_builder(response.id, |node| {
        node.set_role(accesskit::Role::Alert);
        node.set_label(text);
    });
}

/// A text with a capital first letter.
pub(in crate::ui) fn capitalized(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

#[cfg(test)]
mod tests {
    use crate::ui::widgets::text::*;

    #[test]
    fn numbers_that_overflow_say_so() {
        for value in [f32::INFINITY, f32::NEG_INFINITY, f32::NAN, f32::MAX, f32::MIN] {
            assert_eq!(short(value), "overflow");
            assert_eq!(fixed(value.into(), 2), "overflow");
        }
        assert_eq!((short(3e38).as_str(), fixed(3e38, 2).as_str()), ("3.0e38", "3.0e38"));
    }

    #[test]
    fn whole_numbers_have_their_thousands_apart() {
        let cases = [(0, "0"), (999, "999"), (1_000, "1,000"), (12_345_678, "12,345,678")];
        for (number, text) in cases {
            assert_eq!(grouped(number), text);
        }
    }

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
