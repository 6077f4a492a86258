//! The view of the scene: what the pointer does in it.

mod navigation;
pub(in crate::ui) mod projection;

use projection::ScreenProjection;

use egui::{
    Event, EventFilter, Label, PointerButton, Pos2, Rect, Response, RichText, Role, Sense,
    TextureId, Ui, WidgetInfo, pos2, vec2,
};

use crate::document::{Camera, RigKind};
use crate::session::{
    Action, Actions, Drag, DragInput, EditAction, Grip, Motion, PlaybackAction, SelectAction,
    Session, TransactionAction, ViewAction,
};
use crate::ui::gizmo::{Gizmo, view_axes};
use crate::ui::keyboard::{self, focus};
use crate::ui::{commands, pose_summary};
use navigation::{motion, show_cursor, wheel};

pub(in crate::ui) fn ui(
    ui: &mut Ui,
    session: &Session,
    picture: Option<TextureId>,
    actions: &mut Actions,
) -> Rect {
    let rect = whole_pixels(ui, ui.available_rect_before_wrap());
    let response = ui.allocate_rect(rect, Sense::click_and_drag());
    response.widget_info(|| {
        let text = format!("Viewport. {}", pose_summary::summary(session));
        WidgetInfo::labeled(Role::Image, true, text)
    });
    if let Some(texture) = picture {
        let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        ui.painter().image(texture, rect, whole, egui::Color32::WHITE);
    }
    advance(ui, &response, session, actions);

    let picture = ScreenProjection::new(rect, session.camera());
    let grips = Gizmo::new(&picture, session);
    let pointer = ui.input(|input| input.pointer.latest_pos());
    let held_grip = session.drag().map(Drag::grip);

    let on_compass = pointer.is_some_and(|at| view_axes::covers(rect, at));
    let over = response.contains_pointer() && !on_compass;
    let pointed = pointer.filter(|_| over).and_then(|at| grips.at(at));
    grips.paint(&ui.painter().with_clip_rect(rect), ui, pointed, held_grip);
    view_axes::ui(ui, rect, session, actions);
    if has_joints(session) && !session.skeleton_rig().has_bones() {
        invite(ui, rect);
    }

    let Some(pointer) = pointer else {
        keys(ui, &response, session, actions);
        return rect;
    };
    let held = press(ui, &response, session, &picture, &grips, actions);
    follow(ui, held, &picture, pointer, actions);
    if response.contains_pointer() {
        wheel(ui, session, &picture, pointer, actions);
    }
    if over && matches!(held, ViewportDrag::Nothing) {
        point(session, grips.joint_at(pointer), actions);
    }
    if has_joints(session) && response.clicked() && !on_compass {
        select(ui, session, &picture, &grips, pointer, actions);
    }
    if response.double_clicked() && !on_compass {
        actions.push(match pointed {
            Some(_) => commands::frame_selection(session),
            None if grips.joint_at(pointer).is_some() => commands::frame_selection(session),
            None => ViewAction::GlideTo(match session.rig() {
                RigKind::Arm if session.crowd().is_none() => Camera::default(),
                _ => session.framing_all(),
            })
            .into(),
        });
    }
    show_cursor(ui, session, pointed.or(held_grip));
    keys(ui, &response, session, actions);
    rect
}

fn has_joints(session: &Session) -> bool {
    session.rig() == RigKind::Skeleton && session.crowd().is_none()
}

/// Says how to begin, where there is nothing to see yet.
fn invite(ui: &mut Ui, rect: Rect) {
    let line = |text: &str, size: f32| Label::new(RichText::new(text).size(size)).selectable(false);
    let at = Rect::from_center_size(rect.center_top() + vec2(0.0, 64.0), vec2(360.0, 24.0));
    ui.put(at, line("Click to place the first joint", 18.0));
    ui.put(at.translate(vec2(0.0, 26.0)), line("Ctrl+click or A adds the next joint", 13.5));
}

/// Says which joint the pointer is on.
fn point(session: &Session, joint: Option<usize>, actions: &mut Actions) {
    if session.pointed() != joint {
        actions.push(SelectAction::Hover(joint));
    }
}

/// A click selects the joint under the mouse, Shift adds it to the selection or removes it; a click
/// beside all joints selects none. Ctrl adds a bone that ends at the mouse, as does the first click
/// of a skeleton without bones.
fn select(
    ui: &Ui,
    session: &Session,
    picture: &ScreenProjection,
    grips: &Gizmo,
    pointer: Pos2,
    actions: &mut Actions,
) {
    let modifiers = ui.input(|input| input.modifiers);
    let joint = match grips.at(pointer) {
        Some(Grip::Target(joint, _) | Grip::Tip(joint, _)) => Some(joint),
        Some(Grip::Ring(..)) => return,
        _ => grips.joint_at(pointer),
    };
    let is_first = joint.is_none() && !session.skeleton_rig().has_bones();
    if modifiers.command || is_first && modifiers.is_none() {
        let base = session.next_base();
        let at = picture.ray(pointer).meets_plane(base, picture.projection.forward);
        actions.extend(at.map(|tip| EditAction::AddJoint { tip: Some(tip) }));
        return;
    }
    let mut selection = if modifiers.shift { session.selection().to_vec() } else { Vec::new() };
    if let Some(joint) = joint {
        let was_selected = selection.contains(&joint);
        selection.retain(|other| *other != joint);
        if !was_selected {
            selection.push(joint);
        }
    }
    if selection != session.selection() {
        actions.push(SelectAction::Joints(selection));
    }
}

/// On whole pixels, so that the picture is shown pixel for pixel.
fn whole_pixels(ui: &Ui, rect: Rect) -> Rect {
    let scale = ui.pixels_per_point();
    let round = |at: Pos2| pos2((at.x * scale).round() / scale, (at.y * scale).round() / scale);
    Rect::from_min_max(round(rect.min), round(rect.max))
}

/// Lets all that moves by itself go on. Any input ends a glide of the view: a press in the viewport
/// takes hold of the view as it is by then, all else brings it to where it was going.
fn advance(ui: &Ui, response: &Response, session: &Session, actions: &mut Actions) {
    if !session.is_moving() {
        return;
    }
    let is_input = |event: &Event| match event {
        Event::PointerButton { pressed, .. } => *pressed && !response.contains_pointer(),
        Event::Key { pressed, .. } => *pressed,
        Event::MouseWheel { .. } | Event::Zoom(_) => true,
        _ => false,
    };
    if session.is_gliding() && ui.input(|input| input.events.iter().any(is_input)) {
        actions.push(ViewAction::SetCamera(session.settled_camera()));
    }
    actions.push(PlaybackAction::Advance(ui.input(|input| input.time)));
    ui.request_repaint();
}

/// What the pointer holds.
#[derive(Clone, Copy)]
enum ViewportDrag {
    Nothing,
    Grip,
    View,
}

/// What is held, be it since before or by a press in this very frame.
fn press(
    ui: &Ui,
    response: &Response,
    session: &Session,
    picture: &ScreenProjection,
    grips: &Gizmo,
    actions: &mut Actions,
) -> ViewportDrag {
    let mut held = match (session.drag(), session.view_drag()) {
        (Some(_), _) => ViewportDrag::Grip,
        (None, Some(_)) => ViewportDrag::View,
        (None, None) => ViewportDrag::Nothing,
    };
    for event in ui.input(|input| input.events.clone()) {
        let Event::PointerButton { pos, button, pressed: true, modifiers } = event else {
            continue;
        };
        if button == PointerButton::Secondary && session.is_editing() {
            // Wherever the pointer is by then.
            actions.push(TransactionAction::Cancel);
        }
        if !response.contains_pointer() {
            continue;
        }
        response.request_focus();
        if session.is_editing() || !matches!(held, ViewportDrag::Nothing) {
            continue;
        }
        let on_compass = view_axes::covers(picture.rect, pos);
        let can_take = button == PointerButton::Primary && !modifiers.alt && !on_compass;
        // Ctrl and Shift make a click on a skeleton say something else.
        let is_click = session.rig() == RigKind::Skeleton && (modifiers.command || modifiers.shift);
        let grip = grips.at(pos).filter(|_| can_take && !is_click);
        let motion = match motion(session.preferences().navigation, button, modifiers) {
            None if on_compass && button == PointerButton::Primary => Some(Motion::Orbit),
            motion => motion,
        };
        if let Some(grip) = grip {
            let (ray, forward) = (picture.ray(pos), picture.projection.forward);
            actions.push(TransactionAction::Grab { grip, ray, forward });
            held = ViewportDrag::Grip;
        } else if let Some(motion) = motion {
            actions.push(ViewAction::Grab(motion, picture.normalised(pos)));
            held = ViewportDrag::View;
        }
    }
    held
}

/// What is held follows the pointer, and is dropped where the button is let go.
fn follow(
    ui: &Ui,
    held: ViewportDrag,
    picture: &ScreenProjection,
    pointer: Pos2,
    actions: &mut Actions,
) {
    let (down, modifiers) = ui.input(|input| (input.pointer.any_down(), input.modifiers));
    let released = !down || ui.input(|input| input.pointer.any_released());
    let (moved, dropped): (Action, Action) = match held {
        ViewportDrag::Nothing => return,
        ViewportDrag::Grip => {
            let ray = picture.ray(pointer);
            let input = DragInput { ray, precise: modifiers.shift, snap: modifiers.command };
            (TransactionAction::Drag(input).into(), TransactionAction::Commit.into())
        }
        ViewportDrag::View => {
            let (to, aspect) = (picture.normalised(pointer), picture.rect.aspect_ratio());
            (ViewAction::Drag { to, aspect }.into(), ViewAction::Drop.into())
        }
    };
    actions.push(moved);
    if released {
        actions.push(dropped);
    }
}

/// Single keys act while no widget or the viewport itself has the keyboard.
fn keys(ui: &Ui, response: &Response, session: &Session, actions: &mut Actions) {
    let free = ui.memory(|memory| memory.focused().is_none()) || response.has_focus();
    if free || session.drag().is_some() {
        keyboard::viewport::viewport(ui, session, actions);
    }
    if response.has_focus() {
        focus::leave_space(ui, response.id);
        let arrows =
            EventFilter { horizontal_arrows: true, vertical_arrows: true, ..Default::default() };
        ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, arrows));
        keyboard::viewport::turn(ui, session, response.rect.aspect_ratio(), actions);
    }
}
