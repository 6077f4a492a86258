//! The reach of the hand as a bar.

use egui::{Sense, Ui, vec2};

use crate::document::ShownLength;
use crate::kinematics::soft_reach::ReachLimits;
use crate::session::Session;
use crate::ui::style;
use crate::ui::widgets::format;

/// Draws the inner limit, the reachable range and the Cursor along a bar from the shoulder.
pub(in crate::ui) fn ui(ui: &mut Ui, session: &Session) {
    const HEIGHT: f32 = 44.0;
    const BAR: f32 = 8.0;
    const BEYOND: f32 = 1.25;
    let arm = session.arm();
    let ReachLimits { inner, outer } = arm.reach_limits();
    let decimals = format::decimals_of_cell(arm.grid_cell());
    let shown = |length: f32| ShownLength { length, decimals }.to_string();
    let (what, distance) = match arm.uses_ik() {
        true => ("Cursor", arm.cursor_in_root().length()),
        false => ("Hand", session.pose().distance),
    };
    let (rect, response) =
        ui.allocate_exact_size(vec2(ui.available_width(), HEIGHT), Sense::hover());
    let bar = egui::Rect::from_min_size(
        rect.left_top() + vec2(6.0, 10.0),
        vec2(rect.width() - 12.0, BAR),
    );
    let place =
        |distance: f32| bar.left() + bar.width() * (distance / (outer * BEYOND)).clamp(0.0, 1.0);
    let visuals = ui.visuals();
    let accent = style::accent(ui);
    let painter = ui.painter();
    painter.rect_filled(bar, 4.0, visuals.widgets.inactive.bg_fill);
    let within = egui::Rect::from_x_y_ranges(place(inner)..=place(outer), bar.top()..=bar.bottom());
    painter.rect_filled(within, 2.0, accent.gamma_multiply(0.55));
    let cursor = place(distance);
    painter.circle_filled(egui::pos2(cursor, bar.center().y), 6.0, visuals.strong_text_color());
    painter.circle_filled(egui::pos2(cursor, bar.center().y), 3.0, visuals.panel_fill);
    let font = egui::FontId::proportional(12.0);
    let written = |at: f32, anchor, text: String| {
        let at = egui::pos2(at, bar.bottom() + 6.0);
        painter.text(at, anchor, text, font.clone(), visuals.weak_text_color());
    };
    // On a short bar the two numbers would overlap.
    let apart = place(outer) - place(inner) > 60.0;
    if apart && inner > 0.0 {
        written(place(inner), egui::Align2::CENTER_TOP, shown(inner));
    }
    written(place(outer), egui::Align2::CENTER_TOP, shown(outer));
    let [distance, inner, outer] = [distance, inner, outer].map(|it| arm.format_length(it));
    let summary = format!("{what} at {distance}; the hand reaches from {inner} to {outer}");
    response.widget_info(|| {
        egui::WidgetInfo::labeled(egui::Role::Label, true, format!("Reach: {summary}"))
    });
    response.on_hover_text(summary);
}
