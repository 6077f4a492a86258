use glam::{Vec2, Vec3};

use super::inside_layer::InsideLayers;
use super::view_drag::{CameraMotion, Glide, ViewDrag};
use crate::document::Camera;
use crate::kinematics::two_bone::TwoBone;
use crate::rig::{Crowd, Processor};

/// The drag and the glide of the camera, and the crowd that is shown instead of the rig.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct View {
    drag: Option<ViewDrag>,
    glide: Option<Glide>,
    follows_selection: bool,
    /// What is shown of a part of an iteration.
    pub inside_layers: InsideLayers,
    crowd_shown: bool,
    crowd_size: u32,
    crowd_solver: Processor,
    crowd_animated: bool,
    /// Time of the crowd's targets, in seconds.
    crowd_time: f64,
}

impl Default for View {
    fn default() -> Self {
        Self {
            drag: None,
            glide: None,
            follows_selection: false,
            inside_layers: InsideLayers::default(),
            crowd_shown: false,
            crowd_size: 1_000,
            crowd_solver: Processor::Cpu,
            crowd_animated: true,
            crowd_time: 0.0,
        }
    }
}

impl View {
    pub fn drag(&self) -> Option<&ViewDrag> {
        self.drag.as_ref()
    }

    pub fn is_gliding(&self) -> bool {
        self.glide.is_some()
    }

    /// The camera at the end of the glide; `None` without a glide.
    pub fn glide_target(&self) -> Option<Camera> {
        Some(self.glide?.target())
    }

    pub fn glide(&mut self, from: Camera, to: Camera) {
        self.glide = Some(Glide::new(from, to));
    }

    pub fn stop_glide(&mut self) {
        self.glide = None;
    }

    /// Ends the glide and returns the camera at its end; `None` without a glide.
    pub fn take_glide_target(&mut self) -> Option<Camera> {
        Some(self.glide.take()?.target())
    }

    /// Advances the glide to `seconds` on the window's clock and returns its camera; `None` without
    /// a glide.
    pub fn advance_glide(&mut self, seconds: f64) -> Option<Camera> {
        let (camera, arrived) = self.glide.as_mut()?.at(seconds);
        if arrived {
            self.glide = None;
        }
        Some(camera)
    }

    pub fn grab(&mut self, motion: CameraMotion, camera: Camera, at: Vec2) {
        self.glide = None;
        self.drag = Some(ViewDrag::new(motion, camera, at));
    }

    /// Ends the drag and returns the camera from before it; `None` without a drag.
    pub fn drop(&mut self) -> Option<Camera> {
        Some(self.drag.take()?.before)
    }

    pub fn follows_selection(&self) -> bool {
        self.follows_selection
    }

    pub fn follow_selection(&mut self, follows: bool) {
        self.follows_selection = follows;
    }

    /// Moves the cameras that the drag started from and that the glide connects, in the world.
    pub fn translate(&mut self, by: Vec3) {
        if let Some(drag) = &mut self.drag {
            drag.before.target += by;
        }
        if let Some(glide) = &mut self.glide {
            glide.translate(by);
        }
    }

    pub fn crowd(&self, bones: TwoBone) -> Option<Crowd> {
        let Self { crowd_size: arms, crowd_solver: processor, crowd_time, .. } = *self;
        self.crowd_shown.then_some(Crowd { arms, bones, time: crowd_time as f32, processor })
    }

    pub fn is_crowd_animated(&self) -> bool {
        self.crowd_animated
    }

    /// Whether the crowd is shown and animated.
    pub fn is_crowd_moving(&self) -> bool {
        self.crowd_shown && self.crowd_animated
    }

    /// Shows or hides the crowd; returns whether its visibility has changed.
    pub fn show_crowd(&mut self, shown: bool) -> bool {
        std::mem::replace(&mut self.crowd_shown, shown) != shown
    }

    pub fn set_crowd_size(&mut self, arms: u32) {
        self.crowd_size = arms.clamp(1, Crowd::MOST);
    }

    pub fn set_crowd_solver(&mut self, processor: Processor) {
        self.crowd_solver = processor;
    }

    pub fn animate_crowd(&mut self, animated: bool) {
        self.crowd_animated = animated;
    }

    pub fn advance_crowd(&mut self, passed: f64) {
        if self.is_crowd_moving() {
            let period = f64::from(Crowd::PERIOD);
            self.crowd_time = (self.crowd_time + passed).rem_euclid(period);
        }
    }

    /// Resets the crowd and hides it.
    pub fn reset_crowd(&mut self) {
        let Self { drag, glide, follows_selection, .. } = *self;
        *self = Self { drag, glide, follows_selection, ..Self::default() };
    }
}
