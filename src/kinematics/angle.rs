//! Equivalent angles: those that differ by full turns.

/// An angle wrapped to [0, 2π).
#[must_use]
pub fn wrapped(angle: f32) -> f32 {
    wrapped_to_turn(f64::from(angle))
}

/// An angle wrapped to [0, 2π) in f64, then rounded.
pub(crate) fn wrapped_to_turn(angle: f64) -> f32 {
    let wrapped = angle.rem_euclid(core::f64::consts::TAU) as f32;
    // Just below 2π may round up to it.
    if wrapped < core::f32::consts::TAU { wrapped } else { 0.0 }
}
