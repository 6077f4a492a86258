//! Documents evaluated at a time.

use crate::common::arm::{ArmDocument, channels};
use std::f64::consts::{PI, TAU};

use glam::{DQuat, Vec3};
use ik_arm::document::{Channel, Document, Keys, Overlay, Target, Timeline};
use ik_arm::kinematics::skeleton::{JointId, Limit};
use ik_arm::kinematics::spline::{Interpolation, Knot, Spline};

use crate::common::Random;
use crate::common::documents::example;

fn number(value: f32) -> Vec3 {
    Vec3::new(value, 0.0, 0.0)
}

fn human() -> Document {
    example("human")
}

#[test]
fn setting_a_channel_changes_its_value_alone() {
    let document = human();
    let (point, on) = (Vec3::new(1.5, -2.5, 0.25), Vec3::ZERO);
    for (channel, value) in [
        (Channel::Length(JointId::new(2)), number(123.0)),
        (Channel::TargetTwist(JointId::new(14)), number(1.25)),
        (Channel::Translation, point),
        (Channel::Rotation(JointId::new(2)), Vec3::new(0.1, 0.05, -0.1)),
        (Channel::Offset(JointId::new(2)), point),
        (Channel::SkinScale(JointId::new(2)), point),
        (Channel::SkinShear(JointId::new(2)), point),
        (Channel::Target(JointId::new(14)), point),
        (Channel::Enabled(JointId::new(14)), on),
        (Channel::Overlay(Overlay::Cursor), on),
    ] {
        let mut keyed = document.clone();
        keyed.keys.insert(channel, 1.0, value);
        let mut posed = keyed.at(7.0).into_document();
        assert_eq!(channel.value(&posed), Some(value), "{channel:?}");
        channel.set(&mut posed, channel.value(&document).expect("there"));
        posed.keys = Keys::default();
        assert_eq!(posed, document, "{channel:?}");
    }
}

#[test]
fn a_document_without_keys_is_the_same_at_every_time() {
    let document = human();
    assert_eq!(document.at(3.0).into_document(), document);
}

#[test]
fn a_keyed_hand_goes_along_a_spline() {
    let mut document = Document::default();
    for (time, x) in [(0.0, 0.0), (1.0, 100.0), (3.0, 400.0), (4.0, 300.0)] {
        document.keys.insert(channels::HAND, time, Vec3::new(x, 2.0 * x, 5.0));
    }
    // 8/3 · 100: see the spline's tests.
    let hand = document.at(2.0).into_document().arm().cursor_in_root();
    assert!(hand.distance(Vec3::new(266.666_67, 533.333_3, 5.0)) < 1e-3, "{hand}");
}

#[test]
fn lengths_stay_above_0_where_their_spline_does_not() {
    let mut document = Document::default();
    for (time, length) in [(0.0, 1000.0), (1.0, 10.0), (2.0, 10.0), (3.0, 1000.0)] {
        document.keys.insert(channels::UPPER_LENGTH, time, number(length));
    }
    let upper = |time| document.at(time).into_document().arm().bones.upper();
    assert_eq!(upper(1.5), 1.0);
    assert_eq!((upper(0.0), upper(1.0), upper(9.0)), (1000.0, 10.0, 1000.0));
    for step in 0..400 {
        let arm = document.at(f64::from(step) * 0.01).into_document().arm();
        assert!(arm.bones.upper() > 0.0 && arm.pose().elbow.is_finite());
    }
}

#[test]
fn angles_stay_within_the_limits_of_their_joint() {
    let mut document = human();
    let limits = [Some(Limit { min: -0.5, max: 0.5 }), None, None];
    document
        .skeleton_mut()
        .change(JointId::new(1), |joint| joint.limits = limits.into())
        .expect("possible");
    document.keys.insert(Channel::Rotation(JointId::new(1)), 0.0, Vec3::new(3.0, 30.0, -3.0));
    let joint = document.at(0.0).into_document().skeleton().joints()[1].clone();
    assert_eq!(joint.rotation, Vec3::new(0.5, 30.0, -3.0));
}

#[test]
fn switches_step() {
    let mut document = Document::default();
    let limit = Channel::Overlay(Overlay::OuterLimit);
    for (time, on) in [(1.0, 1.0), (2.0, 0.0)] {
        document.keys.insert(limit, time, number(on));
    }
    let shown = |time| document.at(time).into_document().display.shows(Overlay::OuterLimit);
    assert_eq!([0.0, 1.0, 1.99, 2.0].map(shown), [true, true, true, false]);
}

#[test]
fn huge_values_stay_finite() {
    let mut document = Document::default();
    for (time, x) in [(0.0, f32::MAX), (1.0, f32::MAX), (1.5, f32::MIN), (2.0, f32::MAX)] {
        document.keys.insert(channels::HAND, time, Vec3::splat(x));
        document.keys.insert(channels::TWIST, time, number(x));
        document.keys.insert(channels::UPPER_LENGTH, time, number(x.abs()));
    }
    for step in 0..100 {
        let arm = document.at(f64::from(step) * 0.03).into_document().arm();
        assert!(arm.cursor_in_root().is_finite() && arm.twist.is_finite(), "{arm:?}");
        assert!(arm.pose().hand.is_finite());
    }
}

#[test]
fn keys_that_are_not_finite_are_refused() {
    let mut keys = Keys::default();
    keys.insert(channels::HAND, f64::NAN, Vec3::ZERO);
    keys.insert(channels::HAND, 0.0, Vec3::new(0.0, f32::INFINITY, 0.0));
    assert!(keys.is_empty());
}

#[test]
fn keys_follow_their_joints() {
    let mut document = human();
    let target: &Target = &document.rig.targets[0];
    let (hand, joints) = (target.joint, document.skeleton().joints().to_vec());
    for joint in [hand, JointId::new(15)] {
        document.keys.insert(Channel::Rotation(joint), 0.0, Vec3::X);
    }
    document.keys.insert(channels::ROOT_OFFSET, 0.0, Vec3::X);
    let moved = document.skeleton_mut().remove(&[hand]).expect("removed");
    document.keys.remap(&moved);
    let tracks: Vec<Channel> = document.keys.tracks().map(|(channel, _)| channel).collect();
    let foot = document.skeleton().find(&joints[15].name).expect("it is still there");
    assert_eq!(tracks, [Channel::Rotation(foot), channels::ROOT_OFFSET]);
}

#[test]
fn the_frame_count_includes_both_ends() {
    let timeline = Timeline { start: 1.0, end: 2.0, frame_rate: 24.0 };
    assert_eq!((timeline.frames(), timeline.time(24)), (25, 2.0));
    assert_eq!(Timeline { end: 2.02, ..timeline }.frames(), 25);
    assert_eq!(timeline.snapped(1.49), 36.0 / 24.0);
    assert_eq!(timeline.snapped(1.47), 35.0 / 24.0);
    let third = Timeline { start: 0.1, end: 0.1 + 1.0 / 3.0, frame_rate: 30.0 };
    assert_eq!(third.frames(), 11);
}

#[test]
fn slerp_turns_a_joint_the_shortest_way_at_constant_speed() {
    let mut random = Random(77);
    let channel = Channel::Rotation(JointId::new(0));
    let turn = |angles: Vec3| {
        let Vec3 { x, y, z } = angles;
        let [x, y, z] = [x, y, z].map(f64::from);
        DQuat::from_rotation_z(z) * DQuat::from_rotation_y(y) * DQuat::from_rotation_x(x)
    };
    for _ in 0..200 {
        let (from, to) = (random.vector(8.0), random.vector(8.0));
        let mut keys = Keys::default();
        for (time, value) in [(1.0, from), (3.0, to)] {
            let interpolation = Interpolation::Slerp;
            keys.insert_key(channel, Knot { interpolation, ..Knot::new(time, value) });
        }
        let (axis, angle) = (turn(from).inverse() * turn(to)).to_axis_angle();
        let angle = if angle > PI { angle - TAU } else { angle };
        for part in [0.0, 0.1, 0.5, 0.9, 0.999] {
            let found = turn(keys.value(channel, 1.0 + 2.0 * part).expect("keyed"));
            let expected = turn(from) * DQuat::from_axis_angle(axis, part * angle);
            assert!(found.angle_between(expected) < 5e-6, "{from} to {to} at {part}");
        }
        assert_eq!((keys.value(channel, 0.0), keys.value(channel, 3.0)), (Some(from), Some(to)));
    }
}

#[test]
fn frames_of_any_rate_are_whole_at_the_start_and_a_frame_apart() {
    let mut random = Random(31);
    let rates = [24.0, 30e3 / 1001.0, 33.33, 119.88, 0.37, 1000.0];
    for frame_rate in rates {
        for _ in 0..50 {
            let start = f64::from(random.within(-3.0..3.0));
            let timeline = Timeline { start, end: start + 40.0, frame_rate };
            let first = timeline.number(start);
            assert!((first - first.round()).abs() < 1e-5, "{timeline:?}: {first}");
            for frame in 0..timeline.frames().min(300) {
                let time = timeline.time(frame);
                let number = timeline.number(time);
                assert!((number - first - frame as f64).abs() < 1e-6, "{timeline:?}: {number}");
                assert!((timeline.time_of_number(number.round()) - time).abs() < 1e-6);
                let near = time + 0.4 / frame_rate;
                assert!((timeline.snapped(near) - time).abs() < 1e-6, "{timeline:?}");
            }
        }
    }
}

/// A switch and points with keys at random times, some of them at the same times.
fn pinned_at_random(random: &mut Random) -> Keys {
    let mut keys = Keys::default();
    let time = |random: &mut Random| f64::from(random.within(0.0..8.0).round()) / 2.0;
    for _ in 0..1 + random.below(5) {
        keys.insert(channels::PINNED, time(random), number(random.below(2) as f32));
    }
    for channel in [channels::HAND, channels::PIN] {
        for _ in 0..1 + random.below(6) {
            keys.insert(channel, time(random), random.vector(100.0));
        }
    }
    keys
}

/// Times before, at, between and after all keys.
fn samples() -> impl Iterator<Item = f64> {
    (-4..40).map(|step| f64::from(step) * 0.125)
}

/// The spline through the knots of a track for which `is_own` holds.
fn part(track: &Spline<Vec3>, is_own: impl Fn(f64) -> bool) -> Spline<Vec3> {
    track.knots().iter().filter(|knot| is_own(knot.time)).copied().collect()
}

#[test]
fn a_plant_has_a_spline_through_its_own_keys() {
    let mut random = Random(0x91a);
    for _ in 0..2_000 {
        let keys = pinned_at_random(&mut random);
        let (track, is_on) = (keys.track(channels::PIN), |at| keys.value(channels::PINNED, at));
        let track = track.expect("keyed");
        for time in samples() {
            // The switch does not change from the time to the key.
            let is_own = |key: f64| {
                let is_between = |at: &f64| (key.min(time)..key.max(time)).contains(at);
                samples().filter(is_between).chain([time]).all(|at| is_on(at) == is_on(time))
            };
            let expected = part(track, is_own).at(time).or_else(|| track.step(time));
            assert_eq!(keys.value(channels::PIN, time), expected, "at {time} of {keys:?}");
        }
    }
}

#[test]
fn a_key_of_the_hand_in_a_plant_ends_its_spline() {
    let mut random = Random(0x4a4d);
    for _ in 0..2_000 {
        let keys = pinned_at_random(&mut random);
        let track = keys.track(channels::HAND).expect("keyed");
        let is_on = |at| keys.value(channels::PINNED, at) == Some(Vec3::X);
        let times = || track.knots().iter().map(|knot| knot.time);
        let planted: Vec<f64> = times().filter(|at| is_on(*at) || is_on(*at - 0.125)).collect();
        for time in samples() {
            let is_own = |key: f64| {
                if key <= time {
                    !planted.iter().any(|end| key < *end && *end <= time)
                } else {
                    !planted.iter().any(|end| time < *end && *end < key)
                }
            };
            let expected = part(track, is_own).at(time);
            assert_eq!(keys.value(channels::HAND, time), expected, "at {time} of {keys:?}");
        }
    }
}

#[test]
fn without_keys_of_the_switch_hand_and_pin_follow_all_their_keys() {
    let mut random = Random(0x5711);
    for _ in 0..200 {
        let mut keys = pinned_at_random(&mut random);
        keys.clear(channels::PINNED);
        for (channel, track) in keys.tracks() {
            assert!(samples().all(|time| keys.value(channel, time) == track.at(time)));
        }
    }
}
