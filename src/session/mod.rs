//! The document with what is not saved: what is selected and dragged, what a solver is at, what the
//! view glides to, what happened last. Everything that can happen to it is an [`Action`].

mod action;
mod apply;
mod arm;
mod comparison;
mod crowd;
mod dialog;
mod drag;
mod edit_action;
mod edit_label;
mod effect;
mod export;
mod file_action;
mod files;
mod history;
mod keys;
mod message;
mod overlays;
mod playback;
mod playback_action;
mod point_drag;
mod pop_fix;
mod pops;
mod pose_line;
mod pose_mode;
mod preferences;
mod run;
mod select_action;
mod shell_action;
mod skeleton;
mod skeleton_drag;
mod solver_action;
mod solver_run;
mod solver_status;
mod trail;
mod transaction;
mod transaction_action;
mod transport;
mod turn_drag;
mod view_action;
mod view_drag;

use std::cell::OnceCell;
use std::collections::BTreeSet;
use std::path::PathBuf;

use glam::Vec3;

pub use action::{Action, Actions};
pub use comparison::{Comparison, Runner};
pub use dialog::Dialog;
pub use drag::{Drag, Grip};
pub use edit_action::EditAction;
pub use effect::Effect;
pub use export::{Export, Job};
pub use file_action::FileAction;
pub use keys::Key;
pub use overlays::{Ghost, OnionSkin, Overlays};
pub use playback_action::PlaybackAction;
pub use point_drag::{Constraint, DragInput, Handle, PointDrag};
pub use pop_fix::PopFix;
pub use pops::{Pops, Sample, Spike, What};
pub use pose_mode::PoseMode;
pub use preferences::{Navigation, Preferences};
pub use select_action::SelectAction;
pub use shell_action::ShellAction;
pub use solver_action::SolverAction;
pub use solver_run::{History, SolverRun};
pub use solver_status::{SolverState, SolverStatus};
pub use transaction_action::TransactionAction;
pub use transport::TransportPath;
pub use turn_drag::{Ring, TurnDrag};
pub use view_action::ViewAction;
pub use view_drag::{Motion, ViewDrag};

use crate::document::{Arm, Camera, Channel, Document, RigKind, SkeletonRig};
use crate::io;
use crate::kinematics::skeleton::{JointId, Skeleton, SkeletonPose};
use crate::kinematics::two_bone::TwoBonePose;
use crowd::Crowding;
use history::{Overrides, State};
use keys::Clipboard;
use message::Message;
use playback::Playback;
use transaction::Transaction;
use view_drag::Glide;

/// Panels leave the viewport about as high as it is wide; the margin of a framed view covers the
/// rest.
const ASPECT: f32 = 1.0;

/// An open document and what is going on with it.
#[derive(Clone, Debug, PartialEq)]
pub struct Session {
    document: Document,
    /// The document as it stands now: at this time, with what is shown against its keys.
    shown: Document,
    /// Where the document was opened from or saved to.
    file: Option<PathBuf>,
    recent: Vec<PathBuf>,
    pose: TwoBonePose,
    skeleton_pose: SkeletonPose,
    transport_path: TransportPath,
    pops: Pops,
    /// Walked when it is first shown.
    trail: OnceCell<Vec<Vec3>>,
    preferences: Preferences,
    edit: Option<Transaction>,
    history: history::History,
    /// The same number, the same document.
    revision: u64,
    newest_revision: u64,
    /// The same number, the same document but for how it is looked at.
    content: u64,
    saved_content: u64,
    overrides: Overrides,
    auto_key: bool,
    selected_channels: BTreeSet<Channel>,
    selected_keys: Vec<Key>,
    clipboard: Clipboard,
    /// Joints; the last one is the one that is worked on.
    selection: Vec<JointId>,
    pointed: Option<JointId>,
    playback: Playback,
    crowding: Crowding,
    solver_run: Option<SolverRun>,
    /// How everything was before the solver that is running.
    run_before: Option<State>,
    comparison: Option<Comparison>,
    view_drag: Option<ViewDrag>,
    glide: Option<Glide>,
    dialog: Option<Dialog>,
    /// Whether the system's file dialog has been asked for and has not answered.
    choosing: bool,
    export_folder: Option<PathBuf>,
    job: Option<Job>,
    /// Whether what an earlier run kept has been opened or declined.
    recovery_settled: bool,
    /// Which document was there when the file was asked for that is being opened.
    opening: Option<u64>,
    /// What waits for the document to be saved.
    then: Option<Box<FileAction>>,
    message: Option<Message>,
}

impl Default for Session {
    fn default() -> Self {
        Self::new(Preferences::default())
    }
}

impl Session {
    /// A new window's: the arm, with the Human behind the Skeleton switch.
    pub fn new(preferences: Preferences) -> Self {
        Self::with_document(preferences, io::new_document())
    }

    pub fn with_document(preferences: Preferences, document: Document) -> Self {
        Self {
            transport_path: TransportPath::new(&document.arm),
            pops: Pops::new(&document.arm, document.arm.pose(), 0.0),
            pose: document.arm.pose(),
            skeleton_pose: document.skeleton_rig.at(0.0).pose(),
            shown: document.clone(),
            document,
            file: None,
            recent: Vec::new(),
            trail: OnceCell::new(),
            preferences,
            edit: None,
            history: history::History::default(),
            revision: 0,
            newest_revision: 0,
            content: 0,
            saved_content: 0,
            overrides: Overrides::default(),
            auto_key: false,
            selected_channels: BTreeSet::new(),
            selected_keys: Vec::new(),
            clipboard: Clipboard::default(),
            selection: Vec::new(),
            pointed: None,
            playback: Playback::default(),
            crowding: Crowding::default(),
            solver_run: None,
            run_before: None,
            comparison: None,
            view_drag: None,
            glide: None,
            dialog: None,
            choosing: false,
            export_folder: None,
            job: None,
            recovery_settled: false,
            opening: None,
            then: None,
            message: None,
        }
    }

    /// What is saved.
    pub fn document(&self) -> &Document {
        &self.document
    }

    /// The document as it stands now: keyed channels have the values of this time, or those that
    /// they were given since the time changed.
    pub fn shown(&self) -> &Document {
        &self.shown
    }

    pub fn rig(&self) -> RigKind {
        self.document.rig
    }

    pub fn arm(&self) -> &Arm {
        &self.shown.arm
    }

    /// The skeleton as it stands now, with its targets.
    pub fn skeleton_rig(&self) -> &SkeletonRig {
        &self.shown.skeleton_rig
    }

    /// The joints of the skeleton rig.
    pub fn skeleton(&self) -> &Skeleton {
        self.shown.skeleton()
    }

    pub fn camera(&self) -> &Camera {
        &self.document.camera
    }

    /// The document's arm, solved.
    pub fn pose(&self) -> &TwoBonePose {
        &self.pose
    }

    /// What has been carried along with the Pointer.
    pub fn transport_path(&self) -> &TransportPath {
        &self.transport_path
    }

    /// The document's skeleton as it stands at this time, in the world.
    pub fn skeleton_pose(&self) -> &SkeletonPose {
        &self.skeleton_pose
    }

    pub fn preferences(&self) -> &Preferences {
        &self.preferences
    }

    /// Whether a change is under way that can be taken back.
    pub fn is_editing(&self) -> bool {
        self.edit.is_some()
    }

    /// What sliders of the arm go by, a hundredth of its cell: that of the arm as it was before the
    /// change under way, so that no rail moves under the pointer.
    pub fn arm_unit(&self) -> f32 {
        self.edit.as_ref().map_or(&self.shown, |edit| &edit.shown).arm.cell() * 0.01
    }

    /// What is being dragged in the viewport.
    pub fn drag(&self) -> Option<&Drag> {
        self.edit.as_ref()?.drag.as_ref()
    }

    /// The point that is being dragged in the viewport.
    pub fn point_drag(&self) -> Option<&PointDrag> {
        self.drag()?.point()
    }

    pub fn view_drag(&self) -> Option<&ViewDrag> {
        self.view_drag.as_ref()
    }

    /// Whether the view is on its way.
    pub fn is_gliding(&self) -> bool {
        self.glide.is_some()
    }

    /// Selected joints, the one that is worked on last.
    pub fn selection(&self) -> &[JointId] {
        &self.selection
    }

    /// The selected joint that is worked on.
    pub fn selected(&self) -> Option<JointId> {
        self.selection.last().copied()
    }

    /// The joint that the pointer is on, in the viewport or in the tree.
    pub fn pointed(&self) -> Option<JointId> {
        self.pointed
    }

    /// What a solver has done since the last reset.
    pub fn solver_run(&self) -> Option<&SolverRun> {
        self.solver_run.as_ref()
    }

    /// Whether a solver is at work.
    pub fn is_running(&self) -> bool {
        self.solver_run.as_ref().is_some_and(SolverRun::is_running)
    }

    pub fn comparison(&self) -> Option<&Comparison> {
        self.comparison.as_ref()
    }

    /// Whether the next picture is another one by itself.
    pub fn is_moving(&self) -> bool {
        self.is_gliding()
            || self.playback.playing
            || self.crowding.is_going_on()
            || self.is_running()
            || self.comparison.as_ref().is_some_and(Comparison::is_running)
    }

    /// The view that shows what is worked on: the selected joints, else the rig as it stands.
    pub fn framing_selection(&self) -> Camera {
        if self.crowd().is_some() {
            return self.framing_all();
        }
        let (centre, radius) = match self.rig() {
            RigKind::Arm => self.arm().bounds(&self.pose),
            RigKind::Skeleton => {
                self.skeleton_rig().bounds_of(&self.skeleton_pose, &self.selection).unwrap_or_else(
                    || self.skeleton_rig().bounds(&self.skeleton_pose, self.playback.time),
                )
            }
        };
        self.settled_camera().framing(centre, radius, ASPECT)
    }

    /// The view that shows all that the arm's hand can reach, or the skeleton with its targets; of a
    /// crowd all arms.
    pub fn framing_all(&self) -> Camera {
        if let Some(crowd) = self.crowd() {
            let (centre, radius) = crowd.bounds();
            return self.settled_camera().framing(centre, radius, ASPECT);
        }
        let (centre, radius) = match self.rig() {
            RigKind::Arm => (self.arm().root, self.arm().bones.outer_limit()),
            RigKind::Skeleton => {
                self.skeleton_rig().bounds(&self.skeleton_pose, self.playback.time)
            }
        };
        self.settled_camera().framing(centre, radius, ASPECT)
    }

    /// All that is shown follows the document and the time.
    fn refresh(&mut self) {
        self.shown.clone_from(&self.document);
        self.shown.keys_to(self.playback.time);
        for (channel, value) in &self.overrides {
            channel.set(&mut self.shown, *value);
        }
        self.pose = self.shown.arm.pose();
        self.transport_path.go_on(&self.shown.arm);
        self.watch_elbow();
        self.shown.skeleton_rig.write_pose(self.playback.time, &mut self.skeleton_pose);
        let count = self.skeleton_pose.len();
        self.selection.retain(|joint| joint.index() < count);
        self.pointed = self.pointed.filter(|joint| joint.index() < count);
        let skeleton = self.shown.skeleton();
        self.comparison.take_if(|comparison| !comparison.is_of(skeleton));
        self.retain_keys();
    }

    /// A view that is none leaves the last one: so far away, numbers end.
    fn set_camera(&mut self, camera: Camera) {
        if camera.is_valid() {
            self.document.camera = camera;
            self.shown.camera = camera;
        }
    }

    fn select(&mut self, joints: Vec<JointId>) {
        self.selection = joints;
        self.selection.retain(|joint| joint.index() < self.skeleton_pose.len());
        self.forget_trail();
    }

    fn point(&mut self, joint: Option<JointId>) {
        self.pointed = joint.filter(|joint| joint.index() < self.skeleton_pose.len());
    }
}
