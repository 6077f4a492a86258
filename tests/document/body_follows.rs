//! Whole body follows: what limbs do not reach pulls the rest of the body along.

use glam::Vec3;
use ik_arm::document::{Channel, Document, FramePop, Inspection, Target, Track};
use ik_arm::kinematics::chain_ik::{Method, OrientRefusal, SolveError};
use ik_arm::kinematics::limb_ik::LimbReach;
use ik_arm::kinematics::skeleton::JointId;
use ik_arm::rig::{Aim, TargetOutcome, TargetSpace};
use pollster::block_on;

use crate::common::Random;
use crate::common::documents::example;

const FEET: [&str; 2] = ["left_shin", "right_shin"];
/// Index of the left hand among the targets of the Human.
const LEFT_HAND: usize = 1;

fn joint(document: &Document, name: &str) -> JointId {
    document.skeleton().find(name).expect("a joint")
}

/// The Human, whose left hand goes from its place to a point and back, in two seconds each.
fn reaching(method: Method, to: Vec3) -> Document {
    let mut document = example("human");
    document.rig.solver.method = method;
    let hand = joint(&document, "left_forearm");
    let home = document.rig.targets[document.rig.target(hand).expect("a target")].home;
    for (time, point) in [(0.0, home), (2.0, to), (4.0, home)] {
        document.keys.insert(Channel::Target(hand), time, point);
    }
    document
}

/// Largest distance of a tip of some joints in a pose from another one.
fn moved(document: &Document, track: &Track, times: [f64; 2], names: &[&str]) -> f32 {
    let [from, to] = times.map(|time| track.at(time));
    let joints = names.iter().map(|name| joint(document, name));
    joints.map(|it| from.skeleton().tip(it).distance(to.skeleton().tip(it))).fold(0.0, f32::max)
}

fn pops(track: &Track) -> Vec<FramePop> {
    let timeline = track.document().timeline;
    block_on(Inspection::new(track, timeline, false, async |_| true)).expect("not cancelled").pops
}

/// Asserts that the feet are at their targets in all frames of the four seconds.
fn assert_feet_stay(track: &Track, within: f32, case: &str) {
    for frame in 0..=120 {
        let posed = track.at(f64::from(frame) / 30.0);
        for foot in FEET {
            let report = posed.target_report(joint(track.document(), foot)).expect("a report");
            let error = report.error;
            assert!(error < within, "{case}: {foot} is off by {error} at {frame}");
        }
    }
}

/// Points around a shoulder: in front of the body, from the hip to the top of the head.
fn points_in_front(random: &mut Random, shoulder: Vec3, distance: f32) -> Vec3 {
    loop {
        let way = random.direction();
        if way.z > 0.1 && (-0.8..0.3).contains(&way.y) {
            return shoulder + way * distance;
        }
    }
}

fn shoulder() -> Vec3 {
    let human = example("human");
    let shoulder = joint(&human, "left_upper_arm");
    human.at(0.0).skeleton().base(shoulder)
}

/// The length of the Human's arm without the hand.
const ARM: f32 = 0.54;

#[test]
fn a_hand_beyond_its_reach_takes_the_body_along_smoothly_and_the_feet_stay() {
    let (mut random, shoulder) = (Random(38), shoulder());
    for method in [Method::DampedLeastSquares, Method::Transpose, Method::Ccd, Method::Fabrik] {
        for _ in 0..8 {
            let to = points_in_front(&mut random, shoulder, ARM + 0.2);
            let mut document = reaching(method, to);
            document.timeline.end = 4.0;
            let track = Track::new(&document);
            let case = format!("{method}, {}", to - shoulder);
            let far = track.at(2.0);
            assert!(
                far.targets()[LEFT_HAND].error < 1e-4,
                "{case}: {}",
                far.targets()[LEFT_HAND].error
            );
            for part in ["pelvis", "chest"] {
                let way = moved(&document, &track, [0.0, 2.0], &[part]);
                assert!(way > 0.05, "{case}: {part} moved by {way}");
            }
            assert_feet_stay(&track, 1e-6, &case);
            let back = moved(&document, &track, [0.0, 4.0], &["pelvis", "chest", "head"]);
            assert!(back < 1e-4, "{case}: off by {back} after all");
            assert_eq!(pops(&track), vec![], "{case}");
        }
    }
}

#[test]
fn a_hand_that_its_limits_stop_takes_the_body_along_without_a_jump_and_the_feet_stay() {
    let mut random = Random(388);
    let (shoulder, mut stopped) = (shoulder(), 0);
    for method in [Method::DampedLeastSquares, Method::Transpose, Method::Ccd, Method::Fabrik] {
        let mut of_method = 0;
        while of_method < 6 {
            // Behind the body and across it.
            let way = random.direction() - 0.4 * Vec3::X - 0.4 * Vec3::Z;
            let to = shoulder + 0.85 * ARM * way.normalize();
            let mut document = reaching(method, to);
            document.timeline.end = 4.0;
            let mut alone = document.clone();
            alone.rig.body_follows = false;
            let at_far = Track::new(&alone).at(2.0);
            let TargetOutcome::Limb(limb) = &at_far.targets()[LEFT_HAND].outcome else {
                panic!("a limb")
            };
            // Places near enough to turn to.
            let is_stopped = matches!(limb.reach, LimbReach::Limited(_));
            if !is_stopped || at_far.targets()[LEFT_HAND].error > 0.15 {
                continue;
            }
            of_method += 1;
            let track = Track::new(&document);
            let case = format!("{method}, {}", to - shoulder);
            let error = track.at(2.0).targets()[LEFT_HAND].error;
            assert!(error < 1e-3, "{case}: {error}, alone {}", at_far.targets()[LEFT_HAND].error);
            assert_feet_stay(&track, 1e-4, &case);
            // The elbow may have to change sides at a limit; the body must not jump then.
            let most = if method == Method::Transpose { 15.0 } else { 4.0 };
            let step = at_far.targets()[LEFT_HAND]
                .position
                .distance(track.at(0.0).targets()[LEFT_HAND].position)
                / 60.0;
            for frame in 1..=120 {
                let times = [frame - 1, frame].map(|frame| f64::from(frame) / 30.0);
                let way = moved(&document, &track, times, &["pelvis", "spine", "chest", "head"]);
                assert!(way < most * step, "{case}: {} steps at {frame}", way / step);
            }
        }
        stopped += of_method;
    }
    assert_eq!(stopped, 24);
}

#[test]
fn a_hand_within_its_reach_moves_the_arm_alone() {
    let (mut random, shoulder) = (Random(39), shoulder());
    for _ in 0..10 {
        let to = points_in_front(&mut random, shoulder, 0.9 * ARM);
        let document = reaching(Method::DampedLeastSquares, to);
        let track = Track::new(&document);
        for frame in 0..=40 {
            let time = f64::from(frame) / 10.0;
            let way = moved(&document, &track, [0.0, time], &["pelvis", "chest", "head"]);
            assert!(way < 1e-6, "{way} at {time} s");
        }
    }
}

#[test]
fn a_body_that_does_not_follow_lets_the_hand_miss() {
    let mut document = reaching(Method::DampedLeastSquares, shoulder() + Vec3::Z * (ARM + 0.2));
    document.rig.body_follows = false;
    let track = Track::new(&document);
    assert!((track.at(2.0).targets()[LEFT_HAND].error - 0.2).abs() < 1e-3);
    assert!(moved(&document, &track, [0.0, 2.0], &["pelvis", "chest"]) < 1e-6);
}

#[test]
fn a_target_that_moves_with_the_body_does_not_pull_it() {
    let mut document = example("human");
    let (hand, chest) = (joint(&document, "left_forearm"), joint(&document, "chest"));
    let pose = document.at(0.0).skeleton().clone();
    let index = document.rig.target(hand).expect("a target");
    let target = &mut document.rig.targets[index];
    target.space = TargetSpace::Joint(chest);
    *target = target.placed(&pose, 0.0, shoulder() + Vec3::Z);
    let posed = document.at(0.0);
    assert!(posed.targets()[index].error > 0.4);
    assert!(posed.skeleton().tip(chest).distance(pose.tip(chest)) < 1e-6);
}

#[test]
fn a_method_that_cannot_move_the_body_says_so() {
    let mut document = example("human");
    document.rig.solver.method = Method::Relaxation;
    let pelvis = joint(&document, "pelvis");
    let refused = document.at(0.0).evaluated_skeleton().body_refused.clone();
    let expected =
        SolveError::CannotStiffen { method: Method::Relaxation, joint: pelvis, per_angle: false };
    assert_eq!(refused, Some(expected));
    // The closed form is for limbs alone; the body then moves by least squares.
    document.rig.solver.method = Method::TwoBone;
    assert_eq!(document.at(0.0).evaluated_skeleton().body_refused, None);
}

#[test]
fn a_method_that_cannot_aim_refuses_that_target_and_solves_the_others() {
    let to = shoulder() + Vec3::new(0.1, -0.2, ARM + 0.2);
    let solved = |has_aim: bool| {
        let mut document = reaching(Method::Fabrik, to);
        let head = joint(&document, "head");
        let aim = Aim { axis: Vec3::Z, point: Vec3::new(0.5, 1.0, 2.0) };
        let tip = document.skeleton().tip(head);
        let free = Target { weight: 0.0, influence: 1.0, ..Target::new(head, tip, 0.1) };
        document.rig.targets.push(Target { aim: has_aim.then_some(aim), enabled: has_aim, ..free });
        Track::new(&document).at(2.0)
    };
    let (with, without) = (solved(true), solved(false));
    assert_eq!(with.skeleton(), without.skeleton(), "the hand takes the body along as without");
    assert!(with.targets()[LEFT_HAND].error < 1e-4);
    let outcome = &with.targets().last().expect("the head's target").outcome;
    let TargetOutcome::Refused(error) = outcome else { panic!("refused, not {outcome:?}") };
    assert!(
        matches!(
            error,
            SolveError::CannotOrient { method: Method::Fabrik, reason: OrientRefusal::Aim, .. }
        ),
        "{error}"
    );
}
