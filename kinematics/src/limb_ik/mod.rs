//! Closed-form inverse kinematics for a limb of a skeleton: two bones with limits, between any
//! other joints.
//!
//! The lower joint turns about one axis until the tip of the lower bone is as far from the upper
//! joint as the target is (*bend*); the upper joint then turns the bent limb to the target (*aim*).
//! Everything is computed in f64 in skeleton space, from the angles that the skeleton has: the FK
//! pose.
//!
//! # Bend
//!
//! With p from the upper to the lower joint, r from the lower joint to the tip, and the unit axis â
//! of the lower joint,
//!
//! ```text
//! |p + R_â(β) r|² = |p|² + |r|² + 2 (c₀ + h cos(β − β₀))
//! c₀ = (p·â)(r·â)    c₁ = p·r − c₀    c₂ = p·(â × r)    h = hypot(c₁, c₂)    β₀ = atan2(c₂, c₁)
//! ```
//!
//! This holds for skew axes and for locked joints between the two bones. The limits of β bound the
//! reach; they take the place of |δ| and L in [soft limits](super::soft_reach).
//!
//! The axis is the free one of a hinge (a joint with two fixed angles); otherwise the normal of the
//! plane in which the limb is bent; for a straight limb, the axis about which its limits allow
//! most.
//!
//! # LimbAim
//!
//! The elbow's direction from the Pointer, the axis from the upper joint to the target, is e₀
//! turned by the twist; e₀ follows from the [`ElbowReference`].
//!
//! # What breaks
//!
//! - Limits of the upper joint, and of a lower joint that is no hinge, are applied last. Where those
//!   of the upper joint do not allow the elbow's place, the elbow is
//!   [turned aside](LimbReport::turned_aside) about the Pointer to the nearest place that they
//!   allow; between two such places that are as near, it jumps. Without one the limb misses the
//!   target; [`LimbReach::Limited`] names the joint.
//! - Every reference but [`ElbowReference::Fk`] flips the elbow in the direction where it is
//!   singular, as for [twist references](super::twist); [`ElbowReference::Fk`] only for a target
//!   opposite to the tip of the FK pose.

mod carried;
mod elbow;
mod fk_limb;
mod shoulder;
mod solver;
mod triangle;

use core::f32::consts::FRAC_PI_2;

use glam::{DMat3, DVec3, Vec3};
use thiserror::Error;

use crate::skeleton::{Joint, JointId, RotationAxis, Skeleton};

pub use carried::{CarriedLimb, LimbPosture};
pub use elbow::LimbAim;
pub use fk_limb::LimbRange;
pub(crate) use solver::lengthen;
pub use solver::{
    ElbowReference, LimbReach, LimbReport, LimbTarget, bends_to_several_sides, fk_twist, solve,
    step,
};
pub(crate) use triangle::base_space;
pub use triangle::{LimbSolution, LimbTriangle};

/// Two bones of a skeleton that a target poses together, such as an arm or a leg.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limb {
    /// The joint of the upper bone: shoulder or hip.
    pub upper: JointId,
    /// The joint of the lower bone: elbow or knee. Its tip is brought to the target.
    pub lower: JointId,
    /// The joint at the tip of the lower bone: hand or foot; `None` if there is none, or several.
    pub hand: Option<JointId>,
}

/// The reason why a joint is not the lower joint of a limb.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum NoLimb {
    /// The skeleton has no such joint.
    #[error("there is no joint {0}")]
    NoJoint(JointId),
    /// The joint has no bone.
    #[error("it has no bone")]
    NoBone,
    /// No joint above can turn, or all above are at the same point.
    #[error("no joint above it can turn it")]
    NoUpperJoint,
}

impl Limb {
    /// The limb whose lower joint is `lower`. The upper joint is the nearest ancestor that is not
    /// locked.
    ///
    /// # Errors
    ///
    /// [`NoLimb`] if there is no such limb.
    pub fn ending_at(skeleton: &Skeleton, lower: JointId) -> Result<Self, NoLimb> {
        let joint = skeleton.joint(lower).ok_or(NoLimb::NoJoint(lower))?;
        if !has_length(joint.axis) {
            return Err(NoLimb::NoBone);
        }
        let mut has_upper_bone = false;
        let mut child = joint;
        for upper in skeleton.ancestors(lower).skip(1) {
            has_upper_bone |= has_length(child.offset);
            child = &skeleton[upper];
            if !child.locked {
                let hand = hand(skeleton, lower);
                return has_upper_bone
                    .then_some(Self { upper, lower, hand })
                    .ok_or(NoLimb::NoUpperJoint);
            }
        }
        Err(NoLimb::NoUpperJoint)
    }

    /// The limb for a target of `joint`, which is the last joint of a chain without branches, or the
    /// one before it.
    ///
    /// Fingers and toes are no part of the chain: a hand or foot is its last joint if it is shorter,
    /// from its base to the farthest tip below it, than 0.8 times the bone above it.
    ///
    /// A chain of two bones is a limb. In a chain of three or four bones that branches off a body,
    /// the last is the hand or foot, and the limb ends at its base. Any other chain is better posed
    /// as a whole, and so is one whose lower joint cannot bend through a right angle, such as a
    /// neck, or whose upper joint is a hinge, which cannot aim at a target: `None`.
    pub fn for_end(skeleton: &Skeleton, joint: JointId) -> Option<Self> {
        let is_single = |joint: &JointId| skeleton.children(*joint).nth(1).is_none();
        let has_bone = |joint: &JointId| has_length(skeleton[*joint].axis);
        let end = [Some(joint), hand(skeleton, joint)]
            .into_iter()
            .flatten()
            .find(|joint| is_end(skeleton, *joint))?;
        let above = || skeleton.ancestors(end).skip(1);
        let is_on_body = above().any(|joint| !is_single(&joint));
        let bones =
            usize::from(has_bone(&end)) + above().take_while(is_single).filter(has_bone).count();
        let parent = skeleton[end].parent?;
        match bones {
            2 => Self::ending_at(skeleton, end).ok(),
            3 | 4 if is_on_body => Self::ending_at(skeleton, parent).ok(),
            _ => None,
        }
        .filter(|limb| limb.lower == joint || limb.hand == Some(joint))
        .filter(|limb| can_bend(&skeleton[limb.lower]))
        .filter(|limb| skeleton[limb.upper].hinge().is_none())
    }

    /// The joints that a solve turns.
    pub fn joints(self) -> impl Iterator<Item = JointId> {
        [self.upper, self.lower].into_iter().chain(self.hand)
    }

    /// The joints from the lower one up to the upper one, with the locked ones between them.
    pub fn bones(self, skeleton: &Skeleton) -> impl Iterator<Item = JointId> {
        let above = skeleton[self.upper].parent;
        skeleton.ancestors(self.lower).take_while(move |joint| Some(*joint) != above)
    }
}

/// True for a joint without children, and for a hand or foot with fingers or toes.
fn is_end(skeleton: &Skeleton, joint: JointId) -> bool {
    /// Length of a hand or foot with its fingers or toes, at most, relative to the bone above it.
    const LENGTH: f32 = 0.8;
    /// Joints of a finger or toe, at most.
    const MOST: usize = 5;
    if skeleton.children(joint).next().is_none() {
        return true;
    }
    let Some(parent) = skeleton[joint].parent else { return false };
    let most = LENGTH * skeleton[parent].axis.length();
    let mut open = vec![(joint, 0.0, 0)];
    while let Some((joint, length, depth)) = open.pop() {
        if length + skeleton[joint].axis.length() > most || depth > MOST {
            return false;
        }
        let below = skeleton.children(joint);
        open.extend(below.map(|it| (it, length + skeleton[it].offset.length(), depth + 1)));
    }
    true
}

/// The only child at the tip of a joint's bone.
fn hand(skeleton: &Skeleton, joint: JointId) -> Option<JointId> {
    let Joint { axis, .. } = skeleton[joint];
    let is_at_tip =
        |child: &JointId| skeleton[*child].offset.distance(axis) <= 1e-5 * axis.length();
    let mut children = skeleton.children(joint).filter(is_at_tip);
    children.next().filter(|_| children.next().is_none())
}

/// True if limits let a joint turn through a right angle about one of its axes.
fn can_bend(joint: &Joint) -> bool {
    let is_wide = |axis| joint.limits.span(axis) >= FRAC_PI_2;
    !joint.locked && RotationAxis::ALL.into_iter().any(is_wide)
}

fn has_length(bone: glam::Vec3) -> bool {
    bone.as_dvec3().length() > 0.0
}

/// The space of a joint: its rotation and origin in another space, in f64.
#[derive(Clone, Copy, Debug)]
struct JointSpace {
    pub rotation: DMat3,
    pub origin: DVec3,
}

impl JointSpace {
    const IDENTITY: Self = Self { rotation: DMat3::IDENTITY, origin: DVec3::ZERO };

    /// A joint's own space in skeleton space; that of no joint is skeleton space.
    pub fn of(skeleton: &Skeleton, joint: Option<JointId>) -> Self {
        Self::from_top(skeleton, joint.into_iter().flat_map(|joint| skeleton.ancestors(joint)))
    }

    /// The own space of the first of `joints`, each the parent of the one before, in the space of
    /// the last one's parent.
    pub fn from_top(skeleton: &Skeleton, joints: impl Iterator<Item = JointId>) -> Self {
        joints.fold(Self::IDENTITY, |space, joint| {
            let joint = &skeleton[joint];
            let rotation = joint.rotation_f64(joint.rotation);
            Self { rotation, origin: joint.offset.as_dvec3() }.of_inner(space)
        })
    }

    /// A space that is given in this space, in the space in which this one is given.
    pub fn of_inner(self, inner: Self) -> Self {
        let origin = self.origin + self.rotation * inner.origin;
        Self { rotation: self.rotation * inner.rotation, origin }
    }

    /// The space of a child before its rotation.
    pub fn at_base_of(self, child: &Joint) -> Self {
        Self { origin: self.point(child.offset), ..self }
    }

    /// The position of a point of this space.
    pub fn point(self, point: Vec3) -> DVec3 {
        self.origin + self.rotation * point.as_dvec3()
    }
}
