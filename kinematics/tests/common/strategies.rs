//! Random values for proptest: directions, points, twist references, and arms with cursors over the
//! whole domain of the accuracy that the kinematics promises.

use std::f64::consts::TAU;
use std::fmt::Debug;
use std::ops::{Neg, Range};

use glam::{DMat3, DVec3, Vec3};
use ik_arm_kinematics::twist::{Stereographic, TwistReference};
use ik_arm_kinematics::two_bone::{TwoBone, TwoBonePose};
use proptest::prelude::*;
use proptest::test_runner::{RngSeed, TestCaseResult};

/// Error of a hand and of a limb's length, in units of L.
pub const EXACT: f64 = 3e-7;

/// Half an ulp of an f32 near 1: the largest error of one rounding.
pub const U: f64 = f32::EPSILON as f64 / 2.0;

/// The same cases on every run.
pub fn config(cases: u32, seed: u64) -> ProptestConfig {
    ProptestConfig {
        cases,
        rng_seed: RngSeed::Fixed(seed),
        max_global_rejects: cases.max(1024),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

/// Fails if the error is above the bound or NaN.
pub fn within(what: &str, error: f64, bound: f64) -> TestCaseResult {
    prop_assert!(error <= bound, "{what} is off by {error:e}, more than {bound:e}");
    Ok(())
}

/// Input of one solve.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    pub arm: TwoBone,
    pub cursor: Vec3,
    pub twist: f32,
}

impl Case {
    pub fn solve(self) -> TwoBonePose {
        self.arm.solve(self.cursor, self.twist)
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

/// θ_z and θ_y of a cursor; θ_z is 0 on the y axis.
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

/// Uniform on the unit sphere.
pub fn uniform_directions() -> impl Strategy<Value = DVec3> + Clone {
    (-1.0..1.0_f64, 0.0..TAU).prop_map(|(height, turn)| {
        let (sin, cos) = turn.sin_cos();
        let flat = (1.0 - height * height).sqrt();
        DVec3::new(flat * cos, height, flat * sin)
    })
}

/// Uniform on the unit sphere, and on and near every axis and plane: coordinates of very different
/// sizes.
pub fn directions() -> impl Strategy<Value = DVec3> {
    let size = prop_oneof![Just(0.0), 0.0..1.0, power_of_ten(-45.0..0.0)];
    let coordinate = either_sign(size);
    let lopsided = [coordinate.clone(), coordinate.clone(), coordinate]
        .prop_map(|at| DVec3::from_array(at).try_normalize().unwrap_or(DVec3::X));
    prop_oneof![uniform_directions(), lopsided]
}

/// Coordinates within ±`size`.
pub fn points(size: f32) -> impl Strategy<Value = Vec3> + Clone {
    [-size..size, -size..size, -size..size].prop_map(Vec3::from_array)
}

/// Arms with both lengths in a range.
pub fn arms_of(lengths: Range<f32>) -> impl Strategy<Value = TwoBone> {
    [lengths.clone(), lengths].prop_map(|[a, b]| TwoBone::new(a, b).expect("lengths"))
}

/// Every kind of twist reference.
pub fn references(poles: impl Strategy<Value = Vec3>) -> impl Strategy<Value = TwistReference> {
    prop_oneof![
        Just(TwistReference::Up),
        poles.prop_map(TwistReference::Pole),
        Just(TwistReference::Stereographic(Stereographic::default())),
        Just(TwistReference::Transport),
    ]
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

/// Any arm, direction and twist, with the cursor at a radius of so many |δ| plus so many L.
fn cases(radius: impl Strategy<Value = (f64, f64)>) -> impl Strategy<Value = Case> {
    (arms(), directions(), radius, -10.0..10.0_f32).prop_map(|(arm, direction, radius, twist)| {
        let (inner, outer) = limits(arm);
        let cursor = (direction * (radius.0 * inner + radius.1 * outer)).as_vec3();
        Case { arm, cursor, twist }
    })
}

/// Uniform in the logarithm.
pub fn power_of_ten(exponents: Range<f64>) -> impl Strategy<Value = f64> + Clone {
    exponents.prop_map(|exponent| 10_f64.powf(exponent))
}
