use glam::Vec3;

use super::inside_layer::InsideLayers;
use super::panel_tab::PanelTab;
use super::session::{ASPECT, Session};
use super::view_action::ViewAction;
use super::view_drag::ViewDrag;
use crate::document::{Camera, Overlay, RigKind};
use crate::kinematics::skeleton::JointId;
use crate::rig::Crowd;

/// Camera, crowd and panels.
impl Session {
    /// The present camera, which changes during a glide.
    pub fn camera(&self) -> &Camera {
        &self.document().camera
    }

    /// The camera at the end of its glide, or the present camera if it does not glide.
    pub fn settled_camera(&self) -> Camera {
        self.view.glide_target().unwrap_or(*self.camera())
    }

    /// The drag of the camera; `None` if the camera is not dragged.
    pub fn view_drag(&self) -> Option<&ViewDrag> {
        self.view.drag()
    }

    /// What is shown of the part of an iteration that is looked at.
    pub fn inside_layers(&self) -> InsideLayers {
        self.view.inside_layers
    }

    /// Whether the camera is gliding, which is a smooth move to another camera.
    pub fn is_gliding(&self) -> bool {
        self.view.is_gliding()
    }

    /// The crowd that is shown instead of the rig, with the bones of the document's arm; `None` if
    /// the crowd is hidden.
    pub fn crowd(&self) -> Option<Crowd> {
        self.view.crowd(self.arm().bones)
    }

    /// Whether the crowd's targets are animated rather than paused.
    pub fn is_crowd_moving(&self) -> bool {
        self.view.is_crowd_animated()
    }

    /// A camera that frames the selected joints; without a selection, the whole rig. If the crowd
    /// is shown, the camera frames the crowd.
    pub fn framing_selection(&self) -> Camera {
        if self.crowd().is_some() {
            return self.framing_all();
        }
        let (centre, radius) = match self.rig() {
            RigKind::Arm => self.arm().bounds(self.pose()),
            RigKind::Skeleton => self
                .skeleton_rig()
                .bounds_of(self.skeleton_pose(), self.selection())
                .unwrap_or_else(|| self.skeleton_rig().bounds(self.skeleton_pose(), self.time())),
        };
        self.settled_camera().framing(centre, radius, ASPECT)
    }

    /// A camera that frames what is shown, over the whole timeline: all points in reach of the arm, the
    /// skeleton with its targets, or the crowd.
    pub fn framing_all(&self) -> Camera {
        if let Some(crowd) = self.crowd() {
            let (centre, radius) = crowd.bounds();
            return self.settled_camera().framing(centre, radius, ASPECT);
        }
        let (centre, radius) = self
            .shown()
            .motion_bounds_by(|posed| (posed.arm().root, posed.arm().reach_limits().outer));
        self.settled_camera().framing(centre, radius, ASPECT)
    }

    /// The page of the panel on the right.
    pub fn tab(&self) -> PanelTab {
        match self.rig() {
            RigKind::Arm => self.preferences.arm_tab,
            RigKind::Skeleton => self.preferences.skeleton_tab,
        }
    }

    /// Whether the skin is shown for each way of blending joints.
    pub fn compares_skinning(&self) -> bool {
        let display = self.shown().display;
        let is_shown = display.shows(Overlay::Skin) && display.shows(Overlay::CompareSkinning);
        is_shown && self.rig() == RigKind::Skeleton
    }

    /// Whether the timeline is open above the transport bar: by choice, else if the document has keys.
    pub fn shows_timeline(&self) -> bool {
        let has_keys = || !self.document().keys.is_empty();
        self.preferences.timeline_open.unwrap_or_else(has_keys)
    }

    pub(super) fn apply_view(&mut self, action: ViewAction) {
        match action {
            ViewAction::SetCamera(camera) => {
                self.view.stop_glide();
                self.set_camera(camera);
            }
            ViewAction::GlideTo(camera) => {
                if camera.is_valid() {
                    self.glide_to(camera);
                }
            }
            ViewAction::Grab(motion, at) => self.view.grab(motion, *self.camera(), at),
            ViewAction::Drag { to, aspect } => {
                if let Some(drag) = self.view.drag() {
                    self.set_camera(drag.camera(to, aspect));
                }
            }
            ViewAction::Drop => {
                self.view.drop();
            }
            ViewAction::Cancel => {
                if let Some(before) = self.view.drop() {
                    self.set_camera(before);
                }
            }
            ViewAction::FollowSelection(follows) => self.follow_selection(follows),
            ViewAction::ShowInside(layer, shown) => {
                self.view.inside_layers = self.view.inside_layers.with(layer, shown);
            }
            ViewAction::ShowCrowd(shown) => {
                if self.view.show_crowd(shown) {
                    self.forget_pause();
                    self.glide_to(self.framing_all());
                }
            }
            ViewAction::SetCrowdSize(arms) => self.view.set_crowd_size(arms),
            ViewAction::SetCrowdSolver(processor) => self.view.set_crowd_solver(processor),
            ViewAction::AnimateCrowd(animated) => {
                self.view.animate_crowd(animated);
                self.forget_pause();
            }
            ViewAction::ResetTransport => self.reset_transport(),
            ViewAction::ShowExplain(shown) => self.preferences.explain = shown,
            ViewAction::ShowTab(tab) => self.show_tab(tab),
            ViewAction::ShowTimeline(shown) => self.preferences.timeline_open = Some(shown),
            ViewAction::ShowGraphEditor(shown) => self.preferences.curves = shown,
        }
    }

    pub(super) fn show_tab(&mut self, tab: PanelTab) {
        let rig = self.rig();
        if !PanelTab::of(rig).contains(&tab) {
            return;
        }
        match rig {
            RigKind::Arm => self.preferences.arm_tab = tab,
            RigKind::Skeleton => self.preferences.skeleton_tab = tab,
        }
    }

    /// Whether the camera follows the selected joints, or without a selection the whole rig, while the time
    /// changes.
    pub fn follows_selection(&self) -> bool {
        self.view.follows_selection()
    }

    /// Starts or stops to follow the selection. At the start, the camera glides so that it is in the middle
    /// of the picture.
    fn follow_selection(&mut self, follows: bool) {
        self.view.follow_selection(follows);
        let camera = Camera { target: self.followed_point(), ..self.settled_camera() };
        if follows && camera.is_valid() {
            self.glide_to(camera);
        }
    }

    /// The point that the camera follows, in the world: the mean of the bases of the selected joints, or
    /// without a selection of all joints. For the arm it is the Root.
    fn followed_point(&self) -> Vec3 {
        let pose = self.skeleton_pose();
        let bases = |joints: &[JointId]| {
            let weight = 1.0 / joints.len() as f32;
            joints.iter().map(|joint| pose.base(*joint) * weight).sum()
        };
        match self.rig() {
            RigKind::Arm => self.arm().root,
            RigKind::Skeleton if self.selection().is_empty() => {
                bases(&pose.ids().collect::<Vec<_>>())
            }
            RigKind::Skeleton => bases(self.selection()),
        }
    }

    /// Changes the pose by `change`. If the camera follows the selection, it moves as far as that does.
    pub(super) fn with_camera_following(&mut self, change: impl FnOnce(&mut Self)) {
        if !self.follows_selection() || self.crowd().is_some() {
            return change(self);
        }
        let before = self.followed_point();
        change(self);
        let by = self.followed_point() - before;
        let moved = Camera { target: self.camera().target + by, ..*self.camera() };
        if moved.is_valid() {
            self.view.translate(by);
            self.set_camera(moved);
        }
    }

    pub(super) fn glide_to(&mut self, camera: Camera) {
        self.view.glide(*self.camera(), camera);
    }

    /// Moves the camera to the end of its glide.
    pub(super) fn end_glide(&mut self) {
        if let Some(camera) = self.view.take_glide_target() {
            self.set_camera(camera);
        }
    }

    /// Forgets the previous frame unless the timeline plays, so that the crowd continues from where
    /// it paused.
    fn forget_pause(&mut self) {
        if !self.is_playing() {
            self.playback.forget_last_frame();
        }
    }
}
