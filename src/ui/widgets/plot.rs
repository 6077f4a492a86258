//! Settings shared by all plots, and a bar that shows a scale of colours.

use egui::{
    Align2, AsIdSalt, Color32, FontId, Rangef, Rect, Role, Sense, StrokeKind, Ui, WidgetInfo, pos2,
    vec2,
};
use egui_plot::{AxisHints, GridMark, Plot, PlotBounds, PlotUi};

/// A plot that the mouse cannot pan or zoom; `height` is in points.
pub(in crate::ui) fn still<'a>(id: impl AsIdSalt, height: f32) -> Plot<'a> {
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

/// Shows the colours of a scale from 0 to 1 with marks below, each at its place on the scale.
/// `summary` is the tooltip and the accessible name.
pub(in crate::ui) fn colour_bar(
    ui: &mut Ui,
    summary: &str,
    colour: impl Fn(f32) -> Color32,
    marks: &[(f32, &str)],
) {
    const HEIGHT: f32 = 30.0;
    const STEPS: usize = 64;
    let (rect, response) =
        ui.allocate_exact_size(vec2(ui.available_width(), HEIGHT), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, summary));
    let painter = ui.painter();
    let bar = rect.shrink2(vec2(8.0, 0.0)).with_max_y(rect.top() + 10.0);
    for step in 0..STEPS {
        let [from, to] = [step, step + 1].map(|step| step as f32 / STEPS as f32);
        let [left, right] = [from, to].map(|part| bar.left() + part * bar.width());
        let part = Rect::from_x_y_ranges(left..=right, bar.y_range());
        painter.rect_filled(part, 0.0, colour(0.5 * (from + to)));
    }
    // Its colours may end in that of the ground.
    let edge = ui.visuals().widgets.noninteractive.bg_stroke;
    painter.rect_stroke(bar, 0.0, edge, StrokeKind::Outside);
    let font = FontId::proportional(12.0);
    for (place, text) in marks {
        let at = pos2(bar.left() + bar.width() * place, bar.bottom() + 4.0);
        let weak = ui.visuals().weak_text_color();
        painter.vline(at.x, bar.bottom()..=bar.bottom() + 3.0, (1.0, weak));
        painter.text(at, Align2::CENTER_TOP, text, font.clone(), weak);
    }
    response.on_hover_text(summary);
}
