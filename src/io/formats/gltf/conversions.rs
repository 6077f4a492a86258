//! Orthonormal frames, Hermite's polynomials, and channels of colours from 0 to 1: sRGB in this
//! program, linear in materials of glTF.

use glam::{DMat3, DVec3};

/// Returns a right-handed orthonormal frame: its y axis is along the vector `y`, its x axis as near
/// to the vector `x` as possible, and z = x × y. Where zero or parallel vectors leave an axis
/// undetermined, the axis is arbitrary.
pub fn frame(y: DVec3, x: DVec3) -> DMat3 {
    let y = y.try_normalize().unwrap_or(DVec3::Y);
    let x = perpendicular(x, y).unwrap_or_else(|| y.any_orthonormal_vector());
    DMat3::from_cols(x, y, x.cross(y))
}

/// Of all unit vectors perpendicular to the unit vector `y`, returns the one nearest to `x`; `None`
/// if `x` is zero or parallel to `y`.
fn perpendicular(x: DVec3, y: DVec3) -> Option<DVec3> {
    const PARALLEL: f64 = 1e-6;
    let x = x.try_normalize()?;
    let perpendicular = x - y * x.dot(y);
    (perpendicular.length() > PARALLEL).then(|| perpendicular.normalize())
}

pub fn linear(srgb: f32) -> f32 {
    if srgb <= 0.04045 { srgb / 12.92 } else { ((srgb + 0.055) / 1.055).powf(2.4) }
}

/// The sRGB channel of a linear one, which is clamped to 0 to 1.
pub fn srgb(linear: f32) -> f32 {
    match linear {
        1.0.. => 1.0,
        0.003_130_8.. => 1.055 * linear.powf(1.0 / 2.4) - 0.055,
        0.0.. => 12.92 * linear,
        _ => 0.0,
    }
}

/// Weights of the cubic Hermite polynomial at a part of the way: of the first value, the slope
/// there, the last value, and the slope there.
pub fn hermite(s: f64) -> [f64; 4] {
    let (s2, s3) = (s * s, s * s * s);
    [2.0 * s3 - 3.0 * s2 + 1.0, s3 - 2.0 * s2 + s, 3.0 * s2 - 2.0 * s3, s3 - s2]
}
