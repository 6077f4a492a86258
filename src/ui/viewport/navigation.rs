//! Orbit, pan and zoom by mouse and trackpad.

use egui::{CursorIcon, Event, MouseWheelUnit, PointerButton, Pos2, Ui, Vec2};

use crate::document::Camera;
use crate::session::{Actions, CameraMotion, Grip, Navigation, Session, ViewAction};
use crate::ui::gizmo::screen::ScreenProjection;

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
