//! Twist references: directions from which the twist angle ψ of the elbow is measured.
//!
//! ŵ is the Pointer's direction. A reference gives a unit vector e₀ ⟂ ŵ, and the elbow is on the side
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
//! flat). References differ in where they are singular and how widely that is felt, which the gain g
//! measures: radians by which e₀ rotates against a parallel-transported direction, per radian of
//! rotation of the Pointer. It is largest across the direction to the singularity.
//!
//! | reference | e₀ | singular at | gain |
//! | --- | --- | --- | --- |
//! | [`TwistReference::Limb`] | the Limb frame's +y | ŵ = ±y | \|tan θ_y\| |
//! | [`TwistReference::Pole`] p | p less its part along ŵ, normalised | ŵ ∥ p | \|cot ∠(ŵ, p)\| |
//! | [`TwistReference::Stereographic`] | k × ŵ normalised, k = (ŵ − R) × V | ŵ = R | tan(½ ∠(ŵ, −R)) |
//! | [`TwistReference::Transport`] | the previous one, transported | none | 0 |
//!
//! Parallel transport around a closed loop returns e₀ rotated by the solid angle of the loop (its
//! holonomy): transport suits a live drag; keys are measured from another reference.
//!
//! # Sources
//!
//! A. Elias, J. Wen, *Redundancy parameterization and inverse kinematics of 7-DOF revolute
//! manipulators*, arXiv 2307.13122, 2023 (stereographic swivel angle); E. Palmieri, *IK-Rigging in
//! three.js*, 2014 (the Limb's).

use core::f32::consts::TAU;

use glam::{DVec3, Vec3};

use super::two_bone::Facing;

/// Origin of the twist angle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum TwistReference {
    /// The Limb frame's +y: up, less its part along the Pointer.
    #[default]
    Limb,
    /// Direction towards a point of Root space.
    Pole(Vec3),
    /// Stereographic map, singular in one direction only.
    Stereographic(Stereographic),
    /// The previous direction, parallel-transported along the Pointer's least rotation.
    Transport,
}

/// Stereographic map of directions, given by two perpendicular unit vectors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stereographic {
    /// R, the singular direction, chosen where the hand never goes.
    singular: Vec3,
    /// V.
    up: Vec3,
}

/// A Pointer with its twist reference: the state of [`TwistReference::Transport`], which also resolves
/// the other references where they are singular.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TransportedFrame {
    /// ŵ, a unit vector.
    pub direction: Vec3,
    /// e₀, a unit vector perpendicular to ŵ.
    pub outward: Vec3,
}

impl Default for Stereographic {
    /// R behind the body, −x; V up.
    fn default() -> Self {
        Self { singular: Vec3::NEG_X, up: Vec3::Y }
    }
}

impl Stereographic {
    /// A map that is singular along `singular` (any length but 0) and whose e₀ is `up` at the opposite
    /// Pointer; `None` if the two are parallel or have no direction.
    pub fn new(singular: Vec3, up: Vec3) -> Option<Self> {
        let singular = singular.as_dvec3().try_normalize()?;
        let up = up.as_dvec3().reject_from_normalized(singular).try_normalize()?;
        Some(Self { singular: singular.as_vec3(), up: up.as_vec3() })
    }

    /// The singular direction R.
    pub fn singular(self) -> Vec3 {
        self.singular
    }

    /// The direction V, which is e₀ at −R.
    pub fn up(self) -> Vec3 {
        self.up
    }

    fn outward(self, w: DVec3) -> Option<DVec3> {
        let k = (w - unit(self.singular)).cross(unit(self.up));
        k.cross(w).try_normalize()
    }
}

impl TransportedFrame {
    /// Initial frame of a pose without a previous one: the stereographic direction.
    pub fn new(facing: Facing) -> Self {
        let map = TwistReference::Stereographic(Stereographic::default());
        Self { direction: facing.direction, outward: map.outward(facing, None) }
    }

    /// Parallel transport to another Pointer, by the least rotation between the two:
    /// e₀' = e₀ − (e₀·ŵ')/(1 + ŵ·ŵ')·(ŵ + ŵ'). Between opposite Pointers e₀ stays, made
    /// perpendicular again.
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

    /// Angle about the Pointer from this e₀ to another's, in (−π, π]. For the two ends of a closed path
    /// it is the path's holonomy, the solid angle that the path encloses.
    pub fn turn_to(self, other: Self) -> f32 {
        let from = self.to(other.direction).outward.as_dvec3();
        let (w, to) = (other.direction.as_dvec3(), other.outward.as_dvec3());
        w.dot(from.cross(to)).atan2(from.dot(to)) as f32
    }
}

impl TwistReference {
    /// e₀, a unit vector perpendicular to the Pointer. Where the reference is singular, it is that of
    /// the transported `last` frame, else the Limb frame's +y.
    pub fn outward(self, facing: Facing, last: Option<TransportedFrame>) -> Vec3 {
        let w = unit(facing.direction);
        let own = match self {
            Self::Limb => Some(facing.limb_frame().y_axis.as_dvec3()),
            Self::Pole(pole) => towards(pole, w),
            Self::Stereographic(map) => map.outward(w),
            // Without a past it begins on the map.
            Self::Transport if last.is_none() => Stereographic::default().outward(w),
            Self::Transport => None,
        };
        match (own, last) {
            (Some(own), _) => own.as_vec3(),
            (None, Some(last)) => last.to(facing.direction).outward,
            (None, None) => facing.limb_frame().y_axis,
        }
    }

    /// ψ_ref, the angle of e₀ about the Pointer from the Limb frame's +y, in (−π, π]; it is added to ψ
    /// for [`TwoBone::solve_from`](super::two_bone::TwoBone::solve_from).
    pub fn angle(self, facing: Facing, last: Option<TransportedFrame>) -> f32 {
        match self {
            Self::Limb => 0.0,
            _ => angle_from_limb(facing, self.outward(facing, last)),
        }
    }

    /// The gain g (see the module); infinite where the reference is singular.
    pub fn gain(self, facing: Facing) -> f32 {
        let w = unit(facing.direction);
        let gain = match self {
            Self::Limb => w.y.abs() / w.x.hypot(w.z),
            // Rounding of the Pointer leaves a pole on its line a little beside it.
            Self::Pole(pole) if towards(pole, w).is_none() => f64::INFINITY,
            Self::Pole(pole) => {
                let pole = pole.as_dvec3();
                pole.dot(w).abs() / pole.cross(w).length()
            }
            Self::Stereographic(map) => {
                let singular = unit(map.singular);
                (w + singular).length() / (w - singular).length()
            }
            Self::Transport => 0.0,
        };
        if gain.is_nan() { f32::INFINITY } else { gain as f32 }
    }
}

/// Angle about the Pointer from the Limb frame's +y to a direction perpendicular to the Pointer, in
/// (−π, π].
pub fn angle_from_limb(facing: Facing, outward: Vec3) -> f32 {
    let limb = facing.limb_frame();
    outward.dot(limb.z_axis).atan2(outward.dot(limb.y_axis))
}

/// The twist ψ, in [0, 2π), measured from another reference without moving the elbow. `from` and `to`
/// are the references' angles from the Limb's +y.
pub fn respun(spin: f32, from: f32, to: f32) -> f32 {
    wrapped_turn(f64::from(spin) + f64::from(from) - f64::from(to))
}

/// An angle wrapped to [0, 2π).
pub fn wrapped(angle: f32) -> f32 {
    wrapped_turn(f64::from(angle))
}

fn wrapped_turn(angle: f64) -> f32 {
    let wrapped = angle.rem_euclid(core::f64::consts::TAU) as f32;
    // Rounding may bring what is just below 2π to it.
    if wrapped < TAU { wrapped } else { 0.0 }
}

/// Unit vector from the Pointer towards a pole; `None` for a pole on the Pointer's line or at the
/// shoulder.
fn towards(pole: Vec3, w: DVec3) -> Option<DVec3> {
    const ON_LINE: f64 = 1e-6;
    let pole = pole.as_dvec3().try_normalize()?;
    let aside = w.cross(pole).cross(w);
    (aside.length() > ON_LINE).then(|| aside.normalize())
}

/// Near R the map's e₀ is a difference of second order: there the length of a direction in f32, off
/// by one rounding, would turn it.
fn unit(direction: Vec3) -> DVec3 {
    direction.as_dvec3().normalize()
}

fn perpendicular(v: DVec3, w: DVec3) -> Option<DVec3> {
    (v - w * (v.dot(w) / w.length_squared())).try_normalize()
}
