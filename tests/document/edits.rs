//! Every edit is one labelled step that undo and redo restore byte for byte.

use glam::Vec3;
use ik_arm::document::{
    Baked, BalanceTarget, Channel, Overlay, PathKind, Target, Timeline, TwistReferenceKind,
    WavyRing,
};
use ik_arm::io::to_json;
use ik_arm::kinematics::Shared;
use ik_arm::kinematics::chain_ik::{Method, Root, SolverOptions};
use ik_arm::kinematics::diagnosis::Remedy;
use ik_arm::kinematics::skeleton::{JointId, JointLimits, Limit};
use ik_arm::kinematics::skin::Morph;
use ik_arm::kinematics::spline::{Interpolation, Slopes};
use ik_arm::rig::{
    FileMesh, LimbSettings, MeshSkin, Posture, PosturedJoint, Skin, SkinFile, SkinSource,
    TargetKind, TargetSpace,
};
use ik_arm::session::{
    DisplayEdit, Edit, FileAction, JointEdit, KeysEdit, PathEdit, PlaybackAction, PoseMode,
    SelectAction, Session, SkinEdit, SolverAction, SolverEdit, TargetEdit, TransactionAction,
};

/// Joints of the Human: one with a target, one without, and a leaf.
const AIMED: usize = 7;
const INNER: usize = 3;
const LEAF: usize = 18;
/// A channel that no other example changes.
const KEYED: Channel = Channel::Overlay(Overlay::Shadow);

fn remedy(remedy: Remedy) -> TargetEdit {
    TargetEdit::ApplyRemedy { target: JointId::new(AIMED), remedy }
}

/// The examples of every variant; a variant without examples does not compile.
macro_rules! examples {
    ($($part:ident($edit:ident) { $($name:ident: [$($example:expr),+ $(,)?];)* })*) => {
        fn examples() -> Vec<Edit> {
            vec![$($($($example.into()),+),*),*]
        }

        fn name(edit: &Edit) -> &'static str {
            match edit {
                $($(Edit::$part($edit::$name { .. }) => stringify!($name)),*),*
            }
        }

        const NAMES: &[&str] = &[$($(stringify!($name)),*),*];
    };
}

examples! {
    Display(DisplayEdit) {
        ResetPose: [DisplayEdit::ResetPose];
        ResetAll: [DisplayEdit::ResetAll];
        ShowOverlay: [
            DisplayEdit::ShowOverlay(Overlay::SingularityGlobe, true),
            DisplayEdit::ShowOverlay(Overlay::Labels, false),
        ];
    }
    Joint(JointEdit) {
        AddChild: [JointEdit::AddChild { parent: JointId::new(LEAF), tip: Some(Vec3::ONE) }];
        AddJoint: [JointEdit::AddJoint { tip: None }];
        AddRoot: [JointEdit::AddRoot];
        DeleteJoints: [
            JointEdit::DeleteJoints(vec![JointId::new(AIMED)]),
            JointEdit::DeleteJoints(vec![JointId::new(INNER), JointId::new(LEAF)]),
        ];
        DissolveJoints: [JointEdit::DissolveJoints(vec![JointId::new(INNER)])];
        RenameJoint: [JointEdit::RenameJoint { joint: JointId::new(INNER), name: "renamed".to_owned() }];
        ReparentJoint: [JointEdit::ReparentJoint { joint: JointId::new(AIMED), parent: None }];
        SetRotation: [JointEdit::SetRotation { joint: JointId::new(INNER), rotation: Vec3::splat(0.2) }];
        SetAxis: [JointEdit::SetAxis { joint: JointId::new(INNER), axis: Vec3::splat(0.3) }];
        SetLength: [JointEdit::SetLength { joint: JointId::new(INNER), length: 0.4 }];
        SetOffset: [JointEdit::SetOffset { joint: JointId::new(INNER), offset: Vec3::Y * 0.2 }];
        SetLimits: [JointEdit::SetLimits {
            joint: JointId::new(INNER),
            limits: JointLimits::new([None, Some(Limit { min: -0.1, max: 0.1 }), None]),
        }];
        SetStiffness: [JointEdit::SetStiffness {
            joint: JointId::new(INNER),
            stiffness: Vec3::splat(0.6),
        }];
        SetSkinScale: [JointEdit::SetSkinScale {
            joint: JointId::new(INNER),
            scale: Vec3::new(0.5, 2.0, 1.0),
        }];
        SetLocked: [
            JointEdit::SetLocked { joint: JointId::new(INNER), locked: true },
            JointEdit::SetLocked { joint: JointId::new(AIMED), locked: true },
        ];
    }
    Skin(SkinEdit) {
        AddSkin: [SkinEdit::AddSkin];
        ShowSkin: [SkinEdit::ShowSkin { skin: false, bones: true }];
        PackSkin: [SkinEdit::PackSkin];
        Bind: [SkinEdit::Bind];
        Unbind: [SkinEdit::Unbind];
        PlaceRoot: [SkinEdit::PlaceRoot(Vec3::X)];
        SetMorph: [SkinEdit::SetMorph { morph: 0, weight: 0.5 }];
        SetSkin: [SkinEdit::SetSkin(Some(Skin::from_bones(&Shared::default())))];
    }
    Path(PathEdit) {
        SetFollowPath: [PathEdit::SetFollowPath {
            root: JointId::new(0),
            kind: Some(PathKind::Ring(WavyRing { radius: 1.0, amplitude: 0.2, waves: 3, period: 5.0 })),
        }];
        SetHead: [PathEdit::SetHead { root: JointId::new(0), to: Vec3::X }];
    }
    Joint(JointEdit) {
        SetTranslation: [JointEdit::SetTranslation(Vec3::X)];
        TurnYUp: [JointEdit::TurnYUp];
    }
    Target(TargetEdit) {
        AddTarget: [TargetEdit::AddTarget(JointId::new(INNER))];
        AddHumanoidTargets: [TargetEdit::AddHumanoidTargets];
        RemoveTarget: [TargetEdit::RemoveTarget(JointId::new(AIMED))];
        SetTarget: [TargetEdit::SetTarget(Target::new(JointId::new(AIMED), Vec3::Z * 3.0, 1.0))];
        MatchTargetToFk: [TargetEdit::MatchTargetToFk(JointId::new(AIMED))];
        MatchFkToPose: [TargetEdit::MatchFkToPose(JointId::new(AIMED))];
        SetTargetSpace: [TargetEdit::SetTargetSpace {
            joint: JointId::new(AIMED),
            space: TargetSpace::Joint(JointId::new(INNER)),
        }];
        SetReference: [TargetEdit::SetReference {
            joint: JointId::new(AIMED),
            reference: TwistReferenceKind::Up,
        }];
        Pin: [TargetEdit::Pin { joint: JointId::new(AIMED), is_pinned: true }];
        KeepHand: [TargetEdit::KeepHand { joint: JointId::new(AIMED), is_kept: true }];
        SwitchPoseMode: [TargetEdit::SwitchPoseMode {
            joint: JointId::new(AIMED),
            mode: PoseMode::Angles,
        }];
        SetPoleSpace: [TargetEdit::SetPoleSpace {
            joint: JointId::new(AIMED),
            space: TargetSpace::Joint(JointId::new(INNER)),
        }];
        ApplyRemedy: [
            remedy(Remedy::SetRoot(Root::Locked)),
            remedy(Remedy::MoveTarget { joint: JointId::new(AIMED), point: Vec3::ONE }),
            remedy(Remedy::Lengthen { joint: JointId::new(AIMED), factor: 1.5 }),
            remedy(Remedy::AllowIterations(77)),
        ];
    }
    Solver(SolverEdit) {
        SetSolver: [SolverEdit::SetSolver(
            SolverOptions::new(Method::Fabrik).with_damping(0.3),
        )];
        SetTracked: [SolverEdit::SetTracked(false)];
        SetBodyFollows: [SolverEdit::SetBodyFollows(false)];
        SetBalance: [SolverEdit::SetBalance(Some(BalanceTarget::default()))];
        ResetPosture: [SolverEdit::ResetPosture];
        SetPosture: [SolverEdit::SetPosture(Posture {
            joints: [(JointId::new(AIMED), PosturedJoint {
                rotation: Some(Vec3::X * 0.1), ..PosturedJoint::default()
            })].into(),
            ..Posture::default()
        }.into())];
        SetIterationsPerFrame: [SolverEdit::SetIterationsPerFrame(17)];
        ApplyPose: [SolverEdit::ApplyPose];
    }
    Keys(KeysEdit) {
        Key: [
            KeysEdit::Key(vec![Channel::Target(JointId::new(AIMED))]),
            KeysEdit::Key(vec![Channel::TargetTwist(JointId::new(AIMED))]),
            KeysEdit::Key(vec![
                Channel::Length(JointId::new(INNER)),
                Channel::Length(JointId::new(AIMED)),
            ]),
        ];
        DeleteKeys: [KeysEdit::DeleteKeys(vec![(KEYED, 0.0)])];
        ClearChannels: [KeysEdit::ClearChannels(vec![KEYED])];
        MoveKeys: [KeysEdit::MoveKeys { keys: vec![(KEYED, 0.0)], by: 0.5, raise: Vec3::ONE }];
        SetInterpolation: [KeysEdit::SetInterpolation(vec![(KEYED, 0.0)], Interpolation::Linear)];
        SetSlopes: [KeysEdit::SetSlopes(vec![(KEYED, 0.0)], Some(Slopes { arriving: Vec3::X, leaving: Vec3::Y }))];
        PasteKeys: [KeysEdit::PasteKeys];
        Bake: [KeysEdit::Bake(baked())];
        SetTimeline: [KeysEdit::SetTimeline(Timeline { start: 1.0, end: 4.0, frame_rate: 25.0 })];
    }
    Display(DisplayEdit) {
        SetMetres: [DisplayEdit::SetMetres(Some(2.0))];
    }
}

/// The mesh of the skin as from a file.
fn skin_of_a_file(session: &Session) -> Skin {
    let rig = session.rig();
    let mesh = rig.skin.as_ref().expect("a skin").mesh().expect("a mesh").mesh.clone();
    let parents = rig.skeleton.joints().iter().map(|joint| joint.parent).collect();
    let skeleton = "x".to_owned();
    let file = SkinFile { path: "x.glb".into(), checksum: 5, skeleton, animation: None };
    let joints = rig.skeleton.ids().map(Some).collect();
    let morph = Morph {
        name: "smile".into(),
        vertices: vec![0],
        offsets: vec![Vec3::X],
        normals: vec![Vec3::ZERO],
    };
    let mesh = mesh.with_morphs(vec![morph]).expect("a morph target");
    let mesh = FileMesh { mesh, parents, parts: Vec::new() };
    Skin::new(SkinSource::Mesh(MeshSkin::new(mesh.into(), Some(file), joints, &rig.skeleton)))
}

/// A bake of one key.
fn baked() -> Box<Baked> {
    let mut document = session_for(&KeysEdit::PasteKeys.into()).document().clone();
    document.keys.insert(Channel::Rotation(JointId::new(INNER)), 0.5, Vec3::X * 0.1);
    Box::new(Baked { document, keys_at_frames: 1, keys: 1, error: 0.0, shortened: Vec::new() })
}

/// The Human, changed so that every edit has something to do.
fn session_for(edit: &Edit) -> Session {
    let mut session = Session::default();
    session.apply(FileAction::NewFigure);
    let target = Target::new(JointId::new(AIMED), Vec3::new(1.0, 2.0, 3.0), 1.0);
    let with_pole = LimbSettings {
        reference: TwistReferenceKind::Pole,
        pole: Some(Vec3::X),
        ..LimbSettings::default()
    };
    for edit in [
        Edit::from(DisplayEdit::ShowOverlay(Overlay::Axes, true)),
        JointEdit::SetRotation { joint: JointId::new(INNER), rotation: Vec3::splat(0.1) }.into(),
        TargetEdit::SetTarget(Target {
            kind: TargetKind::Limb(with_pole),
            influence: 1.0,
            ..target
        })
        .into(),
        KeysEdit::Key(vec![KEYED]).into(),
    ] {
        session.apply(edit);
    }
    session.apply(SelectAction::Keys(vec![(KEYED, 0.0)]));
    session.apply(SelectAction::CopyKeys);
    session.apply(PlaybackAction::SetTime(1.0));
    let needs_mesh = |edit: &SkinEdit| {
        !matches!(edit, SkinEdit::AddSkin | SkinEdit::ShowSkin { .. } | SkinEdit::SetSkin(_))
    };
    if matches!(edit, Edit::Skin(edit) if needs_mesh(edit)) {
        session.apply(SkinEdit::SetSkin(Some(skin_of_a_file(&session))));
    }
    if *edit == Edit::Solver(SolverEdit::ResetPosture) {
        let target = Target { kind: TargetKind::WholeBody, ..session.rig().targets[0] };
        session.apply(TargetEdit::SetTarget(target));
        session.apply(TargetEdit::SetTarget(Target { home: target.home * 0.9, ..target }));
        assert!(session.document().rig.posture.is_some());
    }
    if *edit == Edit::Target(TargetEdit::AddHumanoidTargets) {
        session.apply(TargetEdit::RemoveTarget(JointId::new(AIMED)));
    }
    if *edit == Edit::Solver(SolverEdit::ApplyPose) {
        session.apply(SolverAction::Step);
    }
    session
}

#[test]
fn every_edit_is_one_labelled_step_that_is_undone_and_redone_to_the_same_bytes() {
    let bytes = |session: &Session| to_json(session.document()).expect("saved");
    for edit in examples() {
        let mut session = session_for(&edit);
        let (before, label) = (bytes(&session), edit.label(&session));
        session.apply(edit.clone());
        let after = bytes(&session);
        assert!(
            before != after,
            "{} changes the document: {:?}",
            name(&edit),
            session.shell().message()
        );
        assert_eq!(session.history().undo_label(), Some(label));
        session.apply(TransactionAction::Undo);
        assert!(bytes(&session) == before, "undo of {}", name(&edit));
        assert_eq!(session.history().redo_label(), Some(label));
        assert_eq!(session.shell().message(), Some(&*format!("Undid {label}")));
        session.apply(TransactionAction::Redo);
        assert!(bytes(&session) == after, "redo of {}", name(&edit));
    }
}

#[test]
fn every_edit_in_a_transaction_is_cancelled_to_the_same_bytes() {
    let bytes = |session: &Session| to_json(session.document()).expect("saved");
    for edit in examples() {
        let mut session = session_for(&edit);
        let (before, last) = (bytes(&session), session.history().undo_label());
        let label = edit.label(&session);
        session.apply(TransactionAction::Begin);
        session.apply(edit.clone());
        assert_eq!(session.history().undo_label(), Some(label));
        session.apply(TransactionAction::Cancel);
        assert!(bytes(&session) == before, "cancelled {}", name(&edit));
        assert_eq!(session.history().undo_label(), last);
    }
}

#[test]
fn labels_are_in_sentence_case_and_every_variant_has_an_example() {
    let all = examples();
    for variant in NAMES {
        assert!(all.iter().any(|edit| name(edit) == *variant), "{variant}");
    }
    for edit in all {
        let label = edit.label(&session_for(&edit));
        assert!(label.starts_with(char::is_uppercase) && !label.ends_with('.'), "{label}");
    }
}
