//! The closed form for one arm in straight-line code: no call, no loop, and no branch that a
//! compiler cannot turn into a select, so that [`batch`](crate::batch) can vectorise
//! it.
//!
//! Numbers are normal if sums and products of their squares neither overflow nor underflow. With
//! `ANY`, the code is correct for all finite numbers. Without `ANY`, [`ScaledCursor`] does not
//! scale and overflow is not clamped, so that the code is correct only if all numbers are normal,
//! which [`ClosedForm::is_normal`] tells. For normal numbers both give the same bits.

use glam::{Vec2, Vec3};

use super::{Pointer, Reach, TwoBone, TwoBonePose};
use crate::vector::power_of_two_near;

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
    /// True if all numbers were normal: see the module.
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

impl TwoBone {
    /// Poses the hand at `cursor` (Root space) with the elbow turned by `twist` (ψ, radians,
    /// right-handed about the Pointer) from the Limb frame's +y.
    ///
    /// A cursor at the shoulder or straight above or below it takes its direction or yaw from
    /// [`Pointer::default`]; see [`Self::solve_from`].
    ///
    /// # Panics
    ///
    /// In debug builds, if an argument is not finite; in release builds the pose is then
    /// meaningless. Callers check numbers where they enter the program.
    #[must_use]
    pub fn solve(self, cursor: Vec3, twist: f32) -> TwoBonePose {
        self.solve_from(cursor, twist, Pointer::default())
    }

    /// As [`Self::solve`], with the previous pose's [`Pointer`] as `last`: a cursor at the shoulder
    /// takes its direction, and a cursor straight above or below the shoulder takes its yaw.
    #[must_use]
    pub fn solve_from(self, cursor: Vec3, twist: f32, last: Pointer) -> TwoBonePose {
        debug_assert!(cursor.is_finite(), "cursor is {cursor}");
        debug_assert!(twist.is_finite(), "twist is {twist}");
        let (sin, cos) = twist.sin_cos();
        let solved = ClosedForm::new::<true>(self, cursor, cos, sin, last);
        let pose = solved.pose(twist);
        TwoBonePose { hand: solved.hand_or(cursor), reach: Some(solved.reach), ..pose }
    }

    /// Poses the hand in the direction of `pointer` at `distance` from the shoulder, clamped to the
    /// limits. The pose has no cursor, so its reach is `None`.
    ///
    /// # Panics
    ///
    /// As [`Self::solve`].
    #[must_use]
    pub fn solve_at(self, pointer: Pointer, distance: f32, twist: f32) -> TwoBonePose {
        debug_assert!(distance.is_finite(), "distance is {distance}");
        debug_assert!(twist.is_finite(), "twist is {twist}");
        let (sin, cos) = twist.sin_cos();
        let scaled = ScaledBones::new(self);
        ClosedForm::at::<true>(scaled, pointer, distance * scaled.scale, cos, sin).pose(twist)
    }
}

/// Range of squared lengths of normal vectors, 2⁻⁶⁴ to 2⁶⁴: sums and products of two such squares
/// neither overflow nor underflow.
const NORMAL: [f32; 2] = [5.421_011e-20, 1.844_674_4e19];

/// Direction and distance of a cursor from the shoulder.
#[derive(Clone, Copy)]
pub(super) struct ScaledCursor {
    pub pointer: Pointer,
    /// Distance in units of `unit`.
    pub distance: f32,
    /// Length in the caller's unit that is 1 in `distance`, a power of two.
    pub unit: f32,
    /// True if the squared lengths were in the range `NORMAL`.
    pub is_normal: bool,
}

impl ScaledCursor {
    #[inline(always)]
    pub fn new<const ANY: bool>(cursor: Vec3, last: Pointer) -> Self {
        let flat = Vec2::new(cursor.x, cursor.z);
        let is_normal = is_normal(flat.length_squared(), cursor.length_squared());
        let [(unit, scale), (_, flat_scale)] = if ANY && !is_normal {
            [cursor.abs().max_element(), flat.abs().max_element()].map(power_of_two_near)
        } else {
            [(1.0, 1.0); 2]
        };
        let (near, near_flat) = (cursor * scale, flat * flat_scale);
        let distance = near.length();
        // A division rounds once, a product with a reciprocal twice. The second rounding would show
        // in the upper bone's length.
        let direction = near / distance;
        let heading = near_flat * (1.0 / near_flat.length());
        let pointer = if ANY && cursor == Vec3::ZERO {
            last
        } else if ANY && flat == Vec2::ZERO {
            Pointer { direction, heading: last.heading }
        } else {
            Pointer { direction, heading }
        };
        Self { pointer, distance, unit, is_normal }
    }
}

impl Pointer {
    /// The Pointer towards `cursor`, in Root space. For a cursor at the shoulder it is `last`; for
    /// a cursor straight above or below the shoulder it has the heading of `last`.
    #[must_use]
    pub fn towards(cursor: Vec3, last: Self) -> Self {
        ScaledCursor::new::<true>(cursor, last).pointer
    }
}

/// True if a set of squares is in the range `NORMAL`, by its smallest and its largest square.
#[inline(always)]
pub(super) fn is_normal(least: f32, most: f32) -> bool {
    (least >= NORMAL[0]) & (most <= NORMAL[1])
}
