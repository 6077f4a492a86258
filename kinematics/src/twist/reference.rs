use core::fmt;

use glam::{DVec3, Vec3};

use super::kind::TwistReferenceKind;
use super::limb::angle_from_limb;
use super::stereographic::{Stereographic, unit};
use super::transported_frame::TransportedFrame;
use crate::two_bone::Pointer;

/// Direction from which the twist angle is measured.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum TwistReference {
    /// Up: the Limb frame's +y, the part of +y of Root space that is perpendicular to the Pointer.
    #[default]
    #[cfg_attr(feature = "serde", serde(alias = "limb"))]
    Up,
    /// Direction towards the pole, a point in Root space.
    Pole(Vec3),
    /// Direction by a stereographic map, which is singular in one direction only.
    Stereographic(Stereographic),
    /// The previous direction, parallel-transported by the smallest rotation to the new Pointer.
    Transport,
}

impl TwistReference {
    /// e₀, a unit vector perpendicular to the Pointer. Where the reference is singular, e₀ is
    /// transported from the frame `last` or, without one, is the Limb frame's +y.
    #[must_use]
    pub fn outward(self, pointer: Pointer, last: Option<TransportedFrame>) -> Vec3 {
        let w = unit(pointer.direction);
        let own = match self {
            Self::Up => Some(pointer.limb_frame().y_axis.as_dvec3()),
            Self::Pole(pole) => towards(pole, w),
            Self::Stereographic(map) => map.outward(w),
            // Without a previous frame, transport begins at the stereographic direction.
            Self::Transport if last.is_none() => Stereographic::default().outward(w),
            Self::Transport => None,
        };
        match (own, last) {
            (Some(own), _) => own.as_vec3(),
            (None, Some(last)) => last.to(pointer.direction).outward,
            (None, None) => pointer.limb_frame().y_axis,
        }
    }

    /// ψ_ref, the angle of e₀ about the Pointer from the Limb frame's +y, in (−π, π]; it is added
    /// to ψ for [`TwoBone::solve_from`](crate::two_bone::TwoBone::solve_from).
    #[must_use]
    pub fn angle(self, pointer: Pointer, last: Option<TransportedFrame>) -> f32 {
        match self {
            Self::Up => 0.0,
            _ => angle_from_limb(pointer, self.outward(pointer, last)),
        }
    }

    /// The gain g (see the module); infinite where the reference is singular.
    #[must_use]
    pub fn gain(self, pointer: Pointer) -> f32 {
        let w = unit(pointer.direction);
        let gain = match self {
            Self::Up => w.y.abs() / w.x.hypot(w.z),
            // Rounding of the Pointer moves a pole on the Pointer's line slightly off this line.
            Self::Pole(pole) if towards(pole, w).is_none() => f64::INFINITY,
            Self::Pole(pole) => {
                let pole = pole.as_dvec3();
                pole.dot(w).abs() / pole.cross(w).length()
            }
            Self::Stereographic(map) => {
                let singular = unit(map.singular());
                (w + singular).length() / (w - singular).length()
            }
            Self::Transport => 0.0,
        };
        if gain.is_nan() { f32::INFINITY } else { gain as f32 }
    }

    /// The kind of the reference, without its pole or map.
    pub fn kind(self) -> TwistReferenceKind {
        match self {
            Self::Up => TwistReferenceKind::Up,
            Self::Pole(_) => TwistReferenceKind::Pole,
            Self::Stereographic(_) => TwistReferenceKind::Stereographic,
            Self::Transport => TwistReferenceKind::Transport,
        }
    }
}

impl fmt::Display for TwistReference {
    /// The name of the [kind](Self::kind).
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.kind().fmt(f)
    }
}

/// Unit vector perpendicular to the Pointer `w`, towards a pole; `None` for a pole on the Pointer's
/// line or at the shoulder.
fn towards(pole: Vec3, w: DVec3) -> Option<DVec3> {
    const ON_LINE: f64 = 1e-6;
    let pole = pole.as_dvec3().try_normalize()?;
    let aside = w.cross(pole).cross(w);
    (aside.length() > ON_LINE).then(|| aside.normalize())
}
