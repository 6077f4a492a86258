//! Every edit is one labelled step that undo and redo restore byte for byte.

use glam::Vec3;
use ik_arm::document::{
    Baked, Channel, HandSpace, Overlay, PathKind, RigKind, Target, Timeline, TwistReferenceKind,
    WavyRing,
};
use ik_arm::io::to_json;
use ik_arm::kinematics::Shared;
use ik_arm::kinematics::chain_ik::{Method, SolverOptions};
use ik_arm::kinematics::diagnosis::Remedy;
use ik_arm::kinematics::limb_ik::ElbowReference;
use ik_arm::kinematics::skeleton::{JointId, Limit, RotationAxis};
use ik_arm::kinematics::soft_reach::SoftReach;
use ik_arm::kinematics::spline::{Interpolation, Slopes};
use ik_arm::rig::{
    FileMesh, LimbSettings, MeshSkin, Skin, SkinFile, SkinSource, TargetKind, TargetSpace,
};
use ik_arm::session::{
    EditAction, PlaybackAction, PoseMode, SelectAction, Session, SolverAction, TransactionAction,
};

/// Joints of the Human: one with a target, one without, and a leaf.
const AIMED: usize = 7;
const INNER: usize = 3;
const LEAF: usize = 18;
/// A channel that no other example changes.
const KEYED: Channel = Channel::Overlay(Overlay::Shadow);

fn remedy(remedy: Remedy) -> EditAction {
    EditAction::ApplyRemedy { target: JointId::new(AIMED), remedy }
}

/// The examples of every variant; a variant without examples does not compile.
macro_rules! examples {
    ($($name:ident: [$($example:expr),+ $(,)?];)*) => {
        fn examples() -> Vec<EditAction> {
            vec![$($($example),+),*]
        }

        fn name(edit: &EditAction) -> &'static str {
            match edit {
                $(EditAction::$name { .. } => stringify!($name)),*
            }
        }

        const NAMES: &[&str] = &[$(stringify!($name)),*];
    };
}

examples! {
    SetHand: [EditAction::SetHand(Vec3::new(100.0, 200.0, -50.0))];
    SetTwist: [EditAction::SetTwist(-0.5)];
    SetRoot: [EditAction::SetRoot(Vec3::X * 20.0)];
    SetPin: [EditAction::SetPin(Vec3::Y * 90.0)];
    PinHand: [EditAction::PinHand(true)];
    SetTwistReference: [
        EditAction::SetTwistReference(TwistReferenceKind::Pole),
        EditAction::SetTwistReference(TwistReferenceKind::Transport),
    ];
    SetPole: [EditAction::SetPole(Vec3::Z * 77.0)];
    SetSoftReach: [
        EditAction::SetSoftReach(SoftReach::new(0.3, 1.2, 0.1).expect("a soft reach")),
    ];
    SetInfluence: [EditAction::SetInfluence(0.5)];
    SwitchPoseMode: [EditAction::SwitchPoseMode(PoseMode::Angles)];
    SetShoulder: [EditAction::SetShoulder(Vec3::new(0.1, 0.2, 0.3))];
    SetBend: [EditAction::SetBend(1.25)];
    SetHandOrientation: [EditAction::SetHandOrientation(Vec3::new(0.3, 0.2, 0.1))];
    SetHandSpace: [EditAction::SetHandSpace(HandSpace::World)];
    SetUpper: [EditAction::SetUpper(180.0)];
    SetLower: [EditAction::SetLower(310.0)];
    ResetPose: [EditAction::ResetPose];
    ResetAll: [EditAction::ResetAll];
    ShowOverlay: [
        EditAction::ShowOverlay(Overlay::SingularityGlobe, true),
        EditAction::ShowOverlay(Overlay::Labels, false),
    ];
    ShowRig: [EditAction::ShowRig(RigKind::Skeleton)];
    AddChild: [EditAction::AddChild { parent: JointId::new(LEAF), tip: Some(Vec3::ONE) }];
    AddJoint: [EditAction::AddJoint { tip: None }];
    AddRoot: [EditAction::AddRoot];
    DeleteJoints: [
        EditAction::DeleteJoints(vec![JointId::new(AIMED)]),
        EditAction::DeleteJoints(vec![JointId::new(INNER), JointId::new(LEAF)]),
    ];
    DissolveJoints: [EditAction::DissolveJoints(vec![JointId::new(INNER)])];
    RenameJoint: [EditAction::RenameJoint { joint: JointId::new(INNER), name: "renamed".to_owned() }];
    ReparentJoint: [EditAction::ReparentJoint { joint: JointId::new(AIMED), parent: None }];
    SetRotation: [EditAction::SetRotation { joint: JointId::new(INNER), rotation: Vec3::splat(0.2) }];
    SetAxis: [EditAction::SetAxis { joint: JointId::new(INNER), axis: Vec3::splat(0.3) }];
    SetLimit: [EditAction::SetLimit {
        joint: JointId::new(INNER),
        axis: RotationAxis::Y,
        limit: Some(Limit { min: -0.1, max: 0.1 }),
    }];
    SetLocked: [
        EditAction::SetLocked { joint: JointId::new(INNER), locked: true },
        EditAction::SetLocked { joint: JointId::new(AIMED), locked: true },
    ];
    AddSkin: [EditAction::AddSkin];
    ShowSkin: [EditAction::ShowSkin { skin: false, bones: true }];
    PackSkin: [EditAction::PackSkin];
    SetSkin: [EditAction::SetSkin(Some(Skin::from_bones(&Shared::default())))];
    SetFollowPath: [EditAction::SetFollowPath {
        root: JointId::new(0),
        kind: Some(PathKind::Ring(WavyRing { radius: 1.0, amplitude: 0.2, waves: 3, period: 5.0 })),
    }];
    SetHead: [EditAction::SetHead { root: JointId::new(0), to: Vec3::X }];
    SetTranslation: [EditAction::SetTranslation(Vec3::X)];
    TurnYUp: [EditAction::TurnYUp];
    AddTarget: [EditAction::AddTarget(JointId::new(INNER))];
    RemoveTarget: [EditAction::RemoveTarget(JointId::new(AIMED))];
    SetTarget: [EditAction::SetTarget(Target::new(JointId::new(AIMED), Vec3::Z * 3.0, 1.0))];
    MatchTargetToFk: [EditAction::MatchTargetToFk(JointId::new(AIMED))];
    MatchFkToPose: [EditAction::MatchFkToPose(JointId::new(AIMED))];
    SetTargetSpace: [EditAction::SetTargetSpace {
        joint: JointId::new(AIMED),
        space: TargetSpace::Joint(JointId::new(INNER)),
    }];
    SetPoleSpace: [EditAction::SetPoleSpace {
        joint: JointId::new(AIMED),
        space: TargetSpace::Joint(JointId::new(INNER)),
    }];
    ApplyRemedy: [
        remedy(Remedy::Unlock(vec![JointId::new(0)])),
        remedy(Remedy::MoveTarget { joint: JointId::new(AIMED), point: Vec3::ONE }),
        remedy(Remedy::Lengthen { joint: JointId::new(AIMED), factor: 1.5 }),
        remedy(Remedy::AllowIterations(77)),
    ];
    SetSolver: [EditAction::SetSolver(
        SolverOptions::new(Method::Fabrik).with_damping(0.3),
    )];
    SetIterationsPerFrame: [EditAction::SetIterationsPerFrame(17)];
    ApplyPose: [EditAction::ApplyPose];
    Key: [
        EditAction::Key(vec![Channel::Hand]),
        EditAction::Key(vec![Channel::Twist]),
        EditAction::Key(vec![Channel::Upper, Channel::Lower]),
    ];
    DeleteKeys: [EditAction::DeleteKeys(vec![(KEYED, 0.0)])];
    ClearChannels: [EditAction::ClearChannels(vec![KEYED])];
    MoveKeys: [EditAction::MoveKeys { keys: vec![(KEYED, 0.0)], by: 0.5, raise: Vec3::ONE }];
    SetInterpolation: [EditAction::SetInterpolation(vec![(KEYED, 0.0)], Interpolation::Linear)];
    SetSlopes: [EditAction::SetSlopes(vec![(KEYED, 0.0)], Some(Slopes { arriving: Vec3::X, leaving: Vec3::Y }))];
    PasteKeys: [EditAction::PasteKeys];
    Bake: [EditAction::Bake(baked())];
    SetTimeline: [EditAction::SetTimeline(Timeline { start: 1.0, end: 4.0, frame_rate: 25.0 })];
    SetMetres: [EditAction::SetMetres(Some(2.0))];
}

/// The mesh of the skin as from a file.
fn skin_of_a_file(session: &Session) -> Skin {
    let rig = session.skeleton_rig();
    let mesh = rig.skin.as_ref().expect("a skin").mesh().expect("a mesh").mesh.clone();
    let parents = rig.skeleton.joints().iter().map(|joint| joint.parent).collect();
    let file = SkinFile { path: "x.glb".into(), checksum: 5, skeleton: "x".to_owned() };
    let joints = rig.skeleton.ids().map(Some).collect();
    let mesh = FileMesh { mesh, parents, parts: Vec::new() };
    Skin::new(SkinSource::Mesh(MeshSkin::new(mesh.into(), Some(file), joints, &rig.skeleton)))
}

/// A bake of one key.
fn baked() -> Box<Baked> {
    let mut document = session_for(&EditAction::PasteKeys).document().clone();
    document.keys.insert(Channel::Rotation(JointId::new(INNER)), 0.5, Vec3::X * 0.1);
    Box::new(Baked { document, keys_at_frames: 1, keys: 1, error: 0.0, shortened: Vec::new() })
}

/// The arm with the Human behind it, changed so that every edit has something to do.
fn session_for(edit: &EditAction) -> Session {
    let mut session = Session::default();
    let target = Target::new(JointId::new(AIMED), Vec3::new(1.0, 2.0, 3.0), 1.0);
    let with_pole =
        LimbSettings { reference: ElbowReference::Pole(Vec3::X), ..LimbSettings::default() };
    for edit in [
        // Both cameras are saved, and not undone.
        EditAction::ShowRig(RigKind::Skeleton),
        EditAction::ShowRig(RigKind::Arm),
        EditAction::SetTwist(1.0),
        EditAction::SetHandOrientation(Vec3::new(0.1, -0.4, 0.2)),
        EditAction::ShowOverlay(Overlay::Axes, true),
        EditAction::SetTarget(Target {
            kind: TargetKind::Limb(with_pole),
            influence: 1.0,
            ..target
        }),
        EditAction::Key(vec![KEYED]),
    ] {
        session.apply(edit);
    }
    session.apply(SelectAction::Keys(vec![(KEYED, 0.0)]));
    session.apply(SelectAction::CopyKeys);
    session.apply(PlaybackAction::SetTime(1.0));
    if *edit == EditAction::PackSkin {
        session.apply(EditAction::SetSkin(Some(skin_of_a_file(&session))));
    }
    if *edit == EditAction::ApplyPose {
        session.apply(EditAction::ShowRig(RigKind::Skeleton));
        session.apply(SolverAction::Step);
    }
    session
}

#[test]
fn every_edit_is_one_labelled_step_that_is_undone_and_redone_to_the_same_bytes() {
    let bytes = |session: &Session| to_json(session.document()).expect("saved");
    for edit in examples() {
        let mut session = session_for(&edit);
        let (before, label) = (bytes(&session), edit.label());
        session.apply(edit.clone());
        let after = bytes(&session);
        assert!(before != after, "{} changes the document: {:?}", name(&edit), session.message());
        assert_eq!(session.undo_label(), Some(label));
        session.apply(TransactionAction::Undo);
        assert!(bytes(&session) == before, "undo of {}", name(&edit));
        assert_eq!(session.redo_label(), Some(label));
        assert_eq!(session.message(), Some(&*format!("Undid {label}")));
        session.apply(TransactionAction::Redo);
        assert!(bytes(&session) == after, "redo of {}", name(&edit));
    }
}

#[test]
fn every_edit_in_a_transaction_is_cancelled_to_the_same_bytes() {
    let bytes = |session: &Session| to_json(session.document()).expect("saved");
    for edit in examples() {
        let mut session = session_for(&edit);
        let (before, last) = (bytes(&session), session.undo_label());
        session.apply(TransactionAction::Begin);
        session.apply(edit.clone());
        assert_eq!(session.undo_label(), Some(edit.label()));
        session.apply(TransactionAction::Cancel);
        assert!(bytes(&session) == before, "cancelled {}", name(&edit));
        assert_eq!(session.undo_label(), last);
    }
}

#[test]
fn labels_are_in_sentence_case_and_every_variant_has_an_example() {
    let all = examples();
    for variant in NAMES {
        assert!(all.iter().any(|edit| name(edit) == *variant), "{variant}");
    }
    for edit in all {
        let label = edit.label();
        assert!(label.starts_with(char::is_uppercase) && !label.ends_with('.'), "{label}");
    }
}
