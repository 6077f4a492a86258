use glam::{DVec3, Vec3};

use crate::two_bone::Pointer;

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

/// A Pointer with its twist reference: the state of
/// [`TwistReference::Transport`](super::TwistReference::Transport). The other references fall back to this frame
/// where they are singular.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TransportedFrame {
    /// ŵ, a unit vector.
    pub direction: Vec3,
    /// e₀, a unit vector perpendicular to ŵ.
    pub outward: Vec3,
}

impl TransportedFrame {
    /// The first frame, for a pose without a previous pose: e₀ is the stereographic direction.
    #[must_use]
    pub fn new(pointer: Pointer) -> Self {
        let outward = Stereographic::default().outward(unit(pointer.direction));
        let outward = outward.map_or(pointer.limb_frame().y_axis, glam::DVec3::as_vec3);
        Self { direction: pointer.direction, outward }
    }

    /// The frame, parallel-transported to the Pointer `direction` by the smallest rotation between
    /// the two Pointers: e₀' = e₀ − (e₀·ŵ')/(1 + ŵ·ŵ')·(ŵ + ŵ'). If the Pointers are opposite, e₀
    /// is kept, except that it is made perpendicular to ŵ'.
    #[must_use]
    pub fn to(self, direction: Vec3) -> Self {
        const OPPOSITE: f64 = 1e-6;
        if direction == self.direction {
            return self;
        }
        let [w, to, e] = [self.direction, direction, self.outward].map(Vec3::as_dvec3);
        let nearness = 1.0 + w.dot(to);
        let transported =
            if nearness < OPPOSITE { e } else { e - (e.dot(to) / nearness) * (w + to) };
        let outward = perpendicular(transported, to).unwrap_or_else(|| to.any_orthonormal_vector());
        Self { direction, outward: outward.as_vec3() }
    }

    /// Angle about the Pointer of `other` from this frame's e₀, transported there, to the e₀ of
    /// `other`, in (−π, π]. For the two ends of a closed path it is the path's holonomy, the solid
    /// angle that the path encloses.
    #[must_use]
    pub fn turn_to(self, other: Self) -> f32 {
        let from = self.to(other.direction).outward.as_dvec3();
        let (w, to) = (other.direction.as_dvec3(), other.outward.as_dvec3());
        w.dot(from.cross(to)).atan2(from.dot(to)) as f32
    }
}

fn perpendicular(v: DVec3, w: DVec3) -> Option<DVec3> {
    (v - w * (v.dot(w) / w.length_squared())).try_normalize()
}
