//! Orbit, pan and zoom by mouse, trackpad and fingers.

use egui::{
    Align2, Color32, CursorIcon, Event, FontId, Id, InputState, MouseWheelUnit, PointerButton,
    Pos2, Rect, Response, Role, Sense, Stroke, Ui, Vec2, WidgetInfo, pos2,
};
use glam::Vec3;

use crate::document::{AxisView, Camera};
use crate::session::{Actions, CameraMotion, Grip, Navigation, Session, ViewAction};
use crate::ui::gizmo::screen::ScreenProjection;
use crate::ui::style;

/// Zoom factor of a wheel step.
const WHEEL: f32 = 1.15;

/// Scroll distance in points that counts as one wheel step.
const POINTS_PER_STEP: f32 = 50.0;

pub(super) fn motion(
    navigation: Navigation,
    button: PointerButton,
    modifiers: egui::Modifiers,
) -> Option<CameraMotion> {
    use PointerButton::{Middle, Primary, Secondary};
    if modifiers.alt {
        // With Alt, a drag moves the camera even if it starts on a handle.
        return match button {
            Primary => Some(CameraMotion::Orbit),
            Middle => Some(CameraMotion::Pan),
            Secondary => Some(CameraMotion::Zoom),
            _ => None,
        };
    }
    match (navigation, button) {
        (Navigation::Maya, _) => None,
        (_, Middle) if modifiers.shift => Some(CameraMotion::Pan),
        (_, Middle) if modifiers.command => Some(CameraMotion::Zoom),
        (_, Middle) => Some(CameraMotion::Orbit),
        (Navigation::Default | Navigation::Trackpad, Primary) => Some(CameraMotion::Orbit),
        (Navigation::Default | Navigation::Trackpad, Secondary) => Some(CameraMotion::Pan),
        _ => None,
    }
}

pub(super) fn wheel(
    ui: &Ui,
    session: &Session,
    screen: &ScreenProjection,
    mouse: Pos2,
    actions: &mut Actions,
) {
    let mut camera = session.settled_camera();
    let (at, aspect) = (screen.normalised(mouse), screen.rect.aspect_ratio());
    let trackpad = session.preferences().navigation == Navigation::Trackpad;
    ui.input(|input| {
        for event in &input.events {
            match event {
                Event::Zoom(factor) => camera = camera.zoomed(1.0 / factor, at, aspect),
                Event::MouseWheel { unit, delta, modifiers, .. } => {
                    let steps = match unit {
                        MouseWheelUnit::Point => *delta / POINTS_PER_STEP,
                        MouseWheelUnit::Line => *delta,
                        MouseWheelUnit::Page => *delta * 10.0,
                    };
                    camera = if trackpad && !modifiers.command {
                        scrolled(camera, steps, modifiers.shift, aspect)
                    } else {
                        let steps = if steps.y == 0.0 { steps.x } else { steps.y };
                        camera.zoomed(WHEEL.powf(-steps), at, aspect)
                    };
                }
                _ => {}
            }
        }
    });
    if camera != session.settled_camera() {
        actions.push(ViewAction::SetCamera(camera));
    }
}

/// The camera after a scroll on a trackpad, in wheel steps: the scroll orbits, or pans with Shift.
fn scrolled(camera: Camera, steps: Vec2, shift: bool, aspect: f32) -> Camera {
    const TURN: f32 = 0.15;
    const PAN: f32 = 0.1;
    if shift {
        camera.panned(glam::Vec2::ZERO, glam::Vec2::new(steps.x / aspect, -steps.y) * PAN, aspect)
    } else {
        camera.orbited(-steps.x * TURN, -steps.y * TURN)
    }
}

/// Pans and zooms by two fingers, which end a drag of the camera by the first one. Returns whether
/// they do: not while the first one holds a handle.
pub(super) fn two_fingers(
    ui: &Ui,
    session: &Session,
    screen: &ScreenProjection,
    view: &Response,
    actions: &mut Actions,
) -> bool {
    let Some(touch) = ui.input(InputState::multi_touch) else { return false };
    if !view.contains_pointer() || session.history().drag().is_some() {
        return false;
    }
    if session.view().drag().is_some() {
        actions.push(ViewAction::Drop);
    }
    let (before, now) = (touch.center_pos - touch.translation_delta, touch.center_pos);
    let (before, now) = (screen.normalised(before), screen.normalised(now));
    let aspect = screen.rect.aspect_ratio();
    let panned = session.settled_camera().panned(before, now, aspect);
    // Fingers that started at one point have no distance.
    let spread = if touch.zoom_delta.is_normal() { touch.zoom_delta } else { 1.0 };
    let camera = panned.zoomed(spread.recip(), now, aspect);
    if camera != session.settled_camera() {
        actions.push(ViewAction::SetCamera(camera));
    }
    true
}

pub(super) fn show_cursor(ui: &Ui, session: &Session, grip: Option<Grip>) {
    let icon = match (session.history().drag(), session.view().drag(), grip) {
        (Some(_), _, _) => CursorIcon::Grabbing,
        (_, Some(drag), _) => match drag.motion {
            CameraMotion::Orbit => CursorIcon::Grabbing,
            CameraMotion::Pan => CursorIcon::Move,
            CameraMotion::Zoom => CursorIcon::ZoomIn,
        },
        (_, _, Some(_)) => CursorIcon::Grab,
        _ => return,
    };
    ui.set_cursor_icon(icon);
}

const RADIUS: f32 = 38.0;
const END: f32 = 9.0;
const MARGIN: f32 = 16.0;
/// Width in points of the view axes, with their distance from the edge of the view.
pub(in crate::ui) const CORNER_AXES: f32 = 2.0 * (RADIUS + END) + MARGIN;

struct AxisEnd {
    view: AxisView,
    name: &'static str,
    letter: &'static str,
    at: Pos2,
    /// Component towards the viewer of the unit vector along the axis, from −1 to 1.
    depth: f32,
    colour: Color32,
}

/// True if a screen position is on the view axes.
pub(in crate::ui) fn covers_view_axes(viewport: Rect, at: Pos2) -> bool {
    centre(viewport).distance(at) <= RADIUS + END + 2.0
}

fn centre(viewport: Rect) -> Pos2 {
    viewport.right_bottom() - Vec2::splat(RADIUS + END + MARGIN)
}

/// Shows the axes at the lower right of `viewport`, and handles clicks on their ends. Drags on the
/// axes are handled by the viewport.
pub(in crate::ui) fn view_axes(ui: &Ui, viewport: Rect, session: &Session, actions: &mut Actions) {
    let centre = centre(viewport);
    let painter = ui.painter();
    let mouse = ui.input(|input| input.pointer.latest_pos());
    if mouse.is_some_and(|mouse| covers_view_axes(viewport, mouse)) {
        let shade = ui.visuals().strong_text_color().gamma_multiply(0.07);
        painter.circle_filled(centre, RADIUS + END + 2.0, shade);
    }
    let mut ends = axis_ends(ui, centre, session);
    ends.sort_by(|a, b| a.depth.total_cmp(&b.depth));
    for end in &ends {
        let rect = Rect::from_center_size(end.at, Vec2::splat(2.0 * END));
        let response = ui.interact(rect, Id::unique(("view axes", end.name)), Sense::click());
        response.widget_info(|| WidgetInfo::labeled(Role::Button, true, end.name));
        if response.clicked() {
            actions.push(ViewAction::GlideTo(session.settled_camera().along(end.view)));
        }
        let lit = response.hovered() || response.has_focus();
        let near = 0.6 + 0.4 * end.depth.clamp(0.0, 1.0);
        let colour = if lit { end.colour } else { end.colour.gamma_multiply(near) };
        if end.letter.is_empty() {
            painter.circle_stroke(end.at, END - 3.0, Stroke::new(1.5, colour));
        } else {
            painter.line_segment([centre, end.at], Stroke::new(2.0, colour));
            painter.circle_filled(end.at, END, colour);
            let font = FontId::proportional(12.0);
            let ink = if ui.visuals().dark_mode { Color32::BLACK } else { Color32::WHITE };
            painter.text(end.at, Align2::CENTER_CENTER, end.letter, font, ink);
        }
        if lit {
            let ring = Stroke::new(1.5, ui.visuals().strong_text_color());
            painter.circle_stroke(end.at, END + 1.0, ring);
        }
        response.on_hover_cursor(CursorIcon::PointingHand).on_hover_text(end.name);
    }
}

fn axis_ends(ui: &Ui, centre: Pos2, session: &Session) -> [AxisEnd; 6] {
    let (back, right, up) = session.camera().basis();
    let axes = style::palette(ui).axes.map(style::colour);
    [
        (AxisView::Right, "View from the right", "X", Vec3::X, axes[0]),
        (AxisView::Top, "View from the top", "Y", Vec3::Y, axes[1]),
        (AxisView::Front, "View from the front", "Z", Vec3::Z, axes[2]),
        (AxisView::Left, "View from the left", "", -Vec3::X, axes[0]),
        (AxisView::Bottom, "View from the bottom", "", -Vec3::Y, axes[1]),
        (AxisView::Back, "View from the back", "", -Vec3::Z, axes[2]),
    ]
    .map(|(view, name, letter, axis, colour)| AxisEnd {
        view,
        name,
        letter,
        at: pos2(centre.x + axis.dot(right) * RADIUS, centre.y - axis.dot(up) * RADIUS),
        depth: axis.dot(back),
        colour,
    })
}
