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
