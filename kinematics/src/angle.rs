//! Wrapped and equivalent angles, in radians. Angles that differ by full turns are equivalent.

use core::f32::consts::TAU;
use core::f64::consts::TAU as TAU_F64;

/// An angle wrapped to [0, 2π).
#[must_use]
pub fn wrapped(angle: f32) -> f32 {
    wrapped_to_turn(f64::from(angle))
}

/// An f64 angle wrapped to [0, 2π), then rounded to f32.
pub(crate) fn wrapped_to_turn(angle: f64) -> f32 {
    let wrapped = angle.rem_euclid(TAU_F64) as f32;
    // An f64 just below 2π may round up to 2π in f32.
    if wrapped >= TAU { 0.0 } else { wrapped }
}

/// The angle equivalent to `angle` that is nearest to `near`.
#[must_use]
pub fn nearest(angle: f32, near: f32) -> f32 {
    angle + ((near - angle) / TAU).round() * TAU
}

/// [`nearest`] in f64.
pub(crate) fn nearest_f64(angle: f64, near: f64) -> f64 {
    angle + ((near - angle) / TAU_F64).round() * TAU_F64
}
