//! The document with what is not saved: what is selected and dragged, what a solver is at, what the
//! view glides to, what happened last. Everything that can happen to it is an [`Action`].

mod action;
mod apply;
mod arm;
mod drag;
mod point_drag;
mod preferences;
mod race;
mod run;
mod skeleton;
mod skeleton_drag;
mod solving;
mod staging;
mod turn_drag;
mod view_drag;

use std::path::{Path, PathBuf};

pub use action::{Action, Effect};
pub use drag::{Drag, Grip};
pub use point_drag::{Constraint, DragInput, Handle, PointDrag};
pub use preferences::{Navigation, Preferences};
pub use race::{Race, Runner};
pub use solving::{History, Solving};
pub use staging::{Ghost, Staging};
pub use turn_drag::{Ring, TurnDrag};
pub use view_drag::{Motion, ViewDrag};

use crate::document::{Arm, Camera, Document, RigKind, SkeletonRig};
use crate::kinematics::skeleton::Pose as SkeletonPose;
use crate::kinematics::two_bone::Pose;
use view_drag::Glide;

/// Panels leave the viewport about as high as it is wide; the margin of a framed view covers the
/// rest.
const ASPECT: f32 = 1.0;

/// An open document and what is going on with it.
#[derive(Clone, Debug, PartialEq)]
pub struct Session {
    document: Document,
    /// Where the document was opened from or saved to.
    file: Option<PathBuf>,
    pose: Pose,
    skeleton_pose: SkeletonPose,
    preferences: Preferences,
    edit: Option<Edit>,
    /// Joints; the last one is the one that is worked on.
    selection: Vec<usize>,
    pointed: Option<usize>,
    clock: Clock,
    solving: Option<Solving>,
    race: Option<Race>,
    view_drag: Option<ViewDrag>,
    glide: Option<Glide>,
    dialog: Option<Dialog>,
    message: Option<String>,
}

/// A change that is not finished: it can still be taken back.
#[derive(Clone, Debug, PartialEq)]
struct Edit {
    arm: Arm,
    skeleton: SkeletonRig,
    drag: Option<Drag>,
}

/// The time that targets and snakes move by.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Clock {
    /// In seconds.
    time: f64,
    playing: bool,
    /// When the last picture was made, in seconds of the window; nothing before the first.
    last: Option<f64>,
}

/// A window over the others.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Dialog {
    About,
    Shortcuts,
    /// Each asks for a path, which is shown as it is typed.
    SavePicture {
        path: String,
    },
    Open {
        path: String,
    },
    SaveAs {
        path: String,
    },
    /// A file has several skeletons.
    ChooseSkeleton {
        path: PathBuf,
        names: Vec<String>,
    },
    /// Asks for a joint's name, which is shown as it is typed.
    Rename {
        joint: usize,
        name: String,
    },
}

impl Default for Session {
    fn default() -> Self {
        Self::new(Preferences::default())
    }
}

impl Session {
    /// The seed's arm.
    pub fn new(preferences: Preferences) -> Self {
        Self::with_document(preferences, Document::default())
    }

    pub fn with_document(preferences: Preferences, document: Document) -> Self {
        Self {
            pose: document.arm.pose(),
            skeleton_pose: document.skeleton.at(0.0).pose(),
            document,
            file: None,
            preferences,
            edit: None,
            selection: Vec::new(),
            pointed: None,
            clock: Clock::default(),
            solving: None,
            race: None,
            view_drag: None,
            glide: None,
            dialog: None,
            message: None,
        }
    }

    pub fn document(&self) -> &Document {
        &self.document
    }

    /// Where the document was opened from or saved to.
    pub fn file(&self) -> Option<&Path> {
        self.file.as_deref()
    }

    pub fn rig(&self) -> RigKind {
        self.document.rig
    }

    pub fn arm(&self) -> &Arm {
        &self.document.arm
    }

    pub fn skeleton(&self) -> &SkeletonRig {
        &self.document.skeleton
    }

    pub fn camera(&self) -> &Camera {
        &self.document.camera
    }

    /// The document's arm, solved.
    pub fn pose(&self) -> &Pose {
        &self.pose
    }

    /// The document's skeleton as it stands at this time, in the world.
    pub fn skeleton_pose(&self) -> &SkeletonPose {
        &self.skeleton_pose
    }

    /// What a picture shows beside the document.
    pub fn staging(&self) -> Staging {
        let runners = self.race.iter().flat_map(Race::runners);
        let ghost = |runner: &Runner| Ghost::new(runner.method, &runner.skeleton);
        Staging {
            time: self.clock.time,
            selection: self.selection.clone(),
            pointed: self.pointed,
            ghosts: runners.filter(|runner| runner.report().is_ok()).map(ghost).collect(),
        }
    }

    pub fn preferences(&self) -> &Preferences {
        &self.preferences
    }

    /// Whether a change is under way that can be taken back.
    pub fn is_editing(&self) -> bool {
        self.edit.is_some()
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
    pub fn selection(&self) -> &[usize] {
        &self.selection
    }

    /// The selected joint that is worked on.
    pub fn selected(&self) -> Option<usize> {
        self.selection.last().copied()
    }

    /// The joint that the pointer is on, in the viewport or in the tree.
    pub fn pointed(&self) -> Option<usize> {
        self.pointed
    }

    /// In seconds.
    pub fn time(&self) -> f64 {
        self.clock.time
    }

    /// Whether the time goes on.
    pub fn is_playing(&self) -> bool {
        self.clock.playing
    }

    /// What a solver has done since the last reset.
    pub fn solving(&self) -> Option<&Solving> {
        self.solving.as_ref()
    }

    /// Whether a solver is at work.
    pub fn is_running(&self) -> bool {
        self.solving.as_ref().is_some_and(Solving::is_running)
    }

    pub fn race(&self) -> Option<&Race> {
        self.race.as_ref()
    }

    /// Whether the next picture is another one by itself.
    pub fn is_moving(&self) -> bool {
        let plays = self.clock.playing && self.skeleton().is_moving();
        self.is_gliding()
            || plays
            || self.is_running()
            || self.race.as_ref().is_some_and(Race::is_running)
    }

    /// The view that shows what is worked on: the selected joints, else the rig as it stands.
    pub fn framing_selection(&self) -> Camera {
        let (centre, radius) = match self.rig() {
            RigKind::Arm => self.arm().bounds(&self.pose),
            RigKind::Skeleton => self
                .skeleton()
                .bounds_of(&self.skeleton_pose, &self.selection)
                .unwrap_or_else(|| self.skeleton().bounds(&self.skeleton_pose, self.clock.time)),
        };
        self.settled_camera().framing(centre, radius, ASPECT)
    }

    /// The view that shows all that the arm's hand can reach, or the skeleton with its targets.
    pub fn framing_all(&self) -> Camera {
        let (centre, radius) = match self.rig() {
            RigKind::Arm => (self.arm().root, self.arm().bones.outer_limit()),
            RigKind::Skeleton => self.skeleton().bounds(&self.skeleton_pose, self.clock.time),
        };
        self.settled_camera().framing(centre, radius, ASPECT)
    }

    pub fn dialog(&self) -> Option<&Dialog> {
        self.dialog.as_ref()
    }

    /// What just happened, if it is worth a word.
    pub fn message(&self) -> Option<&str> {
        self.message.as_deref()
    }
}
