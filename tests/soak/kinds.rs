//! Every kind of action there is: a new one does not compile until it has its line here.

use ik_arm::document::{HandSpace, RigKind, Theme, TwistReferenceKind};
use ik_arm::rig::SolvedBy;
use ik_arm::session::{Action, Navigation, PoseMode};

use crate::values::Values;

/// What actions are about: they come in bursts of a sort.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sort {
    Arm,
    Build,
    Solve,
    Keys,
    Edit,
    Drag,
    Files,
    /// These leave the document as it is, but for its camera.
    Look,
    Time,
}

impl Sort {
    pub const ALL: [Self; 9] = [
        Self::Arm,
        Self::Build,
        Self::Solve,
        Self::Keys,
        Self::Edit,
        Self::Drag,
        Self::Files,
        Self::Look,
        Self::Time,
    ];
}

pub struct Kind {
    pub name: &'static str,
    pub sort: Sort,
    /// How often it comes, beside others.
    pub weight: u32,
    pub make: fn(&mut Values<'_>) -> Action,
}

/// A line for each, and nothing else: its sort, how often it comes, and how one is made.
macro_rules! kinds {
    ($($name:ident: $sort:ident $weight:literal, $make:expr;)*) => {
        pub const KINDS: &[Kind] = &[$(Kind {
            name: stringify!($name),
            sort: Sort::$sort,
            weight: $weight,
            make: $make,
        }),*];

        /// The place of an action's kind among all.
        pub fn kind(action: &Action) -> usize {
            #[derive(Clone, Copy)]
            enum Place { $($name),* }
            let place = match action { $(Action::$name { .. } => Place::$name),* };
            place as usize
        }
    };
}

kinds! {
    SetHand: Arm 10, |v| Action::SetHand(v.cursor());
    SetTwist: Arm 4, |v| Action::SetTwist(v.angle());
    SetRoot: Arm 4, |v| { let size = v.size(); Action::SetRoot(v.point(size)) };
    SetPin: Arm 3, |v| Action::SetPin(v.cursor());
    PinHand: Arm 3, |v| Action::PinHand(v.coin());
    SetTwistReference: Arm 5, |v| Action::SetTwistReference(v.one_of(&TwistReferenceKind::ALL));
    SetPole: Arm 3, |v| { let size = v.size(); Action::SetPole(v.point(size)) };
    SetSoftReach: Arm 3, |v| Action::SetSoftReach(v.soft_reach());
    SetInfluence: Arm 4, |v| Action::SetInfluence(v.part());
    SwitchTo: Arm 4, |v| Action::SwitchTo(v.one_of(&[PoseMode::Hand, PoseMode::Angles]));
    SetShoulder: Arm 3, |v| Action::SetShoulder(v.angles());
    SetBend: Arm 3, |v| Action::SetBend(v.angle());
    SetWrist: Arm 3, |v| Action::SetWrist(v.angles());
    SetWristSpace: Arm 3, |v| Action::SetWristSpace(v.one_of(&[HandSpace::Lower, HandSpace::World]));
    ResetTransport: Look 1, |_| Action::ResetTransport;
    SetUpper: Arm 2, |v| Action::SetUpper(v.length());
    SetLower: Arm 2, |v| Action::SetLower(v.length());
    ResetPose: Arm 1, |_| Action::ResetPose;
    ResetAll: Arm 1, |_| Action::ResetAll;
    Show: Edit 3, |v| Action::Show(v.layer(), v.coin());
    ShowRig: Edit 3, |v| Action::ShowRig(v.one_of(&[RigKind::Arm, RigKind::Skeleton]));

    Select: Look 4, |v| Action::Select(v.some_joints());
    Point: Look 2, |v| Action::Point(if v.coin() { None } else { Some(v.joint()) });
    AddChild: Build 8, |v| Action::AddChild {
        parent: v.joint(),
        tip: if v.coin() { None } else { Some(v.small_point()) },
    };
    AddJoint: Build 4, |v| Action::AddJoint {
        tip: if v.coin() { None } else { Some(v.small_point()) },
    };
    AddRoot: Build 1, |_| Action::AddRoot;
    Delete: Build 2, |v| Action::Delete(v.some_joints());
    Dissolve: Build 2, |v| Action::Dissolve(v.some_joints());
    Rename: Build 2, |v| Action::Rename { joint: v.joint(), name: v.name() };
    Reparent: Build 3, |v| Action::Reparent {
        joint: v.joint(),
        parent: if v.chance(0.2) { None } else { Some(v.joint()) },
    };
    SetRotation: Build 6, |v| Action::SetRotation { joint: v.joint(), rotation: v.angles() };
    SetAxis: Build 3, |v| Action::SetAxis { joint: v.joint(), axis: v.small_point() * 0.3 };
    SetLimit: Build 3, |v| Action::SetLimit { joint: v.joint(), axis: v.axis(), limit: v.limit() };
    SetLocked: Build 2, |v| Action::SetLocked { joint: v.joint(), locked: v.chance(0.3) };
    SetFollowPath: Solve 1, |v| Action::SetFollowPath(v.follow_path());
    SetTranslation: Build 2, |v| Action::SetTranslation(v.small_point());

    AddTarget: Solve 5, |v| Action::AddTarget(v.joint());
    RemoveTarget: Solve 2, |v| Action::RemoveTarget(v.aimed());
    SetTarget: Solve 6, |v| Action::SetTarget(v.target());
    SetSolver: Solve 3, |v| Action::SetSolver(v.options());
    SetIterationsPerFrame: Solve 1, |v| Action::SetIterationsPerFrame(v.iterations_per_frame());
    SetFollow: Look 1, |v| Action::SetFollow(v.coin());
    Run: Solve 5, |v| Action::Run(v.chance(0.8));
    CancelRun: Solve 1, |_| Action::CancelRun;
    Step: Solve 4, |_| Action::Step;
    ResetSolver: Solve 1, |_| Action::ResetSolver;
    Comparison: Solve 1, |v| Action::Comparison(v.coin());
    Play: Time 4, |v| Action::Play(v.chance(0.7));
    SetTime: Time 8, |v| Action::SetTime(v.time());
    SetLooping: Time 1, |v| Action::SetLooping(v.coin());
    SetSpeed: Time 1, |v| Action::SetSpeed(v.speed());

    Key: Keys 6, |v| Action::Key(v.channels());
    DeleteKeys: Keys 2, |v| Action::DeleteKeys(v.keys());
    ClearChannels: Keys 1, |v| Action::ClearChannels(v.channels());
    MoveKeys: Keys 4, |v| Action::MoveKeys { keys: v.keys(), by: v.shift() };
    SelectKeys: Look 3, |v| Action::SelectKeys(v.keys());
    SelectChannels: Look 1, |v| Action::SelectChannels(v.channels());
    CopyKeys: Look 2, |_| Action::CopyKeys;
    PasteKeys: Keys 2, |_| Action::PasteKeys;
    SetAutoKey: Look 2, |v| Action::SetAutoKey(v.chance(0.3));
    SetTimeline: Keys 2, |v| Action::SetTimeline(v.timeline());
    SetMetres: Edit 1, |v| Action::SetMetres(if v.coin() { None } else { Some(v.above_0(2.0)) });

    BeginEdit: Edit 4, |_| Action::BeginEdit;
    CommitEdit: Edit 3, |_| Action::CommitEdit;
    CancelEdit: Edit 2, |_| Action::CancelEdit;
    Undo: Edit 8, |_| Action::Undo;
    Redo: Edit 5, |_| Action::Redo;
    Grab: Drag 6, |v| Action::Grab { grip: v.grip(), ray: v.ray(), forward: v.forward() };
    Drag: Drag 10, |v| Action::Drag(v.drag_input());
    ConstrainDrag: Drag 2, |v| Action::ConstrainDrag(v.constraint());
    TypeOffset: Drag 2, |v| Action::TypeOffset(v.typed());

    SetCamera: Look 1, |v| Action::SetCamera(v.camera());
    GlideTo: Look 1, |v| Action::GlideTo(v.camera());
    Advance: Time 14, |v| Action::Advance(v.seconds());
    GrabView: Look 1, |v| Action::GrabView(v.turn(), v.place());
    DragView: Look 2, |v| Action::DragView { to: v.place(), aspect: v.aspect() };
    DropView: Look 1, |_| Action::DropView;
    CancelView: Look 1, |_| Action::CancelView;

    SetTheme: Look 1, |v| Action::SetTheme(v.one_of(&[Theme::Dark, Theme::Light]));
    SetNavigation: Look 1, |v| Action::SetNavigation(v.one_of(&Navigation::ALL));
    ShowExplain: Look 1, |v| Action::ShowExplain(v.coin());
    ShowTimeline: Look 1, |v| Action::ShowTimeline(v.coin());
    ShowCrowd: Look 1, |v| Action::ShowCrowd(v.coin());
    SetCrowd: Look 1, |v| Action::SetCrowd(v.one_of(&[0, 1, 1_000, 1_000_000, u32::MAX]));
    SolveCrowd: Look 1, |v| Action::SolveCrowd(v.one_of(&[SolvedBy::Cpu, SolvedBy::Gpu]));
    MoveCrowd: Look 1, |v| Action::MoveCrowd(v.coin());
    ShowCurves: Look 1, |v| Action::ShowCurves(v.coin());
    OpenDialog: Look 2, |v| Action::OpenDialog(v.dialog());
    CloseDialog: Look 1, |_| Action::CloseDialog;
    Report: Look 1, |v| Action::Report(v.name());
    Fail: Look 1, |v| Action::Fail(v.name());

    CopyPose: Look 1, |_| Action::CopyPose;
    SavePicture: Look 1, |v| Action::SavePicture(v.name());
    Export: Look 1, |v| Action::Export(v.export());
    Exporting: Look 1, |v| Action::Exporting(v.job());
    CancelExport: Look 1, |_| Action::CancelExport;
    Exported: Look 1, |v| Action::Exported(if v.coin() { Ok(v.name()) } else { Err(v.name()) });
    StopExportAndQuit: Look 1, |_| Action::StopExportAndQuit;
    Ask: Look 1, |v| Action::Ask(v.dialog());
    ChoosePath: Look 1, |_| Action::ChoosePath;
    ChoseNothing: Look 1, |_| Action::ChoseNothing;
    NoSystemDialog: Look 1, |v| Action::NoSystemDialog(v.dialog());
    Open: Files 1, |v| Action::Open { path: v.path(), skeleton: None };
    Opened: Files 1, |v| Action::Opened { document: Box::new(v.document()), file: v.file() };
    NotOpened: Look 1, |v| Action::NotOpened { path: v.path(), why: v.name() };
    Save: Look 1, |_| Action::Save;
    SaveAs: Look 1, |v| Action::SaveAs(v.path());
    Saved: Files 4, |v| Action::Saved(v.path());
    NotSaved: Look 1, |v| Action::NotSaved { path: v.path(), why: v.name() };
    SaveAnd: Files 1, |v| Action::SaveAnd(Box::new(leaving(v)));
    Discard: Files 1, |v| Action::Discard(Box::new(leaving(v)));
    Recover: Files 1, |v| Action::Recover { document: Box::new(v.document()), file: v.file() };
    ForgetRecovered: Look 1, |_| Action::ForgetRecovered;
    OpenExample: Files 1, |v| Action::OpenExample(v.example());
    NewSkeleton: Files 1, |_| Action::NewSkeleton;
    LoseDevice: Look 1, |_| Action::LoseDevice;
    Quit: Look 2, |_| Action::Quit;
}

/// What is asked about where changes are not saved.
pub fn leaving(values: &mut Values<'_>) -> Action {
    match values.random.below(6) {
        0 => Action::NewSkeleton,
        1 => Action::Recover { document: Box::new(values.document()), file: values.file() },
        2 => Action::Opened { document: Box::new(values.document()), file: values.file() },
        3 => Action::Quit,
        _ => Action::OpenExample(values.example()),
    }
}
