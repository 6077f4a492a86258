use glam::{Vec2, Vec3};

use super::pointer::Pointer;
use crate::normalize::power_of_two_near;

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
    /// Whether the squared lengths were in the range `NORMAL`.
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

/// Whether a set of squares is in the range `NORMAL`, by its smallest and its largest square.
#[inline(always)]
pub(super) fn is_normal(least: f32, most: f32) -> bool {
    (least >= NORMAL[0]) & (most <= NORMAL[1])
}
