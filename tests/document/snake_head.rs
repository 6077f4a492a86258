//! A snake's head is dragged and keyed, and its body follows the path that the head has travelled.

use glam::Vec3;
use ik_arm::document::{Channel, Document, FollowPath, PathKind, Ray, SkeletonRig};
use ik_arm::io::{OpenOptions, parse, to_json};
use ik_arm::kinematics::skeleton::{Joint, JointId, Limit, Skeleton};
use ik_arm::kinematics::spline::Spline;
use ik_arm::session::{
    DragInput, Grip, PathEdit, PlaybackAction, PointHandle, Preferences, Session, TransactionAction,
};

use crate::common::Random;

const HEAD: JointId = JointId::new(0);
const JOINTS: usize = 20;

/// A snake with bones of uneven lengths and a bent body, which follows its head.
fn snake(random: &mut Random) -> Document {
    let mut skeleton = Skeleton::default();
    let mut offset = random.vector(1.0);
    for index in 0..JOINTS {
        let axis = Vec3::NEG_X * random.within(0.05..0.15);
        let parent = index.checked_sub(1).map(JointId::new);
        let joint = Joint { offset, ..Joint::new(&format!("joint {index}"), parent, axis) };
        let joint = skeleton.add(joint).expect("a joint");
        skeleton.set_rotation(joint, random.vector(0.2)).expect("finite");
        offset = axis;
    }
    let mut rig = SkeletonRig::new(skeleton);
    rig.follow_paths = vec![FollowPath { root: HEAD, kind: PathKind::Head }];
    Document::new(rig)
}

/// The same snake with keys of its head at uneven times.
fn keyed_snake(random: &mut Random) -> Document {
    let mut document = snake(random);
    let mut at = document.skeleton()[HEAD].offset;
    let mut time = f64::from(random.within(0.0..0.5));
    for _ in 0..8 {
        document.keys.insert(Channel::Offset(HEAD), time, at);
        at += Vec3::X * 0.6 + random.vector(0.5);
        time += f64::from(random.within(0.2..0.8));
    }
    document
}

fn posed(document: &Document, time: f64) -> Skeleton {
    Skeleton::clone(&document.at(time).skeleton().clone())
}

/// The bases of all joints and the last tip.
fn points(skeleton: &Skeleton) -> Vec<Vec3> {
    let pose = skeleton.pose();
    let last = skeleton.ids().next_back().expect("a joint");
    pose.ids().map(|joint| pose.base(joint)).chain([pose.tip(last)]).collect()
}

/// The path that the head has travelled until a time, the newest point first: the spline back to
/// the first key, the body as it was there, and the line straight behind it.
fn travelled(document: &Document, time: f64) -> Vec<Vec3> {
    const STEPS: u32 = 5000;
    let track: &Spline<Vec3> = document.keys.track(Channel::Offset(HEAD)).expect("keys");
    let (first, last) = (track.knots()[0], track.knots()[track.knots().len() - 1]);
    let time = time.clamp(first.time, last.time);
    let back = |step: u32| time + (first.time - time) * f64::from(step) / f64::from(STEPS);
    let on_spline = (0..=STEPS).map(|step| track.at(back(step)).expect("keys"));
    let body = points(document.skeleton());
    let moved = first.value - body[0];
    let behind = body[JOINTS] + (body[JOINTS] - body[JOINTS - 1]) * 100.0;
    on_spline.chain(body.iter().chain([&behind]).map(|point| *point + moved)).collect()
}

/// Distance of a point from the lines between consecutive points.
fn distance(path: &[Vec3], point: Vec3) -> f32 {
    let to_line = |pair: &[Vec3]| {
        let (line, at) = (pair[1] - pair[0], point - pair[0]);
        let part = (at.dot(line) / line.length_squared().max(f32::MIN_POSITIVE)).clamp(0.0, 1.0);
        at.distance(line * part)
    };
    path.windows(2).map(to_line).fold(f32::INFINITY, f32::min)
}

#[test]
fn without_keys_and_up_to_the_first_key_the_body_has_its_own_angles() {
    let mut random = Random(1500);
    for _ in 0..100 {
        let mut document = keyed_snake(&mut random);
        let first = document.keys.track(Channel::Offset(HEAD)).expect("keys").knots()[0].time;
        for time in [f64::MIN, 0.0, first] {
            assert_eq!(posed(&document, time), *document.at(time).into_document().skeleton());
        }
        document.keys.clear(Channel::Offset(HEAD));
        assert_eq!(posed(&document, 1.0), *document.skeleton());
    }
}

#[test]
fn every_joint_is_on_the_path_that_the_head_has_travelled() {
    let mut random = Random(1501);
    for case in 0..40 {
        let document = keyed_snake(&mut random);
        let lengths: Vec<f32> =
            document.skeleton().joints().iter().map(|it| it.axis.length()).collect();
        for time in [0.6, 1.3, 2.9, 9.0] {
            let (posed, path) = (points(&posed(&document, time)), travelled(&document, time));
            let head = document.keys.value(Channel::Offset(HEAD), time).expect("keys");
            assert!(posed[0].distance(head) < 1e-6, "case {case} at {time} s");
            for (index, pair) in posed.windows(2).enumerate() {
                let error = (pair[0].distance(pair[1]) - lengths[index]).abs();
                assert!(error < 1e-5, "case {case} at {time} s: bone {index} by {error}");
                let beside = distance(&path, pair[1]);
                assert!(beside < 1e-4, "case {case} at {time} s: joint {index} by {beside}");
            }
        }
    }
}

#[test]
fn the_body_moves_without_leaps_from_its_own_angles_onto_the_path() {
    let mut random = Random(1502);
    for case in 0..20 {
        let document = keyed_snake(&mut random);
        let times = (0..2000).map(|step| f64::from(step) * 1e-3);
        let frames: Vec<Vec<Vec3>> = times.map(|time| points(&posed(&document, time))).collect();
        for (step, pair) in frames.windows(2).enumerate() {
            for (joint, (before, after)) in pair[0].iter().zip(&pair[1]).enumerate() {
                let moved = before.distance(*after);
                assert!(moved < 0.03, "case {case}, joint {joint} leaps {moved} at {step} ms");
            }
        }
    }
}

#[test]
fn joints_keep_their_roll_on_a_straight_path() {
    let mut random = Random(1503);
    let mut document = snake(&mut random);
    let rolled = Vec3::new(0.7, 0.0, 0.0);
    for joint in document.skeleton().ids() {
        let rotation = if joint == HEAD { rolled } else { Vec3::ZERO };
        document.skeleton_mut().set_rotation(joint, rotation).expect("finite");
    }
    let start = document.skeleton()[HEAD].offset;
    document.keys.insert(Channel::Offset(HEAD), 0.0, start);
    document.keys.insert(Channel::Offset(HEAD), 1.0, start + Vec3::X * 5.0);
    for time in [0.1, 0.5, 1.0] {
        for (joint, own) in posed(&document, time).iter() {
            let before = document.skeleton()[joint].rotation;
            assert!(own.rotation.distance(before) < 1e-4, "joint {joint} at {time} s");
        }
    }
}

#[test]
fn a_limited_joint_turns_within_its_limits_and_the_next_one_starts_where_it_ends() {
    let mut random = Random(1504);
    let mut document = keyed_snake(&mut random);
    let limits = [Some(Limit { min: -0.05, max: 0.05 }); 3];
    for joint in [4, 9, 14].map(JointId::new) {
        document
            .skeleton_mut()
            .change(joint, |joint| joint.limits = limits.into())
            .expect("limited");
    }
    let mut stopped = 0;
    for step in 0..50 {
        let time = f64::from(step) * 0.1;
        let pose = posed(&document, time);
        for joint in [4, 9, 14].map(JointId::new) {
            assert!(pose[joint].rotation.abs().max_element() < 0.05 + 1e-6);
            stopped += usize::from(pose[joint].rotation.abs().max_element() > 0.0499);
        }
        for pair in points(&pose).windows(2).zip(pose.joints()) {
            let error = pair.0[0].distance(pair.0[1]) - pair.1.axis.length();
            assert!(error.abs() < 1e-5, "at {time} s: {error}");
        }
    }
    assert!(stopped > 20, "{stopped} times at a limit");
}

#[test]
fn a_head_that_stays_keeps_its_body() {
    let mut random = Random(1505);
    let mut document = keyed_snake(&mut random);
    let track = document.keys.track(Channel::Offset(HEAD)).expect("keys");
    let (last, value) = track.knots().last().map(|it| (it.time, it.value)).expect("a key");
    let before = points(&posed(&document, last));
    document.keys.insert(Channel::Offset(HEAD), last + 10.0, value);
    for later in [3.0, 10.0, 100.0] {
        for (before, after) in before.iter().zip(points(&posed(&document, last + later))) {
            // The spline still leaves the former last key by its tangent and comes back.
            assert!(before.distance(after) < 0.3, "{later} s later: {before} to {after}");
        }
    }
    let stays = points(&posed(&document, last + 20.0));
    assert_eq!(points(&posed(&document, last + 1000.0)), stays);
}

/// Drags the head through points of the world with a mouse that looks along −z.
fn drag(session: &mut Session, through: &[Vec3]) {
    let ray = |to: Vec3| Ray { origin: to + Vec3::Z * 10.0, direction: Vec3::NEG_Z };
    let from = session.skeleton_pose().base(HEAD);
    let grip = Grip::Head(HEAD, PointHandle::Free);
    session.apply(TransactionAction::Grab { grip, ray: ray(from), forward: Vec3::NEG_Z });
    for to in through {
        let input = DragInput { ray: ray(*to), precise: false, snap: false };
        session.apply(TransactionAction::Drag(input));
    }
    session.apply(TransactionAction::Commit);
}

#[test]
fn a_dragged_head_draws_its_body_along_the_path_of_the_mouse() {
    let mut random = Random(1506);
    for case in 0..20 {
        let mut session = Session::with_document(Preferences::default(), snake(&mut random));
        let before = points(session.skeleton());
        let round = |step: u32| {
            let angle = step as f32 * 0.05;
            before[0] + Vec3::new(angle.sin(), 1.0 - angle.cos(), 0.0)
        };
        let path: Vec<Vec3> = (1..100).map(round).collect();
        drag(&mut session, &path);
        let after = points(session.skeleton());
        assert!(after[0].distance(*path.last().expect("a point")) < 1e-5);
        let all: Vec<Vec3> = path.iter().rev().chain(&before).copied().collect();
        for (index, point) in after.iter().enumerate() {
            let beside = distance(&all, *point);
            assert!(beside < 1e-3, "case {case}: joint {index} is {beside} beside the path");
        }
        assert_eq!(session.history().undo_label(), Some("Move head"));
        session.apply(TransactionAction::Undo);
        assert_eq!(points(session.skeleton()), before);
        assert_eq!(session.history().undo_label(), None);
    }
}

#[test]
fn auto_key_keys_a_dragged_head_alone() {
    let mut random = Random(1507);
    let mut session = Session::with_document(Preferences::default(), snake(&mut random));
    session.apply(PlaybackAction::SetAutoKey(true));
    let head = session.skeleton_pose().base(HEAD);
    let mut ends = Vec::new();
    for second in 0..4 {
        session.apply(PlaybackAction::SetTime(f64::from(second)));
        let to = head + Vec3::new(0.5 + second as f32, 0.3 * second as f32, 0.0);
        drag(&mut session, &[to]);
        ends.push(points(&session.posed().evaluated_skeleton().solved));
    }
    let keyed: Vec<Channel> =
        session.document().keys.tracks().map(|(channel, _)| channel).collect();
    assert_eq!(keyed, [Channel::Offset(HEAD)]);
    let document = session.document();
    assert!(document.rig.head_tracks.is_empty(), "the keys are in the document once");
    for (second, end) in ends.iter().enumerate().skip(1).take(2) {
        let path = travelled(document, second as f64);
        let beside = end.iter().map(|point| distance(&path, *point)).fold(0.0, f32::max);
        // The next key changes the tangent of the spline at this one, but no point of it there.
        assert!(end[0].distance(path[0]) < 1e-5 && beside < 0.2, "{beside}");
    }
}

#[test]
fn a_keyed_head_that_is_moved_without_a_key_draws_its_body_until_the_time_changes() {
    let mut random = Random(1508);
    let mut session = Session::with_document(Preferences::default(), keyed_snake(&mut random));
    session.apply(PlaybackAction::SetTime(1.0));
    let before = points(&session.posed().evaluated_skeleton().solved);
    session.apply(PlaybackAction::SetAutoKey(false));
    let to = before[0] + Vec3::new(0.3, 0.4, 0.0);
    session.apply(PathEdit::SetHead { root: HEAD, to });
    let after = points(&session.posed().evaluated_skeleton().solved);
    assert!(after[0].distance(to) < 1e-5);
    let between: Vec<Vec3> =
        (0..=1000).map(|step| before[0].lerp(after[0], step as f32 / 1000.0)).collect();
    assert!(distance(&between, after[1]) < 1e-3, "the first bone is on the path to the mouse");
    session.apply(PlaybackAction::SetTime(0.5));
    session.apply(PlaybackAction::SetTime(1.0));
    assert_eq!(points(&session.posed().evaluated_skeleton().solved), before);
}

#[test]
fn the_head_can_be_moved_by_numbers_and_refuses_what_is_not_finite() {
    let mut random = Random(1509);
    let mut session = Session::with_document(Preferences::default(), snake(&mut random));
    session.apply(PathEdit::SetHead { root: HEAD, to: Vec3::new(1.0, 2.0, 3.0) });
    assert!(session.skeleton_pose().base(HEAD).distance(Vec3::new(1.0, 2.0, 3.0)) < 1e-5);
    let before = session.document().clone();
    session.apply(PathEdit::SetHead { root: HEAD, to: Vec3::new(f32::NAN, 0.0, 0.0) });
    assert_eq!(*session.document(), before);
    let message = session.shell().message().unwrap_or_default();
    assert!(message.starts_with("The position of the head must be finite, got"), "{message}");
}

#[test]
fn following_the_head_is_saved_without_its_keys_a_second_time() {
    let mut random = Random(1510);
    let document = keyed_snake(&mut random);
    let text = to_json(&document).expect("JSON");
    assert!(
        text.contains("\"follow_path\": [{\n    \"root\": 0,\n    \"path\": \"head\"\n  }]"),
        "{text}"
    );
    let read = parse("a.json", &text, &OpenOptions::default()).expect("a document").document;
    assert_eq!(read, document);
    let cut = text.replace("\"path\": \"head\"", "\"path\": \"ring\", \"radius\": 1");
    let error = parse("a.json", &cut, &OpenOptions::default())
        .expect_err("a ring needs numbers")
        .to_string();
    assert!(error.contains("follow_path[0]: must have `amplitude` for a ring"), "{error}");
}

#[test]
fn a_click_on_the_head_changes_nothing() {
    let mut random = Random(1511);
    let mut session = Session::with_document(Preferences::default(), snake(&mut random));
    let before = session.document().clone();
    let head = session.skeleton_pose().base(HEAD);
    drag(&mut session, &[head]);
    assert_eq!(*session.document(), before);
    assert_eq!(session.history().undo_label(), None);
}

#[test]
fn hundreds_of_keys_within_one_bone_still_lay_the_body_along_the_path() {
    let mut random = Random(1512);
    let mut document = snake(&mut random);
    let start = document.skeleton()[HEAD].offset;
    for key in 0..2_000_u32 {
        let at = start + Vec3::new(key as f32 * 1e-3, 0.3 * (key as f32 * 2e-3).sin(), 0.0);
        document.keys.insert(Channel::Offset(HEAD), f64::from(key) / 60.0, at);
    }
    let time = 1_999.0 / 60.0;
    let (posed, path) = (points(&posed(&document, time)), travelled(&document, time));
    for (joint, point) in posed.iter().enumerate() {
        assert!(distance(&path, *point) < 1e-3, "joint {joint}");
    }
    for (joint, pair) in posed.windows(2).zip(document.skeleton().joints()) {
        assert!((joint[0].distance(joint[1]) - pair.axis.length()).abs() < 1e-5);
    }
}

#[test]
fn auto_key_lets_the_body_follow_before_its_head_has_keys() {
    let mut random = Random(1513);
    let mut session = Session::with_document(Preferences::default(), snake(&mut random));
    session.apply(PlaybackAction::SetAutoKey(true));
    let before = points(session.skeleton());
    let to = before[0] + Vec3::new(0.5, 0.4, 0.0);
    drag(&mut session, &[to]);
    let after = points(&session.posed().evaluated_skeleton().solved);
    let line: Vec<Vec3> = [to].into_iter().chain(before).collect();
    for point in &after {
        assert!(distance(&line, *point) < 1e-4, "{point} is on the path");
    }
    assert_eq!(session.document().keys.count(), 1);
}

#[test]
fn joints_can_be_posed_by_their_own_angles_up_to_the_first_key_of_the_head() {
    let mut random = Random(1514);
    let document = keyed_snake(&mut random);
    let first = document.keys.track(Channel::Offset(HEAD)).expect("keys").knots()[0].time;
    for (time, is_on_path) in [(first - 0.1, false), (first, false), (first + 0.1, true)] {
        assert_eq!(document.at(time).into_document().rig.is_on_path(time), is_on_path);
    }
}
