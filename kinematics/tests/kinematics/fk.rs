//! The arm's joint angles: pose from angles, angles from a pose, and blends.

use std::f64::consts::PI;

use glam::{DMat3, DQuat, DVec3, Vec3};
use ik_arm_kinematics::angle;
use ik_arm_kinematics::fk::{Fk, blended, blended_limits};
use ik_arm_kinematics::ik::{Ik, IkState};
use ik_arm_kinematics::soft_reach::{ReachLimits, SoftReach};
use ik_arm_kinematics::twist::TwistReference;
use ik_arm_kinematics::two_bone::{Pointer, Reach, TwoBone, TwoBonePose};
use proptest::prelude::*;

use crate::common::strategies::{config, limits, references, uniform_directions};

fn arms() -> impl Strategy<Value = TwoBone> {
    let length = || (-2.0..4.0_f32).prop_map(|power| 10_f32.powf(power));
    (length(), -1.4..1.4_f32).prop_map(|(upper, ratio)| {
        TwoBone::new(upper, upper * 10_f32.powf(ratio)).expect("lengths")
    })
}

fn angles() -> impl Strategy<Value = Vec3> {
    let angle = || -3.1..3.1_f32;
    [angle(), angle(), angle()].prop_map(Vec3::from_array)
}

fn bends() -> impl Strategy<Value = f32> {
    prop_oneof![
        8 => -3.1..3.1_f32,
        1 => -0.02..0.02_f32,
        1 => 3.1..PI as f32,
        1 => prop_oneof![Just(0.0_f32), Just(core::f32::consts::PI)],
    ]
}

fn poles() -> impl Strategy<Value = Vec3> {
    uniform_directions().prop_map(glam::DVec3::as_vec3)
}

/// Elbow and hand by matrices, in f64.
fn twin(fk: Fk, bones: TwoBone) -> (DVec3, DVec3) {
    let shoulder = fk.shoulder.as_dvec3();
    let upper = DQuat::from_axis_angle(DVec3::Y, shoulder.y)
        * DQuat::from_axis_angle(DVec3::Z, shoulder.z)
        * DQuat::from_axis_angle(DVec3::X, shoulder.x);
    let lower = upper * DQuat::from_axis_angle(DVec3::Z, -f64::from(fk.bend));
    let elbow = upper * (DVec3::X * f64::from(bones.upper()));
    (elbow, elbow + lower * (DVec3::X * f64::from(bones.lower())))
}

fn apart(pose: &TwoBonePose, other: (DVec3, DVec3)) -> (f64, f64) {
    (pose.elbow.as_dvec3().distance(other.0), pose.hand.as_dvec3().distance(other.1))
}

fn elbow_tolerance(pose: &TwoBonePose) -> f64 {
    let angle = pose.elbow_angle().to_degrees();
    if (1.0..=179.0).contains(&angle) { 1e-5 } else { 5e-4 }
}

fn points(pose: &TwoBonePose) -> (DVec3, DVec3) {
    (pose.elbow.as_dvec3(), pose.hand.as_dvec3())
}

proptest! {
    #![proptest_config(config(10_000, 0x000f_ee1f))]

    #[test]
    fn a_pose_agrees_with_the_matrix_product_of_its_angles(
        bones in arms(), shoulder in angles(), bend in bends()
    ) {
        let fk = Fk { shoulder, bend, stretch: 1.0 };
        let pose = fk.pose(bones, Pointer::default());
        let (elbow, hand) = apart(&pose, twin(fk, bones));
        prop_assert!(elbow < 3e-7 * limits(bones).1 && hand < 3e-7 * limits(bones).1);
        // The hierarchy's rotations agree.
        let w = pose.pointer.direction.as_dvec3();
        let out = pose.outward().as_dvec3();
        let again = w * f64::from(pose.along) + out * f64::from(pose.out);
        prop_assert!(again.distance(pose.elbow.as_dvec3()) < 1e-6 * limits(bones).1);
        prop_assert!((w * f64::from(pose.distance)).distance(twin(fk, bones).1) < 5e-7 * limits(bones).1);
    }

    #[test]
    fn a_negative_bend_is_the_same_pose_with_the_shoulder_turned_about_the_limb(
        bones in arms(), shoulder in angles(), bend in bends()
    ) {
        let fk = Fk { shoulder, bend, stretch: 1.0 };
        let turned = Fk { shoulder: shoulder + Vec3::X * core::f32::consts::PI, bend: -bend, ..fk };
        let (elbow, hand) = apart(&fk.pose(bones, Pointer::default()), points(&turned.pose(bones, Pointer::default())));
        prop_assert!(elbow < 1e-6 * limits(bones).1 && hand < 1e-6 * limits(bones).1);
    }

    #[test]
    fn switching_from_fk_to_ik_and_back_keeps_the_pose(
        bones in arms(), shoulder in angles(), bend in bends(), reference in references(poles())
    ) {
        let fk = Fk { shoulder, bend, stretch: 1.0 };
        let pose = fk.pose(bones, Pointer::default());
        let ik = Ik { bones, reference, soft_reach: SoftReach::default() };
        let (cursor, twist) = ik.matching(&pose, None);
        let solved = ik.solve(cursor, twist, IkState { pointer: pose.pointer, transported: None }).pose;
        let again = Fk::matching(&solved, fk).pose(bones, solved.pointer);
        for found in [solved, again] {
            let (elbow, hand) = apart(&found, points(&pose));
            let l = limits(bones).1;
            prop_assert!(hand <= 1e-6 * l, "the hand is off by {}", hand / l);
            prop_assert!(elbow <= elbow_tolerance(&pose) * l, "the elbow is off by {}", elbow / l);
        }
    }

    #[test]
    fn switching_from_ik_to_fk_and_back_keeps_the_pose(
        bones in arms(), direction in uniform_directions(), part in 0.0..1.2_f32, twist in 0.0..6.2_f32,
        reference in references(poles())
    ) {
        let ik = Ik { bones, reference, soft_reach: SoftReach::default() };
        let cursor = direction.as_vec3() * part * bones.outer_limit();
        let solved = ik.solve(cursor, twist, IkState::default());
        let fk = Fk::matching(&solved.pose, Fk::default());
        let posed = fk.pose(bones, solved.pose.pointer);
        let (cursor, twist) = ik.matching(&posed, Some(solved.transported));
        let again = ik.solve(cursor, twist, IkState { pointer: posed.pointer, ..solved.state() }).pose;
        for found in [posed, again] {
            let (elbow, hand) = apart(&found, points(&solved.pose));
            let l = limits(bones).1;
            prop_assert!(hand <= 1e-6 * l, "the hand is off by {}", hand / l);
            prop_assert!(elbow <= elbow_tolerance(&solved.pose) * l, "the elbow is off by {}", elbow / l);
        }
    }

    #[test]
    fn matching_angles_stay_in_the_same_full_turn(shoulder in angles(), turns in -1..2_i32, bend in bends()) {
        let bones = TwoBone::new(2.0, 3.0).expect("lengths");
        let turned = f64::from(turns) * 2.0 * PI;
        let around = |angle: f32| (f64::from(angle) + turned) as f32;
        let last = Fk { shoulder: shoulder.map(around), bend: around(bend), stretch: 1.0 };
        let found = Fk::matching(&last.pose(bones, Pointer::default()), last);
        let degenerate = shoulder.z.cos().abs() < 1e-3 || bend.sin().abs() < 1e-3;
        prop_assert!(degenerate || found.shoulder.distance(last.shoulder) < 2e-3, "{:?} is not {:?}", found, last);
        prop_assert!((found.bend - last.bend).abs() < 2e-3 || degenerate, "{:?} is not {:?}", found, last);
    }

    #[test]
    fn blending_between_fk_and_ik_keeps_limb_lengths(
        bones in arms(), shoulder in angles(), bend in bends(), direction in uniform_directions(),
        part in 0.0..1.2_f32, weight in 0.0..=1.0_f32
    ) {
        let fk = Fk { shoulder, bend, stretch: 1.0 };
        let cursor = direction.as_vec3() * part * bones.outer_limit();
        let solved = bones.solve(cursor, 0.4);
        let pose = blended(fk, &solved, weight, bones, cursor);
        let l = limits(bones).1;
        let (elbow, hand) = points(&pose);
        prop_assert!((elbow.length() - f64::from(bones.upper())).abs() < 3e-7 * l);
        prop_assert!(((hand - elbow).length() - f64::from(bones.lower())).abs() < 4e-7 * l);
        prop_assert!(pose.reach != Some(Reach::Reached) || hand.distance(cursor.as_dvec3()) < 2e-6 * l);
        prop_assert_eq!(blended(fk, &solved, 1.0, bones, cursor), solved);
        let (elbow, hand) = apart(&blended(fk, &solved, 0.0, bones, cursor), twin(fk, bones));
        prop_assert!(elbow < 3e-7 * l && hand < 3e-7 * l);
    }

    #[test]
    fn half_way_between_fk_and_ik_the_upper_limb_has_made_half_its_rotation(
        shoulder in angles(), bend in 0.0..3.1_f32, direction in uniform_directions(), part in 0.3..0.9_f32
    ) {
        let bones = TwoBone::new(2.0, 3.0).expect("lengths");
        let cursor = direction.as_vec3() * part * 5.0;
        let solved = bones.solve(cursor, 0.4);
        let end = |weight| {
            let pose = blended(Fk { shoulder, bend, stretch: 1.0 }, &solved, weight, bones, cursor);
            let axes = frame(&pose);
            (DQuat::from_mat3(&axes), f64::from(pose.elbow_angle()))
        };
        let [(from, bent), (middle, half), (to, solved)] = [0.0, 0.5, 1.0].map(end);
        let turn = from.angle_between(to).min(from.angle_between(-to));
        prop_assume!(turn < 3.0);
        let [before, after] = [from, to].map(|end| {
            middle.angle_between(end).min(middle.angle_between(-end))
        });
        prop_assert!((before - 0.5 * turn).abs() < 1e-3 && (after - 0.5 * turn).abs() < 1e-3);
        prop_assert!((half - 0.5 * (bent + solved)).abs() < 1e-3);
    }
}

proptest! {
    #![proptest_config(config(20_000, 0x1111_1775))]

    #[test]
    fn the_hand_is_within_its_limits_whatever_the_blend(
        bones in arms(), shoulder in angles(), bend in bends(), stretch in 0.1..4.0_f32,
        soft_reach in soft_reaches(), direction in uniform_directions(), part in 0.0..6.0_f32,
        influence in influences()
    ) {
        let fk = Fk { shoulder, bend, stretch };
        let cursor = direction.as_vec3() * part * bones.outer_limit();
        let pose = blend(fk, soft_reach, influence, bones, cursor);
        let ReachLimits { inner, outer } = blended_limits(fk, soft_reach, influence, bones);
        let rounding = 1e-6 * outer;
        prop_assert!(
            inner - rounding <= pose.distance && pose.distance <= outer + rounding,
            "{} is not from {inner} to {outer}", pose.distance
        );
    }

    #[test]
    fn the_hand_reaches_both_limits_of_a_blend(
        bones in arms(), stretch in 0.1..4.0_f32, soft_reach in soft_reaches(), influence in influences()
    ) {
        let hard = SoftReach::new(0.0, soft_reach.max_stretch(), soft_reach.min_elbow_angle());
        let soft_reach = hard.expect("soft limits");
        let at = |bend, cursor| {
            let fk = Fk { shoulder: Vec3::ZERO, bend, stretch };
            f64::from(blend(fk, soft_reach, influence, bones, cursor).distance)
        };
        let ReachLimits { inner, outer } =
            blended_limits(Fk { stretch, ..Fk::default() }, soft_reach, influence, bones);
        let rounding = 1e-6 * f64::from(outer);
        let straight = at(0.0, Vec3::X * bones.outer_limit() * 20.0);
        prop_assert!((straight - f64::from(outer)).abs() <= rounding, "{straight} is not {outer}");
        let folded = at(PI as f32, Vec3::ZERO);
        prop_assert!((folded - f64::from(inner)).abs() <= rounding, "{folded} is not {inner}");
    }
}

fn soft_reaches() -> impl Strategy<Value = SoftReach> {
    let often_off = |off: f32, values: core::ops::Range<f32>| prop_oneof![Just(off), values];
    (often_off(0.0, 0.0..0.99), often_off(1.0, 1.0..4.0), often_off(0.0, 0.0..3.1)).prop_map(
        |(softness, stretch, angle)| SoftReach::new(softness, stretch, angle).expect("soft limits"),
    )
}

fn influences() -> impl Strategy<Value = f32> {
    prop_oneof![Just(0.0_f32), Just(1.0), 0.0..1.0_f32]
}

fn blend(
    fk: Fk,
    soft_reach: SoftReach,
    influence: f32,
    bones: TwoBone,
    cursor: Vec3,
) -> TwoBonePose {
    let ik = Ik { bones, reference: TwistReference::Up, soft_reach };
    let solved = ik.solve(cursor, 0.3, IkState::default()).pose;
    blended(fk, &solved, influence, bones, cursor)
}

/// The upper limb's axes as its points tell: x along it, z the hinge.
fn frame(pose: &TwoBonePose) -> DMat3 {
    let x = pose.elbow.as_dvec3().normalize();
    let z = pose.pointer.direction.as_dvec3().cross(pose.outward().as_dvec3()).normalize();
    DMat3::from_cols(x, z.cross(x), z)
}

#[test]
fn a_straight_arm_keeps_the_side_that_its_hinge_bends_to() {
    let bones = TwoBone::new(2.0, 3.0).expect("lengths");
    let ik = Ik { bones, reference: TwistReference::Up, soft_reach: SoftReach::default() };
    for twist in [0.0, 1.0, -2.5_f32] {
        for bend in [0.0, core::f32::consts::PI] {
            let fk = Fk { shoulder: Vec3::new(twist, 0.3, -0.7), bend, stretch: 1.0 };
            let pose = fk.pose(bones, Pointer::default());
            let (cursor, twist) = ik.matching(&pose, None);
            let solved = ik
                .solve(cursor * 0.999, twist, IkState { pointer: pose.pointer, transported: None })
                .pose;
            let hinge = DQuat::from_mat3(&angle::euler_rotation(fk.shoulder)) * DVec3::Z;
            let found = solved.pointer.direction.cross(solved.outward()).as_dvec3();
            assert!(hinge.distance(-found).min(hinge.distance(found)) < 1e-3);
            if bend == 0.0 {
                assert!(hinge.distance(found) < 1e-3, "{hinge} is not {found}");
            }
        }
    }
}

proptest! {
    #![proptest_config(config(2_000, 0x000f_ee1f))]

    #[test]
    fn dropping_full_turns_keeps_the_pose(
        shoulder in angles(), bend in bends(), turns in -100_000_000..100_000_000_i32
    ) {
        let bones = TwoBone::new(2.0, 3.0).expect("lengths");
        let around = |angle: f32| (f64::from(angle) + f64::from(turns) * 2.0 * PI) as f32;
        let last = Fk { shoulder: shoulder.map(around), bend: around(bend), stretch: 1.0 };
        let pose = last.pose(bones, Pointer::default());
        prop_assert!(pose.out >= 0.0 && (0.0..=180.001).contains(&pose.elbow_angle().to_degrees()));
        let again = Fk::matching(&pose, last).pose(bones, Pointer::default());
        let (elbow, hand) = apart(&again, points(&pose));
        prop_assert!(hand <= 1e-6 * 5.0 && elbow <= elbow_tolerance(&pose) * 5.0, "{} {}", hand, elbow);
    }
}

#[test]
fn straight_up_the_last_yaw_is_kept() {
    let up = angle::euler_rotation(Vec3::new(0.4, 0.0, core::f32::consts::FRAC_PI_2));
    let angles = angle::euler_angles(up, Vec3::new(0.0, 1.1, 1.0));
    assert!((angles.y - 1.1).abs() < 1e-6, "{angles}");
    let again = angle::euler_rotation(angles);
    assert!((again * DVec3::Y).distance(up * DVec3::Y) < 1e-6);
}

#[test]
fn a_roll_is_the_part_of_a_rotation_about_x_and_continues_past_half_a_turn() {
    let swing = DQuat::from_axis_angle(DVec3::new(0.0, 0.6, 0.8), 0.9);
    let mut last = 0.0;
    for step in 0..=40 {
        let roll = f64::from(step) * 0.25;
        let rotation = DMat3::from_quat(swing * DQuat::from_axis_angle(DVec3::X, roll));
        last = angle::roll(rotation, last);
        assert!((f64::from(last) - roll).abs() < 1e-5, "{last} is not {roll}");
    }
}

#[test]
fn a_hand_that_faces_backwards_keeps_its_last_roll() {
    let around = DMat3::from_rotation_y(PI);
    assert_eq!(angle::roll(around, 0.7), 0.7);
}
