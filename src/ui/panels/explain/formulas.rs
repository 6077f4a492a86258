//! Rows of quantities: symbol, formula and value.

use egui::{Align, Color32, Grid, Layout, Rect, Response, RichText, Ui, vec2};
use glam::Vec3;

use super::drawing::Lit;
use crate::document::Arm;
use crate::session::ArmFigure;
use crate::ui::widgets::symbol;

const SIZE: f32 = 13.5;

/// A quantity with symbol, formula, value and meaning.
pub(super) struct FormulaRow {
    pub symbol: &'static str,
    /// Empty for a quantity that is given.
    pub formula: &'static str,
    pub value: String,
    pub meaning: &'static str,
    pub colour: Option<Color32>,
    /// Lights up while the mouse is over the row.
    pub figure: Option<ArmFigure>,
}

pub(super) fn table(ui: &mut Ui, id: &str, rows: &[FormulaRow], lit: &mut Lit) {
    let right = ui.available_rect_before_wrap().right();
    Grid::new(id).num_columns(3).min_col_width(24.0).spacing(vec2(10.0, 4.0)).show(ui, |ui| {
        for row in rows {
            match row.figure {
                Some(figure) => {
                    let is_lit = lit.shows(figure);
                    lit.row(ui, figure, |ui| show(ui, row, is_lit, right));
                }
                None => {
                    show(ui, row, false, right);
                }
            }
            ui.end_row();
        }
    });
}

/// Shows a row that ends at `right`, and returns its rectangle.
fn show(ui: &mut Ui, row: &FormulaRow, is_lit: bool, right: f32) -> Rect {
    let (text, weak) = (ui.visuals().text_color(), ui.visuals().weak_text_color());
    let symbol = explained(ui, row.symbol, row.colour.unwrap_or(text), row.meaning);
    if row.formula.is_empty() {
        ui.label("");
    } else {
        explained(ui, row.formula, if is_lit { text } else { weak }, row.meaning);
    }
    let value = ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
        ui.label(RichText::new(&row.value).monospace())
    });
    let mut rect = symbol.rect.union(value.inner.rect);
    rect.max.x = rect.max.x.min(right);
    rect
}

/// Shows a name or formula with a tooltip; both may have symbols.
fn explained(ui: &mut Ui, text: &str, colour: Color32, meaning: &str) -> Response {
    let shown = symbol::label(ui, text, SIZE, colour);
    shown.on_hover_ui(|ui| {
        let colour = ui.visuals().text_color();
        symbol::label(ui, meaning, SIZE, colour);
    })
}

/// Shows the name and the value of a quantity that has no formula.
pub(super) fn pair(
    ui: &mut Ui,
    lit: &mut Lit,
    figure: ArmFigure,
    [name, meaning]: [&str; 2],
    value: String,
) {
    let colour = ui.visuals().text_color();
    lit.row(ui, figure, |ui| {
        let row = ui.horizontal(|ui| {
            explained(ui, name, colour, meaning);
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                ui.label(RichText::new(value).monospace());
            });
        });
        row.response.rect
    });
}

/// Writes a formula on a line of its own.
pub(super) fn formula(ui: &mut Ui, text: &str) {
    let colour = ui.visuals().text_color();
    symbol::label(ui, text, SIZE, colour);
}

pub(super) fn degrees(radians: f32) -> String {
    format!("{:.1}°", tidy(radians.to_degrees()))
}

/// Formats a length of the arm; a length that rounds to 0 is shown without a sign.
pub(super) fn length(arm: &Arm, length: f32) -> String {
    let nothing = 0.0005 * arm.grid_cell();
    arm.format_length(if length.abs() < nothing { 0.0 } else { length })
}

/// Formats a point of the arm.
pub(super) fn point(arm: &Arm, point: Vec3) -> String {
    let [x, y, z] = point.to_array().map(|coordinate| length(arm, coordinate));
    format!("({x}, {y}, {z})")
}

/// Returns 0 for a value that rounds to 0 at one decimal, so that 0 has no sign; otherwise the
/// value.
fn tidy(value: f32) -> f32 {
    if value.abs() < 0.05 { 0.0 } else { value }
}
