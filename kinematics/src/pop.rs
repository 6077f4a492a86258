//! Pops: steps in which the elbow moves much faster than the cursor, with their causes.
//!
//! With ŵ the Pointer's direction, ê the unit vector from the Pointer towards the elbow, and hₑ and
//! oₑ the elbow's coordinates along ŵ and ê, the elbow is at hₑ ŵ + oₑ ê. T is the rotation by the
//! smallest angle from the Pointer before a step (ŵ) to the Pointer after it (ŵ'). The elbow's
//! displacement is exactly the sum of three parts:
//!
//! ```text
//! turn    T(hₑ ŵ + oₑ ê) − (hₑ ŵ + oₑ ê)                   the Pointer's rotation
//! bend    (hₑ' − hₑ) ŵ' + (oₑ' − oₑ) · ½ (ê' + T ê)        in the plane of the arm
//! swing   ½ (oₑ + oₑ') · (ê' − T ê)                        rotation about the Pointer, by the twist reference
//! ```
//!
//! # Definition of a spike
//!
//! A spike is a step in which the elbow moves more than twice as far as expected. The expected
//! displacement is the cursor's own, or σd₁/D times that if it is more, as for an arm with stretch
//! σ that rotates rigidly about the shoulder:
//!
//! ```text
//! |Δ elbow| / |Δ cursor|  >  2 · max(1, σd₁ / max(D, L/5))
//! ```
//!
//! The factor is 2 because an arm without a pop can come near it. The sideways part of the bound in
//! [`ik`](super::ik) is (d₁ + oₑ·g)/d ≤ 2·d₁/d wherever the reference swings no faster than the
//! Pointer turns (gain g ≤ 1: at 45° or more from the vertical for the Limb, at 45° or more from
//! the pole's line, and in the half of all directions opposite to the stereographic map's singular
//! one). The bending of two equal bones stays below 2 up to D = 0.968·L. A cursor that passes the
//! shoulder within a fifth of the outer limit rotates the whole arm, which is a kind of pop of its
//! own.
//!
//! Everything is in Root space; lengths share any one unit, angles are radians.

use core::f64::consts::FRAC_PI_2;

use glam::{DVec3, Vec3};

use super::fk::Fk;
use super::ik::Ik;
use super::twist::{Stereographic, TransportedFrame, TwistReference, TwistReferenceKind};
use super::two_bone::TwoBonePose;

/// A solved limb with all inputs of its pose.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PosedLimb {
    /// The pose.
    pub pose: TwoBonePose,
    /// The cursor in Root space.
    pub cursor: Vec3,
    /// Bones, twist reference and soft limits.
    pub ik: Ik,
    /// Kind of the twist reference.
    pub kind: TwistReferenceKind,
    /// Twist ψ, in radians.
    pub twist: f32,
    /// Position of the shoulder in the world if the cursor is pinned to the world; `None` if the
    /// cursor is in Root space and moves with the shoulder.
    pub pinned_root: Option<Vec3>,
    /// Influence of IK: 1 for the solved pose, 0 for the FK angles.
    pub influence: f32,
    /// FK angles.
    pub fk: Fk,
}

/// An input, other than the cursor, that changed in a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum InputChange {
    /// Bone lengths.
    Lengths,
    /// Kind of the twist reference, or its map.
    TwistReference,
    /// Position of the pole.
    Pole,
    /// Soft limits.
    SoftReach,
    /// Influence of IK.
    Influence,
    /// FK angles.
    Angles,
    /// Twist ψ.
    Twist,
    /// Position of the shoulder.
    Root,
}

/// The elbow's displacement in a step of the cursor.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ElbowStep {
    /// Ratio of the elbow's displacement to the cursor's.
    pub ratio: f32,
    /// Ratio above which the step is a spike.
    pub limit: f32,
    /// Part of the displacement caused by the rotation of the Pointer, in Root space.
    pub turn: Vec3,
    /// Part of the displacement in the plane of the arm, in Root space.
    pub bend: Vec3,
    /// Part of the displacement about the Pointer, caused by the twist reference, in Root space.
    pub swing: Vec3,
    /// Cause of the spike; `None` if the step is not a spike.
    pub pop: Option<PopCause>,
}

/// Cause of a pop.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum PopCause {
    /// The Pointer passed a singular direction of the twist reference.
    Singular {
        /// Smallest angle between the Pointer and the singular direction in the step, in radians.
        nearest: f32,
    },
    /// The arm became or ceased to be straight.
    Straight,
    /// The arm became or ceased to be folded.
    Folded,
    /// The cursor passed the shoulder.
    Shoulder,
}

impl InputChange {
    /// All changes, in order of precedence.
    pub const ALL: [Self; 8] = [
        Self::Lengths,
        Self::TwistReference,
        Self::Pole,
        Self::SoftReach,
        Self::Influence,
        Self::Angles,
        Self::Twist,
        Self::Root,
    ];

    /// The first input in [`Self::ALL`] that differs between two poses; `None` if all are equal.
    /// Inputs without effect are ignored: the FK angles at influence 1, and the shoulder's position
    /// unless the cursor is pinned to the world.
    pub fn between(before: &PosedLimb, after: &PosedLimb) -> Option<Self> {
        Self::ALL.into_iter().find(|change| change.is_between(before, after))
    }

    fn is_between(self, before: &PosedLimb, after: &PosedLimb) -> bool {
        let references = (before.ik.reference, after.ik.reference);
        // With FK as reference, its map follows from the angles.
        let is_by_fk = before.kind == TwistReferenceKind::Fk && after.kind == before.kind;
        match self {
            Self::Lengths => before.ik.bones != after.ik.bones,
            Self::TwistReference => match references {
                (TwistReference::Pole(_), TwistReference::Pole(_)) => before.kind != after.kind,
                (one, other) => one != other && !is_by_fk,
            },
            Self::Pole => references.0 != references.1 && !is_by_fk,
            Self::SoftReach => before.ik.soft_reach != after.ik.soft_reach,
            Self::Influence => before.influence != after.influence,
            Self::Angles => (after.influence < 1.0 || is_by_fk) && before.fk != after.fk,
            Self::Twist => before.twist != after.twist,
            Self::Root => match (before.pinned_root, after.pinned_root) {
                (Some(one), Some(other)) => one != other,
                _ => false,
            },
        }
    }

    /// Name of the input, in lower case.
    pub fn name(self) -> &'static str {
        match self {
            Self::Lengths => "lengths",
            Self::TwistReference => "twist reference",
            Self::Pole => "pole",
            Self::SoftReach => "soft limits",
            Self::Influence => "IK influence",
            Self::Angles => "angles",
            Self::Twist => "Socket twist",
            Self::Root => "root",
        }
    }
}

impl ElbowStep {
    /// Length of the cursor's step, as a fraction of L, below which the elbow's displacement cannot
    /// be told from f32 rounding in a nearly straight or folded arm. A caller can accumulate
    /// shorter steps.
    pub const LEAST: f32 = 1e-3;
    /// Ratio of the elbow's displacement to the expected one above which a step is a spike: see the
    /// module.
    const SPIKE: f64 = 2.0;

    /// The elbow's step between two poses, for inputs without an [`InputChange`]; `None` if the
    /// cursor moves by less than [`Self::LEAST`].
    pub fn between(before: &PosedLimb, after: &PosedLimb) -> Option<Self> {
        let went = (after.cursor.as_dvec3() - before.cursor.as_dvec3()).length();
        let sum = f64::from(after.ik.bones.upper()) + f64::from(after.ik.bones.lower());
        if went < f64::from(Self::LEAST) * sum {
            return None;
        }
        let [turn, bend, swing] = parts(before, after);
        let moved = (after.pose.elbow.as_dvec3() - before.pose.elbow.as_dvec3()).length();
        let (ratio, limit) = (moved / went, Self::SPIKE * calm(before, after));
        let pop = (ratio > limit).then(|| {
            let [turned, bent, swung] = [turn, bend, swing].map(DVec3::length);
            if swung >= turned.max(bent) {
                PopCause::Singular { nearest: nearest_to_singular(before, after) as f32 }
            } else if turned >= bent {
                PopCause::Shoulder
            } else if is_far_out(before, after) {
                PopCause::Straight
            } else {
                PopCause::Folded
            }
        });
        let [turn, bend, swing] = [turn, bend, swing].map(DVec3::as_vec3);
        Some(Self { ratio: ratio as f32, limit: limit as f32, turn, bend, swing, pop })
    }
}

/// The parts turn, bend and swing of the elbow's displacement.
pub(crate) fn parts(before: &PosedLimb, after: &PosedLimb) -> [DVec3; 3] {
    let (before, after) = (&before.pose, &after.pose);
    let outward = before.outward();
    let transported = TransportedFrame { direction: before.pointer.direction, outward };
    let [w, to] = [before, after].map(|pose| pose.pointer.direction.as_dvec3());
    let (out, transported) =
        (outward.as_dvec3(), transported.to(after.pointer.direction).outward.as_dvec3());
    let [from, at] =
        [before, after].map(|pose| DVec3::new(pose.along.into(), pose.out.into(), 0.0));
    let side = after.outward().as_dvec3();
    [
        (to - w) * from.x + (transported - out) * from.y,
        to * (at.x - from.x) + (side + transported) * (0.5 * (at.y - from.y)),
        (side - transported) * (0.5 * (from.y + at.y)),
    ]
}

/// Ratio of the elbow's expected displacement to the cursor's: max(1, σd₁ / max(D, L/5)).
pub(crate) fn calm(before: &PosedLimb, after: &PosedLimb) -> f64 {
    const NEAR_SHOULDER: f64 = 0.2;
    let sum = f64::from(after.ik.bones.upper()) + f64::from(after.ik.bones.lower());
    let stretch = f64::from(before.pose.stretch.max(after.pose.stretch));
    let distance = f64::from(before.pose.distance.min(after.pose.distance));
    let upper = stretch * f64::from(after.ik.bones.upper());
    (upper / distance.max(NEAR_SHOULDER * sum)).max(1.0)
}

/// True if the hand's mean distance in both poses is nearer to the outer limit than to the inner
/// one.
pub(crate) fn is_far_out(before: &PosedLimb, after: &PosedLimb) -> bool {
    let sum = f64::from(after.ik.bones.upper()) + f64::from(after.ik.bones.lower());
    let least = f64::from(after.ik.soft_reach.least_distance(after.ik.bones));
    f64::from(before.pose.distance) + f64::from(after.pose.distance) > least + sum
}

/// Smallest angle in radians between the Pointer, on its way from one pose to the other, and a
/// singular direction of the twist reference.
pub(crate) fn nearest_to_singular(before: &PosedLimb, after: &PosedLimb) -> f64 {
    let [from, to] = [before, after].map(|it| it.pose.pointer.direction.as_dvec3());
    let nearest = |direction: Vec3| {
        direction.as_dvec3().try_normalize().map_or(FRAC_PI_2, |it| nearest_on_arc(it, from, to))
    };
    match after.ik.reference {
        TwistReference::Up => nearest(Vec3::Y).min(nearest(Vec3::NEG_Y)),
        TwistReference::Pole(pole) => nearest(pole).min(nearest(-pole)),
        TwistReference::Stereographic(map) => nearest(map.singular()),
        // Without a previous frame, transport begins at the stereographic direction.
        TwistReference::Transport => nearest(Stereographic::default().singular()),
    }
}

/// Smallest angle from the direction `point` to the shorter arc between two directions, in radians.
fn nearest_on_arc(point: DVec3, from: DVec3, to: DVec3) -> f64 {
    let at_ends = from.angle_between(point).min(to.angle_between(point));
    let Some(normal) = from.cross(to).try_normalize() else {
        return at_ends;
    };
    let is_beside = from.cross(point).dot(normal) > 0.0 && point.cross(to).dot(normal) > 0.0;
    if is_beside { normal.dot(point).abs().min(1.0).asin() } else { at_ends }
}
