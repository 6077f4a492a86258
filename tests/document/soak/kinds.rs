//! All kinds of actions. A new action does not compile without its line here.

use ik_arm::document::Theme;
use ik_arm::io::OpenOptions;
use ik_arm::kinematics::spline::{Interpolation, Slopes};
use ik_arm::rig::Processor;
use ik_arm::session::{
    Action, BakeAction, DisplayEdit, Edit, FileAction, FrameBudget, InsideLayer, InspectAction,
    InspectionJob, JointEdit, KeysEdit, LimbFigure, Navigation, PanelTab, PathEdit, PlaybackAction,
    PoseMode, ReachAction, SelectAction, ShellAction, SkinEdit, SolverAction, SolverEdit,
    TargetEdit, TourAction, TransactionAction, ViewAction,
};

use crate::soak::values::Values;

/// Sorts of actions; they come in bursts of one sort.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sort {
    Arm,
    Build,
    Solve,
    Keys,
    Edit,
    Drag,
    Files,
    /// Leaves the document unchanged, except for its camera.
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
    /// Relative frequency.
    pub weight: u32,
    pub make: fn(&mut Values<'_>) -> Action,
}

/// The pattern of an action, or of an edit of a part.
macro_rules! action_pattern {
    ($group:ident () $payload:ident $name:ident) => {
        Action::$group($payload::$name { .. })
    };
    ($group:ident ($part:ident) $payload:ident $name:ident) => {
        Action::$group(Edit::$part($payload::$name { .. }))
    };
}

/// One line for each kind: sort, relative frequency, constructor.
macro_rules! kinds {
    ($($group:ident $part:tt ($payload:ident) {
        $($name:ident: $sort:ident $weight:literal, $make:expr;)*
    })*) => {
        pub const KINDS: &[Kind] = &[$($(Kind {
            name: concat!(stringify!($group), "::", stringify!($name)),
            sort: Sort::$sort,
            weight: $weight,
            make: |values| {
                let make: fn(&mut Values<'_>) -> $payload = $make;
                make(values).into()
            },
        }),*),*];

        /// Index of an action's kind.
        pub fn kind(action: &Action) -> usize {
            let name = match action {
                $($(action_pattern!($group $part $payload $name) => {
                    concat!(stringify!($group), "::", stringify!($name))
                })*)*
            };
            KINDS.iter().position(|kind| kind.name == name).expect("every kind is listed")
        }
    };
}

kinds! {
    Edit (Display) (DisplayEdit) {
        ResetPose: Arm 1, |_| DisplayEdit::ResetPose;
        ResetAll: Arm 1, |_| DisplayEdit::ResetAll;
        ShowOverlay: Edit 3, |v| DisplayEdit::ShowOverlay(v.layer(), v.coin());
    }
    Edit (Joint) (JointEdit) {
        AddChild: Build 8, |v| JointEdit::AddChild {
            parent: v.joint(),
            tip: if v.coin() { None } else { Some(v.small_point()) },
        };
        AddJoint: Build 4, |v| JointEdit::AddJoint {
            tip: if v.coin() { None } else { Some(v.small_point()) },
        };
        AddRoot: Build 1, |_| JointEdit::AddRoot;
        DeleteJoints: Build 2, |v| JointEdit::DeleteJoints(v.some_joints());
        DissolveJoints: Build 2, |v| JointEdit::DissolveJoints(v.some_joints());
        RenameJoint: Build 2, |v| JointEdit::RenameJoint { joint: v.joint(), name: v.name() };
        ReparentJoint: Build 3, |v| JointEdit::ReparentJoint {
            joint: v.joint(),
            parent: if v.chance(0.2) { None } else { Some(v.joint()) },
        };
        SetRotation: Build 6, |v| JointEdit::SetRotation { joint: v.joint(), rotation: v.angles() };
        SetAxis: Build 3, |v| JointEdit::SetAxis { joint: v.joint(), axis: v.small_point() * 0.3 };
        SetLength: Arm 4, |v| JointEdit::SetLength { joint: v.joint(), length: v.length() };
        SetOffset: Arm 4, |v| {
            let size = v.size();
            JointEdit::SetOffset { joint: v.joint(), offset: v.point(size) }
        };
        SetLimits: Build 3, |v| JointEdit::SetLimits { joint: v.joint(), limits: v.limits() };
        SetStiffness: Build 2, |v| JointEdit::SetStiffness {
            joint: v.joint(),
            stiffness: v.stiffness(),
        };
        SetSkinScale: Build 2, |v| JointEdit::SetSkinScale {
            joint: v.joint(),
            scale: v.small_point(),
        };
        SetLocked: Build 2, |v| JointEdit::SetLocked { joint: v.joint(), locked: v.chance(0.3) };
    }
    Edit (Skin) (SkinEdit) {
        AddSkin: Build 1, |_| SkinEdit::AddSkin;
        ShowSkin: Build 1, |v| SkinEdit::ShowSkin { skin: v.coin(), bones: v.coin() };
        PackSkin: Build 1, |_| SkinEdit::PackSkin;
        Bind: Build 1, |_| SkinEdit::Bind;
        Unbind: Build 1, |_| SkinEdit::Unbind;
        PlaceRoot: Build 1, |v| SkinEdit::PlaceRoot(v.small_point());
        SetMorph: Build 1, |v| SkinEdit::SetMorph { morph: v.coin().into(), weight: v.number(2.0) };
        SetSkin: Build 2, |v| SkinEdit::SetSkin(v.skin());
    }
    Edit (Path) (PathEdit) {
        SetFollowPath: Solve 1, |v| PathEdit::SetFollowPath { root: v.joint(), kind: v.path_kind() };
        SetHead: Solve 2, |v| PathEdit::SetHead { root: v.joint(), to: v.small_point() };
    }
    Edit (Joint) (JointEdit) {
        SetTranslation: Build 2, |v| JointEdit::SetTranslation(v.small_point());
        TurnYUp: Build 1, |_| JointEdit::TurnYUp;
    }
    Edit (Target) (TargetEdit) {
        AddTarget: Solve 5, |v| TargetEdit::AddTarget(v.joint());
        AddHumanoidTargets: Solve 1, |_| TargetEdit::AddHumanoidTargets;
        RemoveTarget: Solve 2, |v| TargetEdit::RemoveTarget(v.aimed());
        SetTarget: Arm 20, |v| TargetEdit::SetTarget(v.target());
        MatchTargetToFk: Solve 2, |v| TargetEdit::MatchTargetToFk(v.aimed());
        MatchFkToPose: Solve 2, |v| TargetEdit::MatchFkToPose(v.aimed());
        SetTargetSpace: Solve 2, |v| TargetEdit::SetTargetSpace { joint: v.aimed(), space: v.space() };
        SetPoleSpace: Solve 1, |v| TargetEdit::SetPoleSpace { joint: v.aimed(), space: v.space() };
        Pin: Arm 6, |v| TargetEdit::Pin { joint: v.aimed(), is_pinned: v.coin() };
        KeepHand: Arm 6, |v| TargetEdit::KeepHand { joint: v.aimed(), is_kept: v.coin() };
        SwitchPoseMode: Arm 8, |v| TargetEdit::SwitchPoseMode {
            joint: v.aimed(),
            mode: v.one_of(&[PoseMode::Hand, PoseMode::Angles]),
        };
        SetReference: Arm 6, |v| TargetEdit::SetReference { joint: v.aimed(), reference: v.elbow_reference() };
        ApplyRemedy: Solve 3, |v| TargetEdit::ApplyRemedy { target: v.aimed(), remedy: v.remedy() };
    }
    Edit (Solver) (SolverEdit) {
        SetSolver: Solve 3, |v| SolverEdit::SetSolver(v.options());
        SetTracked: Solve 1, |v| SolverEdit::SetTracked(v.coin());
        SetBodyFollows: Solve 2, |v| SolverEdit::SetBodyFollows(v.coin());
        SetBalance: Solve 2, |v| SolverEdit::SetBalance(v.balance());
        ResetPosture: Solve 1, |_| SolverEdit::ResetPosture;
        SetPosture: Solve 1, |v| SolverEdit::SetPosture(v.posture().into());
        SetIterationsPerFrame: Solve 1, |v| SolverEdit::SetIterationsPerFrame(v.iterations_per_frame());
        ApplyPose: Solve 3, |_| SolverEdit::ApplyPose;
    }
    Edit (Keys) (KeysEdit) {
        Key: Keys 6, |v| KeysEdit::Key(v.channels());
        DeleteKeys: Keys 2, |v| KeysEdit::DeleteKeys(v.keys());
        ClearChannels: Keys 1, |v| KeysEdit::ClearChannels(v.channels());
        MoveKeys: Keys 4, |v| KeysEdit::MoveKeys { keys: v.keys(), by: v.shift(), raise: if v.coin() { glam::Vec3::ZERO } else { v.small_point() } };
        SetInterpolation: Keys 2, |v| KeysEdit::SetInterpolation(v.keys(), v.one_of(&Interpolation::ALL));
        SetSlopes: Keys 2, |v| KeysEdit::SetSlopes(v.keys(), v.coin().then(|| Slopes { arriving: v.small_point(), leaving: v.small_point() }));
        PasteKeys: Keys 2, |_| KeysEdit::PasteKeys;
        Bake: Keys 1, |v| KeysEdit::Bake(v.baked());
        SetTimeline: Keys 2, |v| KeysEdit::SetTimeline(v.timeline());
    }
    Edit (Display) (DisplayEdit) {
        SetMetres: Edit 1, |v| DisplayEdit::SetMetres(if v.coin() { None } else { Some(v.above_0(2.0)) });
    }
    Transaction () (TransactionAction) {
        Begin: Edit 4, |_| TransactionAction::Begin;
        Commit: Edit 3, |_| TransactionAction::Commit;
        Cancel: Edit 2, |_| TransactionAction::Cancel;
        Undo: Edit 8, |_| TransactionAction::Undo;
        Redo: Edit 5, |_| TransactionAction::Redo;
        Grab: Drag 6, |v| TransactionAction::Grab { grip: v.grip(), ray: v.ray(), forward: v.forward() };
        Drag: Drag 10, |v| TransactionAction::Drag(v.drag_input());
        Constrain: Drag 2, |v| TransactionAction::Constrain(v.constraint());
        TypeOffset: Drag 2, |v| TransactionAction::TypeOffset(v.typed());
        FollowMouse: Drag 1, |v| TransactionAction::FollowMouse(v.chance(0.7));
        Lead: Drag 1, |v| TransactionAction::Lead(v.ray());
    }
    Select () (SelectAction) {
        Joints: Look 4, |v| SelectAction::Joints(v.some_joints());
        Hover: Look 2, |v| SelectAction::Hover(v.hovered());
        Wiggle: Look 1, |v| {
            let axis = v.rotation_axis();
            SelectAction::Wiggle(if v.coin() { None } else { Some((v.joint(), axis)) })
        };
        Figure: Look 1, |v| {
            SelectAction::Figure(if v.coin() { None } else { Some(v.one_of(&LimbFigure::ALL)) })
        };
        Keys: Look 3, |v| SelectAction::Keys(v.keys());
        Channels: Look 1, |v| SelectAction::Channels(v.channels());
        CopyKeys: Look 2, |_| SelectAction::CopyKeys;
    }
    View () (ViewAction) {
        ResetTransport: Look 1, |_| ViewAction::ResetTransport;
        SetCamera: Look 1, |v| ViewAction::SetCamera(v.camera());
        GlideTo: Look 1, |v| ViewAction::GlideTo(v.camera());
        Grab: Look 1, |v| ViewAction::Grab(v.turn(), v.place());
        Drag: Look 2, |v| ViewAction::Drag { to: v.place(), aspect: v.aspect() };
        Drop: Look 1, |_| ViewAction::Drop;
        Cancel: Look 1, |_| ViewAction::Cancel;
        ShowExplain: Look 1, |v| ViewAction::ShowExplain(v.coin());
        ShowTab: Look 1, |v| {
            ViewAction::ShowTab(v.one_of(&PanelTab::ALL))
        };
        ShowTimeline: Look 1, |v| ViewAction::ShowTimeline(v.coin());
        FollowSelection: Look 1, |v| ViewAction::FollowSelection(v.coin());
        ShowInside: Look 1, |v| ViewAction::ShowInside(v.one_of(&InsideLayer::ALL), v.coin());
        ShowCrowd: Look 1, |v| ViewAction::ShowCrowd(v.coin());
        SetCrowdSize: Look 1, |v| ViewAction::SetCrowdSize(v.one_of(&[0, 1, 1_000, 1_000_000, u32::MAX]));
        SetCrowdSolver: Look 1, |v| ViewAction::SetCrowdSolver(v.one_of(&[Processor::Cpu, Processor::Gpu]));
        AnimateCrowd: Look 1, |v| ViewAction::AnimateCrowd(v.coin());
        ShowGraphEditor: Look 1, |v| ViewAction::ShowGraphEditor(v.coin());
    }
    Playback () (PlaybackAction) {
        Play: Time 4, |v| PlaybackAction::Play(v.chance(0.7));
        SetTime: Time 8, |v| PlaybackAction::SetTime(v.time());
        SetLooping: Time 1, |v| PlaybackAction::SetLooping(v.coin());
        SetSpeed: Time 1, |v| PlaybackAction::SetSpeed(v.speed());
        SetAutoKey: Look 2, |v| PlaybackAction::SetAutoKey(v.chance(0.3));
        Advance: Time 14, |v| PlaybackAction::Advance(v.seconds());
    }
    Solver () (SolverAction) {
        Run: Solve 5, |v| SolverAction::Run(v.chance(0.8));
        Step: Solve 4, |_| SolverAction::Step;
        Compare: Solve 1, |_| SolverAction::Compare;
        Reset: Solve 1, |_| SolverAction::Reset;
        ShowPart: Solve 3, |v| SolverAction::ShowPart {
            iteration: v.random.below(30) as u32,
            part: if v.coin() { None } else { Some(v.one_of(&[0, 1, 2, 9, usize::MAX])) },
        };
        Walk: Solve 1, |v| SolverAction::Walk(v.coin());
        Show: Solve 4, |v| SolverAction::Show(v.random.below(30) as u32);
    }
    Bake () (BakeAction) {
        Start: Look 1, |v| BakeAction::Start(v.bake());
        Started: Look 1, |v| BakeAction::Started(v.bake_job());
        Ended: Keys 1, |v| BakeAction::Ended(v.bake_job(), Ok(v.baked()));
    }
    Inspect () (InspectAction) {
        Started: Look 1, |v| InspectAction::Started(InspectionJob::new(v.session.history()));
        Ended: Look 1, |v| v.inspected();
    }
    Reach () (ReachAction) {
        Started: Look 1, |v| ReachAction::Started(v.reach_job());
        Ended: Look 1, |v| ReachAction::Ended(v.reach_job(), None);
    }
    File () (FileAction) {
        SavePicture: Look 1, |v| FileAction::SavePicture(v.name());
        CopyLink: Look 1, |_| FileAction::CopyLink;
        Export: Look 1, |v| FileAction::Export(v.export());
        ExportStarted: Look 1, |v| FileAction::ExportStarted(v.job());
        CancelExport: Look 1, |_| FileAction::CancelExport;
        ExportEnded: Look 1, |v| FileAction::ExportEnded(if v.coin() { Ok(v.name()) } else { Err(v.name()) });
        StopExportAndQuit: Look 1, |_| FileAction::StopExportAndQuit;
        AskPath: Look 1, |v| FileAction::AskPath(v.path_dialog());
        ChoosePath: Look 1, |_| FileAction::ChoosePath;
        ChoseNothing: Look 1, |_| FileAction::ChoseNothing;
        NoSystemDialog: Look 1, |v| FileAction::NoSystemDialog(v.path_dialog());
        Open: Files 1, |v| FileAction::Open { path: v.path(), options: OpenOptions::default() };
        Opened: Files 1, |v| FileAction::Opened { document: Box::new(v.document()), file: v.file(), contents: None };
        NotOpened: Look 1, |v| FileAction::NotOpened { path: v.path(), why: v.name() };
        LocateSkin: Look 1, |v| FileAction::LocateSkin(v.path());
        SkinLocated: Build 1, |v| FileAction::SkinLocated { path: v.path(), before: v.skin_file(), read: Box::new(v.located_skin()) };
        Save: Look 1, |_| FileAction::Save;
        SaveAs: Look 1, |v| FileAction::SaveAs(v.path());
        Saved: Files 4, |v| FileAction::Saved(v.path());
        NotSaved: Look 1, |v| FileAction::NotSaved { path: v.path(), why: v.name() };
        SaveAnd: Files 1, |v| FileAction::SaveAnd(Box::new(leaving(v)));
        Discard: Files 1, |v| FileAction::Discard(Box::new(leaving(v)));
        Recover: Files 1, |v| FileAction::Recover { document: Box::new(v.document()), file: v.file() };
        DeclineRecovery: Look 1, |_| FileAction::DeclineRecovery;
        DeclineTurn: Look 1, |_| FileAction::DeclineTurn;
        OpenExample: Files 2, |v| FileAction::OpenExample(v.example());
        New: Files 1, |_| FileAction::New;
        NewFigure: Files 1, |_| FileAction::NewFigure;
        NewEmpty: Files 1, |_| FileAction::NewEmpty;
        Quit: Look 2, |_| FileAction::Quit;
    }
    Shell () (ShellAction) {
        SetTheme: Look 1, |v| ShellAction::SetTheme(v.one_of(&[Theme::Dark, Theme::Light]));
        SetNavigation: Look 1, |v| ShellAction::SetNavigation(v.one_of(&Navigation::ALL));
        RunFromFk: Look 1, |v| ShellAction::RunFromFk(v.coin());
        SetFrameBudget: Look 1, |v| ShellAction::SetFrameBudget(v.one_of(&FrameBudget::ALL));
        OpenDialog: Look 2, |v| ShellAction::OpenDialog(v.dialog());
        CloseDialog: Look 1, |_| ShellAction::CloseDialog;
        Report: Look 1, |v| ShellAction::Report(v.name());
        Fail: Look 1, |v| ShellAction::Fail(v.name());
        ClearMessage: Look 1, |_| ShellAction::ClearMessage;
        CopyPose: Look 1, |_| ShellAction::CopyPose;
    }
    Tour () (TourAction) {
        Enter: Files 1, |v| TourAction::Enter(if v.random.below(40) == 0 { 10 + v.random.below(4) } else { v.random.below(10) });
        Guess: Look 1, |v| TourAction::Guess(v.random.below(5));
        Demonstrate: Edit 1, |_| TourAction::Demonstrate;
        Leave: Files 2, |_| TourAction::Leave;
        Decline: Look 1, |_| TourAction::Decline;
    }
}

/// Actions that ask first if there are unsaved changes.
pub fn leaving(values: &mut Values<'_>) -> FileAction {
    match values.random.below(6) {
        0 => FileAction::NewEmpty,
        1 => FileAction::Recover { document: Box::new(values.document()), file: values.file() },
        2 => FileAction::Opened {
            document: Box::new(values.document()),
            file: values.file(),
            contents: None,
        },
        3 => FileAction::Quit,
        _ => FileAction::OpenExample(values.example()),
    }
}
