//! Inspections of motions: what they find, and that their remedies help.

use glam::{DVec3, Vec3};
use ik_arm::document::{
    Document, FramePop, Inspection, SkeletonRig, Target, TargetMotion, TargetPath, Timeline, Track,
};
use ik_arm::io;
use ik_arm::kinematics::chain_ik::Method;
use ik_arm::kinematics::skeleton::{Joint, JointId, Skeleton};
use ik_arm::rig::RigPopCause;
use ik_arm::session::{Session, SolverEdit, TransactionAction};
use pollster::block_on;

use crate::common::Random;

fn inspected(document: &Document) -> Inspection {
    block_on(Inspection::new(&Track::new(document), document.timeline, false, async |_| true))
        .expect("not cancelled")
}

/// A chain whose limits take its target from it, although it could reach it.
fn lost() -> Document {
    let text = include_str!("../data/lost-target.json");
    io::parse("lost-target.json", text, &io::OpenOptions::default()).expect("a document").document
}

#[test]
fn a_target_that_another_pose_reaches_is_lost_and_another_start_finds_it() {
    let document = lost();
    let mut found = inspected(&document);
    assert_eq!(found.lost.len(), 1, "{:?}", found.lost);
    let span = found.lost[0];
    for time in [span.from, span.to] {
        let track = Track::new(&document);
        let posed = track.at(time);
        let error = posed.targets()[0].error;
        assert!(error > posed.document().rig.tolerance(), "missed at {time}: {error}");
    }
    block_on(found.find_better_posture(&Track::new(&document), document.timeline, async |_| true));
    let posture = found.better_posture.expect("a posture from which nothing is lost");
    let mut session = Session::with_document(Default::default(), document);
    session.apply(SolverEdit::SetPosture(posture));
    assert!(inspected(session.document()).lost.is_empty());
    session.apply(TransactionAction::Undo);
    assert_eq!(session.document().rig.posture, None);
}

/// A chain of eight bones whose tip goes around, tracked or each frame by itself.
fn random_motion(random: &mut Random) -> Document {
    let mut skeleton = Skeleton::with_root("root");
    let mut last = JointId::new(0);
    for bone in 0..8 {
        let joint = Joint::new(&format!("bone {bone}"), Some(last), Vec3::Y);
        let rotation = random.vector(0.4);
        last = skeleton
            .add(Joint { offset: skeleton[last].axis, rotation, ..joint })
            .expect("a joint");
    }
    let mut rig = SkeletonRig::new(skeleton);
    rig.solver = rig.solver.with_method(random.one_of(&[Method::Transpose, Method::Ccd]));
    rig.is_tracked = random.coin();
    let home = rig.skeleton.tip(last) * random.within(0.4..1.0);
    let motion = TargetMotion { path: TargetPath::Circle, radius: 1.5, period: 4.0 };
    rig.targets.push(Target { influence: 1.0, motion, ..Target::new(last, home, 0.3) });
    let timeline = Timeline { start: 0.0, end: 4.0, frame_rate: 30.0 };
    Document { timeline, ..Document::new(rig) }
}

/// With a still FK pose, a pop is a frame in which a base or tip moves more than twice as far as
/// the target: counted here from positions alone.
#[test]
fn pops_are_the_frames_in_which_joints_move_twice_as_far_as_the_target() {
    let mut random = Random(1300);
    let mut all = 0;
    for case in 0..20 {
        let document = random_motion(&mut random);
        let timeline = document.timeline;
        let track = Track::new(&document);
        let length = f64::from(document.rig.length_to(JointId::new(8)));
        let frames: Vec<(Vec<DVec3>, DVec3)> = (0..timeline.frames())
            .map(|frame| {
                let posed = track.at(timeline.time(frame));
                let pose = posed.skeleton().pose();
                // The root is locked.
                let points = pose.points().skip(2).map(Vec3::as_dvec3).collect();
                (points, posed.targets()[0].position.as_dvec3())
            })
            .collect();
        let ratio = |pair: &[(Vec<DVec3>, DVec3)]| {
            let [(before, from), (after, to)] = pair else { panic!("two frames") };
            let moved = before.iter().zip(after).map(|(one, other)| one.distance(*other));
            moved.fold(0.0, f64::max) / from.distance(*to).max(1e-3 * length)
        };
        let expected: Vec<(usize, f64)> = frames
            .windows(2)
            .map(ratio)
            .enumerate()
            .filter(|(_, ratio)| *ratio > 2.0)
            .map(|(frame, ratio)| (frame + 1, ratio))
            .collect();
        let found: Vec<(usize, f64)> = inspected(&document)
            .pops
            .iter()
            .map(|pop| ((pop.time * 30.0).round() as usize, f64::from(pop.pop.ratio)))
            .collect();
        let near = |one: &(usize, f64), other: &(usize, f64)| {
            one.0 == other.0 && (one.1 - other.1).abs() < 0.05 * one.1
        };
        let clear = |(_, ratio): &&(usize, f64)| *ratio > 2.1;
        for expected in expected.iter().filter(clear) {
            assert!(found.iter().any(|it| near(it, expected)), "{case}: {expected:?} of {found:?}");
        }
        for found in found.iter().filter(clear) {
            assert!(expected.iter().any(|it| near(it, found)), "{case}: {found:?} of {expected:?}");
        }
        all += expected.len();
    }
    assert!(all > 100, "{all} pops");
}

#[test]
fn limbs_that_stay_while_the_body_above_them_moves_do_not_pop() {
    let example = io::Example::find("human").expect("an example").open().expect("valid");
    let mut document = example.document;
    let head = document.skeleton().find("head").expect("a head");
    let home = Track::new(&document).at(0.0).skeleton().pose().tip(head);
    let motion = TargetMotion { path: TargetPath::Circle, radius: 0.02, period: 2.0 };
    let target = Target { influence: 1.0, motion, ..Target::new(head, home, 0.1) };
    document.rig.targets.push(target);
    document.timeline = Timeline { start: 0.0, end: 4.0, frame_rate: 30.0 };
    let found = inspected(&document);
    // The arms hang nearly straight, which pops a little; otherwise limbs make up for the motion.
    let is_of_limb =
        |pop: &&FramePop| pop.pop.target != head && pop.pop.cause != RigPopCause::Straight;
    assert_eq!(found.pops.iter().find(is_of_limb), None);
    assert_eq!((&found.lost, &found.slides), (&vec![], &vec![]));
    let hands = document.rig.targets.iter().filter(|target| target.limb().is_some());
    assert!(hands.count() >= 4, "hands and feet stay by limb targets");
}
