//! Closed form for a target's joint and its parent: [`TwoBone`] in the plane of their bones.
//!
//! The elbow keeps its side: its direction from the line between shoulder and hand is transported
//! by the smallest rotation of this line. The upper bone rotates with the whole plane, so that an
//! elbow that is a hinge remains a hinge. A straight or folded limb is first bent within its
//! limits.

use glam::{Mat3A, Vec3, Vec3A};
use thiserror::Error;

use super::ccd::move_roots;
use crate::chain_ik::configuration::Configuration;
use crate::chain_ik::inside::{Event, Recorder};
use crate::chain_ik::perturb::bent_angles;
use crate::chain_ik::problem::{EndEffector, Problem};
use crate::skeleton::{JointId, Skeleton, angle_triples};
use crate::two_bone::TwoBone;
use crate::{normalize, rotation_between};

/// Reason why [`Method::TwoBone`](crate::chain_ik::Method::TwoBone) cannot move a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum TwoBoneRefusal {
    /// The joint is a root.
    #[error("it has no parent")]
    NoParent,
    /// The joint is locked, or a locked root.
    #[error("it is locked")]
    Locked,
    /// The joint's parent is locked, or a locked root.
    #[error("its parent is locked")]
    ParentLocked,
    /// One of the two bones has length 0, or a length that the closed form cannot solve.
    #[error("one of its two bones has no length")]
    NoLength,
    /// The joint or its parent is stiff: the closed form has no motion to divide.
    #[error("it or its parent has a stiffness")]
    Stiff,
    /// The joint or its parent belongs to the limb of another target.
    #[error("another target moves the same joint")]
    Shared,
}

/// A target whose joint the closed form cannot move.
#[derive(Clone, Copy, Debug)]
pub(in crate::chain_ik) struct TwoBonesRefused {
    pub joint: JointId,
    pub reason: TwoBoneRefusal,
}

fn check_stiffness(
    problem: &Problem,
    effector: &EndEffector,
    links: [usize; 2],
) -> Result<(), TwoBonesRefused> {
    let is_stiff = links.iter().any(|link| problem.links[*link].is_stiff());
    let refused = TwoBonesRefused { joint: effector.joint, reason: TwoBoneRefusal::Stiff };
    if is_stiff { Err(refused) } else { Ok(()) }
}

/// The two links above one end effector.
#[derive(Clone, Copy, Debug, PartialEq)]
struct LinkPair {
    effector: usize,
    upper: usize,
    lower: usize,
    arm: TwoBone,
}

#[derive(Clone, Debug, PartialEq)]
pub(in crate::chain_ik) struct TwoBones {
    /// Limbs, sorted from the roots to the tips.
    limbs: Vec<LinkPair>,
}

impl TwoBones {
    pub fn new(problem: &Problem, skeleton: &Skeleton) -> Result<Self, TwoBonesRefused> {
        let mut limbs: Vec<LinkPair> = Vec::new();
        for (index, effector) in problem.effectors.iter().enumerate() {
            let refuse = |reason| TwoBonesRefused { joint: effector.joint, reason };
            let parent = skeleton[effector.joint].parent;
            let parent = parent.ok_or_else(|| refuse(TwoBoneRefusal::NoParent))?;
            // All ancestors of a target that may turn have links.
            let link = |joint: JointId| problem.links.iter().position(|link| link.joint == joint);
            let lower = link(effector.joint).ok_or_else(|| refuse(TwoBoneRefusal::Locked))?;
            let upper = link(parent).ok_or_else(|| refuse(TwoBoneRefusal::ParentLocked))?;
            let lengths = [problem.links[lower].pivot.length(), effector.tip.length()];
            let arm = TwoBone::new(lengths[0], lengths[1])
                .map_err(|_| refuse(TwoBoneRefusal::NoLength))?;
            check_stiffness(problem, effector, [upper, lower])?;
            let is_taken = |limb: &LinkPair| {
                [limb.upper, limb.lower].iter().any(|link| *link == upper || *link == lower)
            };
            if limbs.iter().any(is_taken) {
                return Err(refuse(TwoBoneRefusal::Shared));
            }
            limbs.push(LinkPair { effector: index, upper, lower, arm });
        }
        limbs.sort_by_key(|limb| limb.upper);
        Ok(Self { limbs })
    }

    /// Fits the limbs to other lengths.
    ///
    /// # Errors
    ///
    /// [`TwoBoneRefusal::NoLength`], [`TwoBoneRefusal::Stiff`]; the limbs are unchanged.
    pub fn refit(&mut self, problem: &Problem) -> Result<(), TwoBonesRefused> {
        for check in [true, false] {
            for limb in &mut self.limbs {
                let effector = &problem.effectors[limb.effector];
                let lengths = [problem.links[limb.lower].pivot.length(), effector.tip.length()];
                let refused =
                    |_| TwoBonesRefused { joint: effector.joint, reason: TwoBoneRefusal::NoLength };
                let arm = TwoBone::new(lengths[0], lengths[1]).map_err(refused)?;
                check_stiffness(problem, effector, [limb.upper, limb.lower])?;
                if !check {
                    limb.arm = arm;
                }
            }
        }
        Ok(())
    }

    /// Solves all limbs and returns `false`: a second time would change nothing.
    pub fn iterate(
        &self,
        problem: &Problem,
        config: &mut Configuration,
        recorder: &mut Recorder,
    ) -> bool {
        for limb in &self.limbs {
            self.bend_if_straight(problem, config, *limb);
            place_elbow(problem, config, *limb);
            recorder.record(config, || Event::PlaceElbow(limb.lower));
            aim_hand(problem, config, *limb);
            recorder.record(config, || Event::Aim(limb.lower));
        }
        if problem.free_roots {
            move_roots(problem, config);
            config.forward(problem);
            recorder.record(config, || Event::MoveRoots);
        }
        false
    }

    /// Bends a limb that is too straight to define a plane.
    fn bend_if_straight(&self, problem: &Problem, config: &mut Configuration, limb: LinkPair) {
        // Sine of the angle between the bones below which the plane of the bones is only rounding.
        const STRAIGHT: f32 = 1e-4;
        const BEND: f32 = 0.1;
        let upper =
            normalize(config.bases[limb.lower] - config.bases[limb.upper]).unwrap_or_default();
        let lower =
            normalize(config.tips[limb.effector] - config.bases[limb.lower]).unwrap_or_default();
        if upper.cross(lower).length() < STRAIGHT {
            config.angles[limb.lower] = bent_angles(problem, config, limb.lower, upper, BEND);
            config.forward(problem);
        }
    }
}

/// Rotates the upper bone together with the limb's plane, so that the elbow is where the closed
/// form puts it. A bone that is so short that it underflows beside the chain's length is left
/// unchanged.
fn place_elbow(problem: &Problem, config: &mut Configuration, limb: LinkPair) {
    let shoulder = config.bases[limb.upper];
    let (upper, hand) =
        (config.bases[limb.lower] - shoulder, config.tips[limb.effector] - shoulder);
    let cursor =
        problem.effectors[limb.effector].destination(config.tips[limb.effector]) - shoulder;

    let Some(along) = normalize(upper) else { return };
    let old_normal = normalize(hand.cross(upper));
    let old_normal = old_normal.unwrap_or_else(|| along.any_orthonormal_vector());
    let old_pointer = normalize(hand).unwrap_or_else(|| old_normal.cross(along));
    let pointer = normalize(cursor).unwrap_or(old_pointer);
    let transported = rotation_between(old_pointer, pointer) * old_normal;
    let normal = normalize(transported.reject_from_normalized(pointer));
    let normal = normal.unwrap_or_else(|| pointer.any_orthonormal_vector());

    let solved = limb.arm.solve(Vec3::X * cursor.length(), 0.0);
    let elbow = pointer * solved.along + normal.cross(pointer) * solved.out;
    let Some(new_along) = normalize(elbow) else { return };
    let plane = |along: Vec3A, normal: Vec3A| Mat3A::from_cols(along, normal, along.cross(normal));
    let rotation = plane(new_along, normal) * plane(along, old_normal).transpose();
    rotate_link(problem, config, limb.upper, rotation);
}

/// Rotates the lower bone towards the target.
fn aim_hand(problem: &Problem, config: &mut Configuration, limb: LinkPair) {
    let elbow = config.bases[limb.lower];
    let (lower, cursor) = (
        config.tips[limb.effector] - elbow,
        problem.effectors[limb.effector].destination(config.tips[limb.effector]) - elbow,
    );
    rotate_link(problem, config, limb.lower, Mat3A::from_quat(rotation_between(lower, cursor)));
}

/// Rotates a link by a rotation in skeleton space, within its limits. Of the two equivalent Euler
/// triples it takes the farther one only if the limits contain that one and not the nearer one.
fn rotate_link(problem: &Problem, config: &mut Configuration, index: usize, rotation: Mat3A) {
    let link = &problem.links[index];
    let parent = link.parent.map_or(Mat3A::IDENTITY, |parent| config.frames[parent]);
    let own = (parent * link.mount).transpose() * rotation * config.frames[index];
    let [near, far] = angle_triples(own, config.angles[index]);
    let is_farther = link.limits.contains(far) && !link.limits.contains(near);
    config.angles[index] = link.limits.project(if is_farther { far } else { near });
    config.forward(problem);
}
