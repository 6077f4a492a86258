use glam::{Vec2, Vec3};

use crate::document::Camera;

/// Kind of motion of the camera in a drag.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CameraMotion {
    /// Around the camera's target.
    Orbit,
    /// Parallel to the plane of the picture.
    Pan,
    /// Towards the camera's target, or away from it.
    Zoom,
}

/// A drag of the camera. Positions of the mouse are in the picture, −1 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewDrag {
    /// Kind of motion of the camera.
    pub motion: CameraMotion,
    pub(in crate::session) before: Camera,
    pressed: Vec2,
}

/// A smooth move from one camera to another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::session) struct Glide {
    from: Camera,
    to: Camera,
    /// Start on the window's clock, in seconds; `None` before the first frame.
    started: Option<f64>,
}

impl ViewDrag {
    /// Angle in radians by which a drag over half the height of the picture orbits.
    const TURN: f32 = 2.2;
    /// Factor by which a drag over half the height of the picture zooms.
    const ZOOM: f32 = 4.0;

    pub(in crate::session) fn new(motion: CameraMotion, before: Camera, pressed: Vec2) -> Self {
        Self { motion, before, pressed }
    }

    /// The camera for the mouse at `now`; `aspect` is the ratio of the picture's width to its
    /// height.
    pub(in crate::session) fn camera(&self, now: Vec2, aspect: f32) -> Camera {
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

    pub(in crate::session) fn new(from: Camera, to: Camera) -> Self {
        Self { from, to, started: None }
    }

    pub(in crate::session) fn target(&self) -> Camera {
        self.to
    }

    /// Moves both cameras, in the world.
    pub(in crate::session) fn translate(&mut self, by: Vec3) {
        self.from.target += by;
        self.to.target += by;
    }

    /// The camera at `seconds` on the window's clock, and whether the glide has ended. The first
    /// call starts the glide.
    pub(in crate::session) fn at(&mut self, seconds: f64) -> (Camera, bool) {
        let started = *self.started.get_or_insert(seconds);
        let fraction = ((seconds - started) / Self::SECONDS).clamp(0.0, 1.0) as f32;
        let eased = fraction * fraction * (3.0 - 2.0 * fraction);
        (self.from.interpolated(self.to, eased), fraction >= 1.0)
    }
}
