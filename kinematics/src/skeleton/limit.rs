use glam::Vec3;

/// A closed range of an angle, radians.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Limit {
    /// Lower bound.
    pub min: f32,
    /// Upper bound, not below `min`.
    pub max: f32,
}

/// The angles in `rotation`, clamped to their limits; `None` does not limit an angle.
pub(crate) fn clamp_to_limits(limits: &[Option<Limit>; 3], rotation: Vec3) -> Vec3 {
    let mut clamped = rotation;
    for (axis, limit) in limits.iter().enumerate() {
        if let Some(Limit { min, max }) = limit {
            clamped[axis] = rotation[axis].clamp(*min, *max);
        }
    }
    clamped
}
