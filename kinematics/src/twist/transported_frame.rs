use glam::{DVec3, Vec3};

use super::stereographic::{Stereographic, unit};
use crate::two_bone::Pointer;

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
