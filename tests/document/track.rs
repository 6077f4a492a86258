//! Motions of skeletons: each step continues from the one before, and all is a function of the
//! document.

use glam::Vec3;
use ik_arm::document::{
    Channel, Document, Posed, SkeletonRig, Target, TargetMotion, TargetPath, Timeline, Track,
};
use ik_arm::io;
use ik_arm::kinematics::chain_ik::{Method, Root};
use ik_arm::kinematics::skeleton::{Joint, JointId, JointLimits, Limit, Skeleton};
use ik_arm::kinematics::spline::{Interpolation, Knot};
use ik_arm::kinematics::twist::TwistReferenceKind;
use ik_arm::rig::{LimbSettings, TargetKind};
use ik_arm::session::{
    InspectAction, JointEdit, KeysEdit, PlaybackAction, Session, TargetEdit, TransactionAction,
};
use pollster::block_on;

use crate::common::Random;

/// A chain of `bones` joints, bent at random.
fn chain(random: &mut Random, bones: usize, is_limited: bool) -> Skeleton {
    let mut skeleton = Skeleton::with_root("root");
    let mut last = JointId::new(0);
    for bone in 0..bones {
        let joint =
            Joint::new(&format!("bone {bone}"), Some(last), Vec3::Y * random.within(0.5..1.5));
        let limits = std::array::from_fn(|_| Some(Limit { min: -0.6, max: 0.7 }));
        let joint = Joint {
            offset: skeleton[last].axis,
            rotation: random.vector(0.5),
            limits: if is_limited { JointLimits::new(limits) } else { JointLimits::default() },
            ..joint
        };
        last = skeleton.add(joint).expect("a joint");
    }
    skeleton
}

/// A random skeleton whose joints and targets have keys, at a random frame rate.
fn random_document(random: &mut Random) -> Document {
    let bones = 2 + random.below(8);
    let is_limited = random.coin();
    let mut skeleton = chain(random, bones, is_limited);
    if random.coin() {
        let fork = JointId::new(1 + random.below(bones));
        let branch = Joint::new("branch", Some(fork), Vec3::X);
        skeleton.add(Joint { offset: skeleton[fork].axis, ..branch }).expect("a joint");
    }
    let mut rig = SkeletonRig::new(skeleton);
    rig.solver = rig.solver.with_method(random.one_of(&[
        Method::Fabrik,
        Method::Ccd,
        Method::DampedLeastSquares,
        Method::Transpose,
        Method::TransposeFixed,
        Method::Relaxation,
    ]));
    rig.solver.root = random.one_of(&Root::ALL);
    let tips = [JointId::new(bones), JointId::new(rig.skeleton.joints().len() - 1)];
    for tip in tips {
        if rig.target(tip).is_none() {
            rig.targets.push(target(random, &rig, tip));
        }
    }
    let frame_rate: f64 = random.one_of(&[0.01, 23.976, 29.97, 30.0, 60.0, 1000.0]);
    let start = f64::from(random.within(-5.0..5.0));
    let timeline = Timeline { start, end: start + 40.0 / frame_rate.max(20.0), frame_rate };
    let mut document = Document { timeline, ..Document::new(rig) };
    let channels: Vec<Channel> = tips
        .iter()
        .map(|tip| Channel::Target(*tip))
        .chain([Channel::Rotation(JointId::new(1))])
        .collect();
    for channel in channels {
        let value = channel.value(&document).expect("a value");
        for _ in 0..random.below(4) {
            let time = timeline.start + timeline.duration() * f64::from(random.within(0.0..1.0));
            document.keys.insert_auto(channel, time, value + random.vector(0.4));
        }
    }
    document
}

fn target(random: &mut Random, rig: &SkeletonRig, tip: JointId) -> Target {
    let home = rig.skeleton.tip(tip) + random.vector(0.8);
    let path = random.one_of(&[TargetPath::Still, TargetPath::Circle, TargetPath::FigureEight]);
    let motion = TargetMotion { path, radius: random.within(0.1..1.0), period: 2.0 };
    let influence = random.one_of(&[1.0, 1.0, 0.6]);
    Target { influence, motion, ..Target::new(tip, home, 0.3) }
}

/// Times on steps, beside them, between them, before the start and after the end.
fn times(random: &mut Random, timeline: Timeline) -> Vec<f64> {
    let any = |random: &mut Random| {
        let within = timeline.start + timeline.duration() * f64::from(random.within(-0.2..1.5));
        let frame = timeline.time(random.below(timeline.frames()));
        random.one_of(&[within, frame, frame.next_up(), frame.next_down()])
    };
    (0..50).map(|_| any(random)).collect()
}

fn bits(track: &Track, time: f64) -> Vec<u32> {
    bits_of(&track.at(time))
}

fn bits_of(posed: &Posed) -> Vec<u32> {
    let joints = posed.skeleton().joints().iter();
    let numbers = joints.flat_map(|joint| [joint.rotation, joint.offset].map(|it| it.to_array()));
    numbers.flatten().map(f32::to_bits).collect()
}

fn shuffled(random: &mut Random, times: &[f64]) -> Vec<f64> {
    let mut left = times.to_vec();
    (0..times.len()).map(|_| left.swap_remove(random.below(left.len()))).collect()
}

#[test]
fn a_pose_has_the_same_bits_in_any_order_and_after_saving() {
    let mut random = Random(1200);
    for case in 0..60 {
        let document = random_document(&mut random);
        let times = times(&mut random, document.timeline);
        let track = Track::new(&document);
        let all: Vec<_> = times.iter().map(|time| bits(&track, *time)).collect();
        let json = io::to_json(&document).expect("finite");
        let opened = io::parse("a.json", &json, &io::OpenOptions::default()).expect("a document");
        for document in [document.clone(), opened.document] {
            let track = Track::new(&document);
            for time in shuffled(&mut random, &times) {
                let index = times.iter().position(|other| *other == time).expect("a time");
                assert_eq!(bits(&track, time), all[index], "{case} at {time}");
            }
        }
    }
}

#[test]
fn a_track_of_an_edited_document_is_that_of_a_new_one() {
    let mut random = Random(1201);
    for case in 0..60 {
        let document = random_document(&mut random);
        let times = times(&mut random, document.timeline);
        let track = Track::new(&document);
        let before: Vec<_> = times.iter().map(|time| bits(&track, *time)).collect();
        let mut edited = document.clone();
        let tip = edited.rig.targets[0].joint;
        let time = random.one_of(&times);
        match random.below(4) {
            0 => edited.keys.insert_auto(Channel::Target(tip), time, random.vector(2.0)),
            1 => edited.rig.targets[0].home += Vec3::X * 0.1,
            2 => edited.timeline.end += 0.5,
            _ => edited.keys.clear(Channel::Target(tip)),
        }
        let updated = track.updated(&edited);
        let anew = Track::new(&edited);
        for time in &times {
            assert_eq!(bits(&updated, *time), bits(&anew, *time), "{case} at {time}");
        }
        let back = updated.updated(&document);
        for (time, before) in times.iter().zip(&before) {
            assert_eq!(bits(&back, *time), *before, "{case} at {time}: the edit is undone");
        }
    }
}

#[test]
fn a_still_document_has_one_pose_at_all_times() {
    let mut random = Random(1202);
    for case in 0..60 {
        let mut document = random_document(&mut random);
        document.keys = ik_arm::document::Keys::default();
        for target in &mut document.rig.targets {
            target.motion.path = TargetPath::Still;
        }
        let track = Track::new(&document);
        let first = bits(&track, document.timeline.start);
        for time in [-1e9, 0.0, 0.01, 3600.0, 1e9] {
            assert_eq!(bits(&track, time), first, "{case} at {time}");
        }
    }
}

/// A session with a chain whose target is dragged.
fn chain_session(random: &mut Random) -> (Session, JointId) {
    let mut rig = SkeletonRig::new(chain(random, 6, false));
    // By itself, each pose jumps most with this method.
    rig.solver = rig.solver.with_method(Method::Transpose);
    let tip = JointId::new(6);
    let home = rig.skeleton.tip(tip);
    rig.targets.push(Target { influence: 1.0, ..Target::new(tip, home, 0.3) });
    let document = Document::new(rig);
    (Session::with_document(Default::default(), document), tip)
}

fn drag_to(session: &mut Session, tip: JointId, point: Vec3) {
    let rig = session.rig();
    let target = rig.targets[rig.target(tip).expect("a target")];
    session.apply(TargetEdit::SetTarget(Target { home: point, ..target }));
}

fn pose(session: &Session) -> Vec<[u32; 3]> {
    let joints = session.posed().skeleton().joints().iter();
    joints.map(|joint| joint.rotation.to_array().map(f32::to_bits)).collect()
}

#[test]
fn dragging_continues_from_the_shown_pose_and_saving_keeps_it() {
    let mut random = Random(1203);
    let mut ratios = Vec::new();
    for case in 0..20 {
        let (mut session, tip) = chain_session(&mut random);
        let home = session.rig().targets[0].home;
        let side = home.normalize().any_orthonormal_vector();
        let before = (session.document().clone(), pose(&session));
        session.apply(TransactionAction::Begin);
        let (mut last, mut from) = (session.skeleton_pose().clone(), home);
        for step in 1..=240 {
            // First towards the base, then around.
            let part = (step as f32 / 40.0).min(1.0);
            let (sin, cos) = ((step - 40).max(0) as f32 * std::f32::consts::TAU / 100.0).sin_cos();
            let to =
                home * (1.0 - 0.2 * part) + (side * sin - home.normalize() * (1.0 - cos)) * 0.5;
            drag_to(&mut session, tip, to);
            let now = session.skeleton_pose().clone();
            let moved = now.points().zip(last.points()).map(|(now, last)| now.distance(last));
            ratios.push(moved.fold(0.0, f32::max) / from.distance(to));
            (last, from) = (now, to);
        }
        session.apply(TransactionAction::Commit);
        let dragged = pose(&session);
        let json = io::to_json(session.document()).expect("finite");
        let opened = io::parse("a.json", &json, &io::OpenOptions::default()).expect("a document");
        assert_eq!(pose(&Session::with_document(Default::default(), opened.document)), dragged);
        session.apply(TransactionAction::Undo);
        assert_eq!((session.document(), pose(&session)), (&before.0, before.1), "{case}");
        session.apply(TransactionAction::Redo);
        assert_eq!(pose(&session), dragged, "{case}");
    }
    ratios.sort_unstable_by(f32::total_cmp);
    let [half, most] = [50, 98].map(|percent| ratios[ratios.len() * percent / 100]);
    assert!(half < 1.5 && most < 3.0, "joints move {half} and {most} times as far as targets");
}

#[test]
fn the_first_key_moves_nothing() {
    let mut random = Random(1209);
    for _ in 0..20 {
        let (mut session, tip) = chain_session(&mut random);
        let home = session.rig().targets[0].home;
        drag_to(&mut session, tip, home * 0.7);
        let before = session.skeleton_pose().clone();
        session.apply(KeysEdit::Key(vec![Channel::Target(tip)]));
        let moved = before.points().zip(session.skeleton_pose().points());
        let moved = moved.map(|(one, other)| one.distance(other)).fold(0.0, f32::max);
        assert!(moved < 1e-5, "moved by {moved}");
        session.apply(KeysEdit::ClearChannels(vec![Channel::Target(tip)]));
        assert_eq!(*session.skeleton_pose(), before, "nor does the removal of the last key");
    }
}

#[test]
fn a_closed_loop_comes_back_to_its_first_pose() {
    let mut random = Random(1210);
    let mut apart = Vec::new();
    for _ in 0..20 {
        let mut rig = SkeletonRig::new(chain(&mut random, 8, false));
        rig.solver = rig.solver.with_method(Method::DampedLeastSquares);
        let tip = JointId::new(8);
        let home = rig.skeleton.tip(tip) * 0.6;
        let motion = TargetMotion { path: TargetPath::Circle, radius: 0.8, period: 4.0 };
        rig.targets.push(Target { influence: 1.0, motion, ..Target::new(tip, home, 0.3) });
        let length = rig.length_to(tip);
        let timeline = Timeline { start: 0.0, end: 8.0, frame_rate: 30.0 };
        let document = Document { timeline, ..Document::new(rig) };
        let track = Track::new(&document);
        let [first, again] = [0.0, 4.0].map(|time| track.at(time).skeleton().pose());
        let moved = first.points().zip(again.points()).map(|(one, other)| one.distance(other));
        apart.push(moved.fold(0.0, f32::max) / length);
    }
    apart.sort_unstable_by(f32::total_cmp);
    let [half, most] = [apart[10], apart[17]];
    assert!(half < 0.03 && most < 0.1, "they come back to {half} and {most} of the length");
}

#[test]
fn an_unkeyed_edit_is_shown_as_if_it_were_keyed() {
    let mut random = Random(1204);
    for case in 0..20 {
        let (mut session, tip) = chain_session(&mut random);
        let home = session.rig().targets[0].home;
        for (time, moved) in [(0.0, Vec3::ZERO), (2.0, Vec3::X), (4.0, Vec3::Z)] {
            session.apply(PlaybackAction::SetTime(time));
            drag_to(&mut session, tip, home + moved * 0.7);
            session.apply(KeysEdit::Key(vec![Channel::Target(tip)]));
        }
        session.apply(PlaybackAction::SetTime(3.1));
        drag_to(&mut session, tip, home + random.vector(0.6));
        let unkeyed = pose(&session);
        session.apply(KeysEdit::Key(vec![Channel::Target(tip)]));
        assert_eq!(pose(&session), unkeyed, "{case}");
    }
}

/// The largest step of a joint in a motion, over the time.
fn largest_step(document: &Document) -> f32 {
    let track = Track::new(document);
    let timeline = document.timeline;
    let poses: Vec<_> = (0..timeline.frames())
        .map(|frame| track.at(timeline.time(frame)).skeleton().pose())
        .collect();
    let step = |pair: &[_]| {
        let [before, after]: &[ik_arm::kinematics::skeleton::SkeletonPose; 2] =
            pair.try_into().expect("two");
        before
            .points()
            .zip(after.points())
            .map(|(one, other)| one.distance(other))
            .fold(0.0, f32::max)
    };
    poses.windows(2).map(step).fold(0.0, f32::max)
}

/// An arm of two bones with a limb target; the lower joint is a hinge that bends to both sides, or
/// a ball joint.
fn limb(is_hinge: bool, reference: TwistReferenceKind) -> Document {
    let fixed = Some(Limit { min: 0.0, max: 0.0 });
    let hinge = JointLimits::new([Some(Limit { min: -2.5, max: 2.5 }), fixed, fixed]);
    let mut skeleton = Skeleton::with_root("root");
    let upper = skeleton.add(Joint::new("upper", Some(JointId::new(0)), Vec3::Y)).expect("a joint");
    let limits = if is_hinge { hinge } else { JointLimits::default() };
    let lower = Joint { offset: Vec3::Y, limits, ..Joint::new("lower", Some(upper), Vec3::Y) };
    let lower = skeleton.add(lower).expect("a joint");
    let mut rig = SkeletonRig::new(skeleton);
    let kind = TargetKind::Limb(LimbSettings { reference, ..LimbSettings::default() });
    let home = Vec3::new(0.3, 1.5, 0.2);
    rig.targets.push(Target { influence: 1.0, kind, ..Target::new(lower, home, 0.3) });
    let timeline = Timeline { start: 0.0, end: 4.0, frame_rate: 60.0 };
    Document { timeline, ..Document::new(rig) }
}

#[test]
fn a_knee_whose_fk_pose_swings_through_straight_does_not_jump() {
    for is_hinge in [true, false] {
        let mut document = limb(is_hinge, TwistReferenceKind::Fk);
        let lower = document.rig.targets[0].joint;
        for (time, degrees) in [(0.0, 3.0_f32), (2.0, -3.0), (4.0, 3.0)] {
            document.keys.insert_auto(
                Channel::Rotation(lower),
                time,
                Vec3::X * degrees.to_radians(),
            );
        }
        let step = largest_step(&document);
        assert!(step < 0.03, "hinge {is_hinge}: a step of {step}");
        document.rig.is_tracked = false;
        assert!(largest_step(&document) > 0.3, "by itself, each frame has its own side");
    }
}

#[test]
fn influences_that_begin_do_not_jump() {
    let mut random = Random(1205);
    for case in 0..10 {
        let mut skeleton = chain(&mut random, 6, false);
        let fork = JointId::new(3);
        let branch = Joint::new("branch", Some(fork), Vec3::X);
        let branch =
            skeleton.add(Joint { offset: skeleton[fork].axis, ..branch }).expect("a joint");
        let mut rig = SkeletonRig::new(skeleton);
        for (tip, influence) in [(JointId::new(6), 1.0), (branch, 0.0)] {
            let home = rig.skeleton.tip(tip) + random.vector(0.8);
            rig.targets.push(Target { influence, ..Target::new(tip, home, 0.3) });
        }
        let timeline = Timeline { start: 0.0, end: 4.0, frame_rate: 60.0 };
        let mut document = Document { timeline, ..Document::new(rig) };
        let tracked = Track::new(&document).at(0.0).skeleton().pose();
        document.rig.targets[1].influence = 1e-4;
        let begun = Track::new(&document).at(0.0).skeleton().pose();
        let apart = tracked.points().zip(begun.points()).map(|(one, two)| one.distance(two));
        assert!(apart.fold(0.0, f32::max) < 5e-3, "{case}: an influence of 1e-4 moves joints");
        for (time, influence) in [(0.0, 0.0), (2.0, 1.0), (4.0, 0.0)] {
            document.keys.insert_auto(Channel::TargetInfluence(branch), time, Vec3::X * influence);
        }
        let step = largest_step(&document);
        assert!(step < 0.12, "{case}: a step of {step}");
    }
}

#[test]
fn transport_carries_the_elbow_of_a_limb_through_every_direction() {
    let mut document = limb(true, TwistReferenceKind::Transport);
    let lower = document.rig.targets[0].joint;
    // Up over the shoulder and around: through the directions in which the other references flip.
    for (step, point) in
        [Vec3::X, Vec3::Y, Vec3::NEG_X, Vec3::NEG_Y, Vec3::X].into_iter().enumerate()
    {
        document.keys.insert_auto(Channel::Target(lower), step as f64, point * 1.4);
    }
    let carried = largest_step(&document);
    assert!(carried < 0.1, "a step of {carried}");
    let settings = LimbSettings { reference: TwistReferenceKind::Up, ..LimbSettings::default() };
    document.rig.targets[0].kind = TargetKind::Limb(settings);
    assert!(largest_step(&document) > 3.0 * carried, "the other references flip there");
}

#[test]
fn a_joint_edit_takes_the_posture_along() {
    let mut random = Random(1206);
    let (mut session, tip) = chain_session(&mut random);
    let home = session.rig().targets[0].home;
    session.apply(TransactionAction::Begin);
    (1..=40).for_each(|step| drag_to(&mut session, tip, home * (1.0 - 0.01 * step as f32)));
    session.apply(TransactionAction::Commit);
    let before = session.skeleton_pose().clone();
    let joint = JointId::new(2);
    let rotation = session.skeleton()[joint].rotation;
    session.apply(JointEdit::SetRotation { joint, rotation: rotation + Vec3::X * 0.01 });
    let moved = session.skeleton_pose().points().zip(before.points());
    let moved = moved.map(|(now, before)| now.distance(before)).fold(0.0, f32::max);
    assert!(moved < 0.2, "moved by {moved}");
    let error = session.posed().targets()[0].error;
    assert!(error <= session.rig().tolerance(), "off by {error}");
}

/// A chain of 60 bones whose tip goes around for a minute.
fn long_motion() -> Document {
    let mut rig = SkeletonRig::new(chain(&mut Random(1207), 60, false));
    let tip = JointId::new(60);
    let home = rig.skeleton.tip(tip) * 0.6;
    let motion = TargetMotion { path: TargetPath::Circle, radius: 6.0, period: 4.0 };
    rig.targets.push(Target { influence: 1.0, motion, ..Target::new(tip, home, 0.3) });
    let timeline = Timeline { start: 0.0, end: 60.0, frame_rate: 30.0 };
    Document { timeline, ..Document::new(rig) }
}

#[test]
fn a_motion_that_takes_long_is_shown_provisionally_until_a_thread_has_computed_it() {
    let document = long_motion();
    let mut session = Session::with_document(Default::default(), document.clone());
    let job = session.next_inspection().expect("a motion to inspect");
    session.apply(InspectAction::Started(job.clone()));
    session.apply(PlaybackAction::SetTime(50.0));
    assert!(session.posed().is_provisional());
    let known = bits(&Track::new(&document), 50.0);
    session.apply(block_on(job.run()));
    assert!(!session.posed().is_provisional());
    assert_eq!(bits_of(session.posed()), known);

    // An edit shows one step from the motion before it, and then its own.
    let target = session.rig().targets[0];
    session.apply(TargetEdit::SetTarget(Target { home: target.home + Vec3::X * 0.1, ..target }));
    assert!(session.posed().is_provisional());
    let report = &session.posed().targets()[0];
    assert!(report.error < 0.05, "the provisional pose follows the edit: {}", report.error);
    let exact = session.posed().clone().into_known();
    assert_eq!(bits_of(&exact), bits(&Track::new(session.document()), 50.0));
}

#[test]
fn softness_keeps_a_chain_from_snapping_straight() {
    let mut rig = SkeletonRig::new(chain(&mut Random(1208), 5, false));
    let tip = JointId::new(5);
    let (home, length) = (rig.skeleton.tip(tip), rig.length_to(tip));
    rig.targets.push(Target { influence: 1.0, ..Target::new(tip, home, 0.3) });
    let timeline = Timeline { start: 0.0, end: 2.0, frame_rate: 60.0 };
    let mut document = Document { timeline, ..Document::new(rig) };
    let far = home.normalize() * length * 1.3;
    for (time, point) in [(0.0, home * 0.8), (2.0, far)] {
        let key = Knot { interpolation: Interpolation::Linear, ..Knot::new(time, point) };
        document.keys.insert_key(Channel::Target(tip), key);
    }
    let hard = largest_step(&document);
    document.rig.targets[0].softness = 0.4;
    let soft = largest_step(&document);
    assert!(soft < 0.6 * hard, "{soft} instead of {hard}");
    let pose = Track::new(&document).at(2.0).skeleton().pose();
    assert!(pose.tip(tip).length() < 0.999 * length, "the tip stays short of the target");
}
