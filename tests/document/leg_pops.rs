//! Pops of the legs of the example Walk, against knees that are computed here in f64: from the
//! pelvis, the targets and the twist reference, by the law of cosines.

use core::f64::consts::TAU;

use glam::{DMat3, DQuat, DVec3, Vec3};
use ik_arm::document::{Document, Inspection, Timeline, Track, TwistReferenceKind};
use ik_arm::io;
use ik_arm::kinematics::skeleton::{JointId, JointLimits};
use ik_arm::rig::{LimbSettings, RigPopCause, TargetSpace};
use pollster::block_on;

use crate::common::Random;

const LEGS: [[&str; 2]; 2] = [["left_thigh", "left_shin"], ["right_thigh", "right_shin"]];

fn walk() -> Document {
    io::Example::find("walk").expect("an example").open().expect("valid").document
}

fn joint(document: &Document, name: &str) -> JointId {
    document.skeleton().find(name).expect("a joint")
}

/// Legs whose knees turn by a reference, with shins of a part of their length: those of less than
/// 0.97 straighten in each step.
fn walk_by(reference: TwistReferenceKind, pole: Vec3, twist: f32, shin: f32) -> Document {
    let mut document = walk();
    let pelvis = joint(&document, "pelvis");
    for [thigh, lower] in LEGS {
        let [thigh, lower] = [thigh, lower].map(|name| joint(&document, name));
        let index = document.rig.target(lower).expect("a target");
        let limb = document.rig.targets[index].limb_mut().expect("a limb");
        let pole_space = TargetSpace::Joint(pelvis);
        *limb = LimbSettings { reference, twist, pole: Some(pole), pole_space, ..*limb };
        let foot = document.skeleton().children(lower).next().expect("a foot");
        let skeleton = document.skeleton_mut();
        skeleton.write_local(thigh, |thigh| thigh.limits = JointLimits::default());
        skeleton.write_local(lower, |lower| lower.axis *= shin);
        skeleton.write_local(foot, |foot| foot.offset *= shin);
    }
    document
}

/// A leg at a time, in the space of the pelvis.
#[derive(Clone, Copy, Debug)]
struct Leg {
    /// Target of the ankle, from the hip.
    target: DVec3,
    knee: DVec3,
    lengths: [f64; 2],
}

/// The leg from its inputs alone. In the bind pose it points along −y, and its knee is at +z.
fn leg(track: &Track, time: f64, side: usize) -> Leg {
    let posed = track.at(time);
    let (document, pose) = (posed.document(), posed.skeleton());
    let [pelvis, thigh, shin] =
        ["pelvis", LEGS[side][0], LEGS[side][1]].map(|name| &pose[joint(document, name)]);
    let [x, y, z] = pelvis.rotation.as_dvec3().to_array();
    let turn = DMat3::from_rotation_z(z) * DMat3::from_rotation_y(y) * DMat3::from_rotation_x(x);
    let base = pelvis.offset.as_dvec3();
    let hip = thigh.offset.as_dvec3();
    let index = document.rig.target(joint(document, LEGS[side][1])).expect("a target");
    let target = turn.transpose() * (posed.targets()[index].position.as_dvec3() - base) - hip;
    let lengths = [thigh, shin].map(|bone| bone.axis.as_dvec3().length());

    let limb = *document.rig.targets[index].limb().expect("a limb");
    let (down, forward, pointer) = (DVec3::NEG_Y, DVec3::Z, target.normalize());
    let side = match limb.reference {
        TwistReferenceKind::Up => DVec3::Y,
        TwistReferenceKind::Pole => limb.pole.expect("a pole").as_dvec3() - hip,
        TwistReferenceKind::Stereographic => DQuat::from_rotation_arc(down, pointer) * forward,
        other => panic!("{other:?}"),
    };
    let side = side.reject_from_normalized(pointer).normalize();
    let side = DQuat::from_axis_angle(pointer, f64::from(limb.twist)) * side;
    let [upper, lower] = lengths;
    let distance = target.length().min(upper + lower);
    let along = (upper * upper - lower * lower + distance * distance) / (2.0 * distance);
    let out = (upper * upper - along * along).max(0.0).sqrt();
    Leg { target, knee: pointer * along + side * out, lengths }
}

/// Ratio of the knee's way to the target's, and the ratio above which it is a pop: twice that of a
/// leg that turns about its hip without bending.
fn ratio(before: Leg, after: Leg) -> (f64, f64) {
    let [upper, lower] = after.lengths;
    let length = upper + lower;
    let way = before.target.distance(after.target).max(1e-3 * length);
    let nearest = before.target.length().min(after.target.length()).min(length);
    let stiff = upper / nearest.max(0.2 * length);
    (before.knee.distance(after.knee) / way, 2.0 * stiff.max(1.0))
}

#[test]
fn the_knees_of_walk_are_where_the_law_of_cosines_puts_them() {
    let mut random = Random(3601);
    for reference in
        [TwistReferenceKind::Up, TwistReferenceKind::Pole, TwistReferenceKind::Stereographic]
    {
        let pole = Vec3::new(0.0, -0.4, 0.5);
        let document = walk_by(reference, pole, random.within(-0.5..0.5), 0.97);
        let track = Track::new(&document);
        for frame in 0..document.timeline.frames() {
            let time = document.timeline.time(frame);
            let posed = track.at(time);
            let pelvis = posed.skeleton().full_transform(joint(&document, "pelvis"));
            for (side, [thigh, shin]) in LEGS.into_iter().enumerate() {
                let hip = document.skeleton()[joint(&document, thigh)].offset;
                let knee = pelvis.transform_point3(hip + leg(&track, time, side).knee.as_vec3());
                let found = posed.skeleton().base(joint(&document, shin));
                assert!(found.distance(knee) < 1e-5, "{reference:?}, {time}: {found}, not {knee}");
            }
        }
    }
}

#[test]
fn pops_of_the_legs_of_walk_are_found_where_an_own_derivative_finds_them() {
    let mut random = Random(3602);
    let mut all = 0;
    for case in 0..40 {
        let reference = random.one_of(&[
            TwistReferenceKind::Up,
            TwistReferenceKind::Pole,
            TwistReferenceKind::Pole,
            TwistReferenceKind::Stereographic,
        ]);
        // Below the hips, so that legs swing over it.
        let pole = Vec3::new(random.within(-0.15..0.15), -0.5, random.within(-0.3..0.3));
        let (twist, shin) = (random.within(-0.6..0.6), random.within(0.88..1.0));
        let document = walk_by(reference, pole, twist, shin);
        let frame_rate = random.one_of(&[24.0, 60.0]);
        let frames = Timeline { frame_rate, ..document.timeline };
        let track = Track::new(&document);
        let found = block_on(Inspection::new(&track, frames, false, async |_| true))
            .expect("not cancelled")
            .pops;
        for (side, [_, shin]) in LEGS.into_iter().enumerate() {
            let target = joint(&document, shin);
            let legs: Vec<Leg> =
                (0..frames.frames()).map(|frame| leg(&track, frames.time(frame), side)).collect();
            for (frame, pair) in legs.windows(2).enumerate() {
                let (ratio, limit) = ratio(pair[0], pair[1]);
                let time = frames.time(frame + 1);
                let pop = found.iter().find(|it| {
                    it.pop.target == target && (it.time - time).abs() < 0.5 / frame_rate
                });
                // Near the limit, rounding decides.
                if (ratio / limit - 1.0).abs() > 0.02 {
                    assert_eq!(
                        pop.is_some(),
                        ratio > limit,
                        "{case}, {reference:?}, {shin} at {time}: {ratio} of {limit}"
                    );
                }
                if let Some(found) = pop {
                    let off = (f64::from(found.pop.ratio) / ratio - 1.0).abs();
                    assert!(off < 0.05, "{case}, {shin} at {time}: {} is {ratio}", found.pop.ratio);
                    let is_named =
                        matches!(found.pop.cause, RigPopCause::Singular | RigPopCause::Straight);
                    assert!(is_named, "{case}, {shin} at {time}: {:?}", found.pop.cause);
                    all += 1;
                }
            }
        }
    }
    assert!(all > 50, "{all} pops");
}

/// With the limits of its hips, the legs cannot follow *Up*, which jumps: the limits turn the knees
/// aside, so that neither they nor the feet jump.
#[test]
fn the_limits_of_the_hips_turn_knees_aside_that_would_jump() {
    let mut document = walk();
    for target in &mut document.rig.targets {
        target.limb_mut().expect("a limb").reference = TwistReferenceKind::Up;
    }
    let track = Track::new(&document);
    let found = block_on(Inspection::new(&track, document.timeline, false, async |_| true))
        .expect("not cancelled");
    assert_eq!(found.pops, vec![]);
    let mut aside = 0;
    for frame in 0..document.timeline.frames() {
        let posed = track.at(document.timeline.time(frame));
        for [_, shin] in LEGS {
            let shin = joint(&document, shin);
            assert!(posed.target_report(shin).expect("a report").error < 1e-4, "{frame}");
            let limb = posed.limb_frames(shin).expect("a limb");
            aside += usize::from(limb.turned_aside.abs() > 1.0);
        }
    }
    assert!(aside > 20, "{aside} knees are turned aside");
}

/// A leg that walks under its hip: neither its Limb nor its twist jumps, in the example as it is.
#[test]
fn the_legs_of_walk_do_not_jump() {
    let document = walk();
    let track = Track::new(&document);
    let frames = Timeline { frame_rate: 240.0, ..document.timeline };
    let found = block_on(Inspection::new(&track, document.timeline, false, async |_| true))
        .expect("not cancelled");
    assert_eq!(found.pops, vec![]);
    for [_, shin] in LEGS {
        let target = joint(&document, shin);
        let frames: Vec<_> = (0..frames.frames())
            .map(|frame| {
                let limb = track.at(frames.time(frame)).limb_frames(target).expect("a limb");
                let turn = limb.pose().pointer.limb_frame().as_dmat3();
                (DQuat::from_mat3(&turn), f64::from(limb.posed.twist))
            })
            .collect();
        for (step, pair) in frames.windows(2).enumerate() {
            let turned = pair[0].0.angle_between(pair[1].0);
            let twisted = (pair[1].1 - pair[0].1 + TAU / 2.0).rem_euclid(TAU) - TAU / 2.0;
            assert!(turned < 0.1 && twisted.abs() < 0.1, "{step}: {turned}, {twisted}");
        }
    }
}
