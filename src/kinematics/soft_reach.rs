//! How far the hand goes for a cursor: softly up to the limits, or past them by stretching.
//!
//! Near a straight arm the elbow moves like 1/√(L − D): a hand that runs into the outer limit stops
//! dead while its elbow snaps. Softness lets the hand lag behind the cursor before that; stretching
//! makes the limbs longer instead; a smallest elbow angle keeps the arm from folding up.
//!
//! With d how far the cursor is from the shoulder, L = d₁ + d₂, δ = d₁ − d₂:
//!
//! ```text
//! d_min = max(|δ|, √(d₁² + d₂² − 2 d₁ d₂ cos φ_min))           by the smallest elbow angle φ_min
//! s = 0:   d' = clamp(d, d_min, L)
//! s > 0:   w = s (L − d_min)/2,   d_a = L − w,   d_b = d_min + w
//!          d > d_a:  d' = d_a + w (1 − exp(−(d − d_a)/w))
//!          d < d_b:  d' = d_min + w exp((d − d_b)/w)
//!          else      d' = d
//! stretch: σ = clamp(d/d', 1, max_stretch) for d > d_a, else 1
//! D = σ d', limbs σ d₁ and σ d₂
//! ```
//!
//! The curve has slope 1 at both joins, is monotone, and never asks for more than the cursor does on
//! the outer side: the hand does not overshoot. Softness 0 without the rest is a plain clamp.
//!
//! Lengths share any one unit; angles are radians.
//!
//! # What breaks
//!
//! - The hand is not at the cursor where it is softened: that is the point. Only stretching brings it
//!   there again.
//! - Stretching stops short at `max_stretch`, with a corner in the curve.
//! - A cursor that crosses the shoulder itself makes the hand jump by 2·d_min, whatever the softness.
//!
//! # Sources
//!
//! A. Nicholas, *Creating a Soft IK Setup*, 2012 (the outer curve); Autodesk Softimage, *Soft IK*.

use thiserror::Error;

use super::two_bone::TwoBone;

/// How the hand meets its limits. As it is by default, exactly and hard.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SoftReach {
    softness: f32,
    max_stretch: f32,
    min_elbow_angle: f32,
}

/// A softening that no arm can have.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("{field} is {value}; it must be {range}")]
pub struct SoftReachError {
    /// `"softness"`, `"max_stretch"` or `"min_elbow_angle"`.
    pub field: &'static str,
    /// What was given.
    pub value: f32,
    /// What would be right.
    pub range: &'static str,
}

/// How far a hand goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    /// D, from the shoulder to the hand.
    pub distance: f32,
    /// σ, how many times as long the limbs are.
    pub stretch: f32,
    /// dD/dd, how fast the hand goes for the cursor, outwards.
    pub slope: f32,
}

impl Default for SoftReach {
    fn default() -> Self {
        Self { softness: 0.0, max_stretch: 1.0, min_elbow_angle: 0.0 }
    }
}

impl SoftReach {
    /// # Errors
    ///
    /// Refuses a softness outside [0, 1), a `max_stretch` below 1 or not finite, and a smallest elbow
    /// angle outside [0, π).
    pub fn new(
        softness: f32,
        max_stretch: f32,
        min_elbow_angle: f32,
    ) -> Result<Self, SoftReachError> {
        let refused = |field, value, range| Err(SoftReachError { field, value, range });
        if !(0.0..1.0).contains(&softness) {
            return refused("softness", softness, "from 0 to less than 1");
        }
        if !(max_stretch.is_finite() && max_stretch >= 1.0) {
            return refused("max_stretch", max_stretch, "a finite number, 1 or more");
        }
        if !(0.0..core::f32::consts::PI).contains(&min_elbow_angle) {
            return refused("min_elbow_angle", min_elbow_angle, "from 0 to less than 180°");
        }
        Ok(Self { softness, max_stretch, min_elbow_angle })
    }

    /// s, from 0 to less than 1.
    pub fn softness(self) -> f32 {
        self.softness
    }

    /// How many times as long the limbs may become, 1 or more.
    pub fn max_stretch(self) -> f32 {
        self.max_stretch
    }

    /// φ_min, how far the elbow is open at least; radians.
    pub fn min_elbow_angle(self) -> f32 {
        self.min_elbow_angle
    }

    /// Whether it changes nothing: the solver's own clamp does.
    pub fn is_hard(self) -> bool {
        self == Self::default()
    }

    /// d_min, the nearest that the hand comes to the shoulder.
    pub fn least_distance(self, bones: TwoBone) -> f32 {
        Limits::new(self, bones).least as f32
    }

    /// How far a cursor is from the shoulder that brings the hand to a distance: the inverse of
    /// [`Self::extent`]. The hand meets its limits only in the infinite: there, and beyond, a cursor
    /// 17 soft zones away brings it as near as f32 tells. Where stretching begins, the cursor is at the hand.
    pub fn cursor_distance(self, bones: TwoBone, distance: f32) -> f32 {
        let limits = Limits::new(self, bones);
        let (d, longest) = (f64::from(distance), f64::from(self.max_stretch));
        if d <= limits.outer_join() {
            return saturated(limits.harden(d).max(0.0));
        }
        let is_stretched_to_it = longest > 1.0 && d <= longest * limits.soften(d).0;
        if is_stretched_to_it { distance } else { saturated(limits.harden(d / longest).max(d)) }
    }

    /// How far the hand goes for a cursor at a distance from the shoulder (finite, 0 or more).
    pub fn extent(self, bones: TwoBone, cursor_distance: f32) -> Extent {
        let limits = Limits::new(self, bones);
        let d = f64::from(cursor_distance);
        let (distance, slope) = limits.soften(d);
        let longest = f64::from(self.max_stretch);
        let stretch =
            if d > limits.outer_join() { (d / distance).clamp(1.0, longest) } else { 1.0 };
        // Stretched to the cursor it goes with it; at the longest it lags as it would unstretched.
        let slope = if 1.0 < stretch && stretch < longest { 1.0 } else { slope * stretch };
        Extent {
            distance: saturated(distance * stretch),
            stretch: stretch as f32,
            slope: slope as f32,
        }
    }
}

/// What an arm's distances are measured by, in f64: where the curve is nearly flat, differences of
/// f32 would be coarse.
#[derive(Clone, Copy)]
struct Limits {
    least: f64,
    most: f64,
    /// w, how wide the soft zones are; 0 where nothing is soft.
    width: f64,
}

impl Limits {
    fn new(soft_reach: SoftReach, bones: TwoBone) -> Self {
        let (upper, lower) = (f64::from(bones.upper()), f64::from(bones.lower()));
        let (least, most) = ((upper - lower).abs(), upper + lower);
        // (d₁ − d₂)² + 2 d₁ d₂ (1 − cos φ), which does not cancel.
        let half = (0.5 * f64::from(soft_reach.min_elbow_angle)).sin();
        let open = (least * least + 4.0 * upper * lower * half * half).sqrt();
        let least = least.max(open).min(most);
        Self { least, most, width: 0.5 * f64::from(soft_reach.softness) * (most - least) }
    }

    /// d_a.
    fn outer_join(self) -> f64 {
        self.most - self.width
    }

    /// d_b.
    fn inner_join(self) -> f64 {
        self.least + self.width
    }

    /// d' and its slope.
    fn soften(self, d: f64) -> (f64, f64) {
        let Self { least, most, width } = self;
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

    /// The d that gives a d'.
    fn harden(self, softened: f64) -> f64 {
        const ZONES: f64 = 17.0;
        let Self { least, most, width } = self;
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

fn saturated(value: f64) -> f32 {
    value.min(f64::from(f32::MAX)) as f32
}
