use glam::{DMat3, DVec3};

/// A right-handed frame: y along a vector, x as near to another one as possible, z = x × y.
/// Arbitrary if the vectors are zero or parallel.
pub fn frame(y: DVec3, x: DVec3) -> DMat3 {
    let y = y.try_normalize().unwrap_or(DVec3::Y);
    let x = perpendicular(x, y).unwrap_or_else(|| y.any_orthonormal_vector());
    DMat3::from_cols(x, y, x.cross(y))
}

/// The unit vector perpendicular to unit `y` that is nearest to `x`, unless they are parallel.
fn perpendicular(x: DVec3, y: DVec3) -> Option<DVec3> {
    const PARALLEL: f64 = 1e-6;
    let x = x.try_normalize()?;
    let perpendicular = x - y * x.dot(y);
    (perpendicular.length() > PARALLEL).then(|| perpendicular.normalize())
}
