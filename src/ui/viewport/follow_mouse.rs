//! The switch that lets heads follow the mouse, in the upper left of the view.

use egui::{Area, Frame, Id, Order, Rect, Ui, vec2};

use crate::session::{Actions, Session, TransactionAction};

/// Distance from the edges of the view, in points.
const MARGIN: f32 = 12.0;

pub(super) fn ui(ui: &Ui, session: &Session, viewport: Rect, actions: &mut Actions) {
    if !session.can_follow_mouse() {
        return;
    }
    let area = Area::new(Id::unique("follow the mouse")).order(Order::Middle);
    area.fixed_pos(viewport.min + vec2(MARGIN, MARGIN)).show(ui.ctx(), |ui| {
        Frame::popup(ui.style()).show(ui, |ui| {
            let mut follows = session.follows_mouse();
            let tooltip =
                "Let the heads follow the mouse and record it; a click in the view ends it";
            if ui.checkbox(&mut follows, "Follow the mouse").on_hover_text(tooltip).changed() {
                actions.push(TransactionAction::FollowMouse(follows));
            }
        });
    });
}
