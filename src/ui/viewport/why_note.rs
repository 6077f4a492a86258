//! A note beside a target that is not reached: why, and a button that helps.

use egui::{Area, Frame, Id, Order, Pos2, Rect, Ui, Vec2, vec2};

use super::projection::ScreenProjection;
use crate::document::RigKind;
use crate::session::{Actions, Session};
use crate::ui::why;

/// Width of the text, in points.
const WIDTH: f32 = 232.0;
/// Distance from the target, in points, clear of its arrows.
const DISTANCE: Vec2 = vec2(56.0, 36.0);
/// Distance within which the note hides a point, in points.
const CLEAR: f32 = 12.0;
/// Size before the note was shown.
const SIZE: Vec2 = vec2(WIDTH + 14.0, 108.0);

pub(in crate::ui) fn ui(
    ui: &Ui,
    session: &Session,
    screen: &ScreenProjection,
    actions: &mut Actions,
) {
    let is_shown = session.rig() == RigKind::Skeleton
        && session.crowd().is_none()
        && session.solver_runs().next().is_none();
    let Some(found) = why::found(ui, session).first().filter(|_| is_shown) else { return };
    let Some(report) = session.target_report(found.target) else { return };
    let Some(target) = screen.place(report.position) else { return };
    let id = Id::unique("why not reached");
    let size = ui.memory(|memory| memory.area_rect(id)).map_or(SIZE, |rect| rect.size());
    let room = screen.rect.shrink(8.0);
    let joints = session.skeleton_pose();
    let bones = joints.ids().flat_map(|joint| {
        let (base, tip) = (joints.base(joint), joints.tip(joint));
        [base, base.midpoint(tip), tip].map(|point| screen.place(point))
    });
    let bones: Vec<Pos2> = bones.flatten().collect();
    let at = place(target.clamp(room.min, room.max), size, room, &bones);
    Area::new(id).order(Order::Middle).fixed_pos(at.min).constrain_to(room).show(ui.ctx(), |ui| {
        Frame::popup(ui.style()).show(ui, |ui| {
            ui.set_width(WIDTH);
            why::cause(ui, session, found);
            why::remedies(ui, session, found, 1, actions);
        });
    });
}

/// Of the places beside the target that are in the view, the one that hides the fewest of `points`.
fn place(target: Pos2, size: Vec2, room: Rect, points: &[Pos2]) -> Rect {
    let sides = [vec2(1.0, 0.0), vec2(-1.0, 0.0), vec2(0.0, 1.0), vec2(0.0, -1.0)];
    let corners = [vec2(1.0, 1.0), vec2(-1.0, 1.0), vec2(1.0, -1.0), vec2(-1.0, -1.0)];
    let beside = |side: Vec2| {
        let rect = Rect::from_center_size(target + side * (DISTANCE + size * 0.5), size);
        rect.translate(
            (room.min - rect.min).max(Vec2::ZERO) + (room.max - rect.max).min(Vec2::ZERO),
        )
    };
    let hidden = |rect: &Rect| {
        let near = rect.expand(CLEAR);
        let of_target = if near.contains(target) { points.len() + 1 } else { 0 };
        of_target + points.iter().filter(|point| near.contains(**point)).count()
    };
    let places = sides.into_iter().chain(corners).map(beside);
    places.min_by_key(hidden).unwrap_or(Rect::from_min_size(room.min, size))
}
