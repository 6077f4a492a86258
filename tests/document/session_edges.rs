//! Invalid actions leave a session unchanged.

use crate::common::arm::{ArmEdit, ArmSession, LOWER, Step, UPPER, channels};
use glam::{Vec2, Vec3};
use ik_arm::document::{Camera, Channel, Document, Ray, Theme, TwistReferenceKind};
use ik_arm::io::to_json;
use ik_arm::kinematics::chain_ik::{ChainSolver, Method, SolveError};
use ik_arm::kinematics::diagnosis::Remedy;
use ik_arm::kinematics::skeleton::{Joint, JointId, RotationAxis, Skeleton};
use ik_arm::rig::{SkeletonRig, Target, TargetOutcome};
use ik_arm::scene::Scene;
use ik_arm::session::{
    Action, CameraMotion, Constraint, Drag, DragInput, FileAction, Grip, GripRing, JointEdit,
    KeysEdit, PlaybackAction, PointDrag, PointHandle, PoseMode, Preferences, SelectAction, Session,
    ShellAction, SolverAction, TargetEdit, TransactionAction, TurnDrag, ViewAction,
};

use crate::common::documents::open_example;

fn ray() -> Ray {
    Camera::default().projection(1.0).ray(Vec2::new(0.1, 0.2))
}

/// A session with a skeleton of one root.
fn session() -> Session {
    Session::with_document(Preferences::default(), Document::default())
}

#[test]
fn an_invalid_camera_is_ignored() {
    let camera = Camera::default();
    for invalid in [
        Camera { target: Vec3::NAN, ..camera },
        Camera { yaw: f32::INFINITY, ..camera },
        Camera { pitch: 1.6, ..camera },
        Camera { distance: 0.0, ..camera },
        Camera { distance: f32::NAN, ..camera },
    ] {
        let mut session = session();
        session.apply(ViewAction::SetCamera(invalid));
        session.apply(ViewAction::GlideTo(invalid));
        for seconds in [0.0, 0.1, 1.0] {
            session.apply(PlaybackAction::Advance(seconds));
        }
        assert_eq!(session.camera(), &camera, "after {invalid:?}");
    }
}

#[test]
fn an_invalid_camera_drag_is_ignored() {
    for (motion, to, aspect) in [
        (CameraMotion::Pan, Vec2::NAN, 1.0),
        (CameraMotion::Pan, Vec2::splat(f32::MAX), 2.0),
        (CameraMotion::Zoom, Vec2::NAN, 1.0),
        (CameraMotion::Orbit, Vec2::X, f32::INFINITY),
    ] {
        let mut session = session();
        session.apply(ViewAction::Grab(motion, Vec2::ZERO));
        session.apply(ViewAction::Drag { to, aspect });
        assert_eq!(session.camera(), &Camera::default(), "after {motion:?} to {to}");
    }
}

#[test]
fn a_frame_at_a_non_finite_time_changes_nothing() {
    let mut session = session();
    let to = Camera { yaw: 3.0, ..Camera::default() };
    session.apply(ViewAction::GlideTo(to));
    session.apply(PlaybackAction::Play(true));
    for seconds in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        session.apply(PlaybackAction::Advance(seconds));
        assert_eq!((session.camera(), session.playback().time()), (&Camera::default(), 0.0));
    }
    for seconds in [2.0, 4.0] {
        session.apply(PlaybackAction::Advance(seconds));
    }
    assert_eq!((session.camera(), session.playback().time()), (&to, 2.0));
}

#[test]
fn actions_on_a_fourth_axis_are_refused() {
    for axis in [3, usize::MAX] {
        let mut session = session();
        let before = session.document().clone();
        let (line, plane) = (PointHandle::Axis(axis), PointHandle::Plane(axis));
        for grip in [
            Grip::Target(LOWER, line),
            Grip::LimbPole(LOWER, plane),
            Grip::Target(JointId::new(0), line),
            Grip::Tip(JointId::new(0), plane),
        ] {
            session.apply(TransactionAction::Grab { grip, ray: ray(), forward: Vec3::NEG_Z });
            assert!(!session.history().is_editing(), "{grip:?} holds nothing");
        }
        let grip = Grip::Target(LOWER, PointHandle::Free);
        session.apply(TransactionAction::Grab { grip, ray: ray(), forward: Vec3::NEG_Z });
        for constraint in [Constraint::Axis(axis), Constraint::Plane(axis)] {
            session.apply(TransactionAction::Constrain(Some(constraint)));
            session.apply(TransactionAction::TypeOffset("1".to_owned()));
            assert_eq!(session.history().point_drag().and_then(PointDrag::constraint), None);
        }
        session.apply(TransactionAction::Cancel);
        assert_eq!(session.document(), &before);
    }
}

#[test]
fn a_missing_joint_cannot_be_hovered() {
    let mut session = session();
    for (joint, is_there) in [(3, true), (4, false), (usize::MAX, false)] {
        let joint = JointId::new(joint);
        session.apply(SelectAction::Hover(Some(joint)));
        assert_eq!(session.selection().hovered(), is_there.then_some(joint));
    }
}

#[test]
fn moving_keys_of_deleted_joints_does_not_bring_them_back() {
    let mut session = session();
    let new = JointId::new(session.skeleton().joints().len());
    session.apply(JointEdit::AddChild { parent: JointId::new(0), tip: None });
    session.apply(KeysEdit::Key(vec![Channel::Rotation(new), channels::HAND]));
    session.apply(TransactionAction::Begin);
    session.apply(JointEdit::DeleteJoints(vec![new]));
    let keys = vec![(channels::HAND, 0.0), (Channel::Rotation(new), 0.0)];
    session.apply(KeysEdit::MoveKeys { keys, by: 1.0, raise: Vec3::ZERO });
    let tracks = session.document().keys.tracks();
    let left: Vec<_> = tracks.map(|(channel, track)| (channel, track.knots()[0].time)).collect();
    assert_eq!(left, [(channels::HAND, 1.0)]);
}

#[test]
fn keys_made_while_others_move_stay() {
    let mut session = session();
    session.apply(KeysEdit::Key(vec![channels::HAND]));
    session.apply(TransactionAction::Begin);
    let keys = vec![(channels::HAND, 0.0)];
    session.apply(KeysEdit::MoveKeys { keys: keys.clone(), by: 1.0, raise: Vec3::ZERO });
    session.apply(KeysEdit::MoveKeys { keys: keys.clone(), by: 2.0, raise: Vec3::ZERO });
    assert_eq!(session.selection().keys(), [(channels::HAND, 2.0)]);
    session.apply(KeysEdit::Key(vec![channels::ROOT_OFFSET]));
    session.apply(KeysEdit::MoveKeys {
        keys: vec![(channels::HAND, 2.0)],
        by: 1.0,
        raise: Vec3::ZERO,
    });
    let tracks = session.document().keys.tracks();
    let left: Vec<_> = tracks.map(|(channel, track)| (channel, track.knots()[0].time)).collect();
    assert_eq!(left, [(channels::ROOT_OFFSET, 0.0), (channels::HAND, 3.0)]);
}

#[test]
fn a_dragged_tip_is_released_when_the_joints_change() {
    let hang = JointEdit::AddChild { parent: JointId::new(0), tip: Some(Vec3::Y) };
    for change in [
        JointEdit::DeleteJoints(vec![JointId::new(2)]),
        JointEdit::AddRoot,
        JointEdit::ReparentJoint { joint: JointId::new(2), parent: None },
    ] {
        let mut session = session();
        session.apply(hang.clone());
        session.apply(JointEdit::AddChild { parent: JointId::new(1), tip: None });
        let grip = Grip::Tip(JointId::new(1), PointHandle::Free);
        session.apply(TransactionAction::Grab { grip, ray: ray(), forward: Vec3::NEG_Z });
        assert!(session.history().drag().is_some());
        session.apply(change);
        let joints = session.skeleton().joints().len();
        session.apply(TransactionAction::TypeOffset("0.1".to_owned()));
        assert!(session.history().drag().is_none() && session.history().is_editing());
        assert_eq!(session.skeleton().joints().len(), joints);
    }
}

#[test]
fn a_comparison_is_made_anew_when_the_joints_change() {
    for change in [
        Action::from(JointEdit::DeleteJoints(vec![JointId::new(3)])),
        JointEdit::AddRoot.into(),
        TransactionAction::Undo.into(),
    ] {
        let mut session = session();
        session.apply(open_example("ten-joints"));
        session.apply(JointEdit::AddChild { parent: JointId::new(0), tip: None });
        session.apply(SolverAction::Compare);
        session.apply(PlaybackAction::Advance(1.0));
        assert_eq!(session.overlays().ghosts.len(), Method::ALL.len());
        session.apply(change);
        for ghost in session.overlays().ghosts {
            assert_eq!(ghost.pose.len(), session.skeleton_pose().len());
        }
        let _ = Scene::new(session.posed(), &session.overlays(), Theme::Dark);
    }
}

#[test]
fn a_ring_dragged_by_an_invalid_ray_does_not_turn() {
    let mut session = session();
    session.edit_arm(ArmEdit::SwitchPoseMode(PoseMode::Angles));
    let before = session.document().clone();
    for grip in RotationAxis::ALL
        .into_iter()
        .map(|axis| Grip::Ring(UPPER, axis))
        .chain([Grip::Ring(LOWER, RotationAxis::Z)])
    {
        for invalid in [f32::INFINITY, f32::NAN, f32::MAX] {
            session.apply(TransactionAction::Grab { grip, ray: ray(), forward: Vec3::NEG_Z });
            let (origin, direction) = (Vec3::splat(invalid), Vec3::new(-0.4, 0.4, invalid));
            for ray in
                [Ray { origin, ..ray() }, Ray { direction, ..ray() }, Ray { origin, direction }]
            {
                session.apply(TransactionAction::Drag(DragInput {
                    ray,
                    precise: false,
                    snap: false,
                }));
                assert!(
                    session
                        .history()
                        .drag()
                        .and_then(Drag::turn)
                        .is_some_and(|it| it.turned().is_finite())
                );
                assert!(session.shell().message().is_none(), "{:?}", session.shell().message());
            }
            session.apply(TransactionAction::Cancel);
            assert_eq!(session.document(), &before);
            session.apply(ShellAction::CloseDialog);
        }
    }
}

#[test]
fn rigs_at_the_largest_coordinates_can_be_framed_and_drawn() {
    let far = f32::MAX;
    for actions in [
        vec![
            Step::from(FileAction::NewFigure),
            JointEdit::SetTranslation(Vec3::new(-far, 0.3, 0.2)).into(),
        ],
        vec![
            Step::from(FileAction::NewEmpty),
            JointEdit::AddChild { parent: JointId::new(0), tip: Some(Vec3::splat(far)) }.into(),
        ],
        vec![ArmEdit::SetRoot(Vec3::splat(far)).into(), ArmEdit::SetHand(Vec3::splat(far)).into()],
        vec![
            ArmEdit::SetUpper(far).into(),
            ArmEdit::SetLower(far).into(),
            ArmEdit::SetHand(Vec3::splat(-far)).into(),
        ],
    ] {
        let mut session = session();
        for action in actions {
            action.apply(&mut session);
        }
        for camera in [session.framing_all(), session.framing_selection()] {
            assert!(camera.is_valid(), "{camera:?}");
        }
        let scene = Scene::new(session.posed(), &session.overlays(), Theme::Dark);
        assert!(scene.planes.centre.is_finite() && scene.planes.radius.is_finite());
        assert!(scene.balls.iter().all(|ball| ball.centre.is_finite() && ball.radius.is_finite()));
        assert!(scene.solids.iter().all(|solid| solid.transform.is_finite()));
    }
}

#[test]
fn a_joint_that_would_overflow_is_not_reparented() {
    let mut session = session();
    let far = Vec3::new(-1e19, 0.7, -f32::MAX);
    for (parent, tip) in [(0, Some(far)), (1, Some(far)), (2, None), (3, None)] {
        session.apply(JointEdit::AddChild { parent: JointId::new(parent), tip });
    }
    session.apply(JointEdit::AddRoot);
    session.apply(JointEdit::SetRotation {
        joint: JointId::new(1),
        rotation: Vec3::new(1.0, -3.0, 2.0),
    });
    for (joint, parent) in [(4, None), (4, Some(5)), (3, Some(5)), (2, Some(0)), (5, Some(4))] {
        let parent = parent.map(JointId::new);
        session.apply(JointEdit::ReparentJoint { joint: JointId::new(joint), parent });
        for joint in session.skeleton().joints() {
            assert!(joint.offset.is_finite() && joint.rotation.is_finite(), "{joint:?}");
        }
    }
}

#[test]
fn undo_and_redo_keep_the_sign_of_a_zero() {
    let mut session = session();
    let text = |session: &Session| to_json(session.document()).expect("saved");
    let mut texts = vec![text(&session)];
    for (hand, x) in [(100.0, -0.0), (110.0, 0.0), (120.0, -0.0)] {
        session.apply(TransactionAction::Begin);
        for x in [1.0, x] {
            session.apply(JointEdit::SetRotation {
                joint: JointId::new(0),
                rotation: Vec3::new(x, 0.0, 0.0),
            });
        }
        session.edit_arm(ArmEdit::SetHand(Vec3::X * hand));
        session.apply(TransactionAction::Commit);
        texts.push(text(&session));
    }
    for (back, steps) in
        [(TransactionAction::Undo, [2, 1, 0]), (TransactionAction::Redo, [1, 2, 3])]
    {
        for step in steps {
            session.apply(back.clone());
            assert_eq!(text(&session), texts[step]);
        }
    }
}

#[test]
fn drags_and_snaps_that_overflow_are_clamped() {
    for (pole, typed, snap) in [(-f32::MAX, "", true), (f32::MAX, "3e38", false)] {
        let mut session = session();
        session.edit_arm(ArmEdit::SetTwistReference(TwistReferenceKind::Pole));
        session.edit_arm(ArmEdit::SetPole(Vec3::new(0.0, 0.0, pole)));
        let grip = Grip::LimbPole(LOWER, PointHandle::Axis(2));
        session.apply(TransactionAction::Grab { grip, ray: ray(), forward: Vec3::NEG_Z });
        session.apply(TransactionAction::TypeOffset(typed.to_owned()));
        let ray = Ray { origin: Vec3::new(5.0, 5.0, 9.0), direction: Vec3::new(-0.5, -0.4, -0.8) };
        session.apply(TransactionAction::Drag(DragInput { ray, precise: false, snap }));
        assert!(session.history().point_drag().is_some_and(|drag| drag.moved().is_finite()));
        assert!(session.arm().pole.is_finite(), "{:?}", session.shell().message());
        assert!(session.shell().message().is_none(), "{:?}", session.shell().message());
    }
}

#[test]
fn the_same_revision_is_saved_as_the_same_text() {
    let mut session = session();
    let (revision, text) =
        (session.history().revision(), to_json(session.document()).expect("saved"));
    session.apply(TransactionAction::Begin);
    for x in [1.0, -0.0] {
        session.edit_arm(ArmEdit::SetRoot(Vec3::new(x, 0.0, 0.0)));
    }
    session.apply(TransactionAction::Commit);
    assert_eq!(session.history().revision(), revision);
    assert_eq!(to_json(session.document()).expect("saved"), text);
}

#[test]
fn a_ring_snap_that_overflows_is_clamped() {
    for angle in [f32::MAX, f32::MIN] {
        let mut session = session();
        session.apply(JointEdit::SetRotation { joint: JointId::new(0), rotation: Vec3::X * angle });
        let axis = GripRing::of_joint(session.posed(), JointId::new(0), RotationAxis::X)
            .expect("a ring")
            .axis;
        let seen = |aside: Vec3| Ray { origin: axis * 5.0 + aside, direction: -axis };
        let (one, other) = axis.any_orthonormal_pair();
        let grip = Grip::Ring(JointId::new(0), RotationAxis::X);
        session.apply(TransactionAction::Grab { grip, ray: seen(one), forward: -axis });
        for precise in [false, true] {
            session.apply(TransactionAction::Drag(DragInput {
                ray: seen(other),
                precise,
                snap: true,
            }));
            let turned = session.history().drag().and_then(Drag::turn).map(TurnDrag::turned);
            assert!(turned.is_some_and(f32::is_finite), "{turned:?}");
            assert!(session.shell().message().is_none(), "{:?}", session.shell().message());
        }
        assert!(session.skeleton().joints()[0].rotation.is_finite());
    }
}

#[test]
fn a_remedy_that_allows_no_iterations_is_refused() {
    let mut session = Session::default();
    let before = session.document().clone();
    let (target, remedy) = (JointId::new(0), Remedy::AllowIterations(0));
    session.apply(TargetEdit::ApplyRemedy { target, remedy });
    assert_eq!(session.shell().message(), Some("The solver's iterations must be above 0, got 0"));
    assert_eq!(session.document(), &before);
}

#[test]
fn a_target_at_a_tip_that_overflows_is_refused() {
    let mut session = session();
    session.apply(JointEdit::AddChild { parent: JointId::new(0), tip: Some(Vec3::Y) });
    session.apply(JointEdit::SetAxis { joint: JointId::new(1), axis: Vec3::splat(f32::MAX) });
    session.apply(JointEdit::SetTranslation(Vec3::splat(f32::MAX)));
    let before = session.document().clone();
    session.apply(TargetEdit::AddTarget(JointId::new(1)));
    let message = session.shell().message().unwrap_or_default();
    assert!(message.starts_with("The position of a target must be finite, got"), "{message}");
    assert_eq!(session.document(), &before);
}

/// A star with a target at the end of each ray, which asks for as many iterations as there are
/// numbers.
fn star(rays: u16, method: Method) -> Document {
    let mut skeleton = Skeleton::with_root("centre");
    let mut targets = Vec::new();
    for ray in 0..rays {
        let angle = f32::from(ray) * 0.1;
        let (sin, cos) = angle.sin_cos();
        let ray =
            Joint::new(&format!("ray_{ray}"), Some(JointId::new(0)), Vec3::new(cos, sin, 0.0));
        let joint = skeleton.add(ray).expect("a ray");
        let target = Target::new(joint, Vec3::new(sin, 0.5, cos), 1.0);
        targets.push(Target { influence: 1.0, ..target });
    }
    let mut rig = SkeletonRig::new(skeleton);
    (rig.targets, rig.solver.method) = (targets, method);
    rig.solver.iterations = Some(1_000_000_000);
    Document::new(rig)
}

#[test]
fn the_work_of_each_pose_of_a_huge_star_is_bounded_while_it_is_dragged_played_and_raced() {
    const RAYS: u16 = 9_999;
    let is_bounded =
        |iterations: u32| u64::from(iterations) * u64::from(RAYS) <= ChainSolver::POSE_WORK;
    for method in [Method::Fabrik, Method::DampedLeastSquares] {
        let mut session = Session::with_document(Preferences::default(), star(RAYS, method));
        let tip = JointId::new(7);
        let (forward, at) = (Vec3::NEG_Z, session.skeleton_pose().tip(tip));
        let ray = Ray { origin: at + 5.0 * Vec3::Z, direction: forward };
        for action in [
            Action::from(TransactionAction::Grab {
                grip: Grip::Target(tip, PointHandle::Free),
                ray,
                forward,
            }),
            TransactionAction::Drag(DragInput {
                ray: Ray { origin: ray.origin + Vec3::X, ..ray },
                precise: false,
                snap: false,
            })
            .into(),
            TransactionAction::Commit.into(),
            PlaybackAction::Play(true).into(),
            PlaybackAction::Advance(0.1).into(),
            PlaybackAction::Play(false).into(),
            SolverAction::Compare.into(),
        ] {
            session.apply(action.clone());
            let reports = &session.posed().evaluated_skeleton().targets;
            for outcome in reports.iter().map(|report| &report.outcome) {
                match outcome {
                    TargetOutcome::WholeBody(report) => assert!(is_bounded(report.iterations)),
                    refused => assert!(
                        matches!(refused, TargetOutcome::Refused(SolveError::TooMuchWork { .. })),
                        "{refused:?} after {action:?}"
                    ),
                }
            }
        }
        session.apply(PlaybackAction::Advance(1.0 / 60.0));
        assert!(session.solvers().runs().all(|run| is_bounded(run.report().iterations)));
    }
}
