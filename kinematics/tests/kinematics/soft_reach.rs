//! Distance of the hand: the curve of soft limits and stretch against a twin in f64.

use ik_arm_kinematics::soft_reach::{HandDistance, SoftReach};
use ik_arm_kinematics::two_bone::TwoBone;
use proptest::prelude::*;

use crate::common::strategies::{arms_of, config};

fn soft(softness: f32) -> SoftReach {
    SoftReach::new(softness, 1.0, 0.0).expect("possible")
}

/// The published curve in f64, in the form in which it is published.
#[derive(Clone, Copy)]
struct Twin {
    /// d_min
    least: f64,
    /// L
    most: f64,
    /// w
    width: f64,
    max_stretch: f64,
}

impl Twin {
    fn new(soft_reach: SoftReach, arm: TwoBone) -> Self {
        let (a, b) = (f64::from(arm.upper()), f64::from(arm.lower()));
        let angle = f64::from(soft_reach.min_elbow_angle());
        let opened = (a * a + b * b - 2.0 * a * b * angle.cos()).max(0.0).sqrt();
        let (least, most) = ((a - b).abs().max(opened), a + b);
        let width = f64::from(soft_reach.softness()) * (most - least) / 2.0;
        Self { least, most, width, max_stretch: f64::from(soft_reach.max_stretch()) }
    }

    /// d_a
    fn outer(self) -> f64 {
        self.most - self.width
    }

    /// d_b
    fn inner(self) -> f64 {
        self.least + self.width
    }

    /// d'
    fn soften(self, d: f64) -> f64 {
        let Self { least, most, width, .. } = self;
        if width == 0.0 {
            d.clamp(least, most)
        } else if d > self.outer() {
            self.outer() + width * (1.0 - (-(d - self.outer()) / width).exp())
        } else if d < self.inner() {
            least + width * ((d - self.inner()) / width).exp()
        } else {
            d
        }
    }

    /// σ
    fn stretch(self, d: f64) -> f64 {
        if d > self.outer() { (d / self.soften(d)).clamp(1.0, self.max_stretch) } else { 1.0 }
    }

    /// D
    fn distance(self, d: f64) -> f64 {
        self.stretch(d) * self.soften(d)
    }
}

/// Distances in f32 are off by a few ulp of the longest.
fn is_near(found: f32, expected: f64, longest: f64) -> bool {
    (f64::from(found) - expected).abs() <= 2e-7 * longest
}

proptest! {
    #![proptest_config(config(2000, 0x50f7))]

    #[test]
    fn the_distance_is_the_published_curve(
        arm in arms_of(1.0..1000.0), softness in 0.0..0.99_f32, angle in 0.0..3.0_f32, part in 0.0..2.0_f64
    ) {
        let soft_reach = SoftReach::new(softness, 1.0, angle).expect("possible");
        let twin = Twin::new(soft_reach, arm);
        let d = (twin.most * part) as f32;
        let found = soft_reach.hand_distance(arm, d).distance;
        let expected = twin.distance(f64::from(d));
        prop_assert!(is_near(found, expected, twin.most), "{found}, not {expected}");
    }

    #[test]
    fn the_slope_is_that_of_the_published_curve(
        arm in arms_of(1.0..1000.0), softness in 0.01..0.99_f32, stretch in 1.0..3.0_f32, part in 0.0..2.5_f64
    ) {
        let soft_reach = SoftReach::new(softness, stretch, 0.0).expect("possible");
        let twin = Twin::new(soft_reach, arm);
        let (d, step) = (twin.most * part, 1e-6 * twin.most);
        let [before, here, after] = [d - step, d, d + step].map(|d| twin.distance(d));
        // Not on the corner at the longest stretch.
        prop_assume!((after - 2.0 * here + before).abs() < 1e-3 * step);
        let expected = (after - before) / (2.0 * step);
        let found = f64::from(soft_reach.hand_distance(arm, d as f32).slope);
        prop_assert!((found - expected).abs() < 2e-3, "{found}, not {expected}");
    }

    #[test]
    fn the_slope_is_the_derivative_of_the_distance(
        arm in arms_of(1.0..1000.0), softness in 0.3..0.99_f32, widths in -1.0..3.0_f64
    ) {
        let soft_reach = soft(softness);
        let twin = Twin::new(soft_reach, arm);
        // Only where f32 resolves the difference of two distances.
        prop_assume!(twin.width > 0.05 * twin.most);
        let step = 0.02 * twin.width;
        for d in [twin.outer() + widths * twin.width, twin.inner() - widths * twin.width] {
            let [before, after] = [(d - step) as f32, (d + step) as f32];
            prop_assume!(before > 0.0);
            let run = f64::from(after) - f64::from(before);
            let [low, high] = [before, after].map(|d| f64::from(soft_reach.hand_distance(arm, d).distance));
            let slope = f64::from(soft_reach.hand_distance(arm, d as f32).slope);
            let grown = (high - low) / run;
            prop_assert!((slope - grown).abs() < 0.01, "{slope}, not {grown}");
            let [low, high] = [before, after].map(|d| twin.distance(f64::from(d)));
            prop_assert!((grown - (high - low) / run).abs() < 0.01, "{grown}");
        }
    }

    #[test]
    fn both_joins_have_slope_1_and_between_them_nothing_changes(
        arm in arms_of(1.0..1000.0), softness in 0.05..0.95_f32, part in 0.0..1.0_f64
    ) {
        let soft_reach = soft(softness);
        let twin = Twin::new(soft_reach, arm);
        let (inner, outer, w) = (twin.inner(), twin.outer(), twin.width);
        let slope = |d: f64| f64::from(soft_reach.hand_distance(arm, d as f32).slope);
        // f32 is off by an ulp of L where the joins are: of w that is little where s is not tiny.
        let off = 1e-2;
        for beside in [-1e-4, 1e-4] {
            prop_assert!((slope(inner + beside * w) - 1.0).abs() < off);
            prop_assert!((slope(outer + beside * w) - 1.0).abs() < off);
        }
        // It is not 1 everywhere: one width into a zone it is 1/e.
        prop_assert!((slope(outer + w) - (-1.0_f64).exp()).abs() < off);
        if inner - w > 0.0 {
            prop_assert!((slope(inner - w) - (-1.0_f64).exp()).abs() < off);
        }
        let between = (inner + (outer - inner) * (0.01 + 0.98 * part)) as f32;
        prop_assert_eq!(soft_reach.hand_distance(arm, between).distance.to_bits(), between.to_bits());
    }

    #[test]
    fn it_grows_with_the_cursor_and_never_overshoots(
        arm in arms_of(1.0..1000.0), softness in 0.0..0.99_f32, a in 0.0..2.0_f64, b in 0.0..2.0_f64
    ) {
        let soft_reach = soft(softness);
        let twin = Twin::new(soft_reach, arm);
        let (near, far) = ((a.min(b) * twin.most) as f32, (a.max(b) * twin.most) as f32);
        let [d1, d2] = [near, far].map(|d| soft_reach.hand_distance(arm, d).distance);
        prop_assert!(d1 <= d2);
        let grown = twin.distance(f64::from(far)) - twin.distance(f64::from(near));
        if grown > 1e-6 * twin.most {
            prop_assert!(d1 < d2, "{d1} at {near} and {d2} at {far}");
        }
        // Out of reach the hand lags behind the cursor, too near it stays away from the shoulder.
        for (d, distance) in [(near, d1), (far, d2)] {
            if f64::from(d) > twin.outer() {
                prop_assert!(distance <= d, "{distance} at {d}");
            }
            if f64::from(d) < twin.inner() {
                prop_assert!(distance >= d, "{distance} at {d}");
            }
        }
        let ulp = 1e-7 * twin.most;
        prop_assert!(f64::from(d1) >= twin.least - ulp && f64::from(d2) <= twin.most + ulp);
    }

    #[test]
    fn it_stays_short_of_straight_within_twelve_widths(
        arm in arms_of(1.0..1000.0), softness in 0.05..0.99_f32, widths in 0.0..12.0_f64
    ) {
        let twin = Twin::new(soft(softness), arm);
        // Of a narrower zone even that is less than f32 can tell from L.
        prop_assume!(twin.width > 0.02 * twin.most);
        let d = (twin.outer() + twin.width * widths) as f32;
        let extent = soft(softness).hand_distance(arm, d);
        prop_assert!(f64::from(extent.distance) < twin.most);
        // The gap to straight falls by e with each width, and so does the slope.
        let fallen = (-(f64::from(d) - twin.outer()) / twin.width).exp().min(1.0);
        let gap = twin.most - f64::from(extent.distance);
        prop_assert!((gap - twin.width * fallen).abs() < 1e-7 * twin.most, "{gap}");
        prop_assert!((f64::from(extent.slope) / fallen - 1.0).abs() < 1e-5, "{}", extent.slope);
    }

    #[test]
    fn stretching_brings_the_hand_to_the_cursor_up_to_its_maximum(
        arm in arms_of(1.0..1000.0), softness in 0.0..0.9_f32, max_stretch in 1.0..3.0_f32, part in 0.0..4.0_f64
    ) {
        let soft_reach = SoftReach::new(softness, max_stretch, 0.0).expect("possible");
        let twin = Twin::new(soft_reach, arm);
        let d = (twin.inner() + part * (twin.most - twin.least)) as f32;
        let HandDistance { distance, stretch, .. } = soft_reach.hand_distance(arm, d);
        let longest = twin.most * twin.max_stretch;
        let expected = twin.stretch(f64::from(d));
        prop_assert!((f64::from(stretch) - expected).abs() < 1e-6, "{stretch}, not {expected}");
        let expected = twin.distance(f64::from(d));
        prop_assert!(is_near(distance, expected, longest), "{distance}, not {expected}");
        if 1.0 < stretch && stretch < max_stretch {
            prop_assert!(is_near(distance, f64::from(d), longest), "{distance}, not {d}");
        }
    }

    #[test]
    fn the_elbow_angle_stays_above_its_minimum(
        arm in arms_of(1.0..1000.0), angle in 0.05..3.0_f32, part in 0.0..1.2_f64
    ) {
        let soft_reach = SoftReach::new(0.0, 1.0, angle).expect("possible");
        let twin = Twin::new(soft_reach, arm);
        let least = soft_reach.least_distance(arm);
        prop_assert!(is_near(least, twin.least, twin.most), "{least}, not {}", twin.least);
        let d = (part * twin.most) as f32;
        let distance = soft_reach.hand_distance(arm, d).distance;
        let (a, b) = (f64::from(arm.upper()), f64::from(arm.lower()));
        let elbow = |distance: f64| {
            ((a * a + b * b - distance * distance) / (2.0 * a * b)).clamp(-1.0, 1.0).acos()
        };
        // Just as open where the cursor is nearer, and as the cursor has it where that is farther.
        let expected = elbow(f64::from(d)).max(f64::from(angle));
        let found = elbow(f64::from(distance));
        // The arc cosine loses half the digits near 0 and π.
        let lost = 1e-3 * (a.max(b) / a.min(b)).sqrt();
        prop_assert!((found - expected).abs() <= lost, "{found}, not {expected}");
    }

    #[test]
    fn without_softening_it_is_the_solvers_own_clamp(arm in arms_of(1.0..1000.0), part in 0.0..3.0_f32) {
        let d = arm.outer_limit() * part;
        let extent = SoftReach::default().hand_distance(arm, d);
        let clamped = d.clamp(arm.inner_limit(), arm.outer_limit());
        prop_assert_eq!((extent.distance.to_bits(), extent.stretch), (clamped.to_bits(), 1.0));
        let moves = arm.inner_limit() < d && d < arm.outer_limit();
        prop_assert_eq!(extent.slope, f32::from(u8::from(moves)));
    }

    #[test]
    fn the_cursor_distance_is_the_inverse(
        arm in arms_of(1.0..1000.0), softness in 0.0..0.9_f32, max_stretch in 1.0..3.0_f32, part in 0.0..1.0_f64
    ) {
        let soft_reach = SoftReach::new(softness, max_stretch, 0.0).expect("possible");
        let twin = Twin::new(soft_reach, arm);
        let longest = twin.most * twin.max_stretch;
        let asked = (twin.least + part * (longest - twin.least)) as f32;
        let d = soft_reach.cursor_distance(arm, asked);
        // Nearer than any cursor can bring it, the hand stays at the least distance of the curve.
        let reached = f64::from(asked).max(twin.distance(0.0));
        let found = twin.distance(f64::from(d));
        prop_assert!((found - reached).abs() < 1e-6 * longest, "{found}, not {reached}");
    }
}

#[test]
fn invalid_soft_reach_values_are_named() {
    for (values, said) in [
        ([1.0, 1.0, 0.0], "softness must be from 0 to less than 1, got 1"),
        ([-0.1, 1.0, 0.0], "softness must be from 0 to less than 1, got -0.1"),
        ([f32::NAN, 1.0, 0.0], "softness must be from 0 to less than 1, got NaN"),
        ([0.0, 0.9, 0.0], "max_stretch must be finite and at least 1, got 0.9"),
        ([0.0, f32::INFINITY, 0.0], "max_stretch must be finite and at least 1, got inf"),
        ([0.0, 1.0, 3.2], "min_elbow_angle must be from 0 to less than 180°, got 3.2"),
    ] {
        let [softness, stretch, angle] = values;
        let error = SoftReach::new(softness, stretch, angle).expect_err("refused");
        assert_eq!(error.to_string(), said);
    }
}

#[test]
fn huge_and_tiny_arms_follow_the_curve_up_to_overflow() {
    let soft_reach = SoftReach::new(0.5, 2.0, 0.1).expect("possible");
    for length in [f32::MAX, f32::MIN_POSITIVE, 1e-40, 1.0] {
        let arm = TwoBone::new(length, length).expect("lengths");
        let twin = Twin::new(soft_reach, arm);
        for d in [0.0, 1e-45, 1.0, length / 2.0, length, f32::MAX] {
            let HandDistance { distance, stretch, slope } = soft_reach.hand_distance(arm, d);
            let expected = twin.distance(f64::from(d)).min(f64::from(f32::MAX));
            // Subnormal numbers are 1.4e-45 apart.
            let off = (f64::from(distance) - expected).abs();
            assert!(off <= 4e-7 * expected + 1e-45, "{distance:e} at {d:e}, not {expected:e}");
            assert!((f64::from(stretch) - twin.stretch(f64::from(d))).abs() < 1e-6, "{stretch}");
            assert!((0.0..=2.0).contains(&slope), "{slope}");
        }
    }
}
