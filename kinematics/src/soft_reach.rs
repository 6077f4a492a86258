//! Soft limits: distance of the hand for a distance of the cursor, with softness and stretch.
//!
//! Near a straight arm the elbow speed grows like 1/√(L − D): the hand stops at the outer limit
//! while the elbow snaps. Softness lets the hand lag behind the cursor before the limit; stretch
//! lengthens the limbs instead; a minimum elbow angle keeps the arm from folding.
//!
//! With d the distance of the cursor from the shoulder, L = d₁ + d₂, δ = d₁ − d₂:
//!
//! ```text
//! d_min = max(|δ|, √(d₁² + d₂² − 2 d₁ d₂ cos φ_min))           for the minimum elbow angle φ_min
//! s = 0:   d' = clamp(d, d_min, L)
//! s > 0:   w = s (L − d_min)/2,   d_a = L − w,   d_b = d_min + w
//!          d > d_a:  d' = d_a + w (1 − exp(−(d − d_a)/w))
//!          d < d_b:  d' = d_min + w exp((d − d_b)/w)
//!          else      d' = d
//! stretch: σ = clamp(d/d', 1, max_stretch) for d > d_a, else 1
//! D = σ d', limbs σ d₁ and σ d₂
//! ```
//!
//! The curve has slope 1 at both joins, is monotone, and on the outer side never exceeds the
//! cursor's distance: the hand does not overshoot. With the defaults it is a plain clamp.
//!
//! Lengths share any one unit; angles are radians.
//!
//! # What breaks
//!
//! - Within the soft zones the hand is not at the cursor, by design, unless stretch closes the gap.
//! - Stretch ends at `max_stretch`, with a corner in the curve.
//! - A cursor that crosses the shoulder makes the hand jump by 2·d_min, whatever the softness.
//!
//! # Sources
//!
//! A. Nicholas, *Creating a Soft IK Setup*, 2012 (the outer curve); Autodesk Softimage, *Soft IK*.

use core::fmt;

use thiserror::Error;

use super::two_bone::TwoBone;
use super::vector::saturate;

/// Behaviour of the hand near its limits; hard limits by default.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "UncheckedSoftReach")
)]
pub struct SoftReach {
    softness: f32,
    max_stretch: f32,
    min_elbow_angle: f32,
}

/// An invalid [`SoftReach`].
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("{field} must be {range}, got {value}")]
pub struct SoftReachError {
    /// The invalid field.
    pub field: SoftReachField,
    /// The refused value.
    pub value: f32,
    /// The valid range, in words.
    pub range: &'static str,
}

/// A field of [`SoftReach`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SoftReachField {
    /// Softness s.
    Softness,
    /// Maximum factor by which the limbs are lengthened.
    MaxStretch,
    /// Minimum elbow angle φ_min, in radians.
    MinElbowAngle,
}

/// Limits of the hand's distance from the shoulder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReachLimits {
    /// Radius of the Inner Limit, the sphere around the shoulder that the hand cannot enter.
    pub inner: f32,
    /// Radius of the Outer Limit, the sphere around the shoulder that the hand cannot leave.
    pub outer: f32,
}

impl ReachLimits {
    /// These limits for an elbow whose inner angle is at least `elbow_angle`, radians.
    pub(crate) fn opened(self, bones: TwoBone, elbow_angle: f32) -> Self {
        let open = saturate(bones.distance_at(f64::from(elbow_angle)));
        Self { inner: self.inner.max(open).min(self.outer), ..self }
    }

    /// These limits in a blend of FK with the stretch `fk_stretch` and IK with soft limits. Stretch
    /// and smallest elbow angle are blended as poses are.
    pub(crate) fn blended(
        self,
        bones: TwoBone,
        soft_reach: SoftReach,
        influence: f32,
        fk_stretch: f32,
    ) -> Self {
        let influence = influence.clamp(0.0, 1.0);
        let stretched = |ik: f32| fk_stretch + (ik - fk_stretch) * influence;
        let Self { inner, outer } = self.opened(bones, soft_reach.min_elbow_angle() * influence);
        Self {
            inner: (inner * stretched(1.0)).min(f32::MAX),
            outer: (outer * stretched(soft_reach.max_stretch())).min(f32::MAX),
        }
    }
}

/// Distance of the hand from the shoulder, with stretch and slope.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HandDistance {
    /// D, the distance from the shoulder to the hand.
    pub distance: f32,
    /// σ, the factor by which the limbs are lengthened.
    pub stretch: f32,
    /// dD/dd, the ratio of the hand's radial speed to the cursor's.
    pub slope: f32,
}

impl fmt::Display for SoftReachField {
    /// The field's name, such as `max_stretch`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Softness => "softness",
            Self::MaxStretch => "max_stretch",
            Self::MinElbowAngle => "min_elbow_angle",
        })
    }
}

impl Default for SoftReach {
    fn default() -> Self {
        Self { softness: 0.0, max_stretch: 1.0, min_elbow_angle: 0.0 }
    }
}

impl SoftReach {
    /// Soft limits with a softness in [0, 1), a finite `max_stretch` of at least 1, and a
    /// `min_elbow_angle` in [0, π) radians.
    ///
    /// # Errors
    ///
    /// [`SoftReachError`] for a value outside its range.
    pub fn new(
        softness: f32,
        max_stretch: f32,
        min_elbow_angle: f32,
    ) -> Result<Self, SoftReachError> {
        let refused = |field, value, range| Err(SoftReachError { field, value, range });
        if !(0.0..1.0).contains(&softness) {
            return refused(SoftReachField::Softness, softness, "from 0 to less than 1");
        }
        if !(max_stretch.is_finite() && max_stretch >= 1.0) {
            return refused(SoftReachField::MaxStretch, max_stretch, "finite and at least 1");
        }
        if !(0.0..core::f32::consts::PI).contains(&min_elbow_angle) {
            return refused(
                SoftReachField::MinElbowAngle,
                min_elbow_angle,
                "from 0 to less than 180°",
            );
        }
        Ok(Self { softness, max_stretch, min_elbow_angle })
    }

    /// The softness s, in [0, 1).
    pub fn softness(self) -> f32 {
        self.softness
    }

    /// Maximum factor by which the limbs are lengthened, at least 1.
    pub fn max_stretch(self) -> f32 {
        self.max_stretch
    }

    /// Minimum inner angle φ_min at the elbow, radians.
    pub fn min_elbow_angle(self) -> f32 {
        self.min_elbow_angle
    }

    /// True if the limits are hard: a plain clamp without softness, stretch and minimum elbow
    /// angle.
    pub fn is_hard(self) -> bool {
        self == Self::default()
    }

    /// Limits of the hand's distance from the shoulder: d_min, and L times the maximum stretch.
    pub fn limits(self, bones: TwoBone) -> ReachLimits {
        ReachLimits {
            inner: self.least_distance(bones),
            outer: bones.stretched(self.max_stretch).outer_limit(),
        }
    }

    /// d_min, the hand's minimum distance from the shoulder.
    pub fn least_distance(self, bones: TwoBone) -> f32 {
        SoftLimits::new(self, bones).least as f32
    }

    /// Distance of the cursor from the shoulder for a hand at `distance`: the inverse of
    /// [`Self::hand_distance`]. The hand approaches a soft limit asymptotically; for a hand at the
    /// limit or beyond, the result is 17 widths of the soft zone from the zone's start, where the
    /// hand is at the limit to f32 precision. Where stretch brings the hand to the cursor, the
    /// result is `distance`.
    #[must_use]
    pub fn cursor_distance(self, bones: TwoBone, distance: f32) -> f32 {
        self.inverse_in(SoftLimits::new(self, bones), distance)
    }

    /// [`Self::cursor_distance`] of a hand that can be anywhere within `limits`, without softness
    /// and stretch.
    #[must_use]
    pub fn cursor_distance_within(self, limits: ReachLimits, distance: f32) -> f32 {
        let limits = SoftLimits::between(self, limits.inner.into(), limits.outer.into());
        self.inverse_in(limits, distance)
    }

    fn inverse_in(self, limits: SoftLimits, distance: f32) -> f32 {
        let (d, longest) = (f64::from(distance), f64::from(self.max_stretch));
        if d <= limits.outer_join() {
            return saturate(limits.harden(d).max(0.0));
        }
        let is_stretched_to_it = longest > 1.0 && d <= longest * limits.soften(d).0;
        if is_stretched_to_it { distance } else { saturate(limits.harden(d / longest).max(d)) }
    }

    /// Distance of the hand for a cursor at `cursor_distance` (finite, 0 or more) from the
    /// shoulder.
    #[must_use]
    pub fn hand_distance(self, bones: TwoBone, cursor_distance: f32) -> HandDistance {
        self.distance_in(SoftLimits::new(self, bones), cursor_distance)
    }

    /// [`Self::hand_distance`] of a hand that can be anywhere within `limits`, without softness and
    /// stretch.
    #[must_use]
    pub fn hand_distance_within(self, limits: ReachLimits, cursor_distance: f32) -> HandDistance {
        let limits = SoftLimits::between(self, limits.inner.into(), limits.outer.into());
        self.distance_in(limits, cursor_distance)
    }

    fn distance_in(self, limits: SoftLimits, cursor_distance: f32) -> HandDistance {
        let d = f64::from(cursor_distance);
        let (distance, slope) = limits.soften(d);
        let (longest, stretch) = (f64::from(self.max_stretch), limits.stretch(d, distance));
        // While stretch brings the hand to the cursor, the hand follows it; at maximum stretch it
        // lags as without stretch.
        let slope = if 1.0 < stretch && stretch < longest { 1.0 } else { slope * stretch };
        HandDistance {
            distance: saturate(distance * stretch),
            stretch: stretch as f32,
            slope: slope as f32,
        }
    }

    /// Distance of the hand before the limbs are lengthened, and the factor by which they are, for
    /// a cursor at `distance` and an unstretched hand that can be from `least` to `most` away.
    pub(crate) fn between(self, least: f64, most: f64, distance: f64) -> (f64, f64) {
        let limits = SoftLimits::between(self, least, most);
        let (softened, _) = limits.soften(distance);
        (softened, limits.stretch(distance, softened))
    }
}

/// Limits and soft zones of an arm, in f64: where the curve is nearly flat, f32 differences are
/// coarse.
#[derive(Clone, Copy)]
struct SoftLimits {
    least: f64,
    most: f64,
    /// Width w of the soft zones; 0 for hard limits.
    width: f64,
    max_stretch: f64,
}

impl SoftLimits {
    fn new(soft_reach: SoftReach, bones: TwoBone) -> Self {
        let (upper, lower) = (f64::from(bones.upper()), f64::from(bones.lower()));
        let least = bones.distance_at(f64::from(soft_reach.min_elbow_angle));
        Self::between(soft_reach, least, upper + lower)
    }

    fn between(soft_reach: SoftReach, least: f64, most: f64) -> Self {
        let width = 0.5 * f64::from(soft_reach.softness) * (most - least);
        Self { least, most, width, max_stretch: f64::from(soft_reach.max_stretch) }
    }

    /// σ, the factor by which the limbs are lengthened for a cursor at distance d and a softened
    /// distance d'.
    fn stretch(self, d: f64, softened: f64) -> f64 {
        if d > self.outer_join() { (d / softened).clamp(1.0, self.max_stretch) } else { 1.0 }
    }

    /// d_a, the cursor's distance above which the outer soft zone begins.
    fn outer_join(self) -> f64 {
        self.most - self.width
    }

    /// d_b, the cursor's distance below which the inner soft zone begins.
    fn inner_join(self) -> f64 {
        self.least + self.width
    }

    /// The hand's distance d' without stretch for a cursor at distance d, and the slope dd'/dd.
    fn soften(self, d: f64) -> (f64, f64) {
        let Self { least, most, width, .. } = self;
        if width == 0.0 {
            let is_between = least <= d && d <= most;
            return (d.clamp(least, most), f64::from(u8::from(is_between)));
        }
        if d > self.outer_join() {
            let left = (-(d - self.outer_join()) / width).exp();
            (most - width * left, left)
        } else if d < self.inner_join() {
            let left = ((d - self.inner_join()) / width).exp();
            (least + width * left, left)
        } else {
            (d, 1.0)
        }
    }

    /// The cursor's distance d for a hand at distance d' without stretch: the inverse of
    /// [`Self::soften`].
    fn harden(self, softened: f64) -> f64 {
        const ZONES: f64 = 17.0;
        let Self { least, most, width, .. } = self;
        if width == 0.0 {
            softened.clamp(least, most)
        } else if softened > self.outer_join() {
            self.outer_join() - width * ((most - softened) / width).max((-ZONES).exp()).ln()
        } else if softened < self.inner_join() {
            self.inner_join() + width * ((softened - least) / width).max((-ZONES).exp()).ln()
        } else {
            softened
        }
    }
}

/// Deserialized soft limits, not yet checked.
#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
struct UncheckedSoftReach {
    softness: f32,
    max_stretch: f32,
    min_elbow_angle: f32,
}

#[cfg(feature = "serde")]
impl TryFrom<UncheckedSoftReach> for SoftReach {
    type Error = SoftReachError;

    fn try_from(limits: UncheckedSoftReach) -> Result<Self, SoftReachError> {
        Self::new(limits.softness, limits.max_stretch, limits.min_elbow_angle)
    }
}
