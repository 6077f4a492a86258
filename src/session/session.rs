use super::editing::Editing;
use super::evaluated::Evaluated;
use super::files::Files;
use super::follow_mouse::FollowMouse;
use super::playback::Playback;
use super::pops::{CursorMove, Pops};
use super::preferences::Preferences;
use super::selection::Selection;
use super::shell::Shell;
use super::solvers::Solvers;
use super::tour::TourState;
use super::transport::TransportPath;
use super::view::View;
use super::wiggle::Wiggle;
use crate::document::{Arm, Camera, Document, Posed, RigKind, SkeletonRig};
use crate::io;
use crate::kinematics::skeleton::{JointId, Skeleton, SkeletonPose};
use crate::kinematics::two_bone::TwoBonePose;
use crate::rig::{EvaluatedSkeleton, TargetReport};

/// Ratio of width to height of the viewport that cameras are framed for; the margin of a framed
/// view allows for other ratios.
pub(super) const ASPECT: f32 = 1.0;

/// An open document with its history, and state that is neither saved nor undone. Each part owns
/// its state; a session passes actions to the parts, and changes of one part to the others.
#[derive(Clone, Debug, PartialEq)]
pub struct Session {
    pub(super) editing: Editing,
    pub(super) evaluated: Evaluated,
    pub(super) selection: Selection,
    pub(super) wiggle: Option<Wiggle>,
    /// Heads that follow the mouse, in a transaction of their own.
    pub(super) follow_mouse: Option<FollowMouse>,
    pub(super) playback: Playback,
    pub(super) solvers: Solvers,
    pub(super) view: View,
    pub(super) files: Files,
    pub(super) shell: Shell,
    pub(super) preferences: Preferences,
    /// Where the user is in the tour; `None` outside of it.
    pub(super) tour: Option<TourState>,
    /// During the tour, the session with the user's own document.
    pub(super) own: Option<Box<Session>>,
}

impl Default for Session {
    fn default() -> Self {
        Self::new(Preferences::default())
    }
}

impl Session {
    /// A session with a new document: the arm, and the example "Human" as its skeleton.
    pub fn new(preferences: Preferences) -> Self {
        Self::with_document(preferences, io::new_document())
    }

    /// A session with a document.
    pub fn with_document(preferences: Preferences, document: Document) -> Self {
        let mut editing = Editing::new(document);
        editing.evaluate(Playback::default().time());
        Self {
            evaluated: Evaluated::new(editing.posed()),
            editing,
            selection: Selection::default(),
            wiggle: None,
            follow_mouse: None,
            playback: Playback::default(),
            solvers: Solvers::default(),
            view: View::default(),
            files: Files::default(),
            shell: Shell::default(),
            preferences,
            tour: None,
            own: None,
        }
    }

    /// The document as it is saved, without interpolated values and unkeyed edits of keyed
    /// channels.
    pub fn document(&self) -> &Document {
        self.editing.document()
    }

    /// The document posed at the playhead, with unkeyed edits.
    pub fn posed(&self) -> &Posed {
        self.editing.posed()
    }

    /// The document evaluated at the playhead, with unkeyed edits.
    pub fn shown(&self) -> &Document {
        self.editing.shown()
    }

    /// The rig that is shown.
    pub fn rig(&self) -> RigKind {
        self.document().rig
    }

    /// The arm at the playhead.
    pub fn arm(&self) -> &Arm {
        &self.shown().arm
    }

    /// The skeleton with its targets at the playhead.
    pub fn skeleton_rig(&self) -> &SkeletonRig {
        &self.shown().skeleton_rig
    }

    /// The joints of the skeleton at the playhead.
    pub fn skeleton(&self) -> &Skeleton {
        self.shown().skeleton()
    }

    /// The pose of the arm at the playhead.
    pub fn pose(&self) -> &TwoBonePose {
        self.posed().arm_pose()
    }

    /// The skeleton at the playhead, posed by FK and by its targets, with a report for each target.
    pub fn evaluated_skeleton(&self) -> &EvaluatedSkeleton {
        self.posed().evaluated_skeleton()
    }

    /// The report of a joint's target at the playhead; `None` if the joint has none.
    pub fn target_report(&self, joint: JointId) -> Option<&TargetReport> {
        self.evaluated_skeleton().targets.get(self.skeleton_rig().target(joint)?)
    }

    /// The pose of the skeleton at the playhead, in world space.
    pub fn skeleton_pose(&self) -> &SkeletonPose {
        self.evaluated.skeleton_pose()
    }

    /// Transport of a frame along the Pointer's path.
    pub fn transport_path(&self) -> &TransportPath {
        self.evaluated.transport_path()
    }

    /// Ratios of elbow speed to Cursor speed in the latest steps.
    pub fn pops(&self) -> &Pops {
        self.evaluated.pops()
    }

    /// Whether the next frame differs without further input.
    pub fn is_moving(&self) -> bool {
        self.view.is_gliding()
            || self.playback.is_playing()
            || self.view.is_crowd_moving()
            || self.solvers.is_busy()
            || self.wiggle.is_some()
    }

    /// Evaluates the document at the playhead and updates all that depends on it.
    pub(super) fn refresh(&mut self) {
        self.editing.evaluate(self.playback.time());
        self.follow_document();
    }

    /// Updates all that depends on the evaluated document.
    pub(super) fn follow_document(&mut self) {
        let cause = match self.editing.revision_before() {
            Some(revision) => CursorMove::Dragged(revision),
            None if self.playback.is_playing() => CursorMove::Played,
            None => CursorMove::Set,
        };
        self.evaluated.update(self.editing.posed(), cause);
        self.selection.retain_joints(self.evaluated.skeleton_pose().len());
        self.update_solvers();
        self.selection.retain_keys(self.editing.document());
    }

    /// Sets the camera; ignores an invalid one.
    pub(super) fn set_camera(&mut self, camera: Camera) {
        if camera.is_valid() {
            self.editing.set_camera(camera);
        }
    }

    pub(super) fn reset_transport(&mut self) {
        self.evaluated.reset_transport(self.editing.posed());
    }

    pub(super) fn forget_trail(&mut self) {
        self.evaluated.forget_trail();
    }
}
