//! Hard-case examples: each does what its sentence says at every frame, compared with an arm posed
//! in f64.

mod pictures;
mod twin;

use crate::common::arm::{Arm, ArmDocument, ArmPosed, Cursor, LOWER};
use std::f64::consts::PI;
use std::ops::Deref;

use glam::{DAffine3, DMat3, DVec3, Vec3};
use ik_arm::document::{Document, TwistReferenceKind};
use ik_arm::io::{self, Example, ExampleGroup};
use ik_arm::kinematics::chain_ik;
use ik_arm::kinematics::skeleton::Skeleton;
use ik_arm::kinematics::soft_reach::SoftReach;
use ik_arm::kinematics::two_bone::{Reach, TwoBone, TwoBonePose};
use ik_arm::rig::LimbFrames;

use twin::{check, within};

/// Error of a hand and of a limb's length, in units of L.
const EXACT: f64 = 3e-7;

/// Opens a hard case and checks that it is unchanged by saving and opening.
fn opened(name: &str) -> Document {
    let example = Example::find(name).expect("in the gallery");
    assert_eq!(example.group, ExampleGroup::HardCases);
    let opened = example.open().expect("it opens");
    assert_eq!(opened.warnings, []);
    let json = io::to_json(&opened.document).expect("written");
    let again =
        io::parse(name, &json, &io::OpenOptions::default()).expect("it opens again").document;
    assert_eq!(again, opened.document);
    opened.document
}

fn times(document: &Document) -> impl Iterator<Item = f64> {
    let timeline = document.timeline;
    (0..timeline.frames()).map(move |frame| timeline.time(frame))
}

/// The arm at a frame of a motion.
pub struct Frame {
    arm: Arm,
    frames: LimbFrames,
}

impl Frame {
    fn pose(&self) -> TwoBonePose {
        *self.frames.pose()
    }
}

impl Deref for Frame {
    type Target = Arm;

    fn deref(&self) -> &Arm {
        &self.arm
    }
}

/// The arm at every frame.
fn arms(document: &Document) -> Vec<Frame> {
    let frame = |time| {
        let posed = document.at(time);
        Frame { arm: posed.arm(), frames: posed.arm_frames() }
    };
    times(document).map(frame).collect()
}

/// The arm at every frame, checked against the f64 arm.
fn checked(document: &Document) -> Vec<Frame> {
    let arms = arms(document);
    arms.iter().for_each(check);
    arms
}

fn is_at_its_cursor(arm: &Frame) -> bool {
    let pose = arm.pose();
    pose.reach == Some(Reach::Reached) && pose.hand == arm.cursor_in_root()
}

// Movement from frame to frame

fn steps(arms: &[Frame], of: impl Fn(&Frame) -> Vec3) -> Vec<f64> {
    let at: Vec<DVec3> = arms.iter().map(|arm| of(arm).as_dvec3()).collect();
    at.windows(2).map(|pair| pair[0].distance(pair[1])).collect()
}

/// Ratio of elbow to Cursor movement for each pair of frames.
fn elbow_gains(arms: &[Frame]) -> Vec<f64> {
    let elbow = steps(arms, |arm| arm.pose().elbow);
    let cursor = steps(arms, |arm| arm.cursor_in_root());
    elbow.into_iter().zip(cursor).map(|(elbow, cursor)| elbow / cursor).collect()
}

fn largest(values: &[f64]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}

/// Number of frames at which the elbow moves more than `gain` times as far as the Cursor.
fn jumps(arms: &[Frame], gain: f64) -> usize {
    elbow_gains(arms).into_iter().filter(|it| *it > gain).count()
}

// The cases

#[test]
fn through_the_root_the_hand_jumps_unless_the_limbs_are_equal() {
    let document = opened("through-the-root");
    let arms = checked(&document);
    assert!(arms.iter().any(|arm| arm.cursor_in_root() == Vec3::ZERO), "through it at a frame");
    for arm in &arms {
        let pose = arm.pose();
        let asked = arm.cursor_in_root().as_dvec3().length();
        let reach = if asked < 100.0 { Reach::TooClose } else { Reach::Reached };
        assert_eq!(pose.reach, Some(reach));
        assert!(pose.hand.as_dvec3().length() > 100.0 * (1.0 - EXACT), "{}", pose.hand);
    }
    let mut hand = steps(&arms, |arm| arm.pose().hand);
    hand.sort_by(f64::total_cmp);
    within("the jump", (hand.pop().expect("steps") - 200.0).abs(), 1e-3);
    let cursor = largest(&steps(&arms, |arm| arm.cursor_in_root()));
    assert!(largest(&hand) < 1.001 * cursor, "{}", largest(&hand));

    let bones = TwoBone::new(250.0, 250.0).expect("lengths");
    let mut equal = document;
    equal.edit_arm(|arm| arm.bones = bones);
    let arms = checked(&equal);
    assert!(arms.iter().all(is_at_its_cursor));
    assert!(largest(&elbow_gains(&arms)) < 1.0);
}

#[test]
fn straight_up_and_down_the_limbs_elbow_jumps_and_the_stereographic_one_does_not() {
    let document = opened("straight-up-and-down");
    let arms = checked(&document);
    let is_upright = |arm: &&Frame| arm.cursor_in_root().x == 0.0 && arm.cursor_in_root().z == 0.0;
    let upright: Vec<f32> =
        arms.iter().filter(is_upright).map(|arm| arm.cursor_in_root().y).collect();
    assert_eq!(upright, [350.0, -350.0]);
    assert!(arms.iter().all(is_at_its_cursor));
    assert_eq!((document.arm().twist_reference, jumps(&arms, 20.0)), (TwistReferenceKind::Up, 2));
    let across = largest(&steps(&arms, |arm| arm.pose().elbow));
    let out = f64::from(arms[0].pose().out);
    assert!(across > 1.9 * out, "{across}, out {out}");

    let mut smooth = document.clone();
    smooth.set_limb_reference(LOWER, TwistReferenceKind::Stereographic, 0.0);
    let arms = checked(&smooth);
    assert!(arms.iter().all(is_at_its_cursor));
    // By the formula (d₁ + o_e·g)/d = (200 + 171·1)/350.
    assert!(largest(&elbow_gains(&arms)) < 1.1, "{}", largest(&elbow_gains(&arms)));
}

#[test]
fn along_the_pole_its_elbow_flips_and_the_stereographic_one_does_not() {
    let document = opened("along-the-pole");
    let arms = checked(&document);
    let is_along = |arm: &&Frame| arm.cursor_in_root().cross(arm.pole) == Vec3::ZERO;
    assert_eq!(
        (document.arm().twist_reference, arms.iter().filter(is_along).count()),
        (TwistReferenceKind::Pole, 1)
    );
    assert_eq!(jumps(&arms, 20.0), 1);
    let middle = arms.iter().position(|arm| is_along(&arm)).expect("along it");
    let [before, after] = [middle - 1, middle + 1].map(|frame| arms[frame].pose().outward());
    assert!(before.dot(after) < -0.99, "{before} {after}");

    let mut smooth = document.clone();
    smooth.set_limb_reference(LOWER, TwistReferenceKind::Stereographic, 0.0);
    let arms = checked(&smooth);
    assert!(arms.iter().all(is_at_its_cursor));
    assert!(largest(&elbow_gains(&arms)) < 1.5, "{}", largest(&elbow_gains(&arms)));
}

#[test]
fn exactly_straight_the_target_is_reached_and_the_twist_leaves_the_elbow() {
    let document = opened("exactly-straight");
    let arms = checked(&document);
    let mut twists = arms.iter().map(|arm| arm.twist).collect::<Vec<_>>();
    twists.sort_by(f32::total_cmp);
    twists.dedup();
    assert!(twists.len() > 100 && twists[twists.len() - 1] > 6.0, "it plays once around");
    for arm in &arms {
        assert!(is_at_its_cursor(arm));
        assert_eq!(arm.cursor_in_root().as_dvec3().length(), f64::from(arm.bones.outer_limit()));
        let (pose, straight) = (arm.pose(), arm.cursor_in_root().as_dvec3() * 0.4);
        within("the elbow", pose.elbow.as_dvec3().distance(straight), EXACT * 500.0);
        within("its angle", (f64::from(pose.elbow_angle()) - PI).abs(), 1e-6);
    }
}

#[test]
fn just_past_straight_the_elbow_snaps_unless_it_is_softened() {
    let document = opened("just-past-straight");
    let arms = checked(&document);
    for arm in &arms {
        let asked = arm.cursor_in_root().as_dvec3().length();
        let reach = if asked > 500.0 { Reach::TooFar } else { Reach::Reached };
        assert_eq!(arm.pose().reach, Some(reach), "{asked}");
    }
    let is_out = |arm: &Frame| arm.pose().reach == Some(Reach::TooFar);
    assert!(!is_out(&arms[0]) && !is_out(&arms[arms.len() - 1]));
    assert!(arms.iter().any(is_out));
    let hard = largest(&elbow_gains(&arms));
    assert!(hard > 8.0, "{hard}");

    let soft_reach = SoftReach::new(0.1, 1.0, 0.0).expect("soft");
    let mut soft = document;
    soft.edit_arm(|arm| arm.soft_reach = soft_reach);
    let arms = checked(&soft);
    assert!(largest(&elbow_gains(&arms)) < 2.0, "{}", largest(&elbow_gains(&arms)));
}

#[test]
fn equal_bones_fold_up_completely_and_nothing_jumps() {
    let document = opened("equal-bones-folded");
    let arms = checked(&document);
    assert!(arms.iter().all(is_at_its_cursor));
    let folded: Vec<&Frame> =
        arms.iter().filter(|arm| arm.cursor_in_root() == Vec3::ZERO).collect();
    assert_eq!(folded.len(), 1);
    let pose = folded[0].pose();
    within("the elbow", pose.elbow.as_dvec3().distance(DVec3::Y * 250.0), EXACT * 500.0);
    within("its angle", f64::from(pose.elbow_angle()), 1e-6);
    assert!(largest(&elbow_gains(&arms)) < 1.0, "{}", largest(&elbow_gains(&arms)));
}

#[test]
fn one_bone_a_thousand_times_the_other_brings_the_hand_to_its_target() {
    let document = opened("thousand-to-one");
    let arms = checked(&document);
    let bones = document.arm().bones;
    within("the ratio", (f64::from(bones.upper() / bones.lower()) - 1e3).abs(), 1e-3);
    assert!(arms.iter().all(is_at_its_cursor));
    let angle = |arm: &Frame| {
        let around = arm.cursor_in_root() - Vec3::X * 300.0;
        around.y.atan2(around.x)
    };
    for quarter in [0.0, 1.5, 3.0, -1.5] {
        let is_there = |arm: &Frame| (angle(arm) - quarter).abs() < 0.2;
        assert!(arms.iter().any(is_there), "the hand goes once around");
    }
}

#[test]
fn a_root_a_million_units_away_keeps_limb_lengths_to_f32_precision() {
    let document = opened("far-root");
    let arms = checked(&document);
    let root = document.arm().root;
    assert_eq!(root.as_dvec3().length(), 1e6);
    let place = root.max_element();
    assert_eq!(place.next_up() - place, 1.0 / 16.0);
    for arm in &arms {
        let (pose, near) = (arm.pose(), Arm { root: Vec3::ZERO, ..**arm }.pose());
        assert_eq!((pose.reach, pose.hand), (Some(Reach::Reached), arm.frames.posed.cursor));
        for (one, other) in [(pose.elbow, near.elbow), (pose.hand, near.hand)] {
            let off = one.distance(other);
            assert!(off <= 4.0 / 16.0, "in Root space it is any arm, within rounding: {off}");
        }
    }
}

#[test]
fn a_tiny_arm_moves_as_the_large_ones_do() {
    moves_as_the_default_arm("tiny", 1e-3);
}

#[test]
fn a_huge_arm_moves_as_the_small_ones_do() {
    moves_as_the_default_arm("huge", 1e6);
}

fn moves_as_the_default_arm(name: &str, length: f32) {
    let document = opened(name);
    let arms = checked(&document);
    within("L", f64::from(document.arm().bones.outer_limit() / length - 1.0).abs(), EXACT);
    let scale = f64::from(length) / 500.0;
    for arm in arms {
        assert!(is_at_its_cursor(&arm));
        let cursor = (arm.cursor_in_root().as_dvec3() / scale).as_vec3();
        let seed = Arm { cursor: Cursor::unpinned(cursor), ..Arm::default() }.pose();
        let elbow = arm.pose().elbow.as_dvec3() / scale;
        within("the elbow", elbow.distance(seed.elbow.as_dvec3()), 1e-5 * 500.0);
    }
}

#[test]
fn two_bones_in_a_mirror_follow_their_target() {
    let document = opened("mirrored");
    let mut skeleton = document.skeleton().clone();
    assert!(skeleton.transform().matrix3.determinant() < 0.0);
    let (target, length) = (document.rig.targets[0], 1.4);
    let [_, _, hand] = points(&skeleton);
    within("the hand as it is opened", hand.distance(target.home.as_dvec3()), 1e-4 * length);
    let mut before: Option<[DVec3; 3]> = None;
    for time in times(&document) {
        let targets = document.rig.targets_at(time);
        let report = chain_ik::solve(&mut skeleton, &targets, &document.rig.solver);
        assert!(report.expect("it can be solved").converged(), "at {time}");
        let at = points(&skeleton);
        within("the hand", at[2].distance(target.at(time).as_dvec3()), 2e-6 * length);
        if let Some(before) = before {
            let (elbow, hand) = (before[1].distance(at[1]), before[2].distance(at[2]));
            assert!(elbow < 3.0 * hand, "the elbow jumps by {elbow} at {time}");
        }
        before = Some(at);
    }
    let followed = before.expect("frames")[2].distance(target.home.as_dvec3());
    within("the hand, once around", followed, 1e-5);
}

/// Base, middle and tip of two bones in the world, by products of matrices in f64.
fn points(skeleton: &Skeleton) -> [DVec3; 3] {
    let mut at = skeleton.transform().as_daffine3();
    let mut points = Vec::new();
    for joint in skeleton.joints() {
        let [x, y, z] = joint.rotation.as_dvec3().to_array();
        let turn =
            DMat3::from_rotation_z(z) * DMat3::from_rotation_y(y) * DMat3::from_rotation_x(x);
        at *= DAffine3::from_mat3_translation(turn, joint.offset.as_dvec3());
        points.push(at.transform_point3(DVec3::ZERO));
    }
    let [.., lower] = skeleton.joints() else { panic!("no bones") };
    points.push(at.transform_point3(lower.axis.as_dvec3()));
    points.try_into().expect("two bones")
}
