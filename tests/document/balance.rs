//! Balance: the body moves so that the centre of mass is over the feet, or over a point.

use glam::{Vec2, Vec3};
use ik_arm::document::{
    BalanceOver, BalanceTarget, Channel, Document, FramePop, Inspection, Track,
};
use ik_arm::kinematics::chain_ik::Method;
use ik_arm::kinematics::diagnosis::{Cause, Remedy};
use ik_arm::kinematics::skeleton::{Balance, JointId, Skeleton};
use ik_arm::rig::Carried;
use pollster::block_on;

use crate::common::Random;
use crate::common::documents::example;

const HANDS: [&str; 2] = ["left_forearm", "right_forearm"];
const FEET: [&str; 2] = ["left_shin", "right_shin"];
/// Index of the left hand among the targets of the Human.
const LEFT_HAND: usize = 1;
const BALANCING: [Method; 3] = [Method::DampedLeastSquares, Method::Transpose, Method::Ccd];

fn joint(document: &Document, name: &str) -> JointId {
    document.skeleton().find(name).expect("a joint")
}

/// The Human with a balance, solved by a method.
fn balanced(method: Method, balance: BalanceTarget) -> Document {
    let mut document = example("human");
    document.rig.solver.method = method;
    document.rig.balance = Some(balance);
    document
}

fn centre(pose: &Skeleton) -> Vec2 {
    Balance::of(pose).expect("mass").centre_on_ground()
}

fn set_target(document: &mut Document, name: &str, point: Vec3) {
    let index = document.rig.target(joint(document, name)).expect("a target");
    document.rig.targets[index].home = point;
}

/// Sets the hands to places in front of the body.
fn stretch_hands(document: &mut Document, random: &mut Random, forward: f32) {
    for name in HANDS {
        let side = if name == HANDS[0] { 0.25 } else { -0.25 };
        let way = Vec3::new(random.within(-0.1..0.1), random.within(-0.3..0.3), forward);
        set_target(document, name, Vec3::new(side, 1.1, 0.0) + way);
    }
}

#[test]
fn the_centre_of_mass_goes_over_the_middle_of_the_feet_which_stay() {
    let mut random = Random(1);
    for method in BALANCING {
        let most = if method == Method::Ccd { 5e-3 } else { 1e-3 };
        for case in 0..20 {
            let mut document = balanced(method, BalanceTarget::default());
            stretch_hands(&mut document, &mut random, 0.45);
            let posed = document.at(0.0);
            let (middle, _) = Balance::middle_of_feet(posed.skeleton()).expect("feet");
            let off = centre(posed.skeleton()).distance(middle);
            assert!(off < most, "{method} {case}: {off}");
            let report = posed.evaluated_skeleton().balance.clone().expect("a report");
            assert!((report.error() - off).abs() < 1e-6, "{method} {case}: {report:?}");
            let missed = posed.targets().iter().map(|target| target.error).fold(0.0, f32::max);
            assert!(missed < 1e-3, "{method} {case}: a hand or foot is off by {missed}");

            document.rig.balance = None;
            let without = document.at(0.0);
            let before = centre(without.skeleton()).distance(middle);
            assert!(before > 3.0 * off, "{method} {case}: {off}, without balance {before}");
        }
    }
}

#[test]
fn the_centre_of_mass_goes_over_a_point_as_far_as_the_influence_says() {
    let at = |influence: f32| {
        let over = BalanceOver::Point(Vec2::new(0.06, 0.02));
        let balance = BalanceTarget { influence, over, ..BalanceTarget::default() };
        let document = balanced(Method::DampedLeastSquares, balance);
        centre(document.at(0.0).skeleton())
    };
    let (from, to) = (at(0.0), at(1.0));
    assert!(to.distance(Vec2::new(0.06, 0.02)) < 1e-3, "{to}");
    let half = at(0.5);
    let part = (half - from).dot(to - from) / (to - from).length_squared();
    assert!((0.4..0.6).contains(&part), "{half} is {part} of the way from {from} to {to}");
}

#[test]
fn keys_of_the_influence_move_the_body_over_its_feet_without_pops() {
    for method in BALANCING {
        let mut document = balanced(method, BalanceTarget::default());
        stretch_hands(&mut document, &mut Random(2), 0.45);
        for (time, influence) in [(0.0, 0.0), (2.0, 1.0), (4.0, 0.0)] {
            document.keys.insert(Channel::BalanceInfluence, time, Vec3::X * influence);
        }
        document.timeline.end = 4.0;
        let track = Track::new(&document);
        let tips = |time: f64| {
            let posed = track.at(time);
            let skeleton = posed.skeleton().clone();
            skeleton.ids().map(|joint| skeleton.tip(joint)).collect::<Vec<Vec3>>()
        };
        let off =
            |time: f64| track.at(time).evaluated_skeleton().balance.clone().map(|it| it.error());
        assert_eq!(off(0.0), None, "{method}");
        assert!(off(2.0).expect("a report") < 5e-3, "{method}: {:?}", off(2.0));
        let mut last = tips(0.0);
        for frame in 1..=120 {
            let now = tips(f64::from(frame) / 30.0);
            let way = last.iter().zip(&now).map(|(one, other)| one.distance(*other));
            let way = way.fold(0.0, f32::max);
            assert!(way < 0.02, "{method}: a joint moves by {way} in frame {frame}");
            last = now;
        }
        let first = tips(0.0);
        let back = first.iter().zip(&last).map(|(one, other)| one.distance(*other));
        let back = back.fold(0.0, f32::max);
        assert!(back < 1e-3, "{method}: {back} away after all");
    }
}

#[test]
fn a_hand_that_pulls_the_body_and_a_foot_that_is_lifted_give_no_pops() {
    let document = balanced(Method::DampedLeastSquares, BalanceTarget::default());
    let home = |name: &str| {
        let index = document.rig.target(joint(&document, name)).expect("a target");
        document.rig.targets[index].home
    };
    for (name, by) in [
        (HANDS[0], Vec3::new(0.1, 0.3, 0.7)),
        (FEET[1], Vec3::new(0.0, 0.25, 0.0)),
        (FEET[0], Vec3::new(0.1, 0.2, 0.2)),
    ] {
        let mut moved = document.clone();
        for (time, part) in [(0.0, 0.0), (2.0, 1.0), (4.0, 0.0)] {
            let channel = Channel::Target(joint(&document, name));
            moved.keys.insert(channel, time, home(name) + by * part);
        }
        moved.timeline.end = 4.0;
        let track = Track::new(&moved);
        let found = block_on(Inspection::new(&track, moved.timeline, false, async |_| true));
        let pops: Vec<FramePop> = found.expect("not cancelled").pops;
        assert_eq!(pops, vec![], "{name}");
        let far = track.at(2.0);
        let report = far.evaluated_skeleton().balance.clone().expect("a report");
        assert!(report.error() < 1e-3, "{name}: {report:?}");
    }
}

#[test]
fn a_method_that_cannot_balance_says_so_and_poses_as_without() {
    let document = balanced(Method::Fabrik, BalanceTarget::default());
    let mut without = document.clone();
    without.rig.balance = None;
    let (posed, other) = (document.at(0.0), without.at(0.0));
    assert_eq!(posed.skeleton(), other.skeleton());
    let report = posed.evaluated_skeleton().balance.clone().expect("a report");
    let reason = report.refused.expect("a reason").to_string();
    assert_eq!(reason, "fabrik cannot balance a body; transpose, dls, ccd can");
}

#[test]
fn a_figure_in_the_air_is_not_balanced_over_feet() {
    let mut document = balanced(Method::DampedLeastSquares, BalanceTarget::default());
    for name in FEET.into_iter().chain(HANDS) {
        let index = document.rig.target(joint(&document, name)).expect("a target");
        document.rig.targets[index].home.y += 1.0;
    }
    let pelvis = joint(&document, "pelvis");
    let raised = document.skeleton()[pelvis].offset + Vec3::Y;
    document.rig.skeleton_mut().change(pelvis, |joint| joint.offset = raised).expect("an offset");
    let posed = document.at(0.0);
    let report = posed.evaluated_skeleton().balance.clone().expect("a report");
    assert_eq!((report.over, report.error()), (None, 0.0));
    let mut without = document.clone();
    without.rig.balance = None;
    assert_eq!(posed.skeleton(), without.at(0.0).skeleton());
}

#[test]
fn why_not_names_the_balance_and_switches_it_off_where_that_reaches_the_target() {
    let mut document = balanced(Method::DampedLeastSquares, BalanceTarget::default());
    set_target(&mut document, HANDS[0], Vec3::new(0.75, 1.7, 0.2));
    let rig = &document.rig;
    let evaluated = rig.evaluate(0.0);
    assert!(evaluated.targets[LEFT_HAND].error > rig.tolerance(), "the balance is in the way");
    let found = rig.diagnose(0.0, &Carried::default());
    let balance = found.iter().find(|it| it.cause == Cause::Balance).expect("the balance");
    let tried = balance.remedies.first().expect("a remedy");
    assert_eq!(tried.remedy, Remedy::FreeBalance);
    let mut freed = rig.clone();
    freed.apply_remedy(&tried.remedy, 0.0).expect("applied");
    assert!(freed.evaluate(0.0).targets[LEFT_HAND].error <= rig.tolerance());

    document.rig.balance = None;
    set_target(&mut document, HANDS[0], Vec3::new(2.0, 1.7, 0.2));
    let found = document.rig.diagnose(0.0, &Carried::default());
    assert!(!found.is_empty() && found.iter().all(|it| it.cause != Cause::Balance), "{found:?}");
}
