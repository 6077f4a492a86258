//! The arithmetic of one arm, in straight lines: no call, no loop, and no branch that a compiler
//! could not turn into a choice between two results, so that [`batch`](crate::kinematics::batch) can
//! do it for many arms at once.
//!
//! With `ANY` it is right for every finite number. Without, only for plain ones, and
//! [`Placed::is_plain`] says whether they were: [`Sight`] then has nothing to scale, and nothing can
//! leave the range of numbers on the way back to the caller's unit. For plain numbers both give the
//! same bits.

use glam::{Vec2, Vec3};

use super::{Facing, Reach, TwoBone, TwoBonePose};
use crate::kinematics::normalize::power_of_two_near;

/// Of squares that neither overflow nor vanish however they are added up: 2⁻⁶⁴ and 2⁶⁴.
const PLAIN: [f32; 2] = [5.421_011e-20, 1.844_674_4e19];

/// Nearer to the shoulder than this share of the arm a hand can only be if both bones are equal, bit
/// for bit; then it is at the shoulder, as far as numbers tell.
const NOWHERE: f32 = 1e-30;

/// Where elbow and hand are: before the hand that is reached is taken from the cursor.
#[derive(Clone, Copy)]
pub(crate) struct Placed {
    pub elbow: Vec3,
    pub hand: Vec3,
    pub reach: Reach,
    /// Whether all numbers were plain.
    pub is_plain: bool,
    pub facing: Facing,
    /// Unit vector from the Pointer to the side that the elbow is on.
    pub outward: Vec3,
    /// In `scaled.unit`s.
    pub distance: f32,
    pub along: f32,
    pub out: f32,
    pub scaled: Scaled,
}

/// Bones near 1 long, so that nothing overflows or vanishes.
#[derive(Clone, Copy)]
pub(crate) struct Scaled {
    pub upper: f32,
    pub lower: f32,
    /// L and δ.
    sum: f32,
    difference: f32,
    pub unit: f32,
    pub scale: f32,
}

/// Where the cursor is, seen from the shoulder.
#[derive(Clone, Copy)]
pub(super) struct Sight {
    pub facing: Facing,
    /// In `unit`s.
    far: f32,
    unit: f32,
    is_plain: bool,
}

impl Placed {
    #[inline(always)]
    pub fn new<const ANY: bool>(
        bones: TwoBone,
        cursor: Vec3,
        cos: f32,
        sin: f32,
        last: Facing,
    ) -> Self {
        let scaled = Scaled::new(bones);
        let Sight { facing, far, unit, is_plain } = Sight::new::<ANY>(cursor, last);
        let placed = Self::at::<ANY>(scaled, facing, far * (unit * scaled.scale), cos, sin);
        Self { is_plain: is_plain & placed.is_plain, ..placed }
    }

    /// The hand as far out as it is asked to be and can be.
    #[inline(always)]
    pub fn at<const ANY: bool>(
        scaled: Scaled,
        facing: Facing,
        asked: f32,
        cos: f32,
        sin: f32,
    ) -> Self {
        let Scaled { sum, difference, unit, .. } = scaled;
        let distance = between(asked, difference.abs(), sum);
        let (along, out) = scaled.elbow_in_socket::<ANY>(distance);
        let limb = facing.limb_frame();
        let outward = limb.y_axis * cos + limb.z_axis * sin;
        let elbow = limb.x_axis * along + outward * out;
        let reach = if asked > sum {
            Reach::TooFar
        } else if asked < difference.abs() {
            Reach::TooClose
        } else {
            Reach::Reached
        };
        Self {
            elbow: in_units::<ANY>(elbow, unit),
            hand: in_units::<ANY>(facing.direction * distance, unit),
            reach,
            is_plain: is_plain(unit, unit),
            facing,
            outward,
            distance,
            along,
            out,
            scaled,
        }
    }

    /// The cursor where it is reached, bit for bit.
    #[inline(always)]
    pub fn hand_of(&self, cursor: Vec3) -> Vec3 {
        if self.reach == Reach::Reached { cursor } else { self.hand }
    }

    pub(super) fn pose(&self, spin: f32) -> TwoBonePose {
        let unit = self.scaled.unit;
        TwoBonePose {
            elbow: self.elbow,
            hand: self.hand,
            reach: self.reach,
            distance: (self.distance * unit).min(f32::MAX),
            along: self.along * unit,
            out: self.out * unit,
            spin,
            stretch: 1.0,
            facing: self.facing,
        }
    }
}

impl Scaled {
    #[inline(always)]
    pub fn new(bones: TwoBone) -> Self {
        let (unit, scale) = power_of_two_near(bones.upper.max(bones.lower));
        let (upper, lower) = (bones.upper * scale, bones.lower * scale);
        Self { upper, lower, sum: upper + lower, difference: upper - lower, unit, scale }
    }

    /// (h_e, o_e).
    #[inline(always)]
    fn elbow_in_socket<const ANY: bool>(self, distance: f32) -> (f32, f32) {
        let Self { upper, sum, difference, .. } = self;
        let per_diameter = 0.5 / distance;
        let ahead = (sum - distance) * ((distance - difference) * per_diameter);
        let behind = (sum + distance) * ((distance + difference) * per_diameter);
        let is_ahead = ahead <= behind;
        let missing = if is_ahead { ahead } else { behind };
        let along = upper - missing;
        // With the same `missing`, its rounding leaves h_e² + o_e² at d₁².
        let out = (missing * (upper + along)).sqrt();
        let along = if is_ahead { along } else { -along };
        if ANY && distance < NOWHERE { (0.0, upper) } else { (along, out) }
    }
}

impl Sight {
    #[inline(always)]
    pub fn new<const ANY: bool>(cursor: Vec3, last: Facing) -> Self {
        let flat = Vec2::new(cursor.x, cursor.z);
        let is_plain = is_plain(flat.length_squared(), cursor.length_squared());
        let [(unit, scale), (_, flat_scale)] = if ANY && !is_plain {
            [cursor.abs().max_element(), flat.abs().max_element()].map(power_of_two_near)
        } else {
            [(1.0, 1.0); 2]
        };
        let (near, near_flat) = (cursor * scale, flat * flat_scale);
        let far = near.length();
        // A division rounds once, a reciprocal and a product twice: it shows in the upper length.
        let direction = near / far;
        let heading = near_flat * (1.0 / near_flat.length());
        let facing = if ANY && cursor == Vec3::ZERO {
            last
        } else if ANY && flat == Vec2::ZERO {
            Facing { direction, heading: last.heading }
        } else {
            Facing { direction, heading }
        };
        Self { facing, far, unit, is_plain }
    }
}

#[inline(always)]
fn is_plain(least: f32, most: f32) -> bool {
    (least >= PLAIN[0]) & (most <= PLAIN[1])
}

/// `f32::clamp` without its check of the limits, whose way out would keep arms from being placed side
/// by side.
#[inline(always)]
fn between(value: f32, least: f32, most: f32) -> f32 {
    let value = if value > least { value } else { least };
    if value < most { value } else { most }
}

/// Back to the caller's unit; a result that rounds past the largest number is that number.
#[inline(always)]
fn in_units<const ANY: bool>(v: Vec3, unit: f32) -> Vec3 {
    let v = v * unit;
    if ANY { v.clamp(Vec3::MIN, Vec3::MAX) } else { v }
}
