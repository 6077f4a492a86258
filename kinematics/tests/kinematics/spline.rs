//! Splines through knots at uneven times.

use core::ops::{Add, Mul, Sub};

use glam::Vec3;
use ik_arm_kinematics::spline::{Interpolation, Knot, Slopes, Spline, SplineValue};
use proptest::collection::vec;
use proptest::prelude::*;

use crate::common::strategies::config;
use crate::common::{Random, cases};

fn spline(knots: &[(f64, f32)]) -> Spline<f32> {
    knots.iter().map(|&(time, value)| Knot::new(time, value)).collect()
}

fn at(spline: &Spline<f32>, time: f64) -> f32 {
    spline.at(time).expect("it has knots")
}

/// The formula of the module once more, in f64 and with another way to the neighbours: knots are
/// added at both ends instead of being looked for.
fn twin(knots: &[(f64, f32)], time: f64) -> f64 {
    let mut k: Vec<(f64, f64)> = knots.iter().map(|&(t, v)| (t, f64::from(v))).collect();
    let n = k.len();
    if time <= k[0].0 {
        return k[0].1;
    }
    if time >= k[n - 1].0 {
        return k[n - 1].1;
    }
    k.insert(0, (2.0 * k[0].0 - k[1].0, 2.0 * k[0].1 - k[1].1));
    k.push((2.0 * k[n].0 - k[n - 1].0, 2.0 * k[n].1 - k[n - 1].1));
    let i = (1..n).find(|&i| time < k[i + 1].0).expect("between two knots");
    let m = |i: usize| (k[i + 1].1 - k[i - 1].1) / (k[i + 1].0 - k[i - 1].0);
    let (h, dp) = (k[i + 1].0 - k[i].0, k[i + 1].1 - k[i].1);
    let s = (time - k[i].0) / h;
    // Horner's form of the cubic with the same ends and slopes.
    let (a, b) = (h * m(i), h * m(i + 1));
    k[i].1 + s * (a + s * (3.0 * dp - 2.0 * a - b + s * (a + b - 2.0 * dp)))
}

/// At least two knots, at uneven times.
fn knots() -> impl Strategy<Value = Vec<(f64, f32)>> {
    vec((0.01..3.0_f64, -100.0..100.0_f32), 2..12).prop_map(|steps| {
        let mut time = -4.0;
        steps
            .into_iter()
            .map(|(step, value)| {
                time += step;
                (time, value)
            })
            .collect()
    })
}

proptest! {
    #![proptest_config(config(500, 0x5b11_4e00))]

    #[test]
    fn it_passes_through_every_knot_bit_for_bit(knots in knots()) {
        let spline = spline(&knots);
        for (time, value) in knots {
            prop_assert_eq!(at(&spline, time).to_bits(), value.to_bits());
        }
    }

    #[test]
    fn it_is_the_cubic_with_catmull_rom_tangents(knots in knots(), part in 0.0..1.0_f64) {
        let spline = spline(&knots);
        let (first, last) = (knots[0].0, knots[knots.len() - 1].0);
        let time = first + (last - first) * part;
        let (found, expected) = (f64::from(at(&spline, time)), twin(&knots, time));
        // Between knots 300 times as near as between others the tangents are that much longer.
        prop_assert!((found - expected).abs() < 2e-4, "{found}, not {expected}");
    }

    #[test]
    fn its_slope_is_the_same_on_both_sides_of_an_interior_knot(knots in knots()) {
        // Four points tell a cubic's slope at its end exactly.
        const STEP: f64 = 0.03;
        let tight = knots.windows(2).any(|pair| pair[1].0 - pair[0].0 < 3.0 * STEP);
        prop_assume!(!tight);
        let spline = spline(&knots);
        let slope = |time: f64, step: f64| {
            let [p0, p1, p2, p3] =
                [0.0, 1.0, 2.0, 3.0].map(|n| f64::from(at(&spline, time + n * step)));
            (-11.0 * p0 + 18.0 * p1 - 9.0 * p2 + 2.0 * p3) / (6.0 * step)
        };
        for &(time, _) in &knots[1..knots.len() - 1] {
            let (before, after) = (slope(time, -STEP), slope(time, STEP));
            prop_assert!((before - after).abs() < 0.05, "{before} before, {after} after");
        }
    }

    #[test]
    fn among_some_knots_it_is_the_spline_through_them_alone(
        knots in knots(), from in 0..12_usize, count in 0..12_usize, part in -0.1..1.1_f64
    ) {
        let some: Vec<_> = knots.iter().copied().skip(from).take(count).collect();
        let (first, last) = (knots[0].0, knots[knots.len() - 1].0);
        let time = first + (last - first) * part;
        let (start, end) = some.first().zip(some.last()).map_or((9e9, -9e9), |(a, b)| (a.0, b.0));
        prop_assert_eq!(spline(&knots).at_among(start..=end, time), spline(&some).at(time));
    }

    #[test]
    fn vectors_are_three_numbers(knots in knots(), time in -5.0..30.0_f64) {
        let points: Spline<Vec3> = knots
            .iter()
            .map(|&(time, x)| Knot::new(time, Vec3::new(x, -x, 2.0 * x)))
            .collect();
        let (point, x) = (points.at(time).expect("knots"), at(&spline(&knots), time));
        prop_assert!((point - Vec3::new(x, -x, 2.0 * x)).abs().max_element() < 1e-3);
    }

    #[test]
    fn knots_go_in_and_out_in_any_order(knots in knots(), order in any::<u64>()) {
        let mut shuffled = knots.clone();
        shuffled.sort_by_key(|(time, _)| time.to_bits().wrapping_mul(order | 1));
        let mut spline = spline(&shuffled);
        let times: Vec<f64> = spline.knots().iter().map(|knot| knot.time).collect();
        prop_assert!(times.is_sorted());
        for (time, value) in shuffled {
            prop_assert_eq!(spline.get(time), Some(value));
            prop_assert_eq!(spline.remove(time), Some(value));
            prop_assert_eq!(spline.remove(time), None);
        }
        prop_assert!(spline.is_empty());
    }
}

#[test]
fn values_computed_by_hand() {
    // m at 1 is (4 − 0)/(3 − 0) = 4/3, m at 3 is (3 − 1)/(4 − 1) = 2/3; h = 2. At the middle:
    // ½·1 + ⅛·2·4/3 + ½·4 − ⅛·2·2/3 = 8/3.
    let spline = spline(&[(0.0, 0.0), (1.0, 1.0), (3.0, 4.0), (4.0, 3.0)]);
    assert!((at(&spline, 2.0) - 8.0 / 3.0).abs() < 1e-6);
    // Mirrored: p₀ = −1 at −1, so m at 0 is (1 + 1)/2 = 1. At a quarter, from 0 to 1:
    // 0 + 9/64·1 + 10/64·1 − 3/64·4/3 = 15/64.
    assert!((at(&spline, 0.25) - 15.0 / 64.0).abs() < 1e-6);
}

#[test]
fn two_knots_make_a_straight_line() {
    let spline = spline(&[(1.0, 10.0), (5.0, 18.0)]);
    for step in 0..=16 {
        let time = 1.0 + f64::from(step) * 0.25;
        assert!((f64::from(at(&spline, time)) - (8.0 + 2.0 * time)).abs() < 1e-5);
    }
}

#[test]
fn outside_it_stays_at_the_outer_knots() {
    let spline = spline(&[(1.0, 10.0), (2.0, -3.0), (5.0, 18.0)]);
    for time in [f64::NEG_INFINITY, -1e300, 0.0, 0.999_999_9, 1.0, f64::NAN] {
        assert_eq!(at(&spline, time), 10.0);
    }
    for time in [5.0, 5.000_001, 1e300, f64::INFINITY] {
        assert_eq!(at(&spline, time), 18.0);
    }
}

#[test]
fn one_knot_is_constant_and_no_knots_have_no_value() {
    let one = spline(&[(2.0, 7.0)]);
    assert_eq!([-1.0, 2.0, 9.0].map(|time| at(&one, time)), [7.0; 3]);
    assert_eq!(Spline::<f32>::default().at(0.0), None);
    assert_eq!(Spline::<f32>::default().step(0.0), None);
}

#[test]
fn a_knot_at_an_existing_time_takes_its_place() {
    let mut spline = spline(&[(0.0, 1.0), (1.0, 2.0)]);
    spline.insert(1.0, 5.0);
    spline.insert(-0.0, 6.0);
    assert_eq!(spline.knots().len(), 2);
    assert_eq!((at(&spline, 0.0), at(&spline, 1.0)), (6.0, 5.0));
}

#[test]
fn a_time_that_is_not_finite_is_refused() {
    let mut spline = spline(&[(0.0, 1.0)]);
    for time in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        spline.insert(time, 2.0);
    }
    assert_eq!(spline.knots().len(), 1);
}

#[test]
fn values_that_do_not_blend_step() {
    let switch = spline(&[(1.0, 1.0), (2.0, 0.0)]);
    let values = [0.0, 1.0, 1.999, 2.0, 9.0].map(|time| switch.step(time));
    assert_eq!(values, [Some(1.0), Some(1.0), Some(1.0), Some(0.0), Some(0.0)]);
}

#[test]
fn it_overshoots_as_the_documentation_says() {
    let lengths = spline(&[(0.0, 1000.0), (1.0, 10.0), (2.0, 10.0), (3.0, 1000.0)]);
    let lowest = (0..=300).map(|step| at(&lengths, f64::from(step) / 100.0)).fold(1e9, f32::min);
    assert!((lowest + 113.75).abs() < 0.01, "{lowest}");
}

/// A spline whose knots have shapes and slopes of their own.
fn shaped() -> impl Strategy<Value = Vec<Knot<f32>>> {
    let slope = -50.0..50.0_f32;
    let shape = (0..Interpolation::ALL.len(), proptest::option::of((slope.clone(), slope)));
    (knots(), vec(shape, 12)).prop_map(|(knots, shapes)| {
        let knots = knots.into_iter().zip(shapes);
        let shaped = knots.map(|((time, value), (kind, slopes))| {
            let slopes = slopes.map(|(arriving, leaving)| Slopes { arriving, leaving });
            Knot { time, value, interpolation: Interpolation::ALL[kind], slopes }
        });
        shaped.collect()
    })
}

/// The curve between two knots as a Bézier curve by de Casteljau's construction, in f64.
fn bezier(from: (f64, f64), leaving: f64, arriving: f64, to: (f64, f64), time: f64) -> f64 {
    let h = to.0 - from.0;
    let s = (time - from.0) / h;
    let mut points = [from.1, from.1 + leaving * h / 3.0, to.1 - arriving * h / 3.0, to.1];
    for last in (1..4).rev() {
        for i in 0..last {
            points[i] += (points[i + 1] - points[i]) * s;
        }
    }
    points[0]
}

proptest! {
    #![proptest_config(config(500, 0x5b11_4e01))]

    #[test]
    fn shapes_and_slopes_of_knots_give_lines_steps_and_the_cubic_with_these_slopes(
        knots in shaped(),
        part in 0.001..0.999_f64,
    ) {
        let spline: Spline<f32> = knots.iter().copied().collect();
        let plain: Vec<(f64, f32)> = knots.iter().map(|knot| (knot.time, knot.value)).collect();
        for pair in knots.windows(2) {
            let (from, to) = (pair[0], pair[1]);
            let time = from.time + part * (to.time - from.time);
            let found = f64::from(spline.at(time).unwrap());
            let [a, b] = [from, to].map(|knot| (knot.time, f64::from(knot.value)));
            let has_auto = |at: f64| {
                let beside = [at - 1e-9, at + 1e-9].map(|time| spline.segment(time));
                beside.iter().flatten().any(|it| it.from.interpolation == Interpolation::Auto)
            };
            let automatic = |at: f64| {
                if has_auto(at) {
                    return auto_slope(&plain, at);
                }
                let step = 1e-4 * (to.time - from.time);
                let inwards = if at == from.time { step } else { -step };
                (twin(&plain, at + inwards) - twin(&plain, at)) / inwards
            };
            let expected = match from.interpolation {
                Interpolation::Step => a.1,
                Interpolation::Linear | Interpolation::Slerp => a.1 + (b.1 - a.1) * part,
                Interpolation::Smooth | Interpolation::Auto => {
                    let leaving = from.slopes.map(|it| f64::from(it.leaving));
                    let arriving = to.slopes.map(|it| f64::from(it.arriving));
                    let leaving = leaving.unwrap_or_else(|| automatic(from.time));
                    let arriving = arriving.unwrap_or_else(|| automatic(to.time));
                    bezier(a, leaving, arriving, b, time)
                }
            };
            prop_assert!((found - expected).abs() < 2e-2, "{found} {expected} {:?}", from.interpolation);
        }
        for knot in &knots {
            prop_assert_eq!(spline.at(knot.time), Some(knot.value), "passes through its knots");
        }
    }
}

#[test]
fn a_new_value_at_a_knot_keeps_its_shape() {
    let slopes = Some(Slopes { arriving: 1.0, leaving: -2.0 });
    let knot = Knot { time: 1.0, value: 5.0, interpolation: Interpolation::Linear, slopes };
    let mut spline: Spline<f32> = [knot, Knot::new(2.0, 0.0)].into_iter().collect();
    spline.insert(1.0, 7.0);
    assert_eq!(spline.knot(1.0), Some(&Knot { value: 7.0, ..knot }));
    assert_eq!(spline.slopes(1.0), slopes);
    assert_eq!(spline.slopes(2.0), Some(Slopes { arriving: -7.0, leaving: -7.0 }));
    assert_eq!(spline.slopes(1.5), None);
}

/// The automatic slope at the knot at a time, in f64, as a mean of the secants weighted by their
/// times.
fn auto_slope(knots: &[(f64, f32)], time: f64) -> f64 {
    let secant = |pair: &[(f64, f32)]| {
        let rise = f64::from(pair[1].1) - f64::from(pair[0].1);
        (rise / (pair[1].0 - pair[0].0), pair[1].0 - pair[0].0)
    };
    let beside = knots.windows(2).filter(|pair| pair.iter().any(|knot| knot.0 == time));
    match beside.map(secant).collect::<Vec<_>>()[..] {
        [(only, _)] => only,
        [(a, before), (b, after)] => {
            let mean = (a * before + b * after) / (before + after);
            if a * b <= 0.0 {
                0.0
            } else {
                mean.signum() * mean.abs().min(3.0 * a.abs()).min(3.0 * b.abs())
            }
        }
        _ => panic!("one or two secants meet at {time}"),
    }
}

/// Keys at uneven times, some of them equal to the one before in some components.
fn auto_keys(random: &mut Random, count: usize) -> Vec<Knot<Vec3>> {
    let (mut time, mut value) = (-3.0, Vec3::ZERO);
    let key = |_| {
        time += 10_f64.powf(f64::from(random.within(-2.0..0.5)));
        let size = 10_f32.powf(random.within(-2.0..3.0));
        let next = random.vector(size);
        let holds = [0; 3].map(|_| random.chance(0.3));
        value = Vec3::from_array(
            [0, 1, 2].map(|axis| if holds[axis] { value[axis] } else { next[axis] }),
        );
        Knot { interpolation: Interpolation::Auto, ..Knot::new(time, value) }
    };
    (0..count).map(key).collect()
}

#[test]
fn automatic_curves_have_no_extremum_between_two_keys_in_any_component() {
    const KEYS: usize = 20;
    const STEPS: usize = 64;
    let mut random = Random(0xa070);
    for _ in 0..cases(10_000) / KEYS {
        let keys = auto_keys(&mut random, KEYS);
        let spline: Spline<Vec3> = keys.iter().copied().collect();
        for pair in keys.windows(2) {
            let [from, to] = [pair[0], pair[1]];
            let at = |step: usize| {
                let part = step as f64 / STEPS as f64;
                spline.at(from.time + part * (to.time - from.time)).expect("keys")
            };
            for step in 0..STEPS {
                let (here, next) = (at(step), at(step + 1));
                for axis in 0..3 {
                    let (low, high) = (
                        from.value[axis].min(to.value[axis]),
                        from.value[axis].max(to.value[axis]),
                    );
                    let value = here[axis];
                    assert!((low..=high).contains(&value), "{value} not in {low} to {high}");
                    let rises = to.value[axis] - from.value[axis];
                    let onwards = (next[axis] - value) * rises.signum();
                    assert!(onwards >= 0.0, "goes back by {onwards}");
                    assert!(rises != 0.0 || next[axis] == from.value[axis], "a hold holds");
                }
            }
        }
    }
}

/// A number in double precision.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Double(f64);

impl Add for Double {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}

impl Sub for Double {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self(self.0 - other.0)
    }
}

impl Mul<f32> for Double {
    type Output = Self;

    fn mul(self, factor: f32) -> Self {
        Self(self.0 * f64::from(factor))
    }
}

impl SplineValue for Double {
    fn combine<const N: usize>(values: [Self; N], function: impl Fn([f64; N]) -> f64) -> Self {
        Self(function(values.map(|it| it.0)))
    }
}

#[test]
fn automatic_curves_have_one_slope_at_each_key_by_finite_differences() {
    let mut random = Random(0xc1);
    for _ in 0..cases(500) {
        let keys = auto_keys(&mut random, 8);
        let double = |key: &Knot<Vec3>| Knot {
            interpolation: key.interpolation,
            ..Knot::new(key.time, Double(f64::from(key.value.x)))
        };
        let spline: Spline<Double> = keys.iter().map(double).collect();
        let plain: Vec<_> = keys.iter().map(|key| (key.time, key.value.x)).collect();
        for three in keys.windows(3) {
            let [before, here, after] = [three[0].time, three[1].time, three[2].time];
            // Four points tell a cubic's slope at its end exactly.
            let slope = |step: f64| {
                let [p0, p1, p2, p3] =
                    [0.0, 1.0, 2.0, 3.0].map(|n| spline.at(here + n * step).expect("keys").0);
                (-11.0 * p0 + 18.0 * p1 - 9.0 * p2 + 2.0 * p3) / (6.0 * step)
            };
            let (arriving, leaving) = (slope(-0.3 * (here - before)), slope(0.3 * (after - here)));
            let expected = auto_slope(&plain, here);
            let size = [before, after].map(|time| {
                (spline.at(time).expect("keys").0 - spline.at(here).expect("keys").0).abs()
                    / (time - here).abs()
            });
            let near = 1e-9 * (1.0 + size[0].max(size[1]));
            assert!((arriving - expected).abs() < near, "{arriving}, not {expected}");
            assert!((leaving - expected).abs() < near, "{leaving}, not {expected}");
        }
    }
}

#[test]
fn two_equal_automatic_keys_hold_where_catmull_rom_overshoots() {
    let keys = [(0.0, 90.0), (1.0, 177.0), (2.0, 177.0), (3.0, 90.0)];
    let highest = |interpolation| {
        let knot = |(time, value)| Knot { interpolation, ..Knot::new(time, value) };
        let spline: Spline<f32> = keys.map(knot).into_iter().collect();
        (0..=300).map(|step| at(&spline, f64::from(step) / 100.0)).fold(0.0, f32::max)
    };
    assert!(highest(Interpolation::Smooth) > 187.0);
    assert_eq!(highest(Interpolation::Auto), 177.0);
}

#[test]
fn an_automatic_curve_beside_a_smooth_one_gives_both_its_slope() {
    let (auto, smooth) = (Interpolation::Auto, Interpolation::Smooth);
    let spline = |kinds: [Interpolation; 4]| -> Spline<f32> {
        let keys = [(0.0, 0.0), (1.0, 10.0), (2.0, 10.0), (3.0, 0.0)];
        let knot =
            |((time, value), interpolation)| Knot { interpolation, ..Knot::new(time, value) };
        keys.into_iter().zip(kinds).map(knot).collect()
    };
    let slopes = |kinds, time| spline(kinds).slopes(time).expect("a knot").leaving;
    assert_eq!(slopes([smooth; 4], 1.0), 5.0);
    assert_eq!(slopes([smooth, auto, smooth, smooth], 1.0), 0.0);
    assert_eq!(slopes([smooth, auto, smooth, smooth], 2.0), 0.0);
    assert_eq!(slopes([auto, smooth, smooth, smooth], 1.0), 0.0);
    assert_eq!(slopes([auto, smooth, smooth, smooth], 2.0), -5.0);
    assert_eq!(slopes([auto; 4], 0.0), 10.0);
    assert_eq!(slopes([auto; 4], 3.0), -10.0);
}
