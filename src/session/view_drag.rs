use glam::Vec2;

use crate::document::Camera;

/// What a drag does to the view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CameraMotion {
    Orbit,
    Pan,
    Zoom,
}

/// A view that is held. Places are in the picture's coordinates, −1 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewDrag {
    pub motion: CameraMotion,
    pub(super) before: Camera,
    pressed: Vec2,
}

/// A view on its way to another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Glide {
    from: Camera,
    to: Camera,
    /// Seconds; not known before the first frame of the glide.
    started: Option<f64>,
}

impl ViewDrag {
    /// How far the view turns across half the height of the picture.
    const TURN: f32 = 2.2;
    /// How much nearer the eye comes across half the height.
    const ZOOM: f32 = 4.0;

    pub(super) fn new(motion: CameraMotion, before: Camera, pressed: Vec2) -> Self {
        Self { motion, before, pressed }
    }

    /// The view when the pointer is at `now`.
    pub(super) fn camera(&self, now: Vec2, aspect: f32) -> Camera {
        let moved = now - self.pressed;
        if moved == Vec2::ZERO {
            return self.before;
        }
        match self.motion {
            CameraMotion::Orbit => {
                self.before.orbited(-moved.x * aspect * Self::TURN, -moved.y * Self::TURN)
            }
            CameraMotion::Pan => self.before.panned(self.pressed, now, aspect),
            CameraMotion::Zoom => {
                self.before.zoomed(Self::ZOOM.powf(-moved.y), self.pressed, aspect)
            }
        }
    }
}

impl Glide {
    const SECONDS: f64 = 0.2;

    pub(super) fn new(from: Camera, to: Camera) -> Self {
        Self { from, to, started: None }
    }

    pub(super) fn target(&self) -> Camera {
        self.to
    }

    /// The view at a time, and whether it has arrived.
    pub(super) fn at(&mut self, seconds: f64) -> (Camera, bool) {
        let started = *self.started.get_or_insert(seconds);
        let part = ((seconds - started) / Self::SECONDS).clamp(0.0, 1.0) as f32;
        let eased = part * part * (3.0 - 2.0 * part);
        (self.from.interpolated(self.to, eased), part >= 1.0)
    }
}
