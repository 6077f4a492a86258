//! Chains whose heads follow moving targets and the mouse.

use glam::{DVec3, Vec3};
use ik_arm::document::{Channel, Document, PathKind, Ray};
use ik_arm::io::{OpenOptions, parse, to_json};
use ik_arm::kinematics::skeleton::JointId;
use ik_arm::rig::{Target, TargetOutcome};
use ik_arm::session::{JointEdit, PathEdit, PlaybackAction, Session, TransactionAction};

use crate::common::Random;
use crate::common::documents::open_example;

fn tadpoles() -> Session {
    let mut session = Session::default();
    session.apply(open_example("tadpoles"));
    session
}

fn heads(document: &Document) -> Vec<JointId> {
    document.rig.follow_paths.iter().map(|path| path.root).collect()
}

/// Where a target is at a time in seconds, in the world and in f64, from the document's numbers
/// alone. The pond, on which the targets are, lies 0.07 above the floor and is turned so that its z
/// points up.
fn target_at(document: &Document, head: JointId, time: f64) -> [f64; 3] {
    let rig = &document.rig;
    let Target { home, motion, .. } = rig.targets[rig.target(head).expect("a target")];
    let home = document.keys.value(Channel::Target(head), time).unwrap_or(home);
    let angle = std::f64::consts::TAU * time / f64::from(motion.period);
    let radius = f64::from(motion.radius);
    let [x, y] = match motion.path {
        ik_arm::document::TargetPath::Circle => [angle.sin(), angle.cos() - 1.0],
        ik_arm::document::TargetPath::FigureEight => [angle.sin(), angle.sin() * angle.cos()],
        ik_arm::document::TargetPath::Still => [0.0, 0.0],
    };
    let (x, y) = (f64::from(home.x) + radius * x, f64::from(home.y) + radius * y);
    [x, 0.07 + f64::from(home.z), -y]
}

/// Points of the path that a head's target has taken in the four seconds before a time.
fn path(document: &Document, head: JointId, time: f64) -> Vec<DVec3> {
    let at = |step: u32| target_at(document, head, time - f64::from(step) / 2000.0);
    (0..=8000).map(|step| DVec3::from(at(step))).collect()
}

/// Distance of a point from a line of straight segments.
fn distance(line: &[DVec3], point: DVec3) -> f64 {
    let to_segment = |pair: &[DVec3]| {
        let along = pair[1] - pair[0];
        let share = ((point - pair[0]).dot(along) / along.length_squared()).clamp(0.0, 1.0);
        let share = if share.is_finite() { share } else { 0.0 };
        point.distance(pair[0] + along * share)
    };
    line.windows(2).map(to_segment).fold(f64::INFINITY, f64::min)
}

/// Joints of a head's chain with their distances from the path, relative to the chain's length.
fn beside_path(document: &Document, head: JointId, time: f64) -> Vec<f64> {
    let rig = document.at(time).into_document().rig;
    let skeleton = rig.skeleton_at(time);
    let length: f32 = rig.path_joints(head).map(|joint| rig.skeleton[joint].axis.length()).sum();
    let path = path(document, head, time);
    let beside = |joint| distance(&path, skeleton.base(joint).as_dvec3());
    rig.path_joints(head).map(|joint| beside(joint) / f64::from(length)).collect()
}

#[test]
fn tadpoles_play_when_opened_and_every_tail_is_on_the_path_of_its_head() {
    let session = tadpoles();
    assert!(session.playback().is_playing() && session.can_follow_mouse());
    let document = session.document();
    let text = to_json(document).expect("JSON");
    let again = parse("a.json", &text, &OpenOptions::default()).expect("opens").document;
    let heads = heads(document);
    assert_eq!(heads.len(), 5);
    for time in [0.0, 0.37, 2.0, 7.9] {
        for head in &heads {
            let worst = beside_path(document, *head, time).into_iter().fold(0.0, f64::max);
            assert!(worst < 1e-3, "{worst} at {time} s");
        }
        let rig = document.at(time).into_document().rig;
        let evaluated = rig.evaluate(time);
        assert_eq!(evaluated, again.at(time).evaluated_skeleton().clone());
        for (report, target) in evaluated.targets.iter().zip(&rig.targets) {
            assert_eq!(report.outcome, TargetOutcome::Leads);
            assert!(report.error < 1e-6, "the head is at its target");
            let expected = target_at(document, target.joint, time);
            let at = report.position.as_dvec3().to_array();
            assert!((0..3).all(|axis| (at[axis] - expected[axis]).abs() < 1e-5), "{at:?}");
        }
    }
}

#[test]
fn a_target_that_leads_a_path_is_not_solved_for_and_cannot_be_run() {
    let mut session = tadpoles();
    assert!(!session.rig().targets.is_empty());
    assert!(session.rig().targets_at(0.0).is_empty());
    let head = heads(session.document())[0];
    session.apply(PathEdit::SetFollowPath { root: head, kind: None });
    assert_eq!(session.rig().targets_at(0.0).len(), 1, "without a path it is solved for");
}

/// Plays `frames` of a sixtieth of a second while the mouse is where `at` says.
fn lead(session: &mut Session, clock: &mut f64, frames: u32, at: impl Fn(f64) -> Vec3) {
    for frame in 0..frames {
        let at = at(f64::from(frame) / 60.0);
        let ray = Ray { origin: at + Vec3::Y * 3.0, direction: Vec3::NEG_Y };
        session.apply(TransactionAction::Lead(ray));
        *clock += 1.0 / 60.0;
        session.apply(PlaybackAction::Advance(*clock));
    }
}

#[test]
fn heads_follow_the_mouse_and_tails_the_recorded_path_also_after_save_and_open() {
    let mut session = tadpoles();
    let before = session.document().clone();
    let mut clock = 100.0;
    session.apply(PlaybackAction::Advance(clock));
    session.apply(TransactionAction::FollowMouse(true));
    assert!(session.history().follows_mouse() && session.history().is_editing());
    let s_shape = |seconds: f64| {
        let (x, z) = (0.8 * seconds - 0.8, 0.5 * (3.0 * seconds).sin());
        Vec3::new(x as f32, 0.0, z as f32)
    };
    lead(&mut session, &mut clock, 120, s_shape);
    let end = session.playback().time();
    lead(&mut session, &mut clock, 60, |_| s_shape(2.0));
    session.apply(TransactionAction::FollowMouse(false));
    assert!(!session.history().follows_mouse() && !session.history().is_editing());
    assert_eq!(session.history().undo_label(), Some("Follow the mouse"));

    let recorded = session.document().clone();
    let heads = heads(&recorded);
    let middle = |time: f64| {
        let rig = recorded.at(time).into_document().rig;
        let homes = heads.iter().map(|head| rig.targets[rig.target(*head).expect("one")].home);
        homes.sum::<Vec3>() / heads.len() as f32
    };
    let last = s_shape(2.0);
    assert!((middle(end + 0.99) - Vec3::new(last.x, -last.z, 0.0)).length() < 0.05);
    let text = to_json(&recorded).expect("JSON");
    let again = parse("a.json", &text, &OpenOptions::default()).expect("opens").document;
    for time in [0.5, 1.0, 1.7, end, end + 0.5] {
        for head in &heads {
            let worst = beside_path(&recorded, *head, time).into_iter().fold(0.0, f64::max);
            assert!(worst < 1e-3, "{worst} at {time} s");
        }
        let posed = |document: &Document| document.at(time).skeleton().clone();
        assert_eq!(posed(&again), posed(&recorded));
    }
    session.apply(TransactionAction::Undo);
    assert_eq!(session.document().keys, before.keys);
    assert_eq!(session.document().rig, before.rig);
}

#[test]
fn a_recording_past_the_end_makes_the_timeline_longer_and_esc_restores_it() {
    let mut session = tadpoles();
    let before = session.document().clone();
    session.apply(PlaybackAction::SetTime(before.timeline.end - 0.5));
    let mut clock = 5.0;
    session.apply(PlaybackAction::Advance(clock));
    session.apply(TransactionAction::FollowMouse(true));
    lead(&mut session, &mut clock, 90, |seconds| Vec3::X * seconds as f32);
    let end = session.document().timeline.end;
    assert!(session.playback().time() > before.timeline.end && end >= session.playback().time());
    let times = session.document().keys.times();
    let least = times.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min);
    assert!(least > 0.015 && times.len() < 60, "{} keys, {least} s apart", times.len());
    session.apply(TransactionAction::Cancel);
    assert!(!session.history().follows_mouse());
    assert_eq!(session.document(), &Document { camera: session.document().camera, ..before });
}

#[test]
fn each_root_has_a_path_of_its_own() {
    let mut random = Random(1601);
    let mut session = tadpoles();
    for _ in 0..50 {
        let heads = heads(session.document());
        let roots: Vec<JointId> = session
            .skeleton()
            .ids()
            .filter(|it| session.skeleton()[*it].parent.is_none())
            .collect();
        let root = random.one_of(&roots);
        let kind = random.one_of(&[None, Some(PathKind::Head), Some(PathKind::Target)]);
        session.apply(PathEdit::SetFollowPath { root, kind });
        let rig = session.rig();
        assert_eq!(rig.path_kind(root), kind);
        let others = heads.iter().filter(|head| **head != root);
        assert!(others.into_iter().all(|head| rig.path_kind(*head).is_some()));
    }
    let child = session.skeleton().ids().find(|it| session.skeleton()[*it].parent.is_some());
    let root = child.expect("a tail");
    let before = session.document().clone();
    session.apply(PathEdit::SetFollowPath { root, kind: Some(PathKind::Head) });
    assert_eq!(session.document(), &before);
    assert!(
        session
            .shell()
            .message()
            .is_some_and(|text| text.starts_with("The joint of a path must be a root"))
    );
}

#[test]
fn paths_follow_their_roots_when_joints_are_deleted() {
    let mut session = tadpoles();
    let heads = heads(session.document());
    let name = |session: &Session, joint: JointId| session.skeleton()[joint].name.clone();
    let kept = name(&session, heads[2]);
    let rig = session.rig();
    let first: Vec<JointId> = rig.path_joints(heads[0]).collect();
    session.apply(JointEdit::DeleteJoints(first));
    let paths = &session.rig().follow_paths;
    assert_eq!(paths.len(), 4);
    assert!(paths.iter().any(|path| name(&session, path.root) == kept));
    assert!(session.document().keys.track(Channel::Target(heads[0])).is_none());
}
