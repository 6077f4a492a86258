//! The offer of the tour, in the lower left of the view.

use egui::{Align2, Area, Frame, Id, Order, Rect, RichText, Ui, vec2};

use crate::session::{Actions, TourAction, TourStep};
use crate::ui::widgets;

/// Distance from the edges of the view, in points.
const MARGIN: f32 = 16.0;

pub(in crate::ui) fn offer(ui: &Ui, viewport: Rect, actions: &mut Actions) {
    Area::new(Id::unique("offer of the tour"))
        .order(Order::Middle)
        .pivot(Align2::LEFT_BOTTOM)
        .fixed_pos(viewport.left_bottom() + vec2(MARGIN, -MARGIN))
        .show(ui.ctx(), |ui| {
            Frame::window(ui.style()).show(ui, |ui| contents(ui, actions));
        });
}

fn contents(ui: &mut Ui, actions: &mut Actions) {
    let steps = TourStep::all().len();
    ui.label(RichText::new("New to inverse kinematics?").strong());
    ui.label(format!("See how it works, in {steps} short steps."));
    ui.add_space(4.0);
    ui.horizontal(|ui| {
        let take = widgets::primary_button(ui, "Take the tour", None);
        if take.on_hover_text("Begin the tour; your document is kept").clicked() {
            actions.push(TourAction::Enter(0));
        }
        let play = ui.button("Just play");
        if play.on_hover_text("Close this for good; Help → Tour has it too").clicked() {
            actions.push(TourAction::Decline);
        }
    });
}
