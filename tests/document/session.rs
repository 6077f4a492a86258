//! A session stays valid under any actions.

use crate::common::arm::{
    Arm, ArmDocument, ArmEdit, ArmPosed, ArmSession, HandSpace, LOWER, ROOT, Step, UPPER, WRIST,
    channels,
};
use ik_arm::rig::LimbFrames;
use std::path::PathBuf;

use glam::Vec3;
use ik_arm::document::{
    Camera, Channel, Display, Document, Overlay, PathKind, Ray, SkeletonRig, Target, TargetMotion,
    TargetPath, Timeline, TwistReferenceKind, WavyRing,
};
use ik_arm::io::{FileAnimation, OpenOptions};
use ik_arm::kinematics::chain_ik::{Method, Root, SolverOptions};
use ik_arm::kinematics::skeleton::{
    Extreme, JointId, JointLimits, Limit, LimitEnd, RotationAxis, SwingAxis,
};
use ik_arm::kinematics::soft_reach::SoftReach;
use ik_arm::session::{
    Action, Dialog, DisplayEdit, DragInput, Effect, Export, FileAction, FileContents, Grip,
    GripRing, JointEdit, KeysEdit, PathDialog, PathEdit, PlaybackAction, PointHandle, PoseMode,
    SelectAction, Session, ShellAction, SolverAction, SolverEdit, TargetEdit, TransactionAction,
    ViewAction,
};
use ik_arm::words;
use proptest::collection::vec;
use proptest::prelude::*;

use crate::common::Random;
use crate::common::documents::open_example;
use crate::common::strategies::config;

fn numbers() -> impl Strategy<Value = f32> + Clone {
    prop_oneof![
        8 => -3.0..3.0_f32,
        1 => Just(0.0),
        1 => prop_oneof![Just(f32::NAN), Just(f32::INFINITY), Just(1e30), Just(-1e-30)],
    ]
}

fn points() -> impl Strategy<Value = Vec3> + Clone {
    [numbers(), numbers(), numbers()].prop_map(Vec3::from_array)
}

fn joints() -> impl Strategy<Value = JointId> + Clone {
    (0_usize..9).prop_map(JointId::new)
}

fn rays() -> impl Strategy<Value = Ray> {
    [-1.0..1.0_f32, -1.0..1.0].prop_map(|[x, y]| {
        Camera::default().framing(Vec3::ZERO, 3.0, 1.0).projection(1.0).ray(glam::Vec2::new(x, y))
    })
}

fn rotation_axes() -> impl Strategy<Value = RotationAxis> {
    proptest::sample::select(&RotationAxis::ALL)
}

fn grips() -> impl Strategy<Value = Grip> {
    let handles = prop_oneof![
        Just(PointHandle::Free),
        (0..3_usize).prop_map(PointHandle::Axis),
        (0..3_usize).prop_map(PointHandle::Plane)
    ];
    prop_oneof![
        handles.clone().prop_map(|handle| Grip::Target(LOWER, handle)),
        handles.clone().prop_map(|handle| Grip::LimbPole(LOWER, handle)),
        handles.clone().prop_map(|handle| Grip::Tip(ROOT, handle)),
        Just(Grip::LimbTwist(LOWER)),
        rotation_axes().prop_map(|axis| Grip::Ring(UPPER, axis)),
        Just(Grip::Ring(LOWER, RotationAxis::Z)),
        Just(Grip::Tip(UPPER, PointHandle::Free)),
        rotation_axes().prop_map(|axis| Grip::Ring(WRIST, axis)),
        (joints(), rotation_axes()).prop_map(|(joint, axis)| Grip::Orientation(joint, axis)),
        (joints(), limit_ends()).prop_map(|(joint, end)| Grip::Limit(joint, end)),
        (joints(), handles.clone()).prop_map(|(joint, handle)| Grip::Target(joint, handle)),
        (joints(), handles.clone()).prop_map(|(joint, handle)| Grip::Head(joint, handle)),
        (joints(), handles).prop_map(|(joint, handle)| Grip::Tip(joint, handle)),
        (joints(), rotation_axes()).prop_map(|(joint, axis)| Grip::Ring(joint, axis)),
    ]
}

fn limit_ends() -> impl Strategy<Value = LimitEnd> {
    let extremes = || prop::sample::select(vec![Extreme::Least, Extreme::Greatest]);
    let swings = prop::sample::select(vec![SwingAxis::X, SwingAxis::Z]);
    prop_oneof![
        (rotation_axes(), extremes()).prop_map(|(axis, of)| LimitEnd::Range(axis, of)),
        (swings, extremes()).prop_map(|(axis, of)| LimitEnd::Swing(axis, of)),
        extremes().prop_map(LimitEnd::Twist),
    ]
}

fn followed_paths() -> impl Strategy<Value = Option<PathKind>> {
    let ring = WavyRing { radius: 1.0, amplitude: 0.2, waves: 3, period: 5.0 };
    let kinds = [PathKind::Head, PathKind::Target, PathKind::Ring(ring)];
    prop_oneof![Just(None), prop::sample::select(kinds.map(Some).to_vec())]
}

fn building() -> impl Strategy<Value = Action> {
    prop_oneof![
        3 => (joints(), proptest::option::of(points()))
            .prop_map(|(parent, tip)| Action::from(JointEdit::AddChild { parent, tip })),
        1 => Just(Action::from(JointEdit::AddRoot)),
        1 => vec(joints(), 1..3).prop_map(JointEdit::DeleteJoints).prop_map(Action::from),
        1 => (joints(), "[a-c ]{0,2}").prop_map(|(joint, name)| Action::from(JointEdit::RenameJoint { joint, name })),
        2 => (joints(), proptest::option::of(joints()))
            .prop_map(|(joint, parent)| Action::from(JointEdit::ReparentJoint { joint, parent })),
        1 => (joints(), points()).prop_map(|(joint, axis)| Action::from(JointEdit::SetAxis { joint, axis })),
        1 => (joints(), rotation_axes(), numbers(), numbers()).prop_map(|(joint, axis, min, max)| {
            let limits = JointLimits::NONE.with_range(axis, Some(Limit { min, max }));
            Action::from(JointEdit::SetLimits { joint, limits })
        }),
        1 => (joints(), any::<bool>())
            .prop_map(|(joint, locked)| Action::from(JointEdit::SetLocked { joint, locked })),
        1 => vec(joints(), 0..3).prop_map(SelectAction::Joints).prop_map(Action::from),
    ]
}

fn posing() -> impl Strategy<Value = Action> {
    let paths = prop_oneof![
        Just(TargetPath::Still),
        Just(TargetPath::Circle),
        Just(TargetPath::FigureEight)
    ];
    let motion = (paths, numbers(), numbers()).prop_map(|(path, radius, period)| TargetMotion {
        path,
        radius,
        period,
    });
    prop_oneof![
        2 => (joints(), points())
            .prop_map(|(joint, rotation)| Action::from(JointEdit::SetRotation { joint, rotation })),
        2 => joints().prop_map(TargetEdit::AddTarget).prop_map(Action::from),
        1 => joints().prop_map(TargetEdit::RemoveTarget).prop_map(Action::from),
        2 => (joints(), points(), numbers(), any::<bool>(), motion).prop_map(
            |(joint, home, weight, enabled, motion)| Action::from(TargetEdit::SetTarget(Target {
                weight, enabled, motion, ..Target::new(joint, home, 1.0)
            }))
        ),
        1 => (0..6_usize, numbers(), 0..3_usize).prop_map(|(method, damping, root)| {
            let root = Root::ALL[root];
            Action::from(SolverEdit::SetSolver(
                SolverOptions::new(Method::ALL[method]).with_damping(damping).with_root(root)
            ))
        }),
        2 => (joints(), followed_paths()).prop_map(|(root, kind)| PathEdit::SetFollowPath { root, kind }).prop_map(Action::from),
        1 => (joints(), points()).prop_map(|(root, to)| PathEdit::SetHead { root, to }).prop_map(Action::from),
        1 => any::<bool>().prop_map(SolverAction::Run).prop_map(Action::from),
        2 => Just(Action::from(SolverAction::Step)),
        1 => Just(Action::from(SolverAction::Reset)),
        1 => Just(Action::from(SolverAction::Compare)),
        1 => (0..20_u32).prop_map(SolverAction::Show).prop_map(Action::from),
        1 => Just(Action::from(SolverEdit::ApplyPose)),
        1 => any::<bool>().prop_map(PlaybackAction::Play).prop_map(Action::from),
        2 => (0.0..60.0).prop_map(PlaybackAction::Advance).prop_map(Action::from),
        1 => Just(Action::from(DisplayEdit::ResetPose)),
    ]
}

fn arming() -> impl Strategy<Value = Step> {
    let parts = || prop_oneof![3 => 0.0..1.0_f32, 1 => Just(0.0), 1 => Just(1.0), 1 => numbers()];
    let soft_reach = (0.0..0.9_f32, 1.0..2.0_f32, 0.0..3.0_f32);
    prop_oneof![
        3 => points().prop_map(ArmEdit::SetHand).prop_map(Step::from),
        2 => points().prop_map(ArmEdit::SetRoot).prop_map(Step::from),
        2 => any::<bool>().prop_map(ArmEdit::PinHand).prop_map(Step::from),
        1 => points().prop_map(ArmEdit::SetPin).prop_map(Step::from),
        3 => (0..4_usize).prop_map(|twist_reference| Step::from(ArmEdit::SetTwistReference(TwistReferenceKind::ALL[twist_reference]))),
        2 => points().prop_map(ArmEdit::SetPole).prop_map(Step::from),
        2 => soft_reach.prop_map(|(softness, stretch, angle)| Step::from(ArmEdit::SetSoftReach(
            SoftReach::new(softness, stretch, angle).expect("a softening")
        ))),
        2 => parts().prop_map(ArmEdit::SetInfluence).prop_map(Step::from),
        2 => prop_oneof![Just(PoseMode::Hand), Just(PoseMode::Angles)].prop_map(ArmEdit::SwitchPoseMode).prop_map(Step::from),
        1 => points().prop_map(ArmEdit::SetShoulder).prop_map(Step::from),
        1 => numbers().prop_map(ArmEdit::SetBend).prop_map(Step::from),
        1 => points().prop_map(ArmEdit::SetHandOrientation).prop_map(Step::from),
        1 => prop_oneof![Just(HandSpace::LowerLimb), Just(HandSpace::World)].prop_map(ArmEdit::SetHandSpace).prop_map(Step::from),
        1 => Just(Step::from(ViewAction::ResetTransport)),
    ]
}

fn channels() -> impl Strategy<Value = Channel> + Clone {
    prop_oneof![
        prop_oneof![
            (0..channels::ALL.len()).prop_map(|channel| channels::ALL[channel]),
            Just(Channel::Translation),
            Just(Channel::Overlay(Overlay::Cursor)),
        ],
        joints().prop_map(Channel::Rotation),
        joints().prop_map(Channel::Offset),
        joints().prop_map(Channel::Target),
        joints().prop_map(Channel::Enabled),
    ]
}

fn keying() -> impl Strategy<Value = Action> {
    let times = prop_oneof![(0..5).prop_map(|step| f64::from(step) * 0.5), -1.0..9.0_f64];
    let key = (channels(), times.clone());
    prop_oneof![
        4 => vec(channels(), 1..4).prop_map(KeysEdit::Key).prop_map(Action::from),
        3 => times.clone().prop_map(PlaybackAction::SetTime).prop_map(Action::from),
        1 => vec(key.clone(), 1..3).prop_map(KeysEdit::DeleteKeys).prop_map(Action::from),
        1 => vec(channels(), 1..3).prop_map(KeysEdit::ClearChannels).prop_map(Action::from),
        1 => (vec(key.clone(), 1..3), -2.0..2.0_f64)
            .prop_map(|(keys, by)| Action::from(KeysEdit::MoveKeys { keys, by, raise: Vec3::ZERO })),
        1 => vec(key, 1..3).prop_map(SelectAction::Keys).prop_map(Action::from),
        1 => Just(Action::from(SelectAction::CopyKeys)),
        1 => Just(Action::from(KeysEdit::PasteKeys)),
        1 => any::<bool>().prop_map(PlaybackAction::SetAutoKey).prop_map(Action::from),
        1 => (times.clone(), times, 0.0..70.0).prop_map(|(start, end, frame_rate)| {
            Action::from(KeysEdit::SetTimeline(Timeline { start, end, frame_rate }))
        }),
        1 => any::<bool>().prop_map(|shown| Action::from(DisplayEdit::ShowOverlay(Overlay::Cursor, shown))),
        1 => points().prop_map(JointEdit::SetTranslation).prop_map(Action::from),
        1 => numbers().prop_map(|metres| Action::from(DisplayEdit::SetMetres(Some(metres)))),
        1 => Just(Action::from(TransactionAction::Undo)),
        1 => Just(Action::from(TransactionAction::Redo)),
    ]
}

fn dragging() -> impl Strategy<Value = Action> {
    let input = (rays(), any::<bool>(), any::<bool>()).prop_map(|(ray, precise, snap)| DragInput {
        ray,
        precise,
        snap,
    });
    prop_oneof![
        (grips(), rays()).prop_map(|(grip, ray)| Action::from(TransactionAction::Grab {
            grip,
            ray,
            forward: Camera::default().projection(1.0).forward
        })),
        input.prop_map(TransactionAction::Drag).prop_map(Action::from),
        "[-0-9.,]{0,4}".prop_map(TransactionAction::TypeOffset).prop_map(Action::from),
        Just(Action::from(TransactionAction::Commit)),
        Just(Action::from(TransactionAction::Cancel)),
    ]
}

fn actions() -> impl Strategy<Value = Vec<Step>> {
    vec(
        prop_oneof![
            3 => building().prop_map(Step::from),
            3 => posing().prop_map(Step::from),
            2 => dragging().prop_map(Step::from),
            3 => keying().prop_map(Step::from),
            4 => arming(),
        ],
        1..80,
    )
}

fn session() -> Session {
    let document = Document::new(SkeletonRig::default());
    Session::with_document(Default::default(), document)
}

/// A new document: with the arm, or with one joint.
fn sessions() -> impl Strategy<Value = Session> {
    any::<bool>().prop_map(|has_arm| if has_arm { Session::default() } else { session() })
}

fn check(session: &Session) -> Result<(), TestCaseError> {
    let rig = session.rig();
    let joints = rig.skeleton.joints();
    prop_assert_eq!(session.skeleton_pose().len(), joints.len());
    prop_assert!(
        session.selection().joints().iter().all(|joint| *joint < JointId::new(joints.len()))
    );
    prop_assert!(
        session.selection().hovered().is_none_or(|joint| joint < JointId::new(joints.len()))
    );
    let mut names = std::collections::HashSet::new();
    for (index, joint) in joints.iter().enumerate() {
        prop_assert!(joint.parent.is_none_or(|parent| parent < JointId::new(index)));
        prop_assert!(joint.rotation.is_finite() && joint.axis.is_finite());
        prop_assert!(joint.offset.is_finite(), "{} at {}", joint.name, joint.offset);
        prop_assert!(names.insert(&joint.name), "two are called {}", joint.name);
        prop_assert_eq!(joint.limits.project(joint.rotation), joint.rotation);
    }
    let mut targeted = std::collections::HashSet::new();
    for target in &rig.targets {
        prop_assert!(target.joint < JointId::new(joints.len()) && targeted.insert(target.joint));
        prop_assert!(target.home.is_finite() && target.weight > 0.0);
    }
    for target in &session.rig().targets {
        session.posed().limb_frames(target.joint).as_ref().map_or(Ok(()), check_limb)?;
    }
    let document = session.document();
    prop_assert!(document.timeline.is_valid());
    for (channel, track) in document.keys.tracks() {
        prop_assert!(channel.value(document).is_some(), "{channel:?} is of nothing");
        prop_assert!(track.knots().is_sorted_by(|a, b| a.time < b.time));
        prop_assert!(track.knots().iter().all(|knot| knot.value.is_finite()));
    }
    for (channel, time) in session.selection().keys() {
        prop_assert!(document.keys.track(*channel).and_then(|track| track.get(*time)).is_some());
    }
    Ok(())
}

/// The limbs have their lengths.
fn check_limb(limb: &LimbFrames) -> Result<(), TestCaseError> {
    let pose = limb.pose();
    prop_assert!(pose.elbow.is_finite() && pose.hand.is_finite(), "{:?}", pose);
    let bones = limb.bones();
    let bones = [bones.upper(), bones.lower()].map(|length| f64::from(length * pose.stretch));
    let [elbow, hand] = [pose.elbow, pose.hand].map(Vec3::as_dvec3);
    let tolerance = 2e-6 * (bones[0] + bones[1]);
    prop_assert!((elbow.length() - bones[0]).abs() <= tolerance, "{:?}", pose);
    prop_assert!(((hand - elbow).length() - bones[1]).abs() <= tolerance, "{:?}", pose);
    Ok(())
}

/// A document without its camera, which undo leaves alone.
fn without_views(document: &Document) -> Document {
    Document { camera: Camera::default(), ..document.clone() }
}

/// A document without camera and overlays.
fn content(document: &Document) -> Document {
    Document { display: Display::default(), ..without_views(document) }
}

proptest! {
    #![proptest_config(config(200, 0x5ce1_e70e))]

    #[test]
    fn any_actions_leave_a_valid_session(session in sessions(), actions in actions()) {
        let mut session = session;
        for action in actions {
            action.apply(&mut session);
            check(&session)?;
        }
    }

    #[test]
    fn a_cancelled_drag_restores_the_session(session in sessions(), before in actions(), grip in grips(), drag in vec(dragging(), 1..20)) {
        let mut session = session;
        for action in before {
            action.apply(&mut session);
        }
        for action in [Action::from(TransactionAction::Cancel), Action::from(PlaybackAction::Play(false))] {
            session.apply(action);
        }
        let (document, shown) = (session.document().clone(), session.shown().clone());
        let forward = session.camera().projection(1.0).forward;
        let ray = session.camera().projection(1.0).ray(glam::Vec2::ZERO);
        session.apply(TransactionAction::Grab { grip, ray, forward });
        let held = session.history().is_editing();
        for action in drag {
            let goes_on = matches!(action, Action::Transaction(TransactionAction::Drag(_)) | Action::Transaction(TransactionAction::TypeOffset(_)));
            if goes_on {
                session.apply(action);
            }
        }
        session.apply(TransactionAction::Cancel);
        if held {
            prop_assert!(same(session.rig(), &shown.rig));
            prop_assert_eq!(&session.document().keys, &document.keys);
        }
    }

    #[test]
    fn undo_returns_to_the_first_document_and_redo_to_the_last(session in sessions(), actions in actions()) {
        let mut session = session;
        let first = session.document().clone();
        for action in actions {
            action.apply(&mut session);
        }
        for action in [Action::from(TransactionAction::Commit), Action::from(PlaybackAction::Play(false))] {
            session.apply(action);
        }
        while session.history().redo_label().is_some() {
            session.apply(TransactionAction::Redo);
        }
        let last = session.document().clone();
        prop_assert!(session.history().is_unsaved() || content(&last) == content(&first));
        while session.history().undo_label().is_some() {
            session.apply(TransactionAction::Undo);
            check(&session)?;
        }
        prop_assert_eq!(without_views(session.document()), without_views(&first));
        prop_assert!(!session.history().is_unsaved());
        while session.history().redo_label().is_some() {
            session.apply(TransactionAction::Redo);
            check(&session)?;
        }
        prop_assert_eq!(without_views(session.document()), without_views(&last));
    }
}

/// A hand keyed at two positions a second apart, at a time between them.
fn halfway() -> Session {
    let mut session = Session::default();
    for (time, hand) in [(0.0, Vec3::X * 200.0), (1.0, Vec3::Y * 200.0)] {
        session.apply(PlaybackAction::SetTime(time));
        session.edit_arm(ArmEdit::SetHand(hand));
        session.apply(KeysEdit::Key(vec![channels::HAND]));
    }
    session.apply(PlaybackAction::SetAutoKey(false));
    session.apply(PlaybackAction::SetTime(0.5));
    assert_eq!(session.arm().cursor_in_root(), Vec3::new(100.0, 100.0, 0.0));
    session
}

#[test]
fn an_unkeyed_edit_is_shown_until_the_time_changes() {
    let mut session = halfway();
    let document = session.document().clone();
    session.apply(FileAction::Saved("x.json".into()));
    session.edit_arm(ArmEdit::SetHand(Vec3::Z * 50.0));
    assert!(session.history().is_overridden(channels::HAND));
    assert_eq!(
        session.shell().message(),
        Some("Unkeyed change: press K or it is lost when the time changes")
    );
    assert_eq!(session.arm().cursor_in_root(), Vec3::Z * 50.0);
    assert_eq!(session.document().keys, document.keys);
    for time in [0.6, 0.5] {
        session.apply(PlaybackAction::SetTime(time));
        let expected = Vec3::new(200.0 * (1.0 - time as f32), 200.0 * time as f32, 0.0);
        assert!(session.arm().cursor_in_root().distance(expected) < 1e-3);
        assert!(!session.history().is_overridden(channels::HAND));
    }
}

#[test]
fn an_unkeyed_edit_can_be_undone_and_keyed() {
    let mut session = halfway();
    session.edit_arm(ArmEdit::SetHand(Vec3::Z * 50.0));
    session.apply(TransactionAction::Undo);
    assert_eq!(session.arm().cursor_in_root(), Vec3::new(100.0, 100.0, 0.0));
    session.apply(TransactionAction::Redo);
    assert_eq!(session.arm().cursor_in_root(), Vec3::Z * 50.0);
    session.apply(KeysEdit::Key(vec![channels::HAND]));
    session.apply(PlaybackAction::SetTime(0.0));
    session.apply(PlaybackAction::SetTime(0.5));
    assert_eq!(session.arm().cursor_in_root(), Vec3::Z * 50.0);
}

#[test]
fn an_unkeyed_edit_leaves_the_document_unchanged() {
    let mut session = halfway();
    session.apply(FileAction::Saved("x.json".into()));
    let document = session.document().clone();
    session.edit_arm(ArmEdit::SetHand(Vec3::Z * 50.0));
    session.apply(PlaybackAction::SetTime(0.6));
    assert_eq!(session.document(), &document);
    assert!(!session.history().is_unsaved());
}

#[test]
fn an_unkeyed_edit_that_a_time_change_discards_comes_back_with_undo() {
    let mut session = halfway();
    session.edit_arm(ArmEdit::SetHand(Vec3::Z * 50.0));
    session.apply(PlaybackAction::Play(true));
    session.apply(PlaybackAction::Advance(0.0));
    session.apply(PlaybackAction::Advance(0.1));
    assert_eq!(
        session.shell().message(),
        Some("The unkeyed change at 0.50 s is discarded: Ctrl+Z brings it back")
    );
    let played = (session.playback().time(), session.arm().cursor_in_root());
    assert_ne!(played.0, 0.5);

    session.apply(TransactionAction::Undo);
    assert_eq!((session.playback().time(), session.playback().is_playing()), (0.5, false));
    assert_eq!(session.arm().cursor_in_root(), Vec3::Z * 50.0);
    session.apply(TransactionAction::Redo);
    assert_eq!((session.playback().time(), session.arm().cursor_in_root()), played);

    session.apply(TransactionAction::Undo);
    session.apply(TransactionAction::Undo);
    assert_eq!(session.arm().cursor_in_root(), Vec3::new(100.0, 100.0, 0.0));
    assert_eq!(session.document().keys.count(), 2, "both keys are still there");
}

#[test]
fn the_playhead_stays_when_undo_brings_back_no_unkeyed_edit() {
    let mut session = halfway();
    session.apply(PlaybackAction::SetTime(0.7));
    session.apply(TransactionAction::Undo);
    assert_eq!((session.document().keys.count(), session.playback().time()), (1, 0.7));
}

#[test]
fn a_cancelled_drag_during_playback_leaves_the_playhead_alone() {
    let mut session = halfway();
    session.apply(PlaybackAction::Play(true));
    session.apply(PlaybackAction::Advance(0.0));
    session.apply(TransactionAction::Begin);
    session.edit_arm(ArmEdit::SetHand(Vec3::Z * 50.0));
    session.apply(PlaybackAction::Advance(0.1));
    session.edit_arm(ArmEdit::SetHand(Vec3::Z * 51.0));
    let time = session.playback().time();
    session.apply(TransactionAction::Cancel);
    assert_eq!((session.playback().time(), session.playback().is_playing()), (time, true));
    assert!(!session.history().is_overridden(channels::HAND));
}

#[test]
fn a_move_of_the_playhead_without_unkeyed_edits_is_no_undo_step() {
    let mut session = halfway();
    let label = session.history().undo_label();
    session.apply(PlaybackAction::SetTime(0.7));
    session.apply(PlaybackAction::SetTime(0.2));
    assert_eq!(session.history().undo_label(), label);
}

#[test]
fn the_first_key_turns_auto_key_on_for_the_arm_and_for_figures() {
    for name in [None, Some("human")] {
        let mut session = Session::default();
        if let Some(name) = name {
            session.apply(open_example(name));
            session.apply(KeysEdit::ClearChannels(
                KeysEdit::keyed_channels(session.shown()).collect(),
            ));
        }
        assert!(!session.playback().is_auto_key() && !session.playback().is_auto_key_news());
        let channels = KeysEdit::channels_to_key(&session);
        session.apply(KeysEdit::Key(channels.clone()));
        assert!(session.playback().is_auto_key() && session.playback().is_auto_key_news());
        assert_eq!(
            session.shell().message(),
            Some("Keyed at 0.00 s. Auto-key is on: every edit sets keys")
        );

        session.apply(PlaybackAction::SetTime(2.0));
        let at_2 = |session: &Session| session.document().keys.times().contains(&2.0);
        match name {
            None => session.edit_arm(ArmEdit::SetHand(Vec3::X * 300.0)),
            Some(_) => {
                let joint = JointId::new(1);
                session.apply(JointEdit::SetRotation { joint, rotation: Vec3::X * 0.3 });
            }
        }
        assert!(at_2(&session), "{name:?}: the pose at 2 s is kept");
        assert!(
            session.playback().is_auto_key() && !session.playback().is_auto_key_news(),
            "it is said once"
        );

        for _ in 0..2 {
            session.apply(TransactionAction::Undo);
        }
        assert!(!session.playback().is_auto_key(), "{name:?}: off without keys");
        session.apply(TransactionAction::Redo);
        assert!(session.playback().is_auto_key());
        session.apply(TransactionAction::Undo);
        session.apply(PlaybackAction::SetAutoKey(false));
        session.apply(KeysEdit::Key(channels));
        assert!(!session.playback().is_auto_key(), "{name:?}: the user's choice stays");
        assert_eq!(session.shell().message(), Some("Keyed at 2.00 s"));
    }
}

#[test]
fn a_key_replaces_an_unkeyed_edit() {
    let mut session = halfway();
    session.edit_arm(ArmEdit::SetHand(Vec3::Z * 50.0));
    session.apply(PlaybackAction::SetAutoKey(true));
    session.edit_arm(ArmEdit::SetHand(Vec3::Z * 60.0));
    assert_eq!(session.arm().cursor_in_root(), Vec3::Z * 60.0);
    assert!(!session.history().is_overridden(channels::HAND));

    let mut session = halfway();
    session.edit_arm(ArmEdit::SetHand(Vec3::Z * 50.0));
    session.apply(KeysEdit::ClearChannels(vec![channels::HAND]));
    session.edit_arm(ArmEdit::SetHand(Vec3::Z * 70.0));
    session.edit_arm(ArmEdit::SetTwist(1.0));
    assert_eq!(session.arm().cursor_in_root(), Vec3::Z * 70.0);
    assert_eq!(session.document().arm().cursor_in_root(), Vec3::Z * 70.0);
}

#[test]
fn selected_and_copied_keys_follow_their_joints() {
    let mut session = Session::default();
    session.apply(open_example("human"));
    let channels: Vec<Channel> =
        (0..49).map(|joint| Channel::Rotation(JointId::new(joint))).collect();
    session.apply(KeysEdit::Key(channels));
    let name = |session: &Session, joint: JointId| session.skeleton()[joint].name.clone();
    let foot = name(&session, JointId::new(15));
    session.apply(SelectAction::Keys(vec![(Channel::Rotation(JointId::new(15)), 0.0)]));
    session.apply(SelectAction::Channels(vec![Channel::Rotation(JointId::new(15))]));
    session.apply(SelectAction::CopyKeys);
    session.apply(JointEdit::DeleteJoints(vec![JointId::new(8)]));
    let [(Channel::Rotation(joint), _)] = *session.selection().keys() else { panic!("one is") };
    assert_eq!(name(&session, joint), foot);
    assert!(session.selection().channels().contains(&Channel::Rotation(joint)));
    session.apply(PlaybackAction::SetTime(1.0));
    session.apply(KeysEdit::PasteKeys);
    assert_eq!(session.selection().keys(), [(Channel::Rotation(joint), 1.0)]);
    // Undo restores the joint indices and clears the selection: no wrong joint is selected.
    session.apply(TransactionAction::Undo);
    session.apply(TransactionAction::Undo);
    assert_eq!((session.selection().keys(), session.selection().joints()), (&[][..], &[][..]));
}

#[test]
fn a_file_that_opens_late_asks_before_it_replaces_unsaved_changes() {
    let mut session = Session::default();
    session.apply(FileAction::Open { path: "slow.glb".into(), options: OpenOptions::default() });
    session.edit_arm(ArmEdit::SetTwist(1.0));
    let opened = FileAction::Opened { document: Box::default(), file: None, contents: None };
    session.apply(opened.clone());
    assert_eq!(session.arm().twist, 1.0);
    assert_eq!(session.shell().dialog(), Some(&Dialog::Unsaved { then: Box::new(opened.clone()) }));
    session.apply(FileAction::Discard(Box::new(opened)));
    assert_eq!(session.document(), &Document::default());
}

#[test]
fn many_keys_move_at_once() {
    let mut session = Session::default();
    let mut document = Document::default();
    for frame in 0..50_000 {
        document.keys.insert(channels::HAND, f64::from(frame) / 30.0, Vec3::X * frame as f32);
    }
    session.apply(FileAction::Opened { document: Box::new(document), file: None, contents: None });
    let keys: Vec<_> = (0..50_000).map(|frame| (channels::HAND, f64::from(frame) / 30.0)).collect();
    session.apply(KeysEdit::MoveKeys { keys, by: 1.0, raise: Vec3::ZERO });
    let track = session.document().keys.track(channels::HAND).expect("keyed").knots();
    assert_eq!((track.len(), track[0].time), (50_000, 1.0));
}

#[test]
fn onion_skins_are_shown_while_their_switch_is_keyed_on() {
    let mut session = halfway();
    session.apply(PlaybackAction::SetTime(0.0));
    let skins = Channel::Overlay(Overlay::OnionSkins);
    session.apply(KeysEdit::Key(vec![skins]));
    session.apply(PlaybackAction::SetTime(0.5));
    session.apply(DisplayEdit::ShowOverlay(Overlay::OnionSkins, true));
    session.apply(KeysEdit::Key(vec![skins]));
    for (time, shown) in [(0.4, false), (0.6, true)] {
        session.apply(PlaybackAction::SetTime(time));
        assert_eq!(session.overlays().onion_skins.is_empty(), !shown, "at {time} s");
    }
}

#[test]
fn a_cancelled_drag_restores_the_unkeyed_edit_that_the_time_has_discarded() {
    let mut session = halfway();
    session.edit_arm(ArmEdit::SetHand(Vec3::Z * 50.0));
    session.apply(TransactionAction::Begin);
    session.apply(PlaybackAction::SetTime(1.0));
    session.apply(TransactionAction::Cancel);
    assert_eq!((session.playback().time(), session.arm().cursor_in_root()), (0.5, Vec3::Z * 50.0));
}

#[test]
fn with_auto_key_every_edit_makes_a_key() {
    let mut session = Session::default();
    session.apply(PlaybackAction::SetAutoKey(true));
    for (time, twist) in [(0.0, 6.0), (1.0, 0.5)] {
        session.apply(PlaybackAction::SetTime(time));
        session.edit_arm(ArmEdit::SetTwist(twist));
    }
    let keys = &session.document().keys;
    let channels: Vec<Channel> = keys.tracks().map(|(channel, _)| channel).collect();
    assert_eq!(channels, [channels::TWIST]);
    // The shorter turn, past 0.
    let twist = keys.value(channels::TWIST, 1.0).expect("a key").x;
    assert!((twist - 0.5 - std::f32::consts::TAU).abs() < 1e-5, "{twist}");
    // A switch gets no key by being switched.
    session.apply(DisplayEdit::ShowOverlay(Overlay::Cursor, false));
    assert!(!session.document().keys.has(Channel::Overlay(Overlay::Cursor)));
}

#[test]
fn playing_keeps_time_at_any_frame_rate_and_edits_nothing() {
    for (steps, step) in [(200, 0.01), (4, 0.5), (1, 2.0)] {
        let mut session = halfway();
        session.apply(PlaybackAction::SetTime(0.0));
        let document = session.document().clone();
        session.apply(PlaybackAction::Play(true));
        for tick in 0..=steps {
            session.apply(PlaybackAction::Advance(50.0 + f64::from(tick) * step));
        }
        assert!((session.playback().time() - 2.0).abs() < 1e-9, "{}", session.playback().time());
        assert_eq!(session.document(), &document);
    }
}

#[test]
fn playing_stops_at_the_end_or_loops() {
    for (looping, expected, playing) in [(true, 1.5, true), (false, 8.0, false)] {
        let mut session = halfway();
        session.apply(PlaybackAction::SetTime(0.0));
        session.apply(PlaybackAction::SetLooping(looping));
        session.apply(PlaybackAction::Play(true));
        for seconds in [1.0, 10.5] {
            session.apply(PlaybackAction::Advance(seconds));
        }
        assert_eq!(
            (session.playback().time(), session.playback().is_playing()),
            (expected, playing)
        );
    }
}

#[test]
fn a_paused_solver_uses_the_new_weight_of_a_target() {
    let mut session = Session::default();
    session.apply(open_example("two-targets"));
    let apart = [Vec3::new(-9.0, 2.0, 0.0), Vec3::new(9.0, 2.0, 0.0)];
    let targets: Vec<_> = session.rig().targets.clone();
    for (target, home) in targets.iter().zip(apart) {
        session.apply(TargetEdit::SetTarget(Target { home, ..*target }));
    }
    let heavy = targets[0];
    let gap = |session: &mut Session| {
        (0..400).for_each(|_| drop(session.apply(SolverAction::Step)));
        session.solvers().run().expect("it steps").skeleton().tip(heavy.joint).distance(apart[0])
    };
    let before = gap(&mut session);
    session.apply(TargetEdit::SetTarget(Target { home: apart[0], weight: 50.0, ..heavy }));
    let after = gap(&mut session);
    assert!(after < before * 0.99, "{before} before and {after} after");
}

#[test]
fn a_target_with_influence_poses_the_joints_and_their_rings_but_writes_no_angles() {
    let mut session = Session::default();
    session.apply(open_example("ten-joints"));
    let before = session.document().clone();
    let target = session.rig().targets[0];
    let tip = session.skeleton_pose().tip(target.joint);
    assert!(tip.distance(target.home) > 0.1, "the joints' own angles do not reach the target");
    session.apply(TargetEdit::SetTarget(Target { influence: 1.0, ..target }));
    let tip = session.skeleton_pose().tip(target.joint);
    assert!(tip.distance(target.home) < 1e-3, "{tip}");
    assert_eq!(session.skeleton(), before.skeleton());
    assert_eq!(
        GripRing::of_joint(session.posed(), target.joint, RotationAxis::X),
        None,
        "its angles pose nothing"
    );
    session.apply(TargetEdit::SetTarget(Target { influence: 0.5, ..target }));
    let ring = GripRing::of_joint(session.posed(), target.joint, RotationAxis::X)
        .expect("a movable angle");
    assert_eq!(ring.centre, session.skeleton_pose().base(target.joint));
    assert_eq!(session.skeleton(), before.skeleton());
    session.apply(TransactionAction::Undo);
    session.apply(TransactionAction::Undo);
    assert_eq!(session.document(), &before);
}

/// Equal, and NaN equals NaN.
fn same(a: &SkeletonRig, b: &SkeletonRig) -> bool {
    a == b || format!("{a:?}") == format!("{b:?}")
}

#[test]
fn home_frames_all_that_the_hand_can_reach() {
    let mut random = Random(0x0f2a_9e55);
    for case in 0..2_000 {
        let arm = reaching_arm(&mut random);
        let limits = arm.reach_limits();
        let document = arm.document();
        let session = Session::with_document(Default::default(), document);
        let projection = session.framing_all().projection(1.0);
        for _ in 0..20 {
            let far = arm.root + random.direction() * limits.outer;
            let at = projection.project(far).expect("before the eye");
            assert!(at.abs().max_element() <= 1.0, "case {case}: {far} is drawn at {at}");
        }
        let distance = session.pose().distance;
        let rounding = 1e-6 * limits.outer;
        let reach = limits.inner - rounding..=limits.outer + rounding;
        assert!(reach.contains(&distance), "case {case}: {distance} is not in {reach:?}");
        let frames = session.posed().arm_frames();
        assert_eq!((frames.limits, frames.pointer().length), (limits, limits.outer), "case {case}");
    }
}

/// An arm whose Cursor is in reach, too far or too close, by IK, FK or a blend.
fn reaching_arm(random: &mut Random) -> Arm {
    let stretch = random.one_of(&[1.0, 1.0, 1.5, 3.0]);
    let angle = random.one_of(&[0.0, 0.0, 0.5, 1.5]);
    let lengths = [random.within(10.0..500.0), random.within(10.0..500.0)];
    let mut arm = Arm::new(lengths[0], lengths[1]).expect("lengths");
    arm.root = random.vector(300.0);
    arm.soft_reach =
        SoftReach::new(random.one_of(&[0.0, 0.3]), stretch, angle).expect("soft limits");
    arm.influence = random.one_of(&[0.0, 0.4, 1.0, 1.0]);
    arm.fk.bend = random.within(-3.1..3.1);
    arm.fk.stretch = random.one_of(&[1.0, 0.5, 2.0]);
    arm.set_cursor(random.direction() * arm.bones.outer_limit() * random.within(0.0..4.0));
    arm
}

#[test]
fn the_remark_on_an_unkeyed_change_goes_with_the_change_and_other_remarks_stay() {
    let mut session = halfway();
    session.apply(PlaybackAction::SetAutoKey(false));
    session.edit_arm(ArmEdit::SetHand(Vec3::X));
    assert!(session.shell().message().is_some_and(|it| it.starts_with("Unkeyed change")));
    session.apply(PlaybackAction::SetTime(0.25));
    let discarded = "The unkeyed change at 0.50 s is discarded: Ctrl+Z brings it back";
    assert_eq!(session.shell().message(), Some(discarded));
    session.apply(ShellAction::Report("Saved".to_owned()));
    session.apply(PlaybackAction::SetTime(0.3));
    assert_eq!(session.shell().message(), Some("Saved"));
}

#[test]
fn unsaved_changes_are_asked_about_only_once_the_other_file_was_read() {
    let mut session = Session::default();
    session.edit_arm(ArmEdit::SetTwist(1.0));
    let (path, options) = (PathBuf::from("other.json"), OpenOptions::default());
    let effect = session.apply(FileAction::Open { path: path.clone(), options: options.clone() });
    assert_eq!(effect, Some(Effect::Open { path: path.clone(), options }));
    assert_eq!(session.shell().dialog(), None, "nothing is lost yet");
    session.apply(FileAction::NotOpened { path, why: "it is not there".to_owned() });
    assert!(matches!(session.shell().dialog(), Some(Dialog::Path(PathDialog::Open { .. }))));
    assert_eq!(session.arm().twist, 1.0);

    session.apply(ShellAction::CloseDialog);
    session.remark_when_opened(Some("Opened other.json".to_owned()));
    let opened = FileAction::Opened { document: Box::default(), file: None, contents: None };
    session.apply(opened.clone());
    assert_eq!(session.shell().dialog(), Some(&Dialog::Unsaved { then: Box::new(opened.clone()) }));
    assert_ne!(session.shell().message(), Some("Opened other.json"), "it is not open yet");
    session.apply(FileAction::Discard(Box::new(opened)));
    assert_eq!(
        (session.shell().dialog(), session.shell().message()),
        (None, Some("Opened other.json"))
    );
}

/// The contents of a file of another program with one skeleton and some animations.
fn contents(path: &str, animations: usize) -> Box<FileContents> {
    let moves = |nth| FileAnimation {
        name: format!("{nth}"),
        start: 0.0,
        end: 1.0,
        moving_joints: 3,
        has_morphs: false,
    };
    Box::new(FileContents {
        path: path.into(),
        options: OpenOptions::default(),
        skeletons: vec!["rig".to_owned()],
        animations: (0..animations).map(moves).collect(),
        animation: Some(0),
    })
}

#[test]
fn an_imported_file_gives_the_document_its_name() {
    let mut session = Session::default();
    assert_eq!(session.files().name(), None);
    let contents = Some(contents("/models/Walk cycle.glb", 1));
    session.apply(FileAction::Opened { document: Box::default(), file: None, contents });
    assert_eq!(session.files().name().as_deref(), Some("Walk cycle"));
    assert_eq!(session.files().file(), None, "Save must not overwrite the file of another program");
    let named = |dialog: PathDialog| dialog.path().to_owned();
    assert_eq!(named(session.files().save_as_dialog()), PathBuf::from("Walk cycle.json"));
    assert_eq!(named(session.files().save_picture_dialog()), PathBuf::from("Walk cycle.png"));
    assert_eq!(
        named(session.files().export_dialog(session.document())),
        PathBuf::from("Walk cycle.glb")
    );
    assert_eq!(
        session.files().folder_of(&session.files().save_as_dialog()),
        PathBuf::from("/models")
    );
    assert_eq!(
        session.apply(FileAction::Save),
        Some(Effect::ChoosePath(session.files().save_as_dialog()))
    );
    session.apply(FileAction::Saved("/mine/walk.json".into()));
    assert_eq!(session.files().name().as_deref(), Some("walk.json"));
}

#[test]
fn of_several_animations_the_user_is_asked_for_one_also_after_the_question_about_changes() {
    let mut session = Session::default();
    session.edit_arm(ArmEdit::SetTwist(1.0));
    let contents = Some(contents("/models/Walk.glb", 2));
    let opened = FileAction::Opened { document: Box::default(), file: None, contents };
    session.apply(opened.clone());
    assert!(matches!(session.shell().dialog(), Some(Dialog::Unsaved { .. })));
    session.apply(FileAction::Discard(Box::new(opened)));
    assert!(matches!(session.shell().dialog(), Some(Dialog::ChooseContents(_))));
}

#[test]
fn an_export_into_a_missing_folder_does_not_leave_the_next_one_there() {
    let mut session = Session::default();
    let dialog = session.files().export_dialog(session.document());
    let before = session.files().folder_of(&dialog);
    let PathDialog::Export(export) = dialog.clone() else { panic!("an export") };
    let folder = tempfile::tempdir().expect("a folder");
    let missing = folder.path().join("missing/arm.glb");
    session.apply(FileAction::Export(Export { path: missing, ..export.clone() }));
    session.apply(FileAction::ExportEnded(Err("there is no folder".to_owned())));
    assert_eq!(
        session.files().folder_of(&session.files().export_dialog(session.document())),
        before
    );
    let there = folder.path().join("arm.glb");
    session.apply(FileAction::Export(Export { path: there, ..export }));
    session.apply(FileAction::ExportEnded(Ok("Exported".to_owned())));
    assert_eq!(
        session.files().folder_of(&session.files().export_dialog(session.document())),
        folder.path()
    );
}

#[test]
fn what_a_diagnosis_names_is_outlined() {
    let mut session = Session::default();
    session.apply(open_example("human"));
    let rig = session.rig();
    let [hand, forearm] =
        ["left_hand", "left_forearm"].map(|it| rig.skeleton.find(it).expect("a joint"));
    let index = rig.target_of_end(hand).expect("a target");
    let target = Target { home: Vec3::new(0.8, 1.5, 0.5), ..rig.targets[index] };
    session.apply(SolverEdit::SetBodyFollows(false));
    session.apply(TargetEdit::SetTarget(target));
    let found = session.why(true).first().expect("it is too far away");
    let said = words::cause(session.rig(), found);
    assert!(said.starts_with("left_hand cannot reach that far"), "{said}");
    let outlined = session.overlays().concerned;
    assert!(outlined.contains(&hand) && outlined.contains(&forearm), "{outlined:?}");
}
