//! Closed form for a target's joint and its parent: [`TwoBone`] in their own plane.
//!
//! The elbow stays on the side where it is: its direction out from the line shoulder–hand is carried
//! by the least turn of that line, and the upper bone turns with the whole plane, so that a hinge
//! stays one. A straight or folded arm is bent as its limits let it first.

use glam::{Mat3A, Vec3, Vec3A};

use super::SolveError;
use super::configuration::Configuration;
use super::perturb::bend_body;
use super::problem::Problem;
use crate::kinematics::skeleton::{Limit, angle_triples, within};
use crate::kinematics::two_bone::TwoBone;
use crate::kinematics::{normalize, rotation_between};

/// The two bodies of one goal.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Pair {
    goal: usize,
    upper: usize,
    lower: usize,
    arm: TwoBone,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct TwoBones {
    /// From the roots to the tips.
    pairs: Vec<Pair>,
}

impl TwoBones {
    pub fn new(
        rig: &Problem,
        skeleton: &crate::kinematics::skeleton::Skeleton,
    ) -> Result<Self, SolveError> {
        let mut pairs: Vec<Pair> = Vec::new();
        for (index, goal) in rig.goals.iter().enumerate() {
            let refuse = |reason| SolveError::TwoBone { joint: goal.joint, reason };
            let joint = &skeleton[goal.joint];
            let parent = joint.parent.ok_or_else(|| refuse("it has no parent"))?;
            if joint.locked {
                return Err(refuse("it is locked"));
            }
            if skeleton[parent].locked {
                return Err(refuse("its parent is locked"));
            }
            let place = |joint| rig.bodies.iter().position(|body| body.joint == joint);
            let (Some(upper), Some(lower)) = (place(parent), place(goal.joint)) else {
                return Err(refuse("it is not on the path of a target"));
            };
            let lengths = [rig.bodies[lower].pivot.length(), goal.tip.length()];
            let arm = TwoBone::new(lengths[0], lengths[1])
                .map_err(|_| refuse("one of the two bones has no length"))?;
            let is_taken = |pair: &Pair| {
                [pair.upper, pair.lower].iter().any(|body| *body == upper || *body == lower)
            };
            if pairs.iter().any(is_taken) {
                return Err(refuse("another target moves the same joint"));
            }
            pairs.push(Pair { goal: index, upper, lower, arm });
        }
        pairs.sort_by_key(|pair| pair.upper);
        Ok(Self { pairs })
    }

    pub fn solve(&self, rig: &Problem, pose: &mut Configuration) {
        for pair in &self.pairs {
            self.bend_if_straight(rig, pose, *pair);
            place_elbow(rig, pose, *pair);
            aim_hand(rig, pose, *pair);
        }
        if rig.free {
            super::ccd::move_roots(rig, pose);
            pose.forward(rig);
        }
    }

    fn bend_if_straight(&self, rig: &Problem, pose: &mut Configuration, pair: Pair) {
        // Sine of the angle between the bones: below it their plane is rounding.
        const STRAIGHT: f32 = 1e-4;
        const BEND: f32 = 0.1;
        let upper = normalize(pose.bases[pair.lower] - pose.bases[pair.upper]).unwrap_or_default();
        let lower = normalize(pose.tips[pair.goal] - pose.bases[pair.lower]).unwrap_or_default();
        if upper.cross(lower).length() < STRAIGHT {
            bend_body(rig, pose, pair.lower, upper, BEND);
            pose.forward(rig);
        }
    }
}

/// Turns the upper bone, and the arm's plane with it. A bone that is so short beside the chain that
/// rounding leaves nothing of it stays as it is.
fn place_elbow(rig: &Problem, pose: &mut Configuration, pair: Pair) {
    let shoulder = pose.bases[pair.upper];
    let (upper, hand) = (pose.bases[pair.lower] - shoulder, pose.tips[pair.goal] - shoulder);
    let cursor = rig.goals[pair.goal].point - shoulder;

    let Some(along) = normalize(upper) else { return };
    let old_normal = normalize(hand.cross(upper));
    let old_normal = old_normal.unwrap_or_else(|| along.any_orthonormal_vector());
    let old_pointer = normalize(hand).unwrap_or_else(|| old_normal.cross(along));
    let pointer = normalize(cursor).unwrap_or(old_pointer);
    let transported = rotation_between(old_pointer, pointer) * old_normal;
    let normal = normalize(transported.reject_from_normalized(pointer));
    let normal = normal.unwrap_or_else(|| pointer.any_orthonormal_vector());

    let solved = pair.arm.solve(Vec3::X * cursor.length(), 0.0);
    let elbow = pointer * solved.along + normal.cross(pointer) * solved.out;
    let Some(new_along) = normalize(elbow) else { return };
    let plane = |along: Vec3A, normal: Vec3A| Mat3A::from_cols(along, normal, along.cross(normal));
    let turn = plane(new_along, normal) * plane(along, old_normal).transpose();
    turn_body(rig, pose, pair.upper, turn);
}

/// Turns the lower bone towards the target.
fn aim_hand(rig: &Problem, pose: &mut Configuration, pair: Pair) {
    let elbow = pose.bases[pair.lower];
    let (lower, cursor) = (pose.tips[pair.goal] - elbow, rig.goals[pair.goal].point - elbow);
    turn_body(rig, pose, pair.lower, Mat3A::from_quat(rotation_between(lower, cursor)));
}

/// Turns a body by a turn in skeleton space, as far as its limits let it; of the two ways to write
/// it the one that they let.
fn turn_body(rig: &Problem, pose: &mut Configuration, index: usize, turn: Mat3A) {
    let body = &rig.bodies[index];
    let above = body.parent.map_or(Mat3A::IDENTITY, |parent| pose.frames[parent]);
    let own = (above * body.mount).transpose() * turn * pose.frames[index];
    let [near, far] = angle_triples(own, pose.angles[index]);
    let is_within = |angles: Vec3| {
        let fits = |(angle, limit): (f32, Option<Limit>)| {
            limit.is_none_or(|limit| (limit.min..=limit.max).contains(&angle))
        };
        angles.to_array().into_iter().zip(body.limits).all(fits)
    };
    let angles = if is_within(far) && !is_within(near) { far } else { near };
    pose.angles[index] = within(&body.limits, angles);
    pose.forward(rig);
}
