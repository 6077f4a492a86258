//! Section 3 of Palmieri's report, every kind of input, and accuracy against an f64 solution.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::{DMat3, DVec3, Vec2, Vec3};
use ik_arm_kinematics::two_bone::{Pointer, Reach, TwoBone, TwoBonePose};
use proptest::prelude::*;
use proptest::test_runner::TestCaseResult;

use crate::common::strategies::{
    Case, EXACT, U, anywhere, arms, bones, config, directions, either_sign, in_reach,
    limb_rotation, limits, out_of_reach, within, yaw_and_pitch,
};

/// The same arm in f64 by another method: angles from half-angle tangents, which stay accurate near
/// a straight or folded arm (L, δ and D ± δ are exact or nearly so in f64), then rotation matrices.
struct Twin {
    distance: f64,
    shoulder_angle: f64,
    elbow_angle: f64,
    /// In Socket space.
    elbow_socket: DVec3,
    elbow: DVec3,
    hand: DVec3,
}

impl Twin {
    fn new(arm: TwoBone, asked: f64, pointer: (f64, f64), twist: f32) -> Self {
        let (upper, lower) = bones(arm);
        let (inner, outer) = limits(arm);
        let (distance, difference) = (asked.clamp(inner, outer), upper - lower);
        // tan²(θ_e/2) = near/far, tan²(φ/2) = folded/straight
        let near = (outer - distance) * (distance - difference);
        let far = (outer + distance) * (distance + difference);
        let folded = (distance - difference) * (distance + difference);
        let straight = (outer - distance) * (outer + distance);
        let shoulder_angle =
            if distance == 0.0 { FRAC_PI_2 } else { 2.0 * near.sqrt().atan2(far.sqrt()) };
        let elbow_socket = DMat3::from_rotation_z(shoulder_angle) * (DVec3::X * upper);
        let socket = limb_rotation(pointer) * DMat3::from_rotation_x(twist.into());
        Self {
            distance,
            shoulder_angle,
            elbow_angle: 2.0 * folded.sqrt().atan2(straight.sqrt()),
            elbow_socket,
            elbow: socket * elbow_socket,
            hand: socket * (DVec3::X * distance),
        }
    }

    /// The elbow is ill-conditioned near a straight or folded arm.
    fn elbow_bound(&self, length: f64) -> f64 {
        let well_bent = (1.0..=179.0).contains(&self.elbow_angle.to_degrees());
        length * if well_bent { 1e-5 } else { 1e-3 }
    }
}

/// Compares points and limb lengths with the twin's, where the caller knows the pointer.
fn agrees(pose: &TwoBonePose, arm: TwoBone, twin: &Twin) -> TestCaseResult {
    let length = limits(arm).1;
    let (elbow, hand) = (pose.elbow.as_dvec3(), pose.hand.as_dvec3());
    within("hand", hand.distance(twin.hand), EXACT * length)?;
    within("elbow", elbow.distance(twin.elbow), twin.elbow_bound(length))?;
    within("upper length", (elbow.length() - bones(arm).0).abs(), EXACT * length)?;
    within("lower length", (elbow.distance(hand) - bones(arm).1).abs(), EXACT * length)
}

/// The same number, −0 told from 0.
fn bits(v: Vec3) -> [u32; 3] {
    v.to_array().map(f32::to_bits)
}

/// Expected reach of the cursor, in f64.
fn reach(arm: TwoBone, cursor: Vec3) -> Reach {
    let ((inner, outer), asked) = (limits(arm), cursor.as_dvec3().length());
    if asked > outer {
        Reach::TooFar
    } else if asked < inner {
        Reach::TooClose
    } else {
        Reach::Reached
    }
}

proptest! {
    #![proptest_config(config(10_000, 0x2014_1a4e))]

    #[test]
    fn between_the_limits_the_hand_is_the_cursor_bit_for_bit(case in in_reach()) {
        let pose = case.solve();
        prop_assert_eq!(pose.reach, Some(Reach::Reached));
        prop_assert_eq!(bits(pose.hand), bits(case.cursor));
    }

    #[test]
    fn beyond_a_limit_the_hand_is_on_its_sphere_and_on_the_line_to_the_cursor(
        case in out_of_reach()
    ) {
        let pose = case.solve();
        prop_assert_eq!(pose.reach.unwrap(), reach(case.arm, case.cursor));
        let (inner, outer) = limits(case.arm);
        let limit = if pose.reach == Some(Reach::TooFar) { outer } else { inner };
        let hand = pose.hand.as_dvec3();
        let line = case.cursor.as_dvec3().try_normalize().unwrap_or(DVec3::X);
        within("hand from the sphere", (hand.length() - limit).abs(), EXACT * outer)?;
        within("hand from the line", hand.distance(line * hand.dot(line)), EXACT * outer)?;
        prop_assert!(hand.dot(line) >= 0.0, "the hand is behind the shoulder");
        prop_assert_eq!(pose.out, 0.0, "the arm is not straight or folded");
    }

    #[test]
    fn moving_one_coordinate_leaves_the_other_two_of_the_hand(
        case in in_reach(), axis in 0..3_usize, share in either_sign(0.0..1.0),
    ) {
        // From where the moved cursor leaves the inner limit to where it meets the outer one, clear
        // of both by eight roundings.
        let mut kept = case.cursor.as_dvec3();
        kept[axis] = 0.0;
        let (inner, outer) = limits(case.arm);
        let [from, to] = [inner * (1.0 + 8.0 * U), outer * (1.0 - 8.0 * U)]
            .map(|limit| (limit * limit - kept.length_squared()).max(0.0).sqrt());
        let mut moved = case.cursor;
        moved[axis] = (from.copysign(share) + (to - from) * share) as f32;

        let (before, after) = (case.solve().hand, Case { cursor: moved, ..case }.solve().hand);
        for other in 0..3 {
            let expected = if other == axis { moved } else { before };
            prop_assert_eq!(after[other].to_bits(), expected[other].to_bits());
        }
    }

    #[test]
    fn twist_turns_the_elbow_about_the_pointer_and_keeps_the_hand(case in anywhere()) {
        let (still, twisted) = (Case { twist: 0.0, ..case }.solve(), case.solve());
        let untwisted = TwoBonePose { elbow: still.elbow, twist: still.twist, ..twisted };
        prop_assert_eq!(untwisted, still, "more than the elbow moved");

        let axis = case.cursor.as_dvec3().try_normalize().unwrap_or(DVec3::X);
        let (elbow, (sin, cos)) = (still.elbow.as_dvec3(), f64::from(case.twist).sin_cos());
        let rodrigues =
            elbow * cos + axis.cross(elbow) * sin + axis * axis.dot(elbow) * (1.0 - cos);
        let error = twisted.elbow.as_dvec3().distance(rodrigues);
        within("spun elbow", error, EXACT * limits(case.arm).1)?;
    }

    #[test]
    fn points_and_limb_lengths_agree_with_the_f64_twin(case in anywhere()) {
        let Case { arm, cursor, twist } = case;
        let asked = cursor.as_dvec3().length();
        agrees(&case.solve(), arm, &Twin::new(arm, asked, yaw_and_pitch(cursor), twist))?;
    }

    #[test]
    fn distances_and_angles_agree_with_the_f64_twin(case in anywhere()) {
        let Case { arm, cursor, twist } = case;
        let ((upper, lower), (_, length)) = (bones(arm), limits(arm));
        let (pose, (yaw, pitch)) = (case.solve(), yaw_and_pitch(cursor));
        let twin = Twin::new(arm, cursor.as_dvec3().length(), (yaw, pitch), twist);

        // |c| is 2.5 U of itself off: three roundings under the root, halved, and the root's own.
        // L and |δ| are U off; a clamp adds nothing to the largest.
        let distance = f64::from(pose.distance);
        within("D", (distance - twin.distance).abs(), 2.5 * U * length)?;

        // D's 2.5 U move h_e by |D − h_e| ≤ d₂ times as much. Let m be the smaller of d₁ − h_e and
        // d₁ + h_e; it is at most the shorter bone. L's and δ's roundings (δ has none up to 2 : 1)
        // move m by (D ± δ)/2D and (L ± D)/2D times as much, its own five by 5 U of it, and d₁ − m
        // is rounded once. The sum is largest for equal bones: 1.25 + 0.5 + 2.5 + 0.5 U of L.
        let along = f64::from(pose.along);
        within("along", (along - twin.elbow_socket.x).abs(), 4.75 * U * length)?;

        // A coordinate of the elbow is as good as the elbow.
        let bound = twin.elbow_bound(length);
        within("out", (f64::from(pose.out) - twin.elbow_socket.y).abs(), bound)?;

        // A common factor turns nothing; rounding each coordinate of a direction by U turns it by
        // U at most (θ_y: 2 U, its hypot adds as much). Then atan2, good to a unit in the last
        // place: 4 U of an angle up to π, 2 U up to π/2.
        let turned = (f64::from(pose.yaw()) - yaw).abs();
        within("yaw", turned.min(TAU - turned), (1.0 + 4.0) * U)?;
        within("pitch", (f64::from(pose.pitch()) - pitch).abs(), (2.0 + 2.0) * U)?;

        // A point off by e at radius r is seen off by asin(e/r) ≤ π/2 · e/r.
        let off = FRAC_PI_2 * bound.hypot(4.75 * U * length);
        let at_shoulder = (f64::from(pose.shoulder_angle()) - twin.shoulder_angle).abs();
        within("shoulder angle", at_shoulder, off / upper + 4.0 * U)?;
        // π, two angles and two differences are rounded: five times 4 U at most.
        let at_elbow = (f64::from(pose.elbow_angle()) - twin.elbow_angle).abs();
        within("elbow angle", at_elbow, off / upper + off / lower + 20.0 * U)?;
    }

    #[test]
    fn at_the_shoulder_the_hand_keeps_the_last_direction_or_points_along_x(
        arm in arms(), twist in -10.0..10.0_f32, last in directions()
    ) {
        let equal = arm.upper() == arm.lower();
        let last = last.as_vec3();
        for (pose, way) in [
            (arm.solve(Vec3::ZERO, twist), Vec3::X),
            (arm.solve_from(Vec3::ZERO, twist, arm.solve(last, 0.0).pointer), last),
        ] {
            prop_assert_eq!(pose.reach.unwrap(), if equal { Reach::Reached } else { Reach::TooClose });
            agrees(&pose, arm, &Twin::new(arm, 0.0, yaw_and_pitch(way), twist))?;
        }
    }

    #[test]
    fn straight_above_and_below_the_yaw_is_the_last_or_none(
        case in anywhere(), last in directions(), up in either_sign(Just(1.0)),
    ) {
        let Case { arm, cursor, twist } = case;
        let height = (cursor.as_dvec3().length() as f32).max(f32::from_bits(1));
        let (cursor, pitch) = (Vec3::Y * height * up, FRAC_PI_2 * f64::from(up));
        let last = last.as_vec3();
        for (pose, yaw) in [
            (arm.solve(cursor, twist), 0.0),
            (arm.solve_from(cursor, twist, arm.solve(last, 0.0).pointer), yaw_and_pitch(last).0),
        ] {
            agrees(&pose, arm, &Twin::new(arm, height.into(), (yaw, pitch), twist))?;
        }
    }

    #[test]
    fn a_cursor_exactly_at_a_limit_is_reached_and_the_next_float_is_not(
        arm in arms(), axis in either_sign(prop::sample::select(&Vec3::AXES)),
    ) {
        let (inner, outer) = (arm.inner_limit(), arm.outer_limit());
        let reach = |radius: f32| arm.solve(axis * radius, 1.0).reach.unwrap();
        prop_assert_eq!(reach(outer), Reach::Reached);
        prop_assert_eq!(reach(outer.next_up()), Reach::TooFar);
        prop_assert_eq!(reach(inner), Reach::Reached);
        if inner > 0.0 {
            prop_assert_eq!(reach(inner.next_down()), Reach::TooClose);
        }
    }

    #[test]
    fn every_finite_cursor_gives_a_finite_pose(
        upper in sizes(), lower in sizes(), equal in prop::bool::ANY,
        cursor in [either_sign(sizes()), either_sign(sizes()), either_sign(sizes())],
        twist in either_sign(sizes()),
    ) {
        let [upper, lower] = [upper, lower].map(|length| length.max(f32::from_bits(1)));
        let arm = TwoBone::new(upper, if equal { upper } else { lower }).unwrap();
        let cursor = Vec3::from_array(cursor);
        let pose = arm.solve(cursor, twist);
        let TwoBonePose { elbow, hand, distance, along, out, pointer, .. } = pose;
        prop_assert!(elbow.is_finite() && hand.is_finite(), "{:?}", pose);
        prop_assert!(distance.is_finite() && along.is_finite() && out.is_finite(), "{:?}", pose);
        prop_assert!(pointer.direction.is_normalized() && pointer.heading.is_normalized());
        prop_assert!((0.0..=PI as f32).contains(&pose.shoulder_angle()));
        prop_assert!(pose.yaw().is_finite() && pose.pitch().is_finite());
        prop_assert!(pose.elbow_angle().is_finite() && arm.outer_limit().is_finite());
        let (inner, outer) = limits(arm);
        let length_error = (elbow.as_dvec3().length() - f64::from(arm.upper())).abs();
        within("upper length", length_error, EXACT * outer + f64::from(f32::from_bits(2)))?;
        let asked = cursor.as_dvec3().length();
        if [inner, outer].iter().all(|limit| (asked - limit).abs() > 8.0 * U * limit) {
            prop_assert_eq!(pose.reach.unwrap(), reach(arm, cursor));
        }
    }

    #[test]
    fn scaling_by_a_power_of_two_keeps_the_pose(case in in_reach(), power in 0..=100) {
        let scaled = |case: Case, factor: f32| Case {
            arm: TwoBone::new(case.arm.upper() * factor, case.arm.lower() * factor).unwrap(),
            cursor: case.cursor * factor,
            ..case
        };
        let (small, factor) = (scaled(case, 2.0_f32.powi(-60)), 2.0_f32.powi(power));
        let (large, small) = (scaled(small, factor).solve(), small.solve());
        prop_assert_eq!(large.elbow / factor, small.elbow);
        prop_assert_eq!(large.hand / factor, small.hand);
    }
}

/// Any number from 0 to the largest, often at either end.
fn sizes() -> impl Strategy<Value = f32> + Clone {
    use prop::num::f32::{NORMAL, POSITIVE, SUBNORMAL, ZERO};
    prop_oneof![
        4 => POSITIVE | NORMAL | SUBNORMAL | ZERO,
        2 => POSITIVE | SUBNORMAL,
        1 => prop::sample::select(vec![0.0, f32::from_bits(1), f32::MIN_POSITIVE, 1.0, f32::MAX]),
    ]
}

#[test]
fn an_invalid_length_is_refused_by_name_and_value() {
    for value in [0.0, -0.0, -1.5, f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for (bone, lengths) in [("upper", (value, 1.0)), ("lower", (1.0, value))] {
            let message = TwoBone::new(lengths.0, lengths.1).unwrap_err().to_string();
            let named = format!("{bone} length must be finite and above 0, got {value}");
            assert!(message.eq(&named), "{message}");
        }
    }
}

#[test]
#[cfg(debug_assertions)]
#[should_panic(expected = "cursor is [1, NaN, 0]")]
fn a_cursor_that_is_not_finite_panics() {
    let _ = TwoBone::new(2.0, 3.0).unwrap().solve(Vec3::new(1.0, f32::NAN, 0.0), 0.0);
}

#[test]
fn the_default_pointer_faces_x() {
    assert_eq!(Pointer::default(), Pointer { direction: Vec3::X, heading: Vec2::X });
}

#[test]
fn poses_agree_with_the_original_program() {
    let file = include_str!("../data/original-poses.json");
    let poses = serde_json::from_str::<serde_json::Value>(file).unwrap();
    let arm = TwoBone::new(200.0, 300.0).unwrap();
    let mut reached = 0;
    for row in poses["poses"].as_array().unwrap() {
        let point =
            |name: &str| DVec3::from_array([0, 1, 2].map(|i| row[name][i].as_f64().unwrap()));
        let (hand, root) = (point("hand"), point("root"));
        let twist = row["elbow_spin_deg"].as_f64().unwrap().to_radians();
        let pose = arm.solve(hand.as_vec3(), twist as f32);

        // The original stops 0.01 short of each limit: see "about" in the file.
        let between = (100.0..=500.0).contains(&hand.length());
        let (at_elbow, at_hand) = if between { (1e-3, 1e-3) } else { (1.6, 0.02) };
        let elbow_error = (root + pose.elbow.as_dvec3()).distance(point("elbow_world"));
        let hand_error = (root + pose.hand.as_dvec3()).distance(point("hand_world"));
        assert!(elbow_error <= at_elbow, "elbow off by {elbow_error}: {row}");
        assert!(hand_error <= at_hand, "hand off by {hand_error}: {row}");
        assert_eq!(pose.reach == Some(Reach::Reached), between, "{row}");
        reached += usize::from(between);
    }
    assert_eq!((poses["poses"].as_array().unwrap().len(), reached), (100, 61));
}

/// The original's poses have none that is too close.
#[test]
fn too_close_folds_the_arm_along_the_line_to_the_cursor() {
    let sevenths = Vec3::new(2.0, 3.0, 6.0) / 7.0;
    for (upper, lower, cursor, way) in [
        (200.0, 300.0, Vec3::new(50.0, 0.0, 0.0), Vec3::X),
        (200.0, 300.0, Vec3::new(0.0, -99.0, 0.0), Vec3::NEG_Y),
        (300.0, 200.0, Vec3::new(0.0, 0.0, 1e-30), Vec3::Z),
        (200.0, 300.0, Vec3::new(-20.0, -30.0, -60.0), -sevenths),
        (300.0, 200.0, Vec3::new(2.0, 3.0, 6.0), sevenths),
        (30.0, 1.0, Vec3::new(-8.0, 12.0, 24.0), sevenths * Vec3::new(-1.0, 1.0, 1.0)),
    ] {
        let pose = TwoBone::new(upper, lower).unwrap().solve(cursor, 1.0);
        assert_eq!(pose.reach, Some(Reach::TooClose));
        // A longer upper bone points at the cursor, a shorter one away from it.
        let elbow = way * if upper > lower { upper } else { -upper };
        let bound = EXACT as f32 * (upper + lower);
        assert!(pose.elbow.distance(elbow) <= bound, "{pose:?}");
        assert!(pose.hand.distance(way * (upper - lower).abs()) <= bound, "{pose:?}");
    }
}

/// Hash of the bits of elbows and hands.
fn digest(poses: impl Iterator<Item = TwoBonePose>) -> u64 {
    let coordinates = poses.flat_map(|pose| [pose.elbow, pose.hand]).flat_map(|it| it.to_array());
    // FNV-1a.
    coordinates.fold(0xcbf2_9ce4_8422_2325, |digest, coordinate| {
        (digest ^ u64::from(coordinate.to_bits())).wrapping_mul(0x0100_0000_01b3)
    })
}

#[test]
fn the_plain_arm_is_bit_identical_on_every_machine() {
    // The solver uses sums, products and roots only, which round alike on every machine.
    let arms = [(200.0, 300.0), (1.0, 1.0), (300.0, 10.0), (0.3, 0.3001)];
    let digests = arms.map(|(upper, lower)| {
        let arm = TwoBone::new(upper, lower).expect("lengths");
        let place = |step: u32| (step as f32 / 20.0 - 1.0) * 1.2 * (upper + lower);
        let places = (0..41 * 41 * 41_u32).map(move |index| {
            Vec3::new(place(index % 41), place(index / 41 % 41), place(index / 1681))
        });
        digest(places.map(|cursor| arm.solve(cursor, 0.0)))
    });
    let recorded = [
        0x97b1_83dd_57e8_f1c6,
        0xaecb_a919_44df_8046,
        0x2389_afdf_fddf_a043,
        0xf621_90fa_007f_cd7e,
    ];
    assert_eq!(digests, recorded, "{digests:x?}");
}
