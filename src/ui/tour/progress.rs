//! The steps of the tour as a row of dots.

use egui::{Color32, Pos2, Response, Role, Sense, Stroke, Ui, WidgetInfo, vec2};

use crate::session::{Actions, TourAction, TourState, TourStep};
use crate::ui::style;

/// Width and height of a dot's button, in points.
const CELL: f32 = 15.0;

/// Shows a dot for each step: filled where the user has done the task, ringed for the present step.
pub(super) fn progress(ui: &mut Ui, tour: &TourState, actions: &mut Actions) {
    ui.spacing_mut().item_spacing.x = 0.0;
    for (number, step) in TourStep::all().iter().enumerate() {
        let name = format!("Step {}: {}", number + 1, step.title);
        let is_done = tour.is_done(number);
        let state = if is_done { "done" } else { "not done yet" };
        let dot = dot(ui, number == tour.number(), is_done);
        dot.widget_info(|| WidgetInfo::labeled(Role::Button, true, &name));
        if dot
            .on_hover_text(format!("Go to step {}, {}: {state}", number + 1, step.title))
            .clicked()
        {
            actions.push(TourAction::Enter(number));
        }
    }
}

fn dot(ui: &mut Ui, is_now: bool, is_done: bool) -> Response {
    let (rect, response) = ui.allocate_exact_size(vec2(CELL, CELL), Sense::click());
    let accent = style::accent(ui);
    let colour = match is_now || is_done {
        true => accent,
        false => ui.visuals().weak_text_color(),
    };
    let fill = if is_done { colour } else { Color32::TRANSPARENT };
    ui.painter().circle(rect.center(), 3.5, fill, Stroke::new(1.2, colour));
    if is_now || response.has_focus() || response.hovered() {
        ring(ui, rect.center(), colour);
    }
    response
}

fn ring(ui: &Ui, centre: Pos2, colour: Color32) {
    ui.painter().circle_stroke(centre, 6.5, Stroke::new(1.2, colour));
}
