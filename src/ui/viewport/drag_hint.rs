//! "Drag the hand", beside the hand until it was dragged once.

use egui::{Align2, FontId, Id, Pos2, Rect, Role, Sense, Stroke, Ui, WidgetInfo, pos2, vec2};

use super::projection::ScreenProjection;
use crate::document::RigKind;
use crate::session::Session;
use crate::ui::style;

const TEXT: &str = "Drag the hand";
/// Corner of the hint from the hand, in points, clear of the arrows.
const OFFSET: egui::Vec2 = vec2(44.0, -78.0);

pub(in crate::ui) fn ui(ui: &Ui, session: &Session, screen: &ScreenProjection) {
    let (arm, preferences) = (session.arm(), session.preferences());
    let is_arm = session.rig() == RigKind::Arm && session.crowd().is_none();
    let is_needed =
        session.tour().is_none() && is_arm && arm.uses_ik() && !preferences.has_dragged_hand;
    if !is_needed || session.drag().is_some() {
        return;
    }
    if let Some(hand) = screen.place(arm.cursor_in_world()).filter(|at| screen.rect.contains(*at)) {
        paint(ui, screen.rect, hand);
    }
}

fn paint(ui: &Ui, viewport: Rect, hand: Pos2) {
    let painter = ui.painter().with_clip_rect(viewport);
    let (accent, visuals) = (style::accent(ui), ui.visuals());
    let font = FontId::proportional(15.0);
    let text = painter.layout_no_wrap(TEXT.to_owned(), font, visuals.strong_text_color());
    let tag = Rect::from_min_size(hand + OFFSET, text.size() + vec2(20.0, 10.0));
    let tag = tag.translate(into(tag, viewport.shrink(8.0)));
    let near = pos2(hand.x.clamp(tag.left() + 8.0, tag.right() - 8.0), tag.bottom());
    let direction = (near - hand).normalized();
    painter.line_segment([hand + 18.0 * direction, near], Stroke::new(1.5, accent));
    painter.rect(tag, 6.0, visuals.panel_fill, Stroke::new(1.5, accent), egui::StrokeKind::Inside);
    let at = Align2::CENTER_CENTER.anchor_size(tag.center(), text.size()).min;
    painter.galley(at, text, visuals.strong_text_color());
    let hint = ui.interact(tag, Id::unique("drag hint"), Sense::hover());
    hint.widget_info(|| WidgetInfo::labeled(Role::Label, true, TEXT));
}

/// The shift that brings `tag` into `room`.
fn into(tag: Rect, room: Rect) -> egui::Vec2 {
    let least = (room.min - tag.min).max(egui::Vec2::ZERO);
    let most = (room.max - tag.max).min(egui::Vec2::ZERO);
    least + most
}
