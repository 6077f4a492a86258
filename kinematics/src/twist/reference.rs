use core::fmt;
use core::str::FromStr;

use glam::{DVec3, Vec3};
use thiserror::Error;

use super::stereographic::{Stereographic, TransportedFrame, unit};
use crate::angle::wrapped_to_turn;
use crate::two_bone::Pointer;

/// Kind of a [`TwistReference`](super::TwistReference), without its pole or map; for choices and
/// names.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum TwistReferenceKind {
    /// Up: the Limb frame's +y.
    #[default]
    #[cfg_attr(feature = "serde", serde(alias = "limb"))]
    Up,
    /// Direction towards a point of Root space.
    Pole,
    /// Stereographic map of directions.
    Stereographic,
    /// The previous direction, parallel-transported.
    Transport,
}

/// Error for a text that is not the name of a twist reference.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("twist reference must be up, pole, stereographic or transport")]
pub struct UnknownTwistReference;

impl TwistReferenceKind {
    /// All kinds, in the order in which panels list them.
    pub const ALL: [Self; 4] = [Self::Up, Self::Pole, Self::Stereographic, Self::Transport];

    /// Name for labels, and the name in files and on the command line.
    fn names(self) -> (&'static str, &'static str) {
        match self {
            Self::Up => ("Up", "up"),
            Self::Pole => ("Pole", "pole"),
            Self::Stereographic => ("Stereographic", "stereographic"),
            Self::Transport => ("Transport", "transport"),
        }
    }

    /// Name for labels, such as "Up".
    pub fn name(self) -> &'static str {
        self.names().0
    }
}

impl fmt::Display for TwistReferenceKind {
    /// The name in lower case, as in files and on the command line.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.names().1)
    }
}

impl FromStr for TwistReferenceKind {
    type Err = UnknownTwistReference;

    /// Reads the name in lower case: the inverse of [`Display`](fmt::Display). `limb`, the former name
    /// of `up`, is read too.
    fn from_str(text: &str) -> Result<Self, UnknownTwistReference> {
        let name = if text == "limb" { "up" } else { text };
        Self::ALL.into_iter().find(|kind| kind.names().1 == name).ok_or(UnknownTwistReference)
    }
}

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

/// Angle about the Pointer from the Limb frame's +y to a direction perpendicular to the Pointer, in
/// (−π, π].
#[must_use]
pub fn angle_from_limb(pointer: Pointer, outward: Vec3) -> f32 {
    let limb = pointer.limb_frame();
    outward.dot(limb.z_axis).atan2(outward.dot(limb.y_axis))
}

/// The twist ψ, in [0, 2π), that keeps the elbow in place when the twist reference changes. `from`
/// and `to` are the angles of the old and the new reference from the Limb frame's +y.
#[must_use]
pub fn remeasured(twist: f32, from: f32, to: f32) -> f32 {
    wrapped_to_turn(f64::from(twist) + f64::from(from) - f64::from(to))
}
