//! Grab anywhere: a drag of any point of a body leaves what its targets hold where it is.

use glam::Vec3;
use ik_arm::document::{BalanceTarget, Channel, Document, Ray, SkeletonRig, Target};
use ik_arm::kinematics::skeleton::{Joint, JointId, Skeleton};
use ik_arm::rig::Aim;
use ik_arm::session::{
    DragInput, Grip, KeysEdit, PlaybackAction, PointHandle, Preferences, Session, SolverEdit,
    TargetEdit, TransactionAction, ViewAction,
};

use crate::common::Random;
use crate::common::documents::open_example;

/// The Human, opened.
fn human() -> Session {
    let mut session = Session::default();
    session.apply(open_example("human"));
    session
}

fn joint(session: &Session, name: &str) -> JointId {
    session.skeleton().find(name).expect("a joint")
}

fn pose(session: &Session) -> &Skeleton {
    session.posed().skeleton()
}

/// A ray through a point, along the view.
fn ray(session: &Session, through: Vec3) -> Ray {
    let projection = session.camera().projection(1.6);
    projection.ray(projection.project(through).expect("in the picture"))
}

/// Presses the middle of a bone.
fn press(session: &mut Session, bone: JointId) -> Vec3 {
    let at = pose(session).base(bone).lerp(pose(session).tip(bone), 0.7);
    let (ray, forward) = (ray(session, at), session.camera().projection(1.6).forward);
    let grip = if session.skeleton()[bone].is_root_point() {
        Grip::Tip(bone, PointHandle::Free)
    } else {
        Grip::Bone(bone)
    };
    session.apply(TransactionAction::Grab { grip, ray, forward });
    at
}

fn move_to(session: &mut Session, to: Vec3) {
    let ray = ray(session, to);
    session.apply(TransactionAction::Drag(DragInput { ray, precise: false, snap: false }));
}

/// A way in the plane of the picture.
fn across(session: &Session, right: f32, up: f32) -> Vec3 {
    let forward = session.camera().projection(1.6).forward;
    let side = forward.cross(Vec3::Y).normalize();
    side * right + side.cross(forward) * up
}

fn content(session: &Session) -> Document {
    Document { camera: Document::default().camera, ..session.document().clone() }
}

const ENDS: [&str; 4] = ["left_forearm", "right_forearm", "left_shin", "right_shin"];

#[test]
fn a_body_part_goes_where_it_is_dragged_and_hands_and_feet_stay() {
    for (bone, right, up) in [
        ("chest", 0.1, -0.05),
        ("spine", -0.06, 0.0),
        ("pelvis", 0.08, -0.15),
        ("head", 0.12, -0.02),
        ("left_shoulder", 0.05, -0.05),
    ] {
        let mut session = human();
        let (part, before) = (joint(&session, bone), content(&session));
        let ends = ENDS.map(|name| pose(&session).tip(joint(&session, name)));
        let at = press(&mut session, part);
        let grip = pose(&session).full_transform(part).inverse().transform_point3(at);
        let way = across(&session, right, up);
        for step in 1..=10 {
            move_to(&mut session, at + way * (step as f32 / 10.0));
            for (name, end) in ENDS.iter().zip(ends) {
                let off = pose(&session).tip(joint(&session, name)).distance(end);
                assert!(off < 1e-4, "{bone}, step {step}: {name} is off by {off}");
            }
            let to = at + way * (step as f32 / 10.0);
            let off = pose(&session).point_in_world(part, grip).distance(to);
            assert!(off < 2e-3, "{bone}, step {step}: {off} from the mouse");
        }
        let dragged = pose(&session).clone();
        session.apply(TransactionAction::Commit);
        let kept = pose(&session).tip(part).distance(dragged.tip(part));
        assert!(kept < 1e-4, "{bone} stays where it was dragged: {kept}");
        session.apply(TransactionAction::Undo);
        assert!(content(&session) == before, "{bone}: one undo step");
        session.apply(TransactionAction::Redo);
        let again = pose(&session).tip(part).distance(dragged.tip(part));
        assert!(again < 1e-4, "{bone} is redone: {again}");
    }
}

#[test]
fn a_drag_that_is_cancelled_or_returns_leaves_no_trace() {
    for bone in ["chest", "pelvis", "head"] {
        let mut session = human();
        let part = joint(&session, bone);
        let (before, place) = (content(&session), pose(&session).clone());
        let at = press(&mut session, part);
        let to = at + across(&session, 0.1, 0.02);
        move_to(&mut session, to);
        session.apply(TransactionAction::Cancel);
        assert!(content(&session) == before && *pose(&session) == place, "{bone}: cancelled");
        let at = press(&mut session, part);
        move_to(&mut session, to);
        move_to(&mut session, at);
        assert!(pose(&session).tip(part).distance(place.tip(part)) < 1e-4, "{bone}: returned");
    }
}

#[test]
fn a_part_that_is_dragged_too_far_stops_where_hands_and_feet_hold_it() {
    let mut session = human();
    let pelvis = joint(&session, "pelvis");
    let at = press(&mut session, pelvis);
    move_to(&mut session, at + Vec3::Y * 0.3);
    let short = session.history().drag().and_then(|drag| drag.limit()).expect("a limit").short;
    assert!((0.2..0.3).contains(&short), "the legs are straight before: {short}");
    for name in ENDS {
        let report = session.posed().target_report(joint(&session, name)).expect("a target");
        assert!(report.error < 1e-4, "{name}: {}", report.error);
    }
}

#[test]
fn a_part_that_is_dragged_with_keys_gets_keys_with_auto_key() {
    let mut session = human();
    let chest = joint(&session, "chest");
    session.apply(KeysEdit::Key(vec![Channel::Rotation(chest)]));
    session.apply(PlaybackAction::SetAutoKey(true));
    session.apply(PlaybackAction::SetTime(1.0));
    let at = press(&mut session, chest);
    let grip = pose(&session).full_transform(chest).inverse().transform_point3(at);
    let to = at + across(&session, 0.08, -0.02);
    move_to(&mut session, to);
    session.apply(TransactionAction::Commit);
    let track = session.document().keys.track(Channel::Rotation(chest)).expect("keys");
    assert_eq!(track.knots().len(), 2, "a key at the playhead");
    let off = pose(&session).point_in_world(chest, grip).distance(to);
    assert!(off < 0.02, "{off} from the mouse");
}

/// A chain of joints with a whole-body target at its tip.
fn chain(random: &mut Random, joints: usize) -> Session {
    let mut skeleton = Skeleton::with_root("root");
    for index in 0..joints {
        let parent = JointId::new(index);
        let bone = Joint::new(&format!("bone {index}"), Some(parent), Vec3::Y * 0.2);
        let (offset, rotation) = (skeleton[parent].axis, random.vector(0.5));
        skeleton.add(Joint { offset, rotation, ..bone }).expect("a joint");
    }
    let tip = JointId::new(joints);
    let target = Target { influence: 1.0, ..Target::new(tip, skeleton.tip(tip), 0.1) };
    let mut rig = SkeletonRig::new(skeleton);
    rig.targets.push(target);
    let document = Document { rig, ..Document::default() };
    let mut session = Session::with_document(Preferences::default(), document);
    session.apply(ViewAction::SetCamera(session.framing_all()));
    session
}

#[test]
fn the_target_of_a_chain_stays_while_a_joint_of_it_is_dragged() {
    let mut random = Random(38);
    for case in 0..20 {
        let mut session = chain(&mut random, 10);
        let tip = JointId::new(10);
        let place = session.posed().targets()[0].position;
        let middle = JointId::new(3 + random.below(5));
        let angles = session.skeleton()[middle].rotation;
        let at = press(&mut session, middle);
        for step in 1..=8 {
            let to = at + across(&session, 0.02 * step as f32, 0.01 * step as f32);
            move_to(&mut session, to);
            let off = pose(&session).tip(tip).distance(place);
            assert!(off < session.rig().tolerance(), "case {case}, step {step}: {off}");
        }
        let dragged = pose(&session).tip(middle);
        session.apply(TransactionAction::Commit);
        assert!(pose(&session).tip(middle).distance(dragged) < 1e-3, "case {case}");
        assert_eq!(session.skeleton()[middle].rotation, angles, "the pose is a posture");
        assert!(session.document().rig.posture.is_some());
    }
}

#[test]
fn the_balance_of_a_body_that_is_dragged_holds() {
    for (bone, right, up) in [("chest", 0.1, -0.05), ("spine", -0.06, 0.0), ("head", 0.12, -0.02)] {
        let mut session = human();
        session.apply(SolverEdit::SetBalance(Some(BalanceTarget::default())));
        let part = joint(&session, bone);
        let ends = ENDS.map(|name| pose(&session).tip(joint(&session, name)));
        let at = press(&mut session, part);
        let before = pose(&session).tip(part);
        let way = across(&session, right, up);
        for step in 1..=20_u8 {
            move_to(&mut session, at + way * (f32::from(step) / 20.0));
            let balance = session.posed().evaluated_skeleton().balance.clone().expect("a balance");
            assert!(balance.error() < 2e-3, "{bone} step {step}: {balance:?}");
            for (name, before) in ENDS.into_iter().zip(ends) {
                let off = pose(&session).tip(joint(&session, name)).distance(before);
                assert!(off < 1e-3, "{bone} step {step}: {name} is off by {off}");
            }
        }
        assert!(pose(&session).tip(part).distance(before) > 0.02, "{bone} moves");
        session.apply(TransactionAction::Commit);
        let balance = session.posed().evaluated_skeleton().balance.clone().expect("a balance");
        assert!(balance.error() < 2e-3, "{bone}, let go: {balance:?}");
    }
}

/// Adds a target with which the head looks at a point straight ahead. Returns the target's index.
fn look_ahead(session: &mut Session, head: JointId) -> usize {
    session.apply(TargetEdit::AddTarget(head));
    let index = session.rig().target(head).expect("a target");
    let target = session.rig().targets[index];
    let ahead = pose(session).full_transform(head).transform_point3(2.0 * Vec3::Z);
    let aim = Some(Aim { axis: Vec3::Z, point: ahead });
    session.apply(TargetEdit::SetTarget(Target { weight: 0.0, aim, ..target }));
    index
}

#[test]
fn a_head_that_looks_at_a_point_goes_where_it_is_dragged_and_looks_on() {
    let mut session = human();
    let head = joint(&session, "head");
    let index = look_ahead(&mut session, head);
    let at = press(&mut session, head);
    let grip = pose(&session).full_transform(head).inverse().transform_point3(at);
    let way = across(&session, 0.12, -0.05);
    for step in 1..=10_u8 {
        let to = at + way * (f32::from(step) / 10.0);
        move_to(&mut session, to);
        let off = pose(&session).point_in_world(head, grip).distance(to);
        assert!(off < 2e-3, "step {step}: {off} from the mouse");
        let targets = &session.posed().evaluated_skeleton().targets;
        let turn = targets[index].rotation_error.expect("an aim");
        assert!(turn < 1e-3, "step {step}: the head looks {turn} aside");
    }
}

#[test]
fn a_drag_stops_where_the_limits_of_legs_would_lift_the_feet() {
    let mut session = human();
    let head = joint(&session, "head");
    let index = look_ahead(&mut session, head);
    let pelvis = joint(&session, "pelvis");
    let at = press(&mut session, pelvis);
    let way = across(&session, 0.08, -0.15);
    for step in 1..=30_u8 {
        move_to(&mut session, at + way * (f32::from(step) / 10.0));
        let targets = &session.posed().evaluated_skeleton().targets;
        let missed = targets.iter().map(|target| target.error).fold(0.0, f32::max);
        assert!(missed < 1e-3, "step {step}: a hand or foot is off by {missed}");
        let turn = targets[index].rotation_error.expect("an aim");
        assert!(turn < 1e-3, "step {step}: the head looks {turn} aside");
    }
    let moved = pose(&session).base(pelvis).distance(at);
    assert!(moved > 0.1, "the pelvis goes as far as the legs let it: {moved}");
    let short = session.history().drag().and_then(|drag| drag.limit()).expect("a limit").short;
    let left = (at + way * 3.0).distance(pose(&session).base(pelvis));
    assert!((short - left).abs() < 1e-3 && short > 0.02, "{short} is told, {left} is left");
}
