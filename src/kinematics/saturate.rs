//! Conversion of f64 to f32 that clamps overflow to the largest finite number.

use glam::{DVec3, Vec3};

/// A number of at least −`f32::MAX` as f32; above `f32::MAX` it is `f32::MAX`.
pub(crate) fn saturate(value: f64) -> f32 {
    value.min(f64::from(f32::MAX)) as f32
}

/// A vector as f32, with coordinates clamped to ±`f32::MAX`.
pub(crate) fn saturate_vector(v: DVec3) -> Vec3 {
    v.clamp(Vec3::MIN.as_dvec3(), Vec3::MAX.as_dvec3()).as_vec3()
}
