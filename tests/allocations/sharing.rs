//! In a binary of its own, whose allocator counts: an edit of a large skeleton takes memory for
//! what it changes, and so does its undo step.

use allocation_counter::{AllocationInfo, measure};
use glam::Vec3;
use ik_arm::document::{Channel, Document, SkeletonRig};
use ik_arm::kinematics::skeleton::{Joint, JointId, Skeleton};
use ik_arm::kinematics::spline::Knot;
use ik_arm::session::{
    Action, DisplayEdit, JointEdit, KeysEdit, PlaybackAction, Preferences, Session,
    TransactionAction,
};

const JOINTS: usize = 1000;
/// Channels that are keyed at once.
const KEYED: usize = 60;
/// A key with its track, its entry in the map of tracks, and its copies on the way.
const BYTES_PER_KEY: u64 = 512;

fn chain() -> Skeleton {
    let joint = |index: usize| Joint {
        offset: if index == 0 { Vec3::ZERO } else { Vec3::Y * 0.1 },
        ..Joint::new(
            &format!("joint_{index}"),
            index.checked_sub(1).map(JointId::new),
            Vec3::Y * 0.1,
        )
    };
    Skeleton::from_joints((0..JOINTS).map(joint).collect()).expect("a chain")
}

/// A session that has shown a chain of 1,000 joints for a while.
fn session() -> Session {
    let document = Document { rig: SkeletonRig::new(chain()), ..Document::default() };
    let mut session = Session::with_document(Preferences::default(), document);
    session.apply(turn(JointId::new(1), 0.1));
    session
}

fn turn(joint: JointId, angle: f32) -> Action {
    JointEdit::SetRotation { joint, rotation: Vec3::splat(angle) }.into()
}

fn key() -> Action {
    KeysEdit::Key((0..KEYED).map(JointId::new).map(Channel::Rotation).collect()).into()
}

fn counted(session: &mut Session, action: Action) -> AllocationInfo {
    measure(|| {
        session.apply(action);
    })
}

/// Bytes of one copy of the skeleton: pointers to its joints, which stay shared.
fn copy() -> u64 {
    let skeleton = chain();
    let copied = measure(|| drop(skeleton.clone())).bytes_total;
    assert!(copied <= (JOINTS * size_of::<usize>()) as u64, "{copied} bytes");
    copied
}

#[test]
fn turning_one_joint_copies_one_joint() {
    let mut session = session();
    let taken = counted(&mut session, turn(JointId::new(500), 0.2));
    assert!(taken.bytes_total < copy() + 2048, "{} bytes", taken.bytes_total);
    assert!(taken.count_total < 20, "{} allocations", taken.count_total);
}

#[test]
fn an_edit_of_something_else_copies_no_skeleton() {
    let mut session = session();
    let taken = counted(&mut session, DisplayEdit::SetMetres(Some(2.0)).into()).bytes_total;
    assert!(taken < 2048, "{taken} bytes");
}

#[test]
fn keying_many_channels_takes_the_memory_of_the_keys() {
    let mut session = session();
    let taken = counted(&mut session, key()).bytes_total;
    assert!(taken < KEYED as u64 * BYTES_PER_KEY, "{taken} bytes");
    assert_eq!(session.document().keys.count(), KEYED);

    // An unkeyed edit becomes a key: what is shown copies the skeleton, the document does not.
    session.apply(PlaybackAction::SetAutoKey(false));
    session.apply(PlaybackAction::SetTime(1.0));
    session.apply(turn(JointId::new(3), 0.4));
    let taken = counted(&mut session, key()).bytes_total;
    assert!(taken < copy() + KEYED as u64 * BYTES_PER_KEY, "{taken} bytes");
    assert_eq!(session.document().keys.count(), 2 * KEYED);
}

#[test]
fn undo_steps_share_what_they_have_in_common() {
    let mut session = session();
    let keyed = measure(|| {
        for second in 0..20 {
            session.apply(PlaybackAction::SetTime(f64::from(second)));
            session.apply(key());
        }
    });
    let kept = keyed.bytes_current.unsigned_abs();
    // Every step has the knots of its tracks alone.
    let knots = KEYED as u64 * size_of::<Knot<Vec3>>() as u64 * (1..=20).sum::<u64>();
    assert!(kept < 3 * knots, "{kept} bytes, of which {knots} are knots");

    for _ in 0..20 {
        session.apply(TransactionAction::Undo);
    }
    assert!(session.document().keys.is_empty());
    assert!(!session.skeleton().joints()[1].rotation.eq(&Vec3::ZERO), "the turn is left");
}
