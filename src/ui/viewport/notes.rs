//! Notes over the view: why a target is not reached, with a button that helps; the hint "Drag the
//! hand"; the switch that lets heads follow the mouse; what the colours of a globe mean.

use egui::{
    Align2, Area, FontId, Frame, Id, Label, Order, Pos2, Rect, RichText, Role, Sense, Stroke, Ui,
    Vec2, WidgetInfo, pos2, vec2,
};

use crate::document::Overlay;
use crate::rig::LimbPart;
use crate::session::{Actions, Session, SkinEdit, TransactionAction};
use crate::ui::gizmo::screen::ScreenProjection;
use crate::ui::{panels, pose_summary, style, widgets};

/// Width of the text, in points.
const WIDTH: f32 = 232.0;
/// Distance from the target, in points, clear of its arrows.
const DISTANCE: Vec2 = vec2(56.0, 36.0);
/// Distance within which the note hides a point, in points.
const CLEAR: f32 = 12.0;
/// Size before the note was shown.
const SIZE: Vec2 = vec2(WIDTH + 14.0, 108.0);

pub(in crate::ui) fn why_not_reached(
    ui: &Ui,
    session: &Session,
    screen: &ScreenProjection,
    actions: &mut Actions,
) {
    let is_shown = session.rig().sole_limb().is_none()
        && session.crowd().is_none()
        && session.solvers().runs().next().is_none();
    let Some(found) = pose_summary::found(ui, session).first().filter(|_| is_shown) else { return };
    let Some(report) = session.posed().target_report(found.target) else { return };
    let Some(target) = screen.place(report.position) else { return };
    let id = Id::unique("why not reached");
    let size = ui.memory(|memory| memory.area_rect(id)).map_or(SIZE, |rect| rect.size());
    let room = screen.rect.shrink(8.0);
    let joints = session.skeleton_pose();
    let points = joints.ids().flat_map(|joint| {
        let (base, tip) = (joints.base(joint), joints.tip(joint));
        [base, base.midpoint(tip), tip].map(|point| screen.place(point))
    });
    let bones: Vec<Pos2> = points.flatten().collect();
    let at = place(target.clamp(room.min, room.max), size, room, &bones);
    Area::new(id).order(Order::Middle).fixed_pos(at.min).constrain_to(room).show(ui.ctx(), |ui| {
        Frame::popup(ui.style()).show(ui, |ui| {
            ui.set_width(WIDTH);
            pose_summary::cause(ui, session, found);
            pose_summary::remedies(ui, session, found, 1, actions);
        });
    });
}

/// Of the places beside the target that are in the view, the one that hides the fewest of `points`.
fn place(target: Pos2, size: Vec2, room: Rect, points: &[Pos2]) -> Rect {
    let sides = [vec2(1.0, 0.0), vec2(-1.0, 0.0), vec2(0.0, 1.0), vec2(0.0, -1.0)];
    let corners = [vec2(1.0, 1.0), vec2(-1.0, 1.0), vec2(1.0, -1.0), vec2(-1.0, -1.0)];
    let beside = |side: Vec2| {
        moved_into(Rect::from_center_size(target + side * (DISTANCE + size * 0.5), size), room)
    };
    let hidden = |rect: &Rect| {
        let near = rect.expand(CLEAR);
        let of_target = if near.contains(target) { points.len() + 1 } else { 0 };
        of_target + points.iter().filter(|point| near.contains(**point)).count()
    };
    let places = sides.into_iter().chain(corners).map(beside);
    places.min_by_key(hidden).unwrap_or(Rect::from_min_size(room.min, size))
}

const TEXT: &str = "Drag the hand";
/// Corner of the hint from the hand, in points, clear of the arrows.
const OFFSET: Vec2 = vec2(44.0, -78.0);

pub(in crate::ui) fn drag_the_hand(ui: &Ui, session: &Session, screen: &ScreenProjection) {
    let is_alone = session.rig().sole_limb().is_some() && session.crowd().is_none();
    let is_needed = session.tour().is_none() && !session.preferences().has_dragged_hand;
    let limb = session.limb().filter(|limb| is_alone && is_needed && limb.frames.uses_ik());
    let Some(limb) = limb.filter(|_| session.history().drag().is_none()) else { return };
    let cursor = screen.place(limb.frames.origin(LimbPart::Cursor));
    if let Some(hand) = cursor.filter(|at| screen.rect.contains(*at)) {
        paint(ui, screen.rect, hand);
    }
}

fn paint(ui: &Ui, viewport: Rect, hand: Pos2) {
    let painter = ui.painter().with_clip_rect(viewport);
    let (accent, visuals) = (style::accent(ui), ui.visuals());
    let font = FontId::proportional(15.0);
    let text = painter.layout_no_wrap(TEXT.to_owned(), font, visuals.strong_text_color());
    let beside = Rect::from_min_size(hand + OFFSET, text.size() + vec2(20.0, 10.0));
    let tag = moved_into(beside, viewport.shrink(8.0));
    let near = pos2(hand.x.clamp(tag.left() + 8.0, tag.right() - 8.0), tag.bottom());
    let direction = (near - hand).normalized();
    painter.line_segment([hand + 18.0 * direction, near], Stroke::new(1.5, accent));
    painter.rect(tag, 6.0, visuals.panel_fill, Stroke::new(1.5, accent), egui::StrokeKind::Inside);
    let at = Align2::CENTER_CENTER.anchor_size(tag.center(), text.size()).min;
    painter.galley(at, text, visuals.strong_text_color());
    let hint = ui.interact(tag, Id::unique("drag hint"), Sense::hover());
    hint.widget_info(|| WidgetInfo::labeled(Role::Label, true, TEXT));
}

/// The rectangle, moved into `room`.
fn moved_into(rect: Rect, room: Rect) -> Rect {
    let (least, most) = (room.min - rect.min, room.max - rect.max);
    rect.translate(least.max(Vec2::ZERO) + most.min(Vec2::ZERO))
}

/// Distance from the edges of the view, in points.
const MARGIN: f32 = 12.0;

pub(super) fn follow_mouse(ui: &Ui, session: &Session, viewport: Rect, actions: &mut Actions) {
    if !session.can_follow_mouse() {
        return;
    }
    let area = Area::new(Id::unique("follow the mouse")).order(Order::Middle);
    area.fixed_pos(viewport.min + vec2(MARGIN, MARGIN)).show(ui.ctx(), |ui| {
        Frame::popup(ui.style()).show(ui, |ui| {
            let follows = session.history().follows_mouse();
            let tooltip =
                "Let the heads follow the mouse and record it; a click in the view ends it";
            let changed = widgets::check_box(ui, "Follow the mouse", tooltip, follows, None);
            actions.extend(changed.map(TransactionAction::FollowMouse));
        });
    });
}

/// Says what the colours of the singularity globe mean.
pub(super) fn globe_colours(ui: &Ui, session: &Session, viewport: Rect) {
    // Greatest width in points, and part of the width of a narrow view.
    const WIDTH: f32 = 200.0;
    const PART: f32 = 0.4;
    let is_shown = session.shown().display.shows(Overlay::SingularityGlobe);
    let Some(limb) = session.limb().filter(|_| is_shown && session.crowd().is_none()) else {
        return;
    };
    let area = Area::new(Id::unique("colours of the globe")).order(Order::Middle);
    area.fixed_pos(viewport.min + vec2(MARGIN, MARGIN)).show(ui.ctx(), |ui| {
        Frame::popup(ui.style()).show(ui, |ui| {
            ui.set_width(WIDTH.min(PART * viewport.width()));
            panels::globe_legend(ui, limb.words);
        });
    });
}

/// Shows how to add joints, for a skeleton without bones, and for a mesh that does not follow its bones
/// yet.
pub(super) fn how_to_add_joints(ui: &Ui, session: &Session, viewport: Rect, actions: &mut Actions) {
    let has_bones = session.rig().has_bones();
    let [first, then] = match (session.has_loose_mesh(), has_bones, session.selection().active()) {
        (false, true, _) => return,
        (false, false, _) => {
            ["Click to place the first joint", "Ctrl+click or A adds the next joint"]
        }
        (true, true, _) => {
            ["Ctrl+click on the mesh to add joints", "Bound, the mesh follows the bones"]
        }
        (true, false, None) => {
            ["Click on the mesh to place the first joint", "It goes to the middle of the body"]
        }
        (true, false, Some(_)) => {
            ["Click on the mesh to place the next joint", "A bone leads to it from the first one"]
        }
    };
    let area = Area::new(Id::unique("how to add joints")).order(Order::Middle);
    let top = viewport.center_top() + vec2(0.0, MARGIN);
    area.pivot(Align2::CENTER_TOP).fixed_pos(top).show(ui.ctx(), |ui| {
        ui.vertical_centered(|ui| {
            let line = |text: &str, size: f32| {
                Label::new(RichText::new(text).size(size)).selectable(false).extend()
            };
            ui.add(line(first, 18.0));
            ui.add(line(then, 13.5));
            if has_bones && widgets::button(ui, "Bind mesh", panels::BIND, None) {
                actions.push(SkinEdit::Bind);
            }
        });
    });
}

/// Says what a thread computes that the view does not show yet: the pose of the motion, or a reach
/// region.
pub(super) fn in_the_background(ui: &Ui, session: &Session, viewport: Rect) {
    let text = if session.posed().is_provisional() {
        "Provisional pose: the motion until here is being computed"
    } else if session.is_finding_reach_region() {
        "Finding where the target can be reached"
    } else {
        return;
    };
    let area = Area::new(Id::unique("in the background")).order(Order::Middle);
    let corner = viewport.left_bottom() + vec2(MARGIN, -MARGIN);
    area.pivot(Align2::LEFT_BOTTOM).fixed_pos(corner).show(ui.ctx(), |ui| {
        Frame::popup(ui.style()).show(ui, |ui| {
            ui.label(text);
        });
    });
}
