use std::path::PathBuf;

use glam::{Vec2, Vec3};

use super::{Constraint, Dialog, DragInput, Export, Grip, Job, Key, Motion, Navigation};
use crate::document::{
    Camera, Channel, Document, FollowPath, HandSpace, Overlay, Ray, RigKind, Target, Theme,
    Timeline, TwistReferenceKind,
};
use crate::io::Example;
use crate::kinematics::chain_ik::SolverOptions;
use crate::kinematics::skeleton::Limit;
use crate::kinematics::soft_reach::SoftReach;
use crate::rig::SolvedBy;

/// Everything that can happen. Values are absolute, so that an action said twice is harmless.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// The cursor, in Root space.
    SetHand(Vec3),
    /// ψ in radians; wraps around.
    SetTwist(f32),
    SetRoot(Vec3),
    /// Where the hand is pinned, in the world.
    SetPin(Vec3),
    /// Pins the hand to the world, or lets it go with the shoulder; it stays where it is.
    PinHand(bool),
    /// Measures the elbow's spin from elsewhere; the elbow stays.
    SetTwistReference(TwistReferenceKind),
    /// What the elbow points at, in Root space.
    SetPole(Vec3),
    SetSoftReach(SoftReach),
    /// How far the hand leads (1) or the joints' own angles do (0).
    SetInfluence(f32),
    /// Lets the hand lead alone, or the angles; the pose stays.
    SwitchTo(PoseMode),
    /// The shoulder's own angles about x, y and z in radians.
    SetShoulder(Vec3),
    /// The elbow's own bend β, radians.
    SetBend(f32),
    /// The hand's angles about x, y and z in radians.
    SetWrist(Vec3),
    /// What the hand's angles are measured in; the hand stays as it is turned.
    SetWristSpace(HandSpace),
    /// Measures what is carried along with the Pointer from here.
    ResetTransport,
    SetUpper(f32),
    SetLower(f32),
    /// The arm as at first, or the skeleton without rotations; what is shown stays.
    ResetPose,
    ResetAll,
    Show(Overlay, bool),
    ShowRig(RigKind),

    /// Selects these joints and no others; the last is the one that is worked on.
    Select(Vec<usize>),
    /// Says which joint the pointer is on.
    Point(Option<usize>),
    /// Hangs a joint on the tip of another, with its bone ending at a point of the world or going on
    /// like the other's.
    AddChild {
        parent: usize,
        tip: Option<Vec3>,
    },
    /// Adds a joint at the tip of the selected one, else of the last one, and a root below it where
    /// there is none; its bone ends at a point of the world or continues its parent's.
    AddJoint {
        tip: Option<Vec3>,
    },
    AddRoot,
    /// Deletes joints with all their descendants.
    Delete(Vec<usize>),
    /// Deletes joints; their children are attached to the next ancestor that stays, and do not move.
    Dissolve(Vec<usize>),
    Rename {
        joint: usize,
        name: String,
    },
    Reparent {
        joint: usize,
        parent: Option<usize>,
    },
    /// Euler angles about x, y and z in radians.
    SetRotation {
        joint: usize,
        rotation: Vec3,
    },
    /// The bone, from base to tip.
    SetAxis {
        joint: usize,
        axis: Vec3,
    },
    /// How far an angle (0, 1, 2 for x, y, z) can go.
    SetLimit {
        joint: usize,
        axis: usize,
        limit: Option<Limit>,
    },
    SetLocked {
        joint: usize,
        locked: bool,
    },
    SetFollowPath(Option<FollowPath>),
    /// Where the skeleton's own origin is, in the world.
    SetTranslation(Vec3),

    /// Puts a target where a joint's tip is.
    AddTarget(usize),
    /// Takes the target of a joint away.
    RemoveTarget(usize),
    /// Changes the target of the joint that it names.
    SetTarget(Target),
    SetSolver(SolverOptions),
    SetIterationsPerFrame(u32),
    /// Whether the skeleton follows a target while that is dragged.
    SetFollow(bool),
    /// Lets the solver run, or wait.
    Run(bool),
    /// Stops the solver and takes back what it has done since it began to run.
    CancelRun,
    /// One iteration.
    Step,
    /// Back to the pose before the solver ran.
    ResetSolver,
    /// All solvers from the present pose, beside each other; or no longer.
    Comparison(bool),
    /// Lets the time go on, or stand.
    Play(bool),
    /// In seconds.
    SetTime(f64),
    /// Whether the time begins again where the timeline ends.
    SetLooping(bool),
    /// Seconds of the document in one of the window.
    SetSpeed(f64),

    /// Keys channels as they are shown, where the time is.
    Key(Vec<Channel>),
    DeleteKeys(Vec<Key>),
    /// Takes all keys of channels away.
    ClearChannels(Vec<Channel>),
    /// Moves keys, named by where they were before the change under way.
    MoveKeys {
        keys: Vec<Key>,
        by: f64,
    },
    /// Selects these keys and no others.
    SelectKeys(Vec<Key>),
    SelectChannels(Vec<Channel>),
    CopyKeys,
    /// Puts the copied keys to where the time is.
    PasteKeys,
    /// Whether every edit makes keys.
    SetAutoKey(bool),
    SetTimeline(Timeline),
    /// How long a unit is for other programs, in metres; nothing for what is usual.
    SetMetres(Option<f32>),

    /// Begins a change of several steps, such as a slider's drag.
    BeginEdit,
    CommitEdit,
    /// Takes back the change under way.
    CancelEdit,
    Undo,
    Redo,
    /// Takes hold of something; `forward` is the picture's normal.
    Grab {
        grip: Grip,
        ray: Ray,
        forward: Vec3,
    },
    Drag(DragInput),
    ConstrainDrag(Option<Constraint>),
    TypeOffset(String),

    SetCamera(Camera),
    GlideTo(Camera),
    /// Lets all that moves by itself go on to a time of the window, in seconds.
    Advance(f64),
    GrabView(Motion, Vec2),
    DragView {
        to: Vec2,
        aspect: f32,
    },
    DropView,
    /// Takes back the turn under way.
    CancelView,

    SetTheme(Theme),
    SetNavigation(Navigation),
    ShowExplain(bool),
    ShowTimeline(bool),
    /// Shows many arms in the rig's place.
    ShowCrowd(bool),
    /// How many arms; from 1 to [`Crowd::MOST`](crate::rig::Crowd::MOST).
    SetCrowd(u32),
    SolveCrowd(SolvedBy),
    /// Lets the crowd follow its targets, or stand.
    MoveCrowd(bool),
    /// Shows the keys as curves.
    ShowCurves(bool),
    OpenDialog(Dialog),
    CloseDialog,
    /// Says what just happened.
    Report(String),
    /// Says why something was not done.
    Fail(String),

    CopyPose,
    SavePicture(String),
    Export(Export),
    /// Says that an export has begun.
    Exporting(Job),
    CancelExport,
    /// Says how an export has ended, or why it failed.
    Exported(Result<String, String>),
    StopExportAndQuit,
    /// Asks for a path: by the system's own dialog, or where it has none by this one.
    Ask(Dialog),
    /// Asks the system's own dialog for the path that the open dialog wants.
    ChoosePath,
    /// The system's own dialog was closed without a path.
    ChoseNothing,
    /// The system has no dialog of its own for this one.
    NoSystemDialog(Dialog),
    /// A file, and which of its skeletons if it has several.
    Open {
        path: PathBuf,
        skeleton: Option<String>,
    },
    /// Takes a document's place; nothing is left of the one before.
    Opened {
        document: Box<Document>,
        file: Option<PathBuf>,
    },
    /// Says why a file is not opened.
    NotOpened {
        path: PathBuf,
        why: String,
    },
    /// To where the document is from; asks if it is from nowhere.
    Save,
    SaveAs(PathBuf),
    Saved(PathBuf),
    /// Says why the document is not saved.
    NotSaved {
        path: PathBuf,
        why: String,
    },
    /// Saves, then does what would have lost the changes.
    SaveAnd(Box<Action>),
    /// Does it, though it loses changes.
    Discard(Box<Action>),
    /// Opens what an earlier run kept; it is not saved yet.
    Recover {
        document: Box<Document>,
        file: Option<PathBuf>,
    },
    /// Declines it.
    ForgetRecovered,
    /// One of the scenes that come with the program.
    OpenExample(Example),
    /// A root to hang joints from.
    NewSkeleton,
    /// Takes the graphics device away, as a driver's reset does; for tests of what then happens.
    LoseDevice,
    Quit,
}

/// What poses the arm.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PoseMode {
    /// Inverse kinematics: where the hand is asked to be.
    Hand,
    /// Forward kinematics: the joints' own angles.
    Angles,
}

impl Action {
    /// Whether the open document is left behind.
    pub(super) fn leaves_document(&self) -> bool {
        matches!(
            self,
            Self::Open { .. }
                | Self::OpenExample(_)
                | Self::NewSkeleton
                | Self::Recover { .. }
                | Self::Quit
        )
    }
}

/// What the world outside the session is asked to do.
#[derive(Clone, Debug, PartialEq)]
pub enum Effect {
    CopyText(String),
    SavePicture(String),
    Export(Export),
    ChoosePath(Dialog),
    Open { path: PathBuf, skeleton: Option<String> },
    Save(PathBuf),
    LoseDevice,
    Quit,
}
