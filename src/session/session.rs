use std::path::PathBuf;

use super::evaluated::Evaluated;
use super::files::files::Files;
use super::history::editing::Editing;
use super::inspections::{InspectionJob, Inspections};
use super::limb::ShownLimb;
use super::playback::Playback;
use super::pops::CursorMove;
use super::preferences::Preferences;
use super::reach_regions::ReachRegions;
use super::selection::Selection;
use super::shell::Shell;
use super::solver::solvers::Solvers;
use super::tour::state::TourState;
use super::view::View;
use crate::document::{Camera, Document, Inspection, Posed, SkeletonRig};
use crate::kinematics::skeleton::{Skeleton, SkeletonPose};
use crate::kinematics::two_bone::TwoBone;
use crate::rig::Crowd;
use crate::session::drag::follow_mouse::FollowMouse;

mod act;
mod files;
mod framing;
mod reach;
mod time;
mod tour;

/// Ratio of width to height of the viewport that cameras are framed for; the margin of a framed
/// view allows for other ratios.
pub(super) const ASPECT: f32 = 1.0;

/// An open document with its history, and state that is neither saved nor undone. Each part owns
/// its state. An action is applied by its part, which returns an outcome; only the session acts on
/// that, so that the effects of one part on another stand in one list.
///
/// Parts cannot be changed past the session:
///
/// ```compile_fail
/// # let mut session = ik_arm::session::Session::default();
/// session.playback.time = 1.0;
/// ```
///
/// ```compile_fail
/// # let session = ik_arm::session::Session::default();
/// session.playback().set_playing(true);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Session {
    editing: Editing,
    evaluated: Evaluated,
    selection: Selection,
    playback: Playback,
    solvers: Solvers,
    inspections: Inspections,
    reach_regions: ReachRegions,
    view: View,
    files: Files,
    shell: Shell,
    preferences: Preferences,
    /// Where the user is in the tour; `None` outside of it.
    tour: Option<TourState>,
    /// During the tour, the session with the user's own document.
    own: Option<Box<Session>>,
}

impl Default for Session {
    fn default() -> Self {
        Self::new(Preferences::default())
    }
}

impl Session {
    /// A session with a new document: the arm.
    pub fn new(preferences: Preferences) -> Self {
        Self::with_document(preferences, Document::default())
    }

    /// A session with a document.
    pub fn with_document(preferences: Preferences, document: Document) -> Self {
        let mut editing = Editing::new(document);
        editing.evaluate(Playback::default().time());
        let mut evaluated = Evaluated::new(editing.posed());
        let limb = ShownLimb::new(editing.posed(), None);
        evaluated.follow_limb(limb, CursorMove::Set, editing.posed().time());
        Self {
            evaluated,
            editing,
            selection: Selection::default(),
            playback: Playback::default(),
            solvers: Solvers::default(),
            inspections: Inspections::default(),
            reach_regions: ReachRegions::default(),
            view: View::default(),
            files: Files::default(),
            shell: Shell::default(),
            preferences,
            tour: None,
            own: None,
        }
    }
}

/// Parts.
impl Session {
    /// The document's revisions and the steps to undo and redo.
    pub fn history(&self) -> &Editing {
        &self.editing
    }

    /// Selected joints, keys and channels, and what is under the mouse.
    pub fn selection(&self) -> &Selection {
        &self.selection
    }

    /// Values derived from the pose at the playhead: pops, holonomy, the skin.
    pub fn evaluated(&self) -> &Evaluated {
        &self.evaluated
    }

    /// The playhead and the settings of the transport bar.
    pub fn playback(&self) -> &Playback {
        &self.playback
    }

    /// The solver run or the comparison of solvers.
    pub fn solvers(&self) -> &Solvers {
        &self.solvers
    }

    /// The faults that were found in the motion of the figure: pops, lost targets, slides. `None`
    /// while that is not known, or if no targets move a figure.
    pub fn inspection(&self) -> Option<&Inspection> {
        self.inspections.found(&self.editing)
    }

    /// The inspection of the motion that should run now, on a thread of its own: see
    /// [`InspectAction`](crate::session::InspectAction). `None` if all is known.
    pub fn next_inspection(&self) -> Option<InspectionJob> {
        self.inspections.next(&self.editing)
    }

    /// The moves of the camera, and the crowd.
    pub fn view(&self) -> &View {
        &self.view
    }

    /// The document's file, recent files and the running export.
    pub fn files(&self) -> &Files {
        &self.files
    }

    /// The open dialog and the message in the status bar.
    pub fn shell(&self) -> &Shell {
        &self.shell
    }

    /// The user's preferences, such as theme, navigation and open panels.
    pub fn preferences(&self) -> &Preferences {
        &self.preferences
    }

    /// Where the user is in the tour; `None` outside of it.
    pub fn tour(&self) -> Option<&TourState> {
        self.tour.as_ref()
    }

    /// The session with the user's own document, which the tour does not change: outside the tour,
    /// this session.
    pub fn own(&self) -> &Self {
        self.own.as_deref().unwrap_or(self)
    }

    /// Sets the recent files and the folder of the last export or picture, as saved by an earlier
    /// run of the program.
    pub fn restore_files(&mut self, recent: Vec<PathBuf>, export_folder: Option<PathBuf>) {
        self.files.restore(recent, export_folder);
    }

    /// Sets the text for the status bar once the file is open that was read: with unsaved changes,
    /// that is after a question.
    pub fn remark_when_opened(&mut self, remark: Option<String>) {
        self.files.set_remark(remark);
    }
}

/// The document and its pose.
impl Session {
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

    /// The joints with their targets at the playhead.
    pub fn rig(&self) -> &SkeletonRig {
        &self.shown().rig
    }

    /// The joints of the skeleton at the playhead.
    pub fn skeleton(&self) -> &Skeleton {
        self.shown().skeleton()
    }

    /// The limb that pages and guides are about: that of the selected joint, else the first;
    /// `None` without a limb.
    pub fn limb(&self) -> Option<&ShownLimb> {
        self.evaluated.limb()
    }

    /// The limb of a figure that the open page is about.
    pub fn limb_of_page(&self) -> Option<&ShownLimb> {
        let preferences = self.preferences();
        let is_about_limb = preferences.explain && preferences.tab.is_of_limb();
        self.limb().filter(|_| is_about_limb && self.rig().sole_limb().is_none())
    }

    /// The pose of the skeleton at the playhead, in world space.
    pub fn skeleton_pose(&self) -> &SkeletonPose {
        self.evaluated.skeleton_pose()
    }
}

/// State of the parts.
impl Session {
    /// True if the next frame differs without further input.
    pub fn is_moving(&self) -> bool {
        self.view.is_gliding()
            || self.playback.is_playing()
            || self.view.is_crowd_moving()
            || self.solvers.is_busy()
            || self.view.wiggled().is_some()
    }

    /// The present camera, which changes during a glide.
    pub fn camera(&self) -> &Camera {
        &self.document().camera
    }

    /// The camera at the end of its glide, or the present camera if it does not glide.
    pub fn settled_camera(&self) -> Camera {
        self.view.glide_target().unwrap_or(*self.camera())
    }

    /// The crowd that is shown instead of the rig, with the bones of the shown limb; `None` if the
    /// crowd is hidden.
    pub fn crowd(&self) -> Option<Crowd> {
        self.view.crowd(self.crowd_bones().ok()?)
    }

    /// The bones of the arms of a crowd: those of the shown limb.
    ///
    /// # Errors
    ///
    /// The reason why there is none: the arms of a crowd are straight hinges without limits.
    pub fn crowd_bones(&self) -> Result<TwoBone, &'static str> {
        const SAME: f32 = 1e-4;
        let limb = self.limb().ok_or("A crowd is of limbs, and the figure has none")?;
        let (bones, range) = (limb.frames.bones(), limb.frames.range);
        let is_near = |a: f32, b: f32| (a - b).abs() <= SAME * bones.outer_limit();
        let opened = limb.frames.posed.ik.soft_reach.least_distance(bones);
        let upper = self.rig().limb_joints(limb.target).next();
        let is_limited = upper.is_some_and(|it| self.skeleton()[it].limits.is_limited());
        let is_free = is_near(range.inner, opened) && is_near(range.outer, bones.outer_limit());
        if is_limited || !is_free {
            return Err("A crowd is of limbs without limits, whose bones are straight");
        }
        Ok(bones)
    }

    /// True if targets move heads, which can follow the mouse.
    pub fn can_follow_mouse(&self) -> bool {
        self.crowd().is_none() && FollowMouse::new(self.posed()).is_some()
    }
}
