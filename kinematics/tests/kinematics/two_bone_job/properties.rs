//! Properties of a job for every skeleton.

use std::f64::consts::PI;

use glam::{Affine3A, DQuat, DVec3, Quat, Vec3};
use ik_arm_kinematics::job::{TwoBoneCorrection, TwoBoneJob};
use ik_arm_kinematics::two_bone::Reach;
use proptest::prelude::*;

use crate::common::Random;
use crate::common::strategies::config;
use crate::two_bone_job::skeleton::*;

proptest! {
    #![proptest_config(config(4_000, 0x0221))]

    #[test]
    fn under_every_parent_the_hand_is_where_it_can_be(
        seed in any::<u64>(), far in prop_oneof![Just(0.0_f32), Just(10.0), Just(1e6)],
        share in -0.5..1.5_f64,
    ) {
        let mut random = Random(seed);
        let parent = model_transform(&mut random, far);
        let skeleton = Skeleton { parent, ..Skeleton::random(&mut random) };
        let direction = random.direction().as_dvec3();
        let target = skeleton.point_in_reach(direction, share);
        let nearest = {
            let [start, ..] = skeleton.points();
            let (upper, lower) = skeleton.bones();
            let way = target - start;
            start + way.normalize() * way.length().clamp((upper - lower).abs(), upper + lower)
        };
        // Rounding may move such a target to the start joint's other side.
        prop_assume!(target.distance(skeleton.points()[0]) > 1e-2 * skeleton.length());
        let job = TwoBoneJob {
            pole: Some(random.vector(1.0)), hinge: Some(random.vector(1.0)), ..skeleton.job(target)
        };
        let correction = run(job);
        let [_, _, hand] = skeleton.turned(&correction).points();
        let asked = (target - skeleton.points()[0]).length();
        // Rounding of the direction of a target inside the inner limit is magnified at the limit.
        let lever = (nearest.distance(skeleton.points()[0]) / asked).max(1.0);
        let bound = EXACT * skeleton.length() + lever * skeleton.rounding();
        close("hand", hand.distance(nearest), bound)?;
        if target.distance(nearest) > 2.0 * bound {
            let expected = if asked > skeleton.length() { Reach::TooFar } else { Reach::TooClose };
            prop_assert_eq!(correction.reach, expected);
        }
    }

    #[test]
    fn the_rotations_do_not_depend_on_the_models_transform(seed in any::<u64>()) {
        let mut random = Random(seed);
        let own = Skeleton::random(&mut random);
        let parent = model_transform(&mut random, 1.0);
        let moved = Skeleton { parent, ..own };
        let direction = random.direction().as_dvec3();
        let target = own.point_in_reach(direction, random.within(0.1..0.9).into());
        let pole = random.direction();
        // Away from the pole's line and from bones in one line, which are ill-conditioned.
        prop_assume!(direction.cross(pole.as_dvec3()).length() > 0.2);
        let [shoulder, elbow, hand] = own.points();
        prop_assume!((elbow - shoulder).normalize().cross((hand - elbow).normalize()).length() > 0.2);
        let with = |skeleton: &Skeleton, target, pole: DVec3| TwoBoneJob {
            pole: Some(pole.as_vec3()), twist: 0.7, softness: 0.2, ..skeleton.job(target)
        };
        let here = run(with(&own, target, pole.as_dvec3()));
        let pole = parent.transform_vector3(pole.as_dvec3());
        let there = run(with(&moved, parent.transform_point3(target), pole));
        for (a, b) in [(here.start_correction, there.start_correction), (here.middle_correction, there.middle_correction)] {
            close("rotation", apart(a.as_dquat(), b.as_dquat()), 2e-4)?;
        }
    }

    #[test]
    fn a_hand_that_is_off_its_target_is_never_reported_reached(
        seed in any::<u64>(), share in -0.2..1.2_f64, softness in 0.0..0.9_f32,
        weight in prop_oneof![Just(0.0_f32), 0.0..1.0_f32, 0.999_999..1.0_f32, Just(1.0_f32)],
        far in prop_oneof![Just(0.0_f32), Just(1e4)],
    ) {
        let mut random = Random(seed);
        let parent = model_transform(&mut random, far);
        let skeleton = Skeleton { parent, ..Skeleton::random(&mut random) };
        let here = skeleton.points()[2];
        let direction = random.direction().as_dvec3();
        let target =
            if random.chance(0.1) { here } else { skeleton.point_in_reach(direction, share) };
        let job = TwoBoneJob {
            pole: Some(random.vector(1.0)), hinge: Some(random.vector(1.0)), softness, weight,
            ..skeleton.job(target)
        };
        let correction = run(job);
        let [_, _, hand] = skeleton.turned(&correction).points();
        let bound = EXACT * skeleton.length() + skeleton.rounding();
        let off = hand.distance(target);
        close("what it says of the hand", (f64::from(correction.hand_error) - off).abs(), bound)?;
        if correction.reach == Reach::Reached {
            close("hand", off, bound)?;
        }
    }

    #[test]
    fn the_elbow_points_to_the_pole_and_the_twist_turns_it_right_handed(
        seed in any::<u64>(), share in 0.05..0.95_f64, twist in -3.0..3.0_f32,
    ) {
        let mut random = Random(seed);
        let skeleton = Skeleton::random(&mut random);
        // Right-handed in the start joint's space: as here, if that is not mirrored.
        let start = Local { scale: skeleton.start.scale.abs(), ..skeleton.start };
        let skeleton = Skeleton { start, ..skeleton };
        let direction = random.direction().as_dvec3();
        let target = skeleton.point_in_reach(direction, share);
        let pole = random.direction();
        let expected = pole.as_dvec3().reject_from_normalized(direction);
        prop_assume!(expected.length() > 0.1);
        let expected = DQuat::from_axis_angle(direction, twist.into()) * expected;
        let hinge = random.vector(1.0);
        let job = TwoBoneJob { pole: Some(pole), twist, hinge: Some(hinge), ..skeleton.job(target) };
        let [start, elbow, _] = skeleton.turned(&run(job)).points();
        let out = (elbow - start).reject_from_normalized(direction);
        prop_assume!(out.length() > 1e-2 * skeleton.length());
        close("elbow's direction", out.angle_between(expected), 1e-4)?;
    }

    #[test]
    fn a_softened_hand_is_on_the_published_curve(
        seed in any::<u64>(), share in 0.0..1.5_f64, softness in 0.01..0.9_f32,
    ) {
        let mut random = Random(seed);
        let skeleton = Skeleton::random(&mut random);
        let direction = random.direction().as_dvec3();
        let (upper, lower) = skeleton.bones();
        let (least, most) = ((upper - lower).abs(), upper + lower);
        let asked = share * most;
        let w = f64::from(softness) * (most - least) / 2.0;
        let expected = if asked > most - w {
            most - w * (-(asked - (most - w)) / w).exp()
        } else if asked < least + w {
            least + w * ((asked - (least + w)) / w).exp()
        } else {
            asked
        };
        prop_assume!(asked > 1e-2 * most);
        let start = skeleton.points()[0];
        let job = TwoBoneJob { softness, ..skeleton.job(start + direction * asked) };
        let correction = run(job);
        let hand = skeleton.turned(&correction).points()[2];
        // The target's rounding turns the hand about as far as it is from the start joint.
        let bound = EXACT * most * (expected / asked).max(1.0);
        close("hand", hand.distance(start + direction * expected), bound)?;
        if (asked - expected).abs() > 2e-6 * most {
            let too = if asked > expected { Reach::TooFar } else { Reach::TooClose };
            prop_assert_eq!(correction.reach, too);
        }
    }

    #[test]
    fn a_weight_scales_both_angles(seed in any::<u64>(), weight in 0.0..1.0_f32) {
        let mut random = Random(seed);
        let skeleton = Skeleton::random(&mut random);
        let target = skeleton.points()[0] + random.vector(1.0).as_dvec3();
        let job = TwoBoneJob { pole: Some(random.vector(1.0)), ..skeleton.job(target) };
        let (full, part) = (run(job), run(TwoBoneJob { weight, ..job }));
        for (full, part) in [(full.start_correction, part.start_correction), (full.middle_correction, part.middle_correction)] {
            let (full, part) = (full.as_dquat().normalize(), part.as_dquat().normalize());
            let axis = full.xyz().normalize_or_zero();
            let angle = 2.0 * full.xyz().length().atan2(full.w);
            let expected = DQuat::from_axis_angle(
                if axis == DVec3::ZERO { DVec3::X } else { axis }, angle * f64::from(weight)
            );
            prop_assert!(angle <= PI + 1e-6);
            close("rotation", apart(expected, part), 1e-6)?;
        }
    }

    #[test]
    fn the_middle_joint_turns_about_a_hinge_axis_that_is_perpendicular(
        seed in any::<u64>(), bent in -3.1..3.1_f64, share in 0.05..0.95_f64, mirrored in any::<bool>(),
    ) {
        let mut random = Random(seed);
        // An elbow whose hinge axis is its own z, bent by any angle to either side or not at all.
        let bent = if random.chance(0.2) { 0.0 } else { bent };
        let turn = rotation(&mut random);
        let hinge_start = turn * DVec3::Z;
        let scale = DVec3::splat(if mirrored { -1.0 } else { 1.0 });
        let skeleton = Skeleton {
            start: Local { rotation: rotation(&mut random), ..Local::at(DVec3::ZERO) },
            middle: Local {
                translation: turn * DVec3::X * 0.6,
                rotation: turn * DQuat::from_rotation_z(bent),
                scale,
            },
            end: Local::at(scale * DVec3::X * 0.7),
            ..Skeleton::square()
        };
        let direction = random.direction().as_dvec3();
        let target = skeleton.point_in_reach(direction, share);
        let pole = random.vector(1.0);
        let job = TwoBoneJob { hinge: Some(Vec3::Z * 5.0), pole: Some(pole), ..skeleton.job(target) };
        let correction = run(job);
        let turned = skeleton.turned(&correction);
        close("hand", turned.points()[2].distance(target), EXACT * skeleton.length())?;
        let sideways = correction.middle_correction.xyz().truncate().length();
        // An f32 matrix says where the normal is to 1e-7 of the bend's sine; in line it is not
        // asked.
        let blur = 3e-7 / f64::from(bent.sin().abs() as f32).max(1e-3);
        close("axis", f64::from(sideways), blur)?;
        // Opening is a positive turn: from the present angle to the one that is wanted.
        let open = |skeleton: &Skeleton| {
            let [start, elbow, hand] = skeleton.points();
            let axis = skeleton.joints()[0].matrix3 * hinge_start;
            let (back, on) = (start - elbow, hand - elbow);
            back.cross(on).dot(axis).atan2(back.dot(on))
        };
        prop_assert!(open(&turned) > 0.0, "the limb bends to the wrong side");
    }

    #[test]
    fn a_hand_at_its_target_gets_no_correction(seed in any::<u64>()) {
        let mut random = Random(seed);
        let skeleton = Skeleton::random(&mut random);
        let [start, elbow, hand] = skeleton.points();
        let middle_from_model = skeleton.joints()[1].matrix3.inverse();
        let (back, on) = (middle_from_model * (start - elbow), middle_from_model * (hand - elbow));
        prop_assume!(back.normalize().cross(on.normalize()).length() > 0.05);
        // Not perpendicular, but on the right side.
        let normal = back.cross(on).normalize();
        let hinge = normal + random.direction().as_dvec3() * 0.9;
        let job = TwoBoneJob {
            pole: Some((elbow - start).as_vec3()), hinge: Some(hinge.as_vec3()), ..skeleton.job(hand)
        };
        let correction = run(job);
        prop_assert_eq!(correction.reach, Reach::Reached);
        let nothing = |turn: Quat| apart(turn.as_dquat(), DQuat::IDENTITY);
        close("start", nothing(correction.start_correction), 2e-4)?;
        close("middle", nothing(correction.middle_correction), 2e-4)?;
    }

    #[test]
    fn any_input_gives_a_finite_correction_or_an_error(
        numbers in prop::collection::vec(prop_oneof![
            3 => -2.0..2.0_f32, 1 => Just(0.0_f32), 1 => any::<f32>(), 1 => Just(1.0_f32),
            1 => Just(f32::MAX), 1 => Just(f32::MIN_POSITIVE), 1 => Just(1e-45_f32),
        ], 21),
        size in prop_oneof![Just(1.0_f32), Just(1e30), Just(1e-30), Just(1e-45), Just(0.0), Just(-1.0)],
        axes in prop_oneof![Just(Quat::IDENTITY), Just(Quat::from_xyzw(0.5, 0.5, 0.5, 0.5))],
    ) {
        let vector = |at: usize| Vec3::new(numbers[at], numbers[at + 1], numbers[at + 2]);
        let joint = |at: usize| {
            Affine3A::from_scale_rotation_translation(Vec3::splat(size), axes, vector(at))
        };
        let job = TwoBoneJob {
            pole: Some(vector(12)), hinge: Some(vector(15)), twist: numbers[18],
            softness: numbers[19].abs().fract(), weight: numbers[20].abs().min(1.0),
            ..TwoBoneJob::new(joint(0), joint(3), joint(6), vector(9))
        };
        match job.run() {
            Ok(TwoBoneCorrection { start_correction: start, middle_correction: middle, hand_error, .. }) => {
                prop_assert!(start.is_normalized() && middle.is_normalized(), "{start} {middle}");
                prop_assert!(hand_error.is_finite() && hand_error >= 0.0);
            }
            Err(error) => prop_assert!(!error.to_string().is_empty()),
        }
    }
}
