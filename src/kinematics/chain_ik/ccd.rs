//! Cyclic coordinate descent: from the tips to the roots, each joint turns as if it were the only
//! one.
//!
//! With r the arms from the joint's base to the tips it carries and t those to their targets, one
//! tip is turned exactly onto the line to its target; several by the best angle about Σ w r × t.
//! The best angle about a unit axis a has tan θ = Σ w a·(r × t) / Σ w (r·t − (a·r)(a·t)). A joint
//! with limits is taken as three hinges, x, y and z, each with its best angle within limits. No turn
//! makes anything worse.
//!
//! A sweep turns only the tips; joints follow in one pass from the roots, so that an iteration costs
//! as much as there are joints.
//!
//! # Source
//!
//! L. Wang, C. Chen, *A combined optimization method for solving the inverse kinematics problem of
//! mechanical manipulators*, 1991.

use glam::{Mat3A, Quat, Vec3A};

use super::align::{Pair, align, align_within};
use super::configuration::Configuration;
use super::problem::Problem;
use crate::kinematics::skeleton::EulerAngles;

#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Ccd {
    /// From bodies' parents' spaces to their own, without E.
    mounts: Vec<Quat>,
    /// By which each body turned in this sweep; then with what is above it.
    turns: Vec<Quat>,
    pairs: Vec<Pair>,
}

impl Ccd {
    pub fn new(rig: &Problem) -> Self {
        Self {
            mounts: rig.bodies.iter().map(|body| Quat::from_mat3a(&body.mount)).collect(),
            turns: vec![Quat::IDENTITY; rig.bodies.len()],
            pairs: Vec::with_capacity(rig.goals.len()),
        }
    }

    pub fn iterate(&mut self, rig: &Problem, pose: &mut Configuration) {
        for index in (0..rig.bodies.len()).rev() {
            self.turns[index] = self.turn(rig, pose, index);
        }
        self.follow(rig, pose);
        if rig.free {
            move_roots(rig, pose);
        }
    }

    /// Turns one body, and the tips it carries.
    fn turn(&mut self, rig: &Problem, pose: &mut Configuration, index: usize) -> Quat {
        let (body, base) = (&rig.bodies[index], pose.bases[index]);
        let below = &rig.below[body.below.0..body.below.1];
        self.pairs.clear();
        self.pairs.extend(below.iter().map(|goal| Pair {
            arm: pose.tips[*goal] - base,
            goal: rig.goals[*goal].point - base,
            weight: rig.goals[*goal].weight,
        }));
        let turn = if body.is_limited() {
            let above = body.parent.map_or(Quat::IDENTITY, |parent| pose.turned[parent]);
            let axes = Mat3A::from_quat(above * self.mounts[index])
                * EulerAngles(pose.angles[index]).axes();
            let axes = [axes.x_axis, axes.y_axis, axes.z_axis];
            align_within(&body.limits, axes, &mut pose.angles[index], &mut self.pairs)
        } else {
            let turn = align(&self.pairs);
            self.pairs.iter_mut().for_each(|pair| pair.arm = turn * pair.arm);
            turn
        };
        for (goal, pair) in below.iter().zip(&self.pairs) {
            pose.tips[*goal] = base + pair.arm;
        }
        turn
    }

    /// Everything else from the turns: each body's own first, then those above it.
    fn follow(&mut self, rig: &Problem, pose: &mut Configuration) {
        for (index, body) in rig.bodies.iter().enumerate() {
            if let Some(parent) = body.parent {
                self.turns[index] = self.turns[parent] * self.turns[index];
            }
            pose.turned[index] = if body.is_limited() {
                let above = body.parent.map_or(Quat::IDENTITY, |parent| pose.turned[parent]);
                let own = Quat::from_mat3a(&EulerAngles(pose.angles[index]).matrix());
                (above * self.mounts[index] * own).normalize()
            } else {
                (self.turns[index] * pose.turned[index]).normalize()
            };
        }
        place(rig, pose);
    }
}

/// Bases and tips from how bodies are turned.
pub(super) fn place(rig: &Problem, pose: &mut Configuration) {
    for (index, body) in rig.bodies.iter().enumerate() {
        pose.bases[index] = match body.parent {
            Some(parent) => pose.bases[parent] + pose.turned[parent] * body.pivot,
            None => pose.shift[body.tree] + body.pivot,
        };
    }
    for (goal, tip) in rig.goals.iter().zip(&mut pose.tips) {
        *tip = match goal.body {
            Some(body) => pose.bases[body] + pose.turned[body] * goal.tip,
            None => pose.shift[goal.tree] + goal.tip,
        };
    }
}

/// Each tree by what its tips are short of their targets in the mean, as far as numbers go.
pub(super) fn move_roots(rig: &Problem, pose: &mut Configuration) {
    for tree in 0..rig.trees.len() {
        let (mut sum, mut weights) = (Vec3A::ZERO, 0.0);
        for (goal, tip) in rig.goals.iter().zip(&pose.tips).filter(|(goal, _)| goal.tree == tree) {
            sum += goal.weight * (goal.point - *tip);
            weights += goal.weight;
        }
        let by = sum / weights;
        if !rig.can_go(tree, pose.shift[tree] + by) {
            continue;
        }
        pose.shift[tree] += by;
        let bases = rig.bodies.iter().zip(&mut pose.bases);
        bases.filter(|(body, _)| body.tree == tree).for_each(|(_, base)| *base += by);
        let tips = rig.goals.iter().zip(&mut pose.tips);
        tips.filter(|(goal, _)| goal.tree == tree).for_each(|(_, tip)| *tip += by);
    }
}
