use glam::{DVec3, Vec3};
#[cfg(feature = "serde")]
use thiserror::Error;

/// Stereographic map of directions, given by two perpendicular unit vectors.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "UncheckedMap")
)]
pub struct Stereographic {
    /// R, the singular direction, chosen where the hand never goes.
    singular: Vec3,
    /// V, which is e₀ at the Pointer opposite to R.
    up: Vec3,
}

impl Default for Stereographic {
    /// R is −x, behind the body; V is +y, up.
    fn default() -> Self {
        Self { singular: Vec3::NEG_X, up: Vec3::Y }
    }
}

impl Stereographic {
    /// A map that is singular along `singular` (any length but 0). At the opposite Pointer, e₀ is
    /// `up`, made perpendicular to `singular`. `None` if the two are parallel or one of them has no
    /// direction.
    pub fn new(singular: Vec3, up: Vec3) -> Option<Self> {
        let singular = singular.as_dvec3().try_normalize()?;
        let up = up.as_dvec3().reject_from_normalized(singular).try_normalize()?;
        Some(Self { singular: singular.as_vec3(), up: up.as_vec3() })
    }

    /// The singular direction R.
    pub fn singular(self) -> Vec3 {
        self.singular
    }

    /// The direction V, which is e₀ at the Pointer −R.
    pub fn up(self) -> Vec3 {
        self.up
    }

    /// e₀ for a Pointer in the direction `w`; `None` if that is R.
    pub(crate) fn outward(self, w: DVec3) -> Option<DVec3> {
        let k = (w - unit(self.singular)).cross(unit(self.up));
        k.cross(w).try_normalize()
    }
}

/// The direction as a unit vector in f64. Near R, e₀ is a difference of second order, which would
/// be rotated by the rounded length of an f32 unit vector.
pub(super) fn unit(direction: Vec3) -> DVec3 {
    direction.as_dvec3().normalize()
}

/// Deserialized directions, not yet checked.
#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
struct UncheckedMap {
    singular: Vec3,
    up: Vec3,
}

/// Error for directions that are parallel or have length 0.
#[cfg(feature = "serde")]
#[derive(Debug, Error)]
#[error("the directions `singular` and `up` must have lengths above 0 and not be parallel")]
struct ParallelDirections;

#[cfg(feature = "serde")]
impl TryFrom<UncheckedMap> for Stereographic {
    type Error = ParallelDirections;

    fn try_from(map: UncheckedMap) -> Result<Self, ParallelDirections> {
        let UncheckedMap { singular, up } = map;
        let checked = Self::new(singular, up).ok_or(ParallelDirections)?;
        // Directions of a map that was saved keep their bits.
        let is_same = |a: Vec3, b: Vec3| a.distance(b) <= 4.0 * f32::EPSILON;
        let is_map = is_same(checked.singular, singular) && is_same(checked.up, up);
        Ok(if is_map { Self { singular, up } } else { checked })
    }
}
