//! Settings shared by all plots.

use egui::{Rangef, Ui};
use egui_plot::{AxisHints, GridMark, Plot, PlotBounds, PlotUi};

/// A plot that the mouse cannot pan or zoom; `height` is in points.
pub(in crate::ui) fn still<'a>(id: &'static str, height: f32) -> Plot<'a> {
    Plot::new(id)
        .height(height)
        .show_background(false)
        .show_x(false)
        .show_y(false)
        .allow_drag(false)
        .allow_zoom(false)
        .allow_scroll(false)
        .allow_boxed_zoom(false)
        .allow_double_click_reset(false)
        .set_margin_fraction(egui::Vec2::ZERO)
}

/// Sets the visible range of the plot to exactly `bounds`.
pub(in crate::ui) fn show(plot: &mut PlotUi<'_>, bounds: PlotBounds) {
    plot.set_auto_bounds(egui::Vec2b::FALSE);
    plot.set_plot_bounds(bounds);
}

/// An axis with a label at every grid mark; `written` formats the value of a mark.
pub(in crate::ui) fn axis<'a>(
    ui: &Ui,
    axis: AxisHints<'a>,
    written: impl Fn(f64) -> String + 'a,
) -> AxisHints<'a> {
    axis.formatter(move |mark, _| written(mark.value))
        .label_spacing(Rangef::new(0.5, 1.0))
        .tick_label_color(ui.visuals().weak_text_color())
        .tick_label_font(egui::FontId::proportional(11.0))
        .min_thickness(12.0)
}

/// Grid marks at the given values.
pub(in crate::ui) fn marks(values: &[f64]) -> Vec<GridMark> {
    let step_size = 1.0;
    values.iter().map(|value| GridMark { value: *value, step_size }).collect()
}
