//! Cubic splines through unevenly spaced knots in time.
//!
//! Between two knots, a smooth curve is the cubic Hermite polynomial with Catmull–Rom tangents:
//!
//! ```text
//! m₁ = (p₂ − p₀)/(t₂ − t₀)        m₂ = (p₃ − p₁)/(t₃ − t₁)        h = t₂ − t₁,  s = (t − t₁)/h
//! p(t) = (2s³ − 3s² + 1) p₁ + (s³ − 2s² + s) h m₁ + (3s² − 2s³) p₂ + (s³ − s²) h m₂
//! ```
//!
//! An automatic curve is the same polynomial with slopes that keep it between its knots. With the
//! secants a before a knot and b after it, each component has there
//!
//! ```text
//! a = (p₁ − p₀)/(t₁ − t₀)         b = (p₂ − p₁)/(t₂ − t₁)
//! m₁ = 0 if a·b ≤ 0, else the Catmull–Rom slope, clamped to ±3·min(|a|, |b|)
//! ```
//!
//! and at the first and last knot the only secant. So no component has an extremum between two
//! knots, and equal knots hold their value. At a knot between an automatic and a smooth curve, both
//! have the automatic slope.
//!
//! A knot can have slopes of its own in place of m, and the curve from a knot to the next one can
//! be a straight line or a step instead. Whoever knows that the values are the angles of a rotation
//! can turn the shortest way instead: see [`Spline::segment`].
//!
//! A missing outer neighbour is mirrored: p₀ = p₁ − (p₂ − p₁) and t₀ = t₁ − (t₂ − t₁). Before the
//! first knot and after the last, the curve is constant. Between smooth and automatic curves it is
//! C¹.
//!
//! # What breaks
//!
//! A smooth curve overshoots: the values 1000, 10, 10, 1000 at equal intervals give −114 between
//! the two in the middle. So does an automatic one whose knots have slopes of their own. The caller
//! clamps values that have a valid range. Angles must be unwrapped: from 350° to 10° the curve
//! passes through 180°, from 350° to 370° through 360°.
//!
//! # Source
//!
//! E. Catmull, R. Rom, *A Class of Local Interpolating Splines*, 1974; the tangents over uneven
//! times as in *Animation: Spline Interpolation*, wiki of Scotty3D (CMU 15-462). The bound of
//! automatic slopes: F. Fritsch, R. Carlson, *Monotone Piecewise Cubic Interpolation*, 1980.

use core::ops::{Add, Mul, RangeInclusive, Sub};

use glam::Vec3;

/// A number, or a vector of numbers that a spline interpolates each on its own.
pub trait SplineValue:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<f32, Output = Self>
{
    /// The value whose components are `function` of the components of `values`.
    #[must_use]
    fn combine<const N: usize>(values: [Self; N], function: impl Fn([f64; N]) -> f64) -> Self;
}

impl SplineValue for f32 {
    fn combine<const N: usize>(values: [Self; N], function: impl Fn([f64; N]) -> f64) -> Self {
        function(values.map(f64::from)) as Self
    }
}

impl SplineValue for Vec3 {
    fn combine<const N: usize>(values: [Self; N], function: impl Fn([f64; N]) -> f64) -> Self {
        let component = |axis: usize| f32::combine(values.map(|value| value[axis]), &function);
        Self::new(component(0), component(1), component(2))
    }
}

/// A value at a time, with the shape of the curve there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Knot<V> {
    /// Time in seconds; finite.
    pub time: f64,
    /// Value at this time.
    pub value: V,
    /// Curve from this knot to the next one.
    pub interpolation: Interpolation,
    /// Slopes of cubic curves at this knot; `None` for the tangent that the neighbours give.
    pub slopes: Option<Slopes<V>>,
}

/// The curve from a knot to the next one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum Interpolation {
    /// A cubic polynomial with slopes of both knots that keep it between them.
    Auto,
    /// A cubic polynomial with the Catmull–Rom tangents of both knots.
    #[default]
    Smooth,
    /// A straight line.
    Linear,
    /// The value of the knot, until the next one.
    Step,
    /// For the angles of a joint, the shortest turn at constant speed, by spherical linear
    /// interpolation; for any other value, a straight line.
    Slerp,
}

/// Two neighbouring knots, and where a time is between them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment<V> {
    /// The knot before or at the time.
    pub from: Knot<V>,
    /// The knot after the time.
    pub to: Knot<V>,
    /// Part of the way from one to the other, 0 to less than 1.
    pub part: f64,
}

/// Slopes of a curve at a knot, per second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slopes<V> {
    /// Slope with which the curve arrives from the knot before.
    pub arriving: V,
    /// Slope with which the curve leaves to the knot after.
    pub leaving: V,
}

impl Interpolation {
    /// All kinds, in the order of menus.
    pub const ALL: [Self; 5] = [Self::Auto, Self::Smooth, Self::Linear, Self::Step, Self::Slerp];

    /// True if the curve is a cubic polynomial with the slopes of both knots.
    pub fn is_cubic(self) -> bool {
        match self {
            Self::Auto | Self::Smooth => true,
            Self::Linear | Self::Step | Self::Slerp => false,
        }
    }

    /// Name on screen.
    pub fn title(self) -> &'static str {
        match self {
            Self::Auto => "Auto",
            Self::Smooth => "Catmull–Rom",
            Self::Linear => "Linear",
            Self::Step => "Step",
            Self::Slerp => "Slerp",
        }
    }
}

impl<V> Knot<V> {
    /// A knot with a smooth curve and Catmull–Rom tangents.
    pub fn new(time: f64, value: V) -> Self {
        Self { time, value, interpolation: Interpolation::Smooth, slopes: None }
    }
}

/// A cubic spline through knots sorted by time, with at most one knot per time; constant before the
/// first and after the last.
///
/// ```
/// use ik_arm_kinematics::spline::Spline;
///
/// let mut height = Spline::default();
/// height.insert(0.0, 1.0_f32);
/// height.insert(2.0, 3.0);
/// height.insert(3.0, 3.0);
/// assert_eq!(height.at(2.0), Some(3.0));
/// assert_eq!(height.at(-5.0), Some(1.0));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Spline<V> {
    knots: Vec<Knot<V>>,
}

impl<V> Default for Spline<V> {
    /// A spline without knots.
    fn default() -> Self {
        Self { knots: Vec::new() }
    }
}

/// Of several knots at the same time, the last in iteration order is kept; knots at non-finite
/// times are skipped.
impl<V: Copy> FromIterator<Knot<V>> for Spline<V> {
    fn from_iter<T: IntoIterator<Item = Knot<V>>>(knots: T) -> Self {
        let mut spline = Self::default();
        for knot in knots {
            spline.insert_knot(knot);
        }
        spline
    }
}

impl<V: Copy> Spline<V> {
    /// All knots, sorted by time.
    pub fn knots(&self) -> &[Knot<V>] {
        &self.knots
    }

    /// True if the spline has no knots.
    pub fn is_empty(&self) -> bool {
        self.knots.is_empty()
    }

    /// Inserts a knot, or sets the value of the knot at this time, which keeps its interpolation
    /// and slopes. Does nothing if the time is not finite.
    pub fn insert(&mut self, time: f64, value: V) {
        let knot = self.knot(time).copied().unwrap_or(Knot::new(time, value));
        self.insert_knot(Knot { value, ..knot });
    }

    /// Inserts a knot, or replaces the knot at its time. Does nothing if the time is not finite.
    pub fn insert_knot(&mut self, knot: Knot<V>) {
        if !knot.time.is_finite() {
            return;
        }
        // Adding 0 makes −0 and 0 the same time.
        let knot = Knot { time: knot.time + 0.0, ..knot };
        match self.search(knot.time) {
            Ok(index) => self.knots[index] = knot,
            Err(index) => self.knots.insert(index, knot),
        }
    }

    /// Removes the knot at exactly this time and returns its value; `None` if there is no such
    /// knot.
    pub fn remove(&mut self, time: f64) -> Option<V> {
        let index = self.search(time).ok()?;
        Some(self.knots.remove(index).value)
    }

    /// Value of the knot at exactly this time; `None` if there is no such knot.
    pub fn get(&self, time: f64) -> Option<V> {
        self.knot(time).map(|knot| knot.value)
    }

    /// The knot at exactly this time; `None` if there is no such knot.
    pub fn knot(&self, time: f64) -> Option<&Knot<V>> {
        Some(&self.knots[self.search(time).ok()?])
    }

    /// Value of the last knot at or before a time, for values that do not blend. Before the first
    /// knot it is the first knot's value; without knots it is `None`.
    pub fn step(&self, time: f64) -> Option<V> {
        let until = self.knots.partition_point(|knot| knot.time <= time);
        Some(self.knots.get(until.saturating_sub(1))?.value)
    }

    /// The knots around a time; `None` before the first knot, and at and after the last.
    pub fn segment(&self, time: f64) -> Option<Segment<V>> {
        let after = self.knots.partition_point(|knot| knot.time <= time);
        let (from, to) = (*self.knots.get(after.checked_sub(1)?)?, *self.knots.get(after)?);
        Some(Segment { from, to, part: (time - from.time) / (to.time - from.time) })
    }

    fn search(&self, time: f64) -> Result<usize, usize> {
        let index = self.knots.partition_point(|knot| knot.time < time);
        match self.knots.get(index) {
            Some(knot) if knot.time == time => Ok(index),
            _ => Err(index),
        }
    }
}

impl<V: SplineValue> Spline<V> {
    /// Interpolated value at a time (see the module); `None` without knots.
    pub fn at(&self, time: f64) -> Option<V> {
        interpolated(&self.knots, time)
    }

    /// Slopes of cubic curves at the knot at exactly this time, per second: its own, or else the
    /// tangent that the neighbours give. `None` if there is no such knot.
    pub fn slopes(&self, time: f64) -> Option<Slopes<V>> {
        let index = self.search(time).ok()?;
        let given = tangent(&self.knots, index, 1.0);
        let given = Slopes { arriving: given, leaving: given };
        Some(self.knots[index].slopes.unwrap_or(given))
    }

    /// Value at a time of the spline through only those knots whose times are in a range; `None` if
    /// there are none.
    pub fn at_among(&self, times: RangeInclusive<f64>, time: f64) -> Option<V> {
        let start = self.knots.partition_point(|knot| knot.time < *times.start());
        let end = self.knots.partition_point(|knot| knot.time <= *times.end());
        interpolated(self.knots.get(start..end)?, time)
    }
}

/// Interpolated value of the spline through `knots`; `None` without knots.
fn interpolated<V: SplineValue>(knots: &[Knot<V>], time: f64) -> Option<V> {
    let (first, last) = (knots.first()?, knots.last()?);
    if time.is_nan() || time <= first.time {
        return Some(first.value);
    }
    if time >= last.time {
        return Some(last.value);
    }
    let after = knots.partition_point(|knot| knot.time <= time);
    let (from, to) = (knots[after - 1], knots[after]);
    if time == from.time {
        return Some(from.value);
    }
    let span = to.time - from.time;
    let s = (time - from.time) / span;
    let tangents = || {
        let leaving = from.slopes.map(|slopes| slopes.leaving * span as f32);
        let arriving = to.slopes.map(|slopes| slopes.arriving * span as f32);
        (
            leaving.unwrap_or_else(|| tangent(knots, after - 1, span)),
            arriving.unwrap_or_else(|| tangent(knots, after, span)),
        )
    };
    Some(match from.interpolation {
        Interpolation::Step => from.value,
        Interpolation::Linear | Interpolation::Slerp => {
            from.value * (1.0 - s) as f32 + to.value * s as f32
        }
        Interpolation::Smooth => {
            let [a, b, c, d] = hermite(s).map(|weight| weight as f32);
            let (leaving, arriving) = tangents();
            from.value * a + leaving * b + to.value * c + arriving * d
        }
        Interpolation::Auto => {
            let (leaving, arriving) = tangents();
            let [_, b, c, d] = hermite(s);
            // From the rise, so that equal values are held without rounding.
            V::combine(
                [from.value, to.value, leaving, arriving],
                |[from, to, leaving, arriving]| {
                    from + ((to - from) * c + leaving * b + arriving * d)
                },
            )
        }
    })
}

/// h·m at a knot: the tangent m that its neighbours give, times the time span h.
fn tangent<V: SplineValue>(knots: &[Knot<V>], knot: usize, span: f64) -> V {
    let before = knot.checked_sub(1).map(|before| knots[before]);
    let after = knots.get(knot + 1).copied();
    let is_auto = |from: Knot<V>| from.interpolation == Interpolation::Auto;
    match (before, after) {
        (Some(before), Some(after)) if is_auto(before) || is_auto(knots[knot]) => {
            bounded_tangent([before, knots[knot], after], span)
        }
        _ => catmull_rom_tangent(before, knots[knot], after, span),
    }
}

/// h·m with the automatic slope m at the second of three knots.
fn bounded_tangent<V: SplineValue>(knots: [Knot<V>; 3], span: f64) -> V {
    let (before, after) = (knots[1].time - knots[0].time, knots[2].time - knots[1].time);
    V::combine(knots.map(|knot| knot.value), |[p0, p1, p2]| {
        let (a, b) = ((p1 - p0) / before, (p2 - p1) / after);
        if a.signum() != b.signum() || a == 0.0 || b == 0.0 {
            return 0.0;
        }
        let most = 3.0 * a.abs().min(b.abs());
        span * ((p2 - p0) / (before + after)).clamp(-most, most)
    })
}

/// h·m with the Catmull–Rom tangent m at a knot.
fn catmull_rom_tangent<V: SplineValue>(
    before: Option<Knot<V>>,
    here: Knot<V>,
    after: Option<Knot<V>>,
    span: f64,
) -> V {
    let mirrored = |of: Knot<V>| {
        let time = here.time - (of.time - here.time);
        Knot::new(time, here.value - (of.value - here.value))
    };
    let (before, after) = match (before, after) {
        (Some(before), Some(after)) => (before, after),
        (None, Some(after)) => (mirrored(after), after),
        (Some(before), None) => (before, mirrored(before)),
        (None, None) => (here, here),
    };
    let wide = after.time - before.time;
    let part = if wide > 0.0 { span / wide } else { 0.0 };
    (after.value - before.value) * part as f32
}

/// Weights of the cubic Hermite polynomial between two values, p₁ and p₂, with the slopes m₁ and m₂
/// over a span of time h: p(s) = a·p₁ + b·h·m₁ + c·p₂ + d·h·m₂ for the weights [a, b, c, d]. `s` is
/// the part of the span that has passed, from 0 to 1; beyond it, the polynomial goes on.
pub fn hermite(s: f64) -> [f64; 4] {
    let (s2, s3) = (s * s, s * s * s);
    [2.0 * s3 - 3.0 * s2 + 1.0, s3 - 2.0 * s2 + s, 3.0 * s2 - 2.0 * s3, s3 - s2]
}
