use glam::{DQuat, DVec3};

/// The roll τ of a rotation about a unit axis, in (−π, π]: the rotation is a swing of the axis after a
/// rotation about the axis by τ. It is 0 where the rotation turns the axis around by 180°, where any roll
/// would do.
pub fn roll(rotation: DQuat, axis: DVec3) -> f64 {
    let (cos, sin) = (rotation.w, rotation.xyz().dot(axis));
    let sign = if cos < 0.0 { -1.0 } else { 1.0 };
    if cos.hypot(sin) > 1e-9 { 2.0 * (sign * sin).atan2(sign * cos) } else { 0.0 }
}
