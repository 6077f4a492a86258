//! Twist references: directions from which the twist angle ψ of the elbow is measured.
//!
//! ŵ is the Pointer's direction. A reference gives a unit vector e₀ ⟂ ŵ; the elbow is on the side
//!
//! ```text
//! e = cos ψ e₀ + sin ψ (ŵ × e₀)
//! ```
//!
//! Everything is in Root space, right-handed; angles are radians.
//!
//! # What breaks
//!
//! No choice of e₀ that depends on ŵ alone is smooth for every ŵ (a hair on a ball cannot be combed
//! flat). References differ in where they are singular and in how far around the singularity e₀
//! still rotates fast. The gain g measures that: radians by which e₀ rotates against a
//! parallel-transported direction, per radian of rotation of the Pointer. The table gives the
//! maximum of g, which is reached by a rotation of the Pointer across the direction to the
//! singularity. θ_y is the Pointer's pitch, p the pole; R is the singular direction of the
//! [`Stereographic`] map and V its up direction.
//!
//! | reference | e₀ | singular at | gain |
//! | --- | --- | --- | --- |
//! | [`TwistReference::Up`] | the Limb frame's +y | ŵ = ±y | \|tan θ_y\| |
//! | [`TwistReference::Pole`] p | component of p perpendicular to ŵ, normalised | ŵ ∥ p | \|cot ∠(ŵ, p)\| |
//! | [`TwistReference::Stereographic`] | k × ŵ normalised, k = (ŵ − R) × V | ŵ = R | tan(½ ∠(ŵ, −R)) |
//! | [`TwistReference::Transport`] | the previous e₀, parallel-transported | none | 0 |
//!
//! Parallel transport around a closed loop returns e₀ rotated by the solid angle of the loop (its
//! holonomy). So transport suits a live drag, and keys are measured from another reference.
//!
//! # Sources
//!
//! A. Elias, J. Wen, *Redundancy parameterization and inverse kinematics of 7-DOF revolute
//! manipulators*, arXiv 2307.13122, 2023 (stereographic swivel angle); E. Palmieri, *IK-Rigging in
//! three.js*, 2014 (up as reference).

use core::fmt;
use core::str::FromStr;

use glam::{DVec3, Vec3};
use thiserror::Error;

use crate::angle::wrapped_to_turn;
use crate::two_bone::Pointer;

/// Kind of a [`TwistReference`], without its pole or map; for choices and
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
    /// The direction that joint angles give the elbow, carried to the Pointer by the least
    /// rotation; for limbs of skeletons.
    Fk,
}

/// Error for a text that is not the name of a twist reference.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("twist reference must be up, pole, stereographic, transport or fk")]
pub struct UnknownTwistReference;

impl TwistReferenceKind {
    /// All kinds, in the order in which panels list them.
    pub const ALL: [Self; 5] =
        [Self::Up, Self::Pole, Self::Stereographic, Self::Transport, Self::Fk];

    /// Name for labels, and the name in files and on the command line.
    fn names(self) -> (&'static str, &'static str) {
        match self {
            Self::Up => ("Up", "up"),
            Self::Pole => ("Pole", "pole"),
            Self::Stereographic => ("Stereographic", "stereographic"),
            Self::Transport => ("Transport", "transport"),
            Self::Fk => ("FK", "fk"),
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

    /// Reads the name in lower case: the inverse of [`Display`](fmt::Display). `limb`, the former
    /// name of `up`, is read too.
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

    /// [`Stereographic::new`], but directions of a map that was saved keep their bits.
    pub fn from_saved(singular: Vec3, up: Vec3) -> Option<Self> {
        let checked = Self::new(singular, up)?;
        let is_same = |a: Vec3, b: Vec3| a.distance(b) <= 4.0 * f32::EPSILON;
        let is_map = is_same(checked.singular, singular) && is_same(checked.up, up);
        Some(if is_map { Self { singular, up } } else { checked })
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
fn unit(direction: Vec3) -> DVec3 {
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

    fn try_from(UncheckedMap { singular, up }: UncheckedMap) -> Result<Self, ParallelDirections> {
        Self::from_saved(singular, up).ok_or(ParallelDirections)
    }
}

/// A Pointer with its twist reference: the state of [`TwistReference::Transport`]. The other
/// references fall back to this frame where they are singular.
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
        let outward = outward.map_or(pointer.limb_frame().y_axis, DVec3::as_vec3);
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
