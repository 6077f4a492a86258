use glam::{Vec2, Vec3};

use super::pointer::Pointer;
use crate::kinematics::normalize::power_of_two_near;

/// Squares of normal numbers: their sums and products neither overflow nor underflow. 2⁻⁶⁴ and 2⁶⁴.
const NORMAL: [f32; 2] = [5.421_011e-20, 1.844_674_4e19];

/// A cursor as seen from the shoulder.
#[derive(Clone, Copy)]
pub(super) struct ScaledCursor {
    pub pointer: Pointer,
    /// Distance in `unit`s.
    pub distance: f32,
    /// Length of 1, a power of two.
    pub unit: f32,
    /// Whether all numbers were normal.
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
        // A division rounds once, a reciprocal and a product twice: it shows in the upper length.
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
    /// Direction and heading of the cursor. A cursor at the shoulder keeps the last direction, one
    /// straight above or below it the last heading.
    #[must_use]
    pub fn towards(cursor: Vec3, last: Self) -> Self {
        ScaledCursor::new::<true>(cursor, last).pointer
    }
}

/// Whether the least and the largest of some squares are normal.
#[inline(always)]
pub(super) fn is_normal(least: f32, most: f32) -> bool {
    (least >= NORMAL[0]) & (most <= NORMAL[1])
}
