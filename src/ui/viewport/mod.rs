//! The viewport: gizmos, selection, orbit, pan and zoom.

mod navigation;
mod notes;

use core::f32::consts::TAU;

use egui::{
    Event, Id, InputState, PointerButton, Pos2, Rect, Response, Role, Sense, TouchPhase, Ui, Vec2,
    WidgetInfo, pos2,
};
use glam::Vec3;

use super::gizmo::screen::ScreenProjection;
use super::gizmo::{Gizmo, aims, freedom, limb_of_page, locked_axis};
use super::keyboard::{self, focus};
use super::{commands, pose_summary, status_bar};
use crate::document::Ray;
use crate::kinematics::skeleton::JointId;
use crate::session::{
    Action, Actions, CameraMotion, Drag, DragInput, Grip, JointEdit, PlaybackAction, PointHandle,
    SelectAction, Session, SkinEdit, TransactionAction, ViewAction,
};
pub(in crate::ui) use navigation::CORNER_AXES;
use navigation::{covers_view_axes, motion, show_cursor, two_fingers, view_axes, wheel};

/// Width in points of the strip at each edge of the view in which the mouse grabs the panel beside
/// it.
const PANEL_EDGE: f32 = 4.0;

pub(in crate::ui) fn ui(ui: &mut Ui, session: &Session, actions: &mut Actions) -> Rect {
    // The notes below and the status bar read the diagnosis that this call makes.
    pose_summary::found(ui, session);
    let rect = whole_pixels(ui, ui.available_rect_before_wrap());
    // The edges are those of the resizable panels beside the view.
    let inside = rect.shrink(PANEL_EDGE);
    let response = ui.allocate_rect(inside, Sense::click_and_drag());
    response.widget_info(|| {
        let text = format!("Viewport. {}", pose_summary::summary(session));
        WidgetInfo::labeled(Role::Image, true, text)
    });
    advance(ui, &response, session, actions);

    let screen = ScreenProjection::new(rect, session.camera());
    let gizmo = Gizmo::new(&screen, session);
    let mouse = ui.input(|input| input.pointer.latest_pos());
    let held_grip = session.history().drag().map(Drag::grip);

    let on_view_axes = mouse.is_some_and(|at| covers_view_axes(rect, at));
    let over = response.contains_pointer() && !on_view_axes;
    let is_held = (held_grip.is_some() || session.view().drag().is_some())
        && !ui.input(|input| input.pointer.any_released());
    let free_mouse = mouse.filter(|_| over && !is_held);
    let found = free_mouse.map(|at| pointed_at(session, &screen, &gizmo, at));
    let Pointed { grip: pointed, lit } = found.unwrap_or_default();
    status_bar::set_pointed(ui, pointed);
    if held_grip.is_none() && session.view().drag().is_none() {
        light_up(ui, session, lit, actions);
    }
    notes::drag_the_hand(ui, session, &screen);
    if session.crowd().is_none() {
        limb_of_page(&ui.painter().with_clip_rect(rect), ui, &screen, session);
        aims(&ui.painter().with_clip_rect(rect), ui, &screen, session);
    }
    locked_axis(&ui.painter().with_clip_rect(rect), ui, &screen, session);
    freedom(&ui.painter().with_clip_rect(rect), ui, &screen, session);
    gizmo.paint(&ui.painter().with_clip_rect(rect), ui, pointed, held_grip);
    view_axes(ui, rect, session, actions);
    notes::why_not_reached(ui, session, &screen, actions);
    notes::follow_mouse(ui, session, rect, actions);
    notes::globe_colours(ui, session, rect);
    notes::in_the_background(ui, session, rect);
    if has_joints(session) {
        notes::how_to_add_joints(ui, session, rect, actions);
    }

    wiggle(ui, session, pointed.filter(|_| held_grip.is_none()), actions);
    let Some(mouse) = mouse.or_else(|| lifted_from(ui)) else {
        keys(ui, &response, session, actions);
        return rect;
    };
    if over && session.history().follows_mouse() {
        actions.push(TransactionAction::Lead(screen.ray(mouse)));
    }
    let drag = press(ui, &response, session, &screen, &gizmo, actions);
    if !two_fingers(ui, session, &screen, &response, actions) {
        follow(ui, drag, &screen, mouse, actions);
    }
    if response.contains_pointer() {
        wheel(ui, session, &screen, mouse, actions);
    }
    if has_joints(session) && response.clicked() && !on_view_axes {
        select(ui, session, &screen, &gizmo, mouse, actions);
    }
    if response.double_clicked() && !on_view_axes {
        let is_on_body = pointed.is_some() || joint_at(session, &screen, &gizmo, mouse).is_some();
        let is_measured = session.shown().measured_limb().is_some();
        actions.push(match is_on_body {
            true => commands::frame_selection(session),
            false if is_measured && session.crowd().is_none() => {
                ViewAction::GlideTo(session.shown().framing_camera())
            }
            false => commands::frame_all(session),
        });
    }
    show_cursor(ui, session, pointed.or(held_grip));
    if let Some(hint) = pointed.and_then(|grip| hint(session, grip)) {
        response.clone().on_hover_text_at_pointer(hint);
    }
    keys(ui, &response, session, actions);
    rect
}

/// Tooltip of a handle or part of a limb that shows more when it is clicked; `None` for others,
/// while its joint is selected, and during a drag.
fn hint(session: &Session, grip: Grip) -> Option<&'static str> {
    let (rig, selected) = (session.rig(), session.selection().active());
    rig.sole_limb()?;
    match grip {
        _ if session.history().is_editing() => None,
        Grip::Tip(joint, _) if rig.skeleton.joint(joint)?.is_root_point() => {
            (selected != Some(joint)).then_some("Move the Root; click to show its arrows")
        }
        Grip::LimbTwist(joint) if selected != Some(joint) => {
            Some("Turn the elbow about the Pointer (Socket twist)")
        }
        Grip::Target(joint, PointHandle::Free) if selected != rig.end_of_target(joint) => {
            Some("Move the hand; click to show the rings that turn it")
        }
        _ => None,
    }
}

fn has_joints(session: &Session) -> bool {
    session.crowd().is_none()
}

/// Things under the mouse: the grip that a press would drag, and the joint that lights up.
#[derive(Clone, Copy, Default)]
struct Pointed {
    grip: Option<Grip>,
    lit: Option<JointId>,
}

/// The handle at the mouse, or else the bone or skin there that can be dragged.
fn pointed_at(session: &Session, screen: &ScreenProjection, gizmo: &Gizmo, mouse: Pos2) -> Pointed {
    let can_drag = |grip: &Grip| match grip {
        Grip::Tip(joint, _) => Grip::can_drag_tip(session.posed(), *joint),
        _ => true,
    };
    if let Some(grip) = gizmo.at(mouse).filter(can_drag) {
        return Pointed { grip: Some(grip), lit: part_of(session, grip) };
    }
    let joint = joint_at(session, screen, gizmo, mouse).filter(|_| session.crowd().is_none());
    let grip = joint.and_then(|joint| Grip::of_part(session.posed(), joint));
    Pointed { grip, lit: joint.filter(|_| grip.is_some()) }
}

/// The joint that a handle stands for; `None` for a handle beside it.
fn part_of(session: &Session, grip: Grip) -> Option<JointId> {
    match grip {
        Grip::Target(joint, PointHandle::Free) if session.rig().sole_limb().is_some() => {
            session.rig().end_of_target(joint)
        }
        Grip::Tip(joint, PointHandle::Free) | Grip::Bone(joint) => Some(joint),
        _ => None,
    }
}

/// The joint at the mouse: that of the cylinder there, else of the bone if bones are shown, or else
/// of the skin.
fn joint_at(
    session: &Session,
    screen: &ScreenProjection,
    gizmo: &Gizmo,
    mouse: Pos2,
) -> Option<JointId> {
    let on_cylinders = Grip::joint_on_cylinders(session.posed(), screen.ray(mouse));
    let of_bone = || gizmo.joint_at(mouse).filter(|_| !session.shown().hides_bones());
    on_cylinders
        .or_else(of_bone)
        .or_else(|| session.evaluated().joint_on_skin(session.posed(), screen.ray(mouse)))
}

/// Lets the angle swing whose ring is at the mouse while Alt is held and no button is.
fn wiggle(ui: &Ui, session: &Session, pointed: Option<Grip>, actions: &mut Actions) {
    let is_asked = ui.input(|input| input.modifiers.alt && !input.pointer.any_down());
    let wiggled = match pointed.filter(|_| is_asked) {
        Some(Grip::Ring(joint, axis)) => Some((joint, axis)),
        _ => None,
    };
    if wiggled != session.view().wiggled() {
        actions.push(SelectAction::Wiggle(wiggled));
    }
}

/// Lights up the part at the mouse. Away from all parts, puts out only the light of the viewport:
/// the outliner lights up joints, too.
fn light_up(ui: &Ui, session: &Session, lit: Option<JointId>, actions: &mut Actions) {
    let id = Id::unique("part lit in the viewport");
    let hovered = session.selection().hovered();
    let before = ui.data(|data| data.get_temp::<Option<JointId>>(id)).flatten();
    let own = lit.or(before.filter(|before| hovered == Some(*before)));
    if own.is_some() && hovered != lit {
        actions.push(SelectAction::Hover(lit));
    }
    ui.data_mut(|data| data.insert_temp(id, own));
}

/// Handles a click in the viewport. A click selects the joint at the mouse, and with Shift adds it
/// to the selection or removes it; a click beside all joints deselects. With Ctrl, or while the
/// skeleton has no bones, a click adds a bone that ends at the mouse.
fn select(
    ui: &Ui,
    session: &Session,
    screen: &ScreenProjection,
    gizmo: &Gizmo,
    mouse: Pos2,
    actions: &mut Actions,
) {
    let modifiers = ui.input(|input| input.modifiers);
    let joint = match gizmo.at(mouse) {
        Some(Grip::Target(joint, PointHandle::Free) | Grip::Aim(joint, _)) => {
            session.rig().end_of_target(joint).or(Some(joint))
        }
        Some(Grip::Target(joint, _) | Grip::Head(joint, _) | Grip::Tip(joint, _)) => Some(joint),
        Some(Grip::LimbTwist(joint)) => Some(joint),
        Some(Grip::Ring(..) | Grip::Orientation(..) | Grip::Limit(..)) => return,
        _ => joint_at(session, screen, gizmo, mouse),
    };
    let is_first = modifiers.is_none() && !session.rig().has_bones();
    if modifiers.command || is_first {
        let ray = screen.ray(mouse);
        let in_mesh = session.middle_of_mesh(ray);
        let is_place = match session.has_loose_mesh() {
            true => in_mesh.is_some(),
            false => joint.is_none(),
        };
        if modifiers.command || is_place {
            place_joint(session, ray, screen.projection.forward, in_mesh, actions);
            return;
        }
    }
    let mut selection =
        if modifiers.shift { session.selection().joints().to_vec() } else { Vec::new() };
    if let Some(joint) = joint {
        let was_selected = selection.contains(&joint);
        selection.retain(|other| *other != joint);
        if !was_selected {
            selection.push(joint);
        }
    }
    if selection != session.selection().joints() {
        actions.push(SelectAction::Joints(selection));
    }
}

/// Adds a bone that ends at `in_mesh`, or without it in the plane through its base across the view.
/// The lone first joint of a mesh goes there itself.
fn place_joint(
    session: &Session,
    ray: Ray,
    forward: Vec3,
    in_mesh: Option<Vec3>,
    actions: &mut Actions,
) {
    let is_root = session.selection().active().is_none() && session.has_lone_root();
    if let Some(at) = in_mesh.filter(|_| is_root) {
        actions.push(SkinEdit::PlaceRoot(at));
        return;
    }
    let at = in_mesh.or_else(|| ray.meets_plane(JointEdit::next_base(session), forward));
    actions.extend(at.map(|tip| JointEdit::AddJoint { tip: Some(tip) }));
}

/// The rectangle rounded to whole pixels, so that each pixel of the scene covers one pixel of the
/// screen.
fn whole_pixels(ui: &Ui, rect: Rect) -> Rect {
    let scale = ui.pixels_per_point();
    let round = |at: Pos2| pos2((at.x * scale).round() / scale, (at.y * scale).round() / scale);
    Rect::from_min_max(round(rect.min), round(rect.max))
}

/// Advances everything that moves without input, such as playback. Input ends a glide of the
/// camera: a press in the viewport stops the camera where it is, any other input moves it to the
/// end of the glide.
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
    if session.view().is_gliding() && ui.input(|input| input.events.iter().any(is_input)) {
        actions.push(ViewAction::SetCamera(session.settled_camera()));
    }
    actions.push(PlaybackAction::Advance(ui.input(|input| input.time)));
    ui.request_repaint();
}

/// The current drag in the viewport: of nothing, a handle, or the camera.
#[derive(Clone, Copy)]
enum ViewportDrag {
    Nothing,
    Grip,
    View,
}

/// Handles presses of mouse buttons. Returns the current drag, or the drag that a press in this
/// frame starts.
fn press(
    ui: &Ui,
    response: &Response,
    session: &Session,
    screen: &ScreenProjection,
    gizmo: &Gizmo,
    actions: &mut Actions,
) -> ViewportDrag {
    let mut drag = match (session.history().drag(), session.view().drag()) {
        (Some(_), _) => ViewportDrag::Grip,
        (None, Some(_)) => ViewportDrag::View,
        (None, None) => ViewportDrag::Nothing,
    };
    for event in ui.input(|input| input.events.clone()) {
        let Event::PointerButton { pos, button, pressed: true, modifiers } = event else {
            continue;
        };
        if button == PointerButton::Secondary && session.history().is_editing() {
            // The right button cancels a drag anywhere in the window.
            actions.push(TransactionAction::Cancel);
        }
        if !response.contains_pointer() {
            continue;
        }
        response.request_focus();
        if session.history().follows_mouse() && button == PointerButton::Primary {
            actions.push(TransactionAction::FollowMouse(false));
        }
        if session.history().is_editing() || !matches!(drag, ViewportDrag::Nothing) {
            continue;
        }
        let on_view_axes = covers_view_axes(screen.rect, pos);
        let can_take = button == PointerButton::Primary && !modifiers.alt && !on_view_axes;
        // Ctrl and Shift clicks select and add joints.
        let is_click = modifiers.command || modifiers.shift;
        let at = under_finger(ui, gizmo, pos).unwrap_or(pos);
        let grip = pointed_at(session, screen, gizmo, at).grip.filter(|_| can_take && !is_click);
        let motion = match motion(session.preferences().navigation, button, modifiers) {
            None if on_view_axes && button == PointerButton::Primary => Some(CameraMotion::Orbit),
            motion => motion,
        };
        if let Some(grip) = grip {
            let (ray, forward) = (screen.ray(pos), screen.projection.forward);
            actions.push(TransactionAction::Grab { grip, ray, forward });
            drag = ViewportDrag::Grip;
        } else if let Some(motion) = motion {
            actions.push(ViewAction::Grab(motion, screen.normalised(pos)));
            drag = ViewportDrag::View;
        }
    }
    drag
}

/// Updates the drag, and ends it when the mouse button is released.
fn follow(
    ui: &Ui,
    drag: ViewportDrag,
    screen: &ScreenProjection,
    mouse: Pos2,
    actions: &mut Actions,
) {
    let (down, modifiers) = ui.input(|input| (input.pointer.any_down(), input.modifiers));
    let released = !down || lifted_from(ui).is_some();
    let (moved, dropped): (Action, Action) = match drag {
        ViewportDrag::Nothing => return,
        ViewportDrag::Grip => {
            let ray = screen.ray(mouse);
            let input = DragInput { ray, precise: modifiers.shift, snap: modifiers.command };
            (TransactionAction::Drag(input).into(), TransactionAction::Commit.into())
        }
        ViewportDrag::View => {
            let (to, aspect) = (screen.normalised(mouse), screen.rect.aspect_ratio());
            (ViewAction::Drag { to, aspect }.into(), ViewAction::Drop.into())
        }
    };
    actions.push(moved);
    if released {
        actions.push(dropped);
    }
}

/// Where a mouse button was released in this frame, or a finger lifted.
fn lifted_from(ui: &Ui) -> Option<Pos2> {
    let is_cancel =
        |event: &Event| matches!(event, Event::Touch { phase, .. } if *phase == TouchPhase::Cancel);
    ui.input(|input| {
        let is_lifted = input.pointer.any_released() || input.events.iter().any(is_cancel);
        input.pointer.interact_pos().filter(|_| is_lifted)
    })
}

/// The place of a handle that a finger at `at` covers: the nearest point, or else the nearest arrow
/// or ring; `None` without a finger.
fn under_finger(ui: &Ui, gizmo: &Gizmo, at: Pos2) -> Option<Pos2> {
    const RADII: [f32; 3] = [0.0, 11.0, 22.0];
    const PLACES: u8 = 12;
    if !ui.input(InputState::any_touches) {
        return None;
    }
    let around = |radius: f32| {
        (0..PLACES).map(move |place| {
            at + radius * Vec2::angled(f32::from(place) * TAU / f32::from(PLACES))
        })
    };
    let places = RADII.into_iter().flat_map(around);
    let is_point = |grip: Grip| {
        use PointHandle::Free;
        matches!(
            grip,
            Grip::Target(_, Free) | Grip::Aim(_, Free) | Grip::Head(_, Free) | Grip::Tip(_, Free)
        )
    };
    let handles = places.filter_map(|place| Some((place, is_point(gizmo.at(place)?))));
    Some(handles.min_by_key(|(_, is_point)| !is_point)?.0)
}

/// Handles shortcuts of single keys during a drag of a handle, or while the viewport or no widget
/// has the keyboard focus.
fn keys(ui: &Ui, response: &Response, session: &Session, actions: &mut Actions) {
    let free = ui.memory(|memory| memory.focused().is_none()) || response.has_focus();
    if free || session.history().drag().is_some() {
        keyboard::viewport::viewport(ui, session, actions);
    } else if focus::leaves_letters(ui) && !session.shell().is_asking() {
        keyboard::viewport::axis_views(ui, session, actions);
    }
    if response.has_focus() {
        focus::leave_letters(ui, response.id);
        focus::take_arrows(ui, response.id);
        keyboard::viewport::turn(ui, session, response.rect.aspect_ratio(), actions);
    }
}
