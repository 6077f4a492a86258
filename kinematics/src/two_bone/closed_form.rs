//! The closed form for one arm in straight-line code: no call, no loop, and no branch that a
//! compiler cannot turn into a select, so that [`batch`](crate::batch) can vectorise
//! it.
//!
//! Numbers are normal if sums and products of their squares neither overflow nor underflow. With
//! `ANY`, the code is correct for all finite numbers. Without `ANY`, [`ScaledCursor`] does not
//! scale and overflow is not clamped, so that the code is correct only if all numbers are normal,
//! which [`ClosedForm::is_normal`] tells. For normal numbers both give the same bits.

use glam::Vec3;

use super::bones::TwoBone;
use super::cursor::{ScaledCursor, is_normal};
use super::pointer::Pointer;
use super::pose::TwoBonePose;
use super::reach::Reach;
use crate::normalize::power_of_two_near;

/// Distance of the hand, as a fraction of the arm length, below which the bones must be equal and
/// the hand is at the shoulder.
const AT_SHOULDER: f32 = 1e-30;

/// Elbow and hand by the closed form, in Root space.
#[derive(Clone, Copy)]
pub(crate) struct ClosedForm {
    pub elbow: Vec3,
    /// Position of the hand, computed from the Pointer and D. It may differ from a reached cursor
    /// by rounding; [`Self::hand_or`] returns the cursor then.
    pub hand: Vec3,
    pub reach: Reach,
    /// Whether all numbers were normal: see the module.
    pub is_normal: bool,
    pub pointer: Pointer,
    /// Unit vector perpendicular to the Pointer, on the side of the elbow.
    pub outward: Vec3,
    /// D, the hand's distance from the shoulder, in units of `scaled.unit`.
    pub distance: f32,
    /// h_e, the elbow's x in Socket space, in units of `scaled.unit`.
    pub along: f32,
    /// o_e, the elbow's y in Socket space, in units of `scaled.unit`.
    pub out: f32,
    pub scaled: ScaledBones,
}

/// Bones scaled to lengths near 1, so that nothing overflows or underflows.
#[derive(Clone, Copy)]
pub(crate) struct ScaledBones {
    pub upper: f32,
    pub lower: f32,
    /// L = d₁ + d₂.
    sum: f32,
    /// δ = d₁ − d₂.
    difference: f32,
    /// Length in the caller's unit that is 1 here, a power of two.
    pub unit: f32,
    /// Reciprocal of `unit`.
    pub scale: f32,
}

impl ClosedForm {
    #[inline(always)]
    pub fn new<const ANY: bool>(
        bones: TwoBone,
        cursor: Vec3,
        cos: f32,
        sin: f32,
        last: Pointer,
    ) -> Self {
        let scaled = ScaledBones::new(bones);
        let ScaledCursor { pointer, distance, unit, is_normal } =
            ScaledCursor::new::<ANY>(cursor, last);
        let solved = Self::at::<ANY>(scaled, pointer, distance * (unit * scaled.scale), cos, sin);
        Self { is_normal: is_normal & solved.is_normal, ..solved }
    }

    /// The arm with its hand in the direction of `pointer`. The distance `wanted`, in units of
    /// `scaled.unit`, is clamped to the limits.
    #[inline(always)]
    pub fn at<const ANY: bool>(
        scaled: ScaledBones,
        pointer: Pointer,
        wanted: f32,
        cos: f32,
        sin: f32,
    ) -> Self {
        let ScaledBones { sum, difference, unit, .. } = scaled;
        let distance = between(wanted, difference.abs(), sum);
        let (along, out) = scaled.elbow_in_socket::<ANY>(distance);
        let limb = pointer.limb_frame();
        let outward = limb.y_axis * cos + limb.z_axis * sin;
        let elbow = limb.x_axis * along + outward * out;
        let reach = if wanted > sum {
            Reach::TooFar
        } else if wanted < difference.abs() {
            Reach::TooClose
        } else {
            Reach::Reached
        };
        Self {
            elbow: in_units::<ANY>(elbow, unit),
            hand: in_units::<ANY>(pointer.direction * distance, unit),
            reach,
            is_normal: is_normal(unit, unit),
            pointer,
            outward,
            distance,
            along,
            out,
            scaled,
        }
    }

    /// The cursor, bit for bit, if it is reached; otherwise the hand on a limit sphere.
    #[inline(always)]
    pub fn hand_or(&self, cursor: Vec3) -> Vec3 {
        if self.reach == Reach::Reached { cursor } else { self.hand }
    }

    pub(super) fn pose(&self, twist: f32) -> TwoBonePose {
        let unit = self.scaled.unit;
        TwoBonePose {
            elbow: self.elbow,
            hand: self.hand,
            reach: None,
            distance: (self.distance * unit).min(f32::MAX),
            along: self.along * unit,
            out: self.out * unit,
            twist,
            stretch: 1.0,
            pointer: self.pointer,
        }
    }
}

impl ScaledBones {
    #[inline(always)]
    pub fn new(bones: TwoBone) -> Self {
        let (unit, scale) = power_of_two_near(bones.upper.max(bones.lower));
        let (upper, lower) = (bones.upper * scale, bones.lower * scale);
        Self { upper, lower, sum: upper + lower, difference: upper - lower, unit, scale }
    }

    /// The elbow (h_e, o_e) in Socket space for a hand at `distance`, in scaled units.
    #[inline(always)]
    fn elbow_in_socket<const ANY: bool>(self, distance: f32) -> (f32, f32) {
        let Self { upper, sum, difference, .. } = self;
        let per_diameter = 0.5 / distance;
        let ahead = (sum - distance) * ((distance - difference) * per_diameter);
        let behind = (sum + distance) * ((distance + difference) * per_diameter);
        let is_ahead = ahead <= behind;
        let missing = if is_ahead { ahead } else { behind };
        let along = upper - missing;
        // Both h_e and o_e use `missing`, so that its rounding keeps h_e² + o_e² = d₁².
        let out = (missing * (upper + along)).sqrt();
        let along = if is_ahead { along } else { -along };
        if ANY && distance < AT_SHOULDER { (0.0, upper) } else { (along, out) }
    }
}

/// Clamps like `f32::clamp`, but without its check of the limits, whose panic would prevent
/// vectorisation.
#[inline(always)]
fn between(value: f32, least: f32, most: f32) -> f32 {
    let value = if value > least { value } else { least };
    if value < most { value } else { most }
}

/// Converts to the caller's unit. With `ANY`, overflow is clamped to ±f32::MAX.
#[inline(always)]
fn in_units<const ANY: bool>(v: Vec3, unit: f32) -> Vec3 {
    let v = v * unit;
    if ANY { v.clamp(Vec3::MIN, Vec3::MAX) } else { v }
}
