//! Random arms and cursors over the whole domain of the accuracy that the kinematics promises.

use std::f64::consts::TAU;
use std::fmt::Debug;
use std::ops::{Neg, Range};

use glam::{DMat3, DVec3, Vec3};
use ik_arm::kinematics::two_bone::{TwoBone, TwoBonePose};
use proptest::prelude::*;
use proptest::test_runner::{RngSeed, TestCaseResult};

/// Error of a hand and of a limb's length, in units of L.
pub const EXACT: f64 = 3e-7;

/// Half a unit in the last place of an f32 near 1: what one rounding costs at most.
pub const U: f64 = f32::EPSILON as f64 / 2.0;

/// The same 10,000 poses on every run.
pub fn config() -> ProptestConfig {
    ProptestConfig {
        cases: 10_000,
        rng_seed: RngSeed::Fixed(0x2014_1a4e),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

/// Fails where the error is beyond the bound, or not a number.
pub fn within(what: &str, error: f64, bound: f64) -> TestCaseResult {
    prop_assert!(error <= bound, "{what} is off by {error:e}, more than {bound:e}");
    Ok(())
}

/// One question to the solver.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    pub arm: TwoBone,
    pub cursor: Vec3,
    pub spin: f32,
}

impl Case {
    pub fn solve(self) -> TwoBonePose {
        self.arm.solve(self.cursor, self.spin)
    }
}

/// d₁ and d₂.
pub fn bones(arm: TwoBone) -> (f64, f64) {
    (f64::from(arm.upper()), f64::from(arm.lower()))
}

/// |δ| and L.
pub fn limits(arm: TwoBone) -> (f64, f64) {
    let (upper, lower) = bones(arm);
    ((upper - lower).abs(), upper + lower)
}

/// θ_z and θ_y of a cursor; one without a yaw has 0.
pub fn yaw_and_pitch(cursor: Vec3) -> (f64, f64) {
    let DVec3 { x, y, z } = cursor.as_dvec3();
    let yaw = if x == 0.0 && z == 0.0 { 0.0 } else { z.atan2(x) };
    (yaw, y.atan2(x.hypot(z)))
}

/// R_y(−θ_z) · R_z(θ_y), from angles.
pub fn limb_rotation((yaw, pitch): (f64, f64)) -> DMat3 {
    DMat3::from_rotation_y(-yaw) * DMat3::from_rotation_z(pitch)
}

/// Lengths 1e-2 to 1e4, ratios up to 30 : 1, equal and nearly equal bones.
pub fn arms() -> impl Strategy<Value = TwoBone> {
    let ratio = prop_oneof![
        3 => (0.0..30.0_f64.ln()).prop_map(f64::exp),
        1 => Just(30.0),
        1 => Just(1.0),
        2 => 1.0 - 1e-6..1.0 + 1e-6,
    ];
    (-2.0..4.0, ratio, any::<bool>()).prop_map(|(exponent, ratio, upper_is_longer)| {
        let longer = 10_f64.powf(exponent);
        let shorter = (longer / ratio).max(1e-2);
        let (upper, lower) = if upper_is_longer { (longer, shorter) } else { (shorter, longer) };
        TwoBone::new(upper as f32, lower as f32).expect("lengths")
    })
}

/// Every direction: uniform on the sphere; and on and near every axis and plane, which has x and z
/// tiny against y and the reverse.
pub fn directions() -> impl Strategy<Value = DVec3> {
    let uniform = (-1.0..1.0_f64, 0.0..TAU).prop_map(|(height, turn)| {
        let (sin, cos) = turn.sin_cos();
        let flat = (1.0 - height * height).sqrt();
        DVec3::new(flat * cos, height, flat * sin)
    });
    let size = prop_oneof![Just(0.0), 0.0..1.0, power_of_ten(-45.0..0.0)];
    let coordinate = either_sign(size);
    let lopsided = [coordinate.clone(), coordinate.clone(), coordinate]
        .prop_map(|at| DVec3::from_array(at).try_normalize().unwrap_or(DVec3::X));
    prop_oneof![uniform, lopsided]
}

/// Of these sizes, half of them negative.
pub fn either_sign<T>(size: impl Strategy<Value = T> + Clone) -> impl Strategy<Value = T> + Clone
where
    T: Neg<Output = T> + Debug,
{
    (size, any::<bool>()).prop_map(|(size, minus)| if minus { -size } else { size })
}

/// Cursors between the limits: clear of both by eight roundings, often just so.
pub fn in_reach() -> impl Strategy<Value = Case> {
    let share = prop_oneof![
        0.0..1.0,
        power_of_ten(-8.0..0.0),
        power_of_ten(-8.0..0.0).prop_map(|t| 1.0 - t)
    ];
    cases(share.prop_map(|t| ((1.0 - t) * (1.0 + 8.0 * U), t * (1.0 - 8.0 * U))))
}

/// Cursors beyond the limits: clear of both by eight roundings, often just so, and far away.
pub fn out_of_reach() -> impl Strategy<Value = Case> {
    let too_far = power_of_ten(-7.0..28.0).prop_map(|more| (0.0, (1.0 + more) * (1.0 + 8.0 * U)));
    let part = prop_oneof![
        power_of_ten(-7.0..0.0).prop_map(|less| 1.0 - less),
        power_of_ten(-30.0..0.0),
        Just(0.0),
    ];
    let too_close = part.prop_map(|part| (part * (1.0 - 8.0 * U), 0.0));
    cases(prop_oneof![too_far, too_close]).prop_filter("equal bones", |case| {
        case.arm.inner_limit() > 0.0 || case.cursor != Vec3::ZERO
    })
}

/// Cursors between the limits, beyond them, and within roundings of each.
pub fn anywhere() -> impl Strategy<Value = Case> {
    let roundings = || (-8..=8).prop_map(|n| 1.0 + f64::from(n) * U);
    let at_inner = roundings().prop_map(|about_one| (about_one, 0.0));
    let at_outer = roundings().prop_map(|about_one| (0.0, about_one));
    prop_oneof![4 => in_reach(), 2 => out_of_reach(), 1 => cases(at_inner), 1 => cases(at_outer)]
}

/// Every arm, direction and spin, with the cursor so many |δ| plus so many L away.
fn cases(radius: impl Strategy<Value = (f64, f64)>) -> impl Strategy<Value = Case> {
    (arms(), directions(), radius, -10.0..10.0_f32).prop_map(|(arm, direction, radius, spin)| {
        let (inner, outer) = limits(arm);
        let cursor = (direction * (radius.0 * inner + radius.1 * outer)).as_vec3();
        Case { arm, cursor, spin }
    })
}

/// Every magnitude alike.
pub fn power_of_ten(exponents: Range<f64>) -> impl Strategy<Value = f64> + Clone {
    exponents.prop_map(|exponent| 10_f64.powf(exponent))
}
