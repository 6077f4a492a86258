//! Conversion of f64 to f32 that clamps overflow to the largest finite number.

use glam::{DVec3, Vec3};

/// Converts a number of at least −`f32::MAX` to f32; numbers above `f32::MAX` become `f32::MAX`.
pub(crate) fn saturate(value: f64) -> f32 {
    value.min(f64::from(f32::MAX)) as f32
}

/// Converts a vector to f32, with its coordinates clamped to ±`f32::MAX`.
pub(crate) fn saturate_vector(v: DVec3) -> Vec3 {
    v.clamp(Vec3::MIN.as_dvec3(), Vec3::MAX.as_dvec3()).as_vec3()
}
