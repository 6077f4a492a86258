use glam::{Vec2, Vec3};

use crate::document::{Camera, Posed};
use crate::kinematics::skeleton::{JointId, RotationAxis};
use crate::kinematics::two_bone::TwoBone;
use crate::rig::{Crowd, Processor};
use crate::session::outcome::{Consequence, Outcome};
use crate::session::preferences::{PanelTab, Preferences};
use crate::session::solver::iterates::{InsideLayer, InsideLayers};
use crate::session::solver::wiggle::{Wiggle, WiggleView};

/// Changes the camera, the crowd or the open panels. The camera is saved, but not undone.
#[derive(Clone, Debug, PartialEq)]
pub enum ViewAction {
    /// Sets the camera at once.
    SetCamera(Camera),
    /// Moves the camera smoothly.
    GlideTo(Camera),
    /// Begins to drag the camera from a position of the mouse in the picture, −1 to 1.
    Grab(CameraMotion, Vec2),
    /// Drags the camera by the mouse.
    Drag {
        /// Position of the mouse in the picture, −1 to 1.
        to: Vec2,
        /// Ratio of the picture's width to its height.
        aspect: f32,
    },
    /// Ends the drag of the camera.
    Drop,
    /// Ends the drag and restores the camera from before it.
    Cancel,
    /// Keeps the camera at its distance and direction from the selected joints, or from the middle
    /// of all joints, while the time changes; or lets it stand again.
    FollowSelection(bool),
    /// Shows or hides something of the part of an iteration that is looked at.
    ShowInside(InsideLayer, bool),
    /// Shows a crowd of arms instead of the rig, or the rig again.
    ShowCrowd(bool),
    /// Sets the number of arms, from 1 to [`Crowd::MOST`](crate::rig::Crowd::MOST).
    SetCrowdSize(u32),
    /// Solves the crowd on the CPU or on the GPU.
    SetCrowdSolver(Processor),
    /// Animates or pauses the crowd's targets.
    AnimateCrowd(bool),
    /// Restarts the measurement of holonomy at the present direction of the Pointer.
    ResetTransport,
    /// Opens or closes the panel on the right.
    ShowExplain(bool),
    /// Shows a page of the panel on the right, if the shown rig has it.
    ShowTab(PanelTab),
    /// Opens or closes the timeline above the transport bar.
    ShowTimeline(bool),
    /// Shows keys in the graph editor (true) or in the dope sheet (false).
    ShowGraphEditor(bool),
}

/// The drag and the glide of the camera, and the crowd that is shown instead of the rig.
#[derive(Clone, Debug, PartialEq)]
pub struct View {
    drag: Option<ViewDrag>,
    glide: Option<Glide>,
    follows_selection: bool,
    /// The layers that are shown of a part of an iteration.
    inside_layers: InsideLayers,
    wiggle: Option<Wiggle>,
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
            wiggle: None,
            crowd_shown: false,
            crowd_size: 1_000,
            crowd_solver: Processor::Cpu,
            crowd_animated: true,
            crowd_time: 0.0,
        }
    }
}

impl View {
    /// Applies an action; `camera` and `preferences` are the present ones.
    pub(in crate::session) fn apply(
        &mut self,
        action: ViewAction,
        camera: Camera,
        preferences: Preferences,
    ) -> Outcome {
        match action {
            ViewAction::SetCamera(camera) => {
                self.stop_glide();
                return Consequence::SetCamera(camera).into();
            }
            ViewAction::GlideTo(to) if to.is_valid() => self.glide(camera, to),
            ViewAction::GlideTo(_) => {}
            ViewAction::Grab(motion, at) => {
                self.glide = None;
                self.drag = Some(ViewDrag::new(motion, camera, at));
            }
            ViewAction::Drag { to, aspect } => {
                let camera = self.drag.map(|drag| drag.camera(to, aspect));
                return camera.map(Consequence::SetCamera).into();
            }
            ViewAction::Drop => {
                self.drop();
            }
            ViewAction::Cancel => return self.drop().map(Consequence::SetCamera).into(),
            ViewAction::FollowSelection(follows) => {
                self.follow(follows);
                return follows.then_some(Consequence::CentreFollowed).into();
            }
            ViewAction::ShowInside(layer, shown) => {
                self.inside_layers = self.inside_layers.with(layer, shown);
            }
            ViewAction::ShowCrowd(shown) if shown != self.crowd_shown => {
                self.crowd_shown = shown;
                return Outcome::from(Consequence::ForgetPause).and(Consequence::FrameAll);
            }
            ViewAction::ShowCrowd(_) => {}
            ViewAction::SetCrowdSize(arms) => self.crowd_size = arms.clamp(1, Crowd::MOST),
            ViewAction::SetCrowdSolver(processor) => self.crowd_solver = processor,
            ViewAction::AnimateCrowd(animated) => {
                self.crowd_animated = animated;
                return Consequence::ForgetPause.into();
            }
            ViewAction::ResetTransport => return Consequence::ResetTransport.into(),
            ViewAction::ShowTab(tab) => return Consequence::ShowTab(tab).into(),
            ViewAction::ShowExplain(explain) => {
                return Consequence::Prefer(Preferences { explain, ..preferences }).into();
            }
            ViewAction::ShowTimeline(shown) => {
                let timeline_open = Some(shown);
                return Consequence::Prefer(Preferences { timeline_open, ..preferences }).into();
            }
            ViewAction::ShowGraphEditor(curves) => {
                return Consequence::Prefer(Preferences { curves, ..preferences }).into();
            }
        }
        Outcome::default()
    }

    /// Lets an angle swing, or stops the one that does.
    pub(in crate::session) fn set_wiggle(&mut self, wiggled: Option<(JointId, RotationAxis)>) {
        if self.wiggled() != wiggled {
            self.wiggle = wiggled.map(|(joint, axis)| Wiggle::new(joint, axis));
        }
    }

    /// The angle that swings; `None` if none does.
    pub fn wiggled(&self) -> Option<(JointId, RotationAxis)> {
        self.wiggle.map(Wiggle::angle)
    }

    /// The angle that swings on a pose, with the paths of the tip; `None` if none does.
    pub fn wiggle_view(&self, posed: &Posed) -> Option<WiggleView> {
        self.wiggle?.view(&posed.document().rig, posed.evaluated_skeleton())
    }

    /// The layers that are shown of the chosen part of an iteration.
    pub fn inside_layers(&self) -> InsideLayers {
        self.inside_layers
    }

    /// The drag of the camera; `None` if the camera is not dragged.
    pub fn drag(&self) -> Option<&ViewDrag> {
        self.drag.as_ref()
    }

    /// True if the camera is gliding, which is a smooth move to another camera.
    pub fn is_gliding(&self) -> bool {
        self.glide.is_some()
    }

    /// The camera at the end of the glide; `None` without a glide.
    pub(in crate::session) fn glide_target(&self) -> Option<Camera> {
        Some(self.glide?.target())
    }

    pub(in crate::session) fn glide(&mut self, from: Camera, to: Camera) {
        self.glide = Some(Glide::new(from, to));
    }

    pub(in crate::session) fn stop_glide(&mut self) {
        self.glide = None;
    }

    /// Ends the glide and returns the camera at its end; `None` without a glide.
    pub(in crate::session) fn take_glide_target(&mut self) -> Option<Camera> {
        Some(self.glide.take()?.target())
    }

    /// Advances the glide to `seconds` on the window's clock and returns its camera; `None` without
    /// a glide.
    pub(in crate::session) fn advance_glide(&mut self, seconds: f64) -> Option<Camera> {
        let (camera, arrived) = self.glide.as_mut()?.at(seconds);
        if arrived {
            self.glide = None;
        }
        Some(camera)
    }

    /// Ends the drag and returns the camera from before it; `None` without a drag.
    pub(in crate::session) fn drop(&mut self) -> Option<Camera> {
        Some(self.drag.take()?.before)
    }

    /// True if the camera follows the selected joints, or without a selection the whole rig,
    /// while the time changes.
    pub fn follows_selection(&self) -> bool {
        self.follows_selection
    }

    /// Lets the camera follow the selected joints, or without a selection the whole rig.
    pub(in crate::session) fn follow(&mut self, follows: bool) {
        self.follows_selection = follows;
    }

    /// Moves the cameras that the drag started from and that the glide connects, in the world.
    pub(in crate::session) fn translate(&mut self, by: Vec3) {
        if let Some(drag) = &mut self.drag {
            drag.before.target += by;
        }
        if let Some(glide) = &mut self.glide {
            glide.translate(by);
        }
    }

    pub(in crate::session) fn crowd(&self, bones: TwoBone) -> Option<Crowd> {
        let Self { crowd_size: arms, crowd_solver: processor, crowd_time, .. } = *self;
        self.crowd_shown.then_some(Crowd { arms, bones, time: crowd_time as f32, processor })
    }

    /// True if the crowd's targets are animated rather than paused.
    pub fn is_crowd_animated(&self) -> bool {
        self.crowd_animated
    }

    /// True if the crowd is shown and animated.
    pub(in crate::session) fn is_crowd_moving(&self) -> bool {
        self.crowd_shown && self.crowd_animated
    }

    /// Lets time pass for the crowd and for the angle that swings.
    pub(in crate::session) fn advance(&mut self, passed: f64) {
        if let Some(wiggle) = &mut self.wiggle {
            wiggle.advance(passed);
        }
        if self.is_crowd_moving() {
            let period = f64::from(Crowd::PERIOD);
            self.crowd_time = (self.crowd_time + passed).rem_euclid(period);
        }
    }

    /// Resets the crowd and hides it.
    pub(in crate::session) fn reset_crowd(&mut self) {
        let Self { drag, glide, follows_selection, wiggle, .. } = *self;
        *self = Self { drag, glide, follows_selection, wiggle, ..Self::default() };
    }
}

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
