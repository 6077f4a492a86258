//! How far the hand goes.

use ik_arm::kinematics::reach::Softening;
use ik_arm::kinematics::two_bone::TwoBone;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

fn config() -> ProptestConfig {
    ProptestConfig {
        cases: 2000,
        rng_seed: RngSeed::Fixed(0x50f7),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

fn arms() -> impl Strategy<Value = TwoBone> {
    (1.0..1000.0_f32, 1.0..1000.0_f32)
        .prop_map(|(upper, lower)| TwoBone::new(upper, lower).expect("lengths"))
}

fn soft(softness: f32) -> Softening {
    Softening::new(softness, 1.0, 0.0).expect("possible")
}

/// d_min, L and w, in f64.
fn limits(arm: TwoBone, softness: f32, angle: f32) -> (f64, f64, f64) {
    let (a, b) = (f64::from(arm.upper()), f64::from(arm.lower()));
    let opened = (a * a + b * b - 2.0 * a * b * f64::from(angle).cos()).sqrt();
    let (least, most) = ((a - b).abs().max(opened), a + b);
    (least, most, f64::from(softness) * (most - least) / 2.0)
}

/// d' in the form in which it is published, in f64.
fn curve((least, most, w): (f64, f64, f64), d: f64) -> f64 {
    let (outer, inner) = (most - w, least + w);
    if w == 0.0 {
        d.clamp(least, most)
    } else if d > outer {
        outer + w * (1.0 - (-(d - outer) / w).exp())
    } else if d < inner {
        least + w * ((d - inner) / w).exp()
    } else {
        d
    }
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn the_distance_is_the_published_curve(
        arm in arms(), softness in 0.0..0.99_f32, angle in 0.0..3.0_f32, part in 0.0..2.0_f64
    ) {
        let softening = Softening::new(softness, 1.0, angle).expect("possible");
        let limits = limits(arm, softness, angle);
        let d = (limits.1 * part) as f32;
        let found = f64::from(softening.extent(arm, d).distance);
        prop_assert!((found - curve(limits, f64::from(d))).abs() < 2e-7 * limits.1);
    }

    #[test]
    fn the_slope_is_the_curves(
        arm in arms(), softness in 0.01..0.99_f32, stretch in 1.0..3.0_f32, part in 0.0..2.5_f64
    ) {
        let softening = Softening::new(softness, stretch, 0.0).expect("possible");
        let limits = limits(arm, softness, 0.0);
        let stretched = |d: f64| {
            let d1 = curve(limits, d);
            let outer = d > limits.1 - limits.2;
            d1 * if outer { (d / d1).clamp(1.0, f64::from(stretch)) } else { 1.0 }
        };
        let (d, step) = (limits.1 * part, 1e-6 * limits.1);
        let expected = (stretched(d + step) - stretched(d - step)) / (2.0 * step);
        let (before, after) = (stretched(d) - stretched(d - step), stretched(d + step) - stretched(d));
        // Not on the corner at the longest stretch.
        prop_assume!((before - after).abs() < 1e-3 * step);
        let found = f64::from(softening.extent(arm, d as f32).slope);
        prop_assert!((found - expected).abs() < 2e-3, "{found}, not {expected}");
    }

    #[test]
    fn both_joins_have_slope_1_and_between_them_nothing_changes(
        arm in arms(), softness in 0.05..0.95_f32, part in 0.0..1.0_f64
    ) {
        let (least, most, w) = limits(arm, softness, 0.0);
        let (inner, outer) = (least + w, most - w);
        let softening = soft(softness);
        // What f32 makes of the joins is off by an ulp of L: of w that is little where s is not tiny.
        for (d, side) in [(inner, -1.0), (inner, 1.0), (outer, -1.0), (outer, 1.0)] {
            let slope = softening.extent(arm, (d + side * 1e-4 * w) as f32).slope;
            prop_assert!((slope - 1.0).abs() < 1e-2, "{slope}");
        }
        let between = (inner + (outer - inner) * (0.01 + 0.98 * part)) as f32;
        prop_assert_eq!(softening.extent(arm, between).distance.to_bits(), between.to_bits());
    }

    #[test]
    fn it_is_monotone_and_never_overshoots(
        arm in arms(), softness in 0.0..0.99_f32, a in 0.0..2.0_f64, b in 0.0..2.0_f64
    ) {
        let (least, most, w) = limits(arm, softness, 0.0);
        let softening = soft(softness);
        let (near, far) = ((a.min(b) * most) as f32, (a.max(b) * most) as f32);
        let [d1, d2] = [near, far].map(|d| softening.extent(arm, d).distance);
        prop_assert!(d1 <= d2);
        // Out of reach the hand lags behind the cursor, too near it stays away from the shoulder.
        if f64::from(far) > most - w {
            prop_assert!(d2 <= far.max(d1));
        }
        if f64::from(near) < least + w {
            prop_assert!(d1 >= near.min(d2));
        }
        let ulp = 1e-7 * most;
        prop_assert!(f64::from(d1) >= least - ulp && f64::from(d2) <= most + ulp);
    }

    #[test]
    fn it_stays_short_of_straight_within_twelve_widths(
        arm in arms(), softness in 0.05..0.99_f32, part in 0.0..1.0_f64
    ) {
        let (_, most, w) = limits(arm, softness, 0.0);
        // Of a narrower zone even that is less than f32 can tell from L.
        prop_assume!(w > 0.02 * most);
        let d = (most - w + 12.0 * w * part) as f32;
        let extent = soft(softness).extent(arm, d);
        prop_assert!(f64::from(extent.distance) < most && extent.slope > 0.0);
    }

    #[test]
    fn stretching_brings_the_hand_to_the_cursor_as_far_as_it_may(
        arm in arms(), softness in 0.0..0.9_f32, most_stretch in 1.0..3.0_f32, part in 0.0..4.0_f64
    ) {
        let (least, most, w) = limits(arm, softness, 0.0);
        let d = (least + w + part * (most - least)) as f32;
        let extent = Softening::new(softness, most_stretch, 0.0).expect("possible").extent(arm, d);
        prop_assert!((1.0..=most_stretch).contains(&extent.stretch));
        if extent.stretch < most_stretch {
            let off = (extent.distance - d).abs();
            prop_assert!(off <= 2e-7 * most as f32 * most_stretch, "off by {off}");
        } else {
            prop_assert!(extent.distance <= d * (1.0 + 1e-6));
        }
    }

    #[test]
    fn the_elbow_is_never_less_open_than_it_may_be(
        arm in arms(), angle in 0.05..3.0_f32, part in 0.0..1.2_f64
    ) {
        let softening = Softening::new(0.0, 1.0, angle).expect("possible");
        let (least, most, _) = limits(arm, 0.0, angle);
        let d = softening.extent(arm, (part * most) as f32).distance;
        prop_assert!((f64::from(softening.least_distance(arm)) - least).abs() < 2e-7 * most);
        let (a, b, d) = (f64::from(arm.upper()), f64::from(arm.lower()), f64::from(d));
        let cos = ((a * a + b * b - d * d) / (2.0 * a * b)).clamp(-1.0, 1.0);
        // The arc cosine loses half the digits near 0 and π.
        let lost = 1e-3 * (a.max(b) / a.min(b)).sqrt();
        prop_assert!(cos.acos() >= f64::from(angle) - lost, "{} of {angle}", cos.acos());
    }

    #[test]
    fn without_softening_it_is_the_solvers_own_clamp(arm in arms(), part in 0.0..3.0_f32) {
        let d = arm.outer_limit() * part;
        let extent = Softening::default().extent(arm, d);
        let clamped = d.clamp(arm.inner_limit(), arm.outer_limit());
        prop_assert_eq!((extent.distance.to_bits(), extent.stretch), (clamped.to_bits(), 1.0));
    }
}

#[test]
fn numbers_that_no_softening_has_are_named() {
    for (values, said) in [
        ([1.0, 1.0, 0.0], "softness is 1; it must be from 0 to less than 1"),
        ([-0.1, 1.0, 0.0], "softness is -0.1; it must be from 0 to less than 1"),
        ([f32::NAN, 1.0, 0.0], "softness is NaN; it must be from 0 to less than 1"),
        ([0.0, 0.9, 0.0], "max_stretch is 0.9; it must be a finite number, 1 or more"),
        ([0.0, f32::INFINITY, 0.0], "max_stretch is inf; it must be a finite number, 1 or more"),
        ([0.0, 1.0, 3.2], "min_elbow_angle is 3.2; it must be from 0 to less than 180°"),
    ] {
        let [softness, stretch, angle] = values;
        let error = Softening::new(softness, stretch, angle).expect_err("refused");
        assert_eq!(error.to_string(), said);
    }
}

#[test]
fn huge_and_tiny_arms_are_finite() {
    for length in [f32::MAX, f32::MIN_POSITIVE, 1e-40, 1.0] {
        let arm = TwoBone::new(length, length).expect("lengths");
        for d in [0.0, 1e-45, 1.0, f32::MAX] {
            let extent = Softening::new(0.5, 2.0, 0.1).expect("possible").extent(arm, d);
            assert!(extent.distance.is_finite() && extent.slope.is_finite(), "{extent:?}");
            assert!((1.0..=2.0).contains(&extent.stretch));
        }
    }
}
