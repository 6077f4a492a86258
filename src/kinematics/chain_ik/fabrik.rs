//! Forward and backward reaching: points are pulled to where they are wanted, first from targets to
//! roots, then back, each time to the right distance from the one before.
//!
//! ```text
//! inward    base' = wanted + r · unit(base − wanted)      wanted: the target, or the child's base'
//! outward   point = base + r · unit(wanted − base)        base: of the root, then the parent's point
//! ```
//!
//! Children that share a point want it at the weighted mean of their bases'. A body with several
//! points (bones with children not at their tips; locked forks) asks for the mean of what its points
//! ask, and is turned as a whole, to fit them best.
//!
//! With limits every body is turned so on the way back, and limited ones angle by angle as far as
//! they can. The way in knows no limits: what it asks for may be what they forbid, and the points
//! would go back and forth. Where that makes nothing better, a sweep of cyclic coordinate descent
//! takes the iteration's place.
//!
//! A chain with one target beyond reach is laid out straight towards it.
//!
//! Bodies with one point and no limits are turned only when asked how: by the least turn from where
//! they were. A tree whose root is free stays where the inward pass leaves it.
//!
//! # Source
//!
//! A. Aristidou, J. Lasenby, *FABRIK: A fast, iterative solver for the Inverse Kinematics problem*,
//! 2011; sections 3 and 5 (several end effectors).

use glam::{Mat3A, Quat, Vec3A};

use super::align::{Pair, align, align_within};
use super::ccd::Ccd;
use super::configuration::Configuration;
use super::problem::Problem;
use crate::kinematics::skeleton::EulerAngles;
use crate::kinematics::{normalize, rotation_between};

/// A point of a body, and what is there.
#[derive(Clone, Debug, PartialEq)]
struct Point {
    /// In the body's space, and its distance from the base.
    at: Vec3A,
    reach: f32,
    weight: f32,
    holds: Vec<Held>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Held {
    what: What,
    /// Of all goals below.
    weight: f32,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum What {
    Base(usize),
    Tip(usize),
}

#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Fabrik {
    points: Vec<Point>,
    /// For each body, its range of points.
    of_body: Vec<(usize, usize)>,
    /// For each tree, what is fixed to its root.
    grounds: Vec<Vec<Held>>,
    mounts: Vec<Quat>,
    limited: bool,
    /// With limits: what to go back to, and on with, where an iteration made nothing better.
    before: Configuration,
    ccd: Ccd,
    /// Where points are to come, and where bases ask to be.
    wanted: Vec<Vec3A>,
    asked: Vec<Vec3A>,
    /// From bases to points.
    arms: Vec<Vec3A>,
    pairs: Vec<Pair>,
}

impl Fabrik {
    pub fn new(rig: &Problem) -> Self {
        let mut fabrik = Self {
            grounds: vec![Vec::new(); rig.trees.len()],
            mounts: rig.bodies.iter().map(|body| Quat::from_mat3a(&body.mount)).collect(),
            limited: rig.bodies.iter().any(super::problem::Body::is_limited),
            ccd: Ccd::new(rig),
            asked: vec![Vec3A::ZERO; rig.bodies.len()],
            ..Self::default()
        };
        let lists = fabrik.list_points(rig);
        for points in lists {
            let from = fabrik.points.len();
            fabrik.points.extend(points);
            fabrik.of_body.push((from, fabrik.points.len()));
        }
        fabrik.wanted = vec![Vec3A::ZERO; fabrik.points.len()];
        fabrik.arms = vec![Vec3A::ZERO; fabrik.points.len()];
        fabrik.pairs.reserve(fabrik.points.len());
        fabrik
    }

    fn list_points(&mut self, rig: &Problem) -> Vec<Vec<Point>> {
        let mut lists: Vec<Vec<Point>> = vec![Vec::new(); rig.bodies.len()];
        let mut hold = |body: Option<usize>, tree: usize, at: Vec3A, held: Held| match body {
            Some(body) => hold(&mut lists[body], at, held),
            None => self.grounds[tree].push(held),
        };
        for (index, body) in rig.bodies.iter().enumerate() {
            let below = &rig.below[body.below.0..body.below.1];
            let weight = below.iter().map(|goal| rig.goals[*goal].weight).sum();
            let held = Held { what: What::Base(index), weight };
            hold(body.parent, body.tree, body.pivot, held);
        }
        for (index, goal) in rig.goals.iter().enumerate() {
            let held = Held { what: What::Tip(index), weight: goal.weight };
            hold(goal.body, goal.tree, goal.tip, held);
        }
        lists
    }

    pub fn iterate(&mut self, rig: &Problem, pose: &mut Configuration) {
        if !self.limited {
            return self.reach(rig, pose);
        }
        self.before.copy(pose);
        self.reach(rig, pose);
        if pose.cost(rig) >= self.before.cost(rig) {
            pose.copy(&self.before);
            self.ccd.iterate(rig, pose);
        }
    }

    fn reach(&mut self, rig: &Problem, pose: &mut Configuration) {
        if self.is_beyond_reach(rig, pose) {
            self.wanted.fill(rig.goals[0].point);
        } else {
            for body in (0..rig.bodies.len()).rev() {
                self.pull_in(rig, pose, body);
            }
        }
        if rig.free {
            self.move_roots(rig, pose);
        }
        for (index, body) in rig.bodies.iter().enumerate() {
            if body.parent.is_none() {
                pose.bases[index] = pose.shift[body.tree] + body.pivot;
            }
            self.lay_out(rig, pose, index);
        }
    }

    /// Whether a chain can only point at its one target.
    fn is_beyond_reach(&self, rig: &Problem, pose: &Configuration) -> bool {
        let ([goal], false, false) = (&rig.goals[..], self.limited, rig.free) else { return false };
        let bones: f32 = self.points.iter().map(|point| point.reach).sum();
        goal.body.is_some() && goal.point.distance(pose.bases[0]) >= bones
    }

    /// Where the body's base asks to be, from where its points are wanted.
    fn pull_in(&mut self, rig: &Problem, pose: &Configuration, body: usize) {
        let (from, to) = self.of_body[body];
        let base = pose.bases[body];
        let (mut sum, mut weights) = (Vec3A::ZERO, 0.0);
        for index in from..to {
            let point = &self.points[index];
            let wanted = self.wanted(rig, point);
            self.wanted[index] = wanted;
            self.arms[index] = point.place(pose) - base;
            let back = normalize(base - wanted).or_else(|| normalize(-self.arms[index]));
            sum += point.weight * (wanted + point.reach * back.unwrap_or(Vec3A::ZERO));
            weights += point.weight;
        }
        self.asked[body] = sum / weights;
    }

    /// The mean of what a point's holds ask.
    fn wanted(&self, rig: &Problem, point: &Point) -> Vec3A {
        if let [held] = point.holds[..] {
            return self.asks(rig, held.what);
        }
        let sum: Vec3A =
            point.holds.iter().map(|held| held.weight * self.asks(rig, held.what)).sum();
        sum / point.weight
    }

    fn asks(&self, rig: &Problem, what: What) -> Vec3A {
        match what {
            What::Base(body) => self.asked[body],
            What::Tip(goal) => rig.goals[goal].point,
        }
    }

    /// Each tree by the mean of what is asked of its root, as far as numbers go.
    fn move_roots(&self, rig: &Problem, pose: &mut Configuration) {
        for (tree, ground) in self.grounds.iter().enumerate() {
            let weights: f32 = ground.iter().map(|held| held.weight).sum();
            let sum: Vec3A = ground
                .iter()
                .map(|held| held.weight * (self.asks(rig, held.what) - held.what.place(pose)))
                .sum();
            let moved = pose.shift[tree] + sum / weights;
            if rig.can_go(tree, moved) {
                pose.shift[tree] = moved;
            }
            for held in ground {
                if let What::Tip(goal) = held.what {
                    pose.tips[goal] = pose.shift[tree] + rig.goals[goal].tip;
                }
            }
        }
    }

    /// The body's points from its base.
    fn lay_out(&mut self, rig: &Problem, pose: &mut Configuration, body: usize) {
        let (from, to) = self.of_body[body];
        let base = pose.bases[body];
        if self.limited || to - from > 1 {
            self.turn(rig, pose, body);
        } else if let Some(towards) = normalize(self.wanted[from] - base) {
            self.arms[from] = self.points[from].reach * towards;
        }
        for index in from..to {
            let place = base + self.arms[index];
            for held in &self.points[index].holds {
                match held.what {
                    What::Base(child) => pose.bases[child] = place,
                    What::Tip(goal) => pose.tips[goal] = place,
                }
            }
        }
    }

    /// Turns the body as a whole, so that its points come near where they are wanted.
    fn turn(&mut self, rig: &Problem, pose: &mut Configuration, index: usize) {
        // Each turn about several points is the best about one axis only; a few come near the best
        // of all.
        const TURNS: usize = 3;
        let (from, to) = self.of_body[index];
        let body = &rig.bodies[index];
        let above = body.parent.map_or(Quat::IDENTITY, |parent| pose.turned[parent]);
        let mounted = above * self.mounts[index];
        let own =
            |pose: &Configuration| Quat::from_mat3a(&EulerAngles(pose.angles[index]).matrix());
        if body.is_limited() {
            pose.turned[index] = (mounted * own(pose)).normalize();
        }
        self.pairs.clear();
        for point in from..to {
            let Point { at, weight, .. } = self.points[point];
            let arm = pose.turned[index] * at;
            self.pairs.push(Pair { arm, goal: self.wanted[point] - pose.bases[index], weight });
        }
        for _ in 0..if to - from > 1 || body.is_limited() { TURNS } else { 1 } {
            if body.is_limited() {
                let axes = Mat3A::from_quat(mounted) * EulerAngles(pose.angles[index]).axes();
                let axes = [axes.x_axis, axes.y_axis, axes.z_axis];
                align_within(&body.limits, axes, &mut pose.angles[index], &mut self.pairs);
            } else {
                let turn = align(&self.pairs);
                self.pairs.iter_mut().for_each(|pair| pair.arm = turn * pair.arm);
                pose.turned[index] = (turn * pose.turned[index]).normalize();
            }
        }
        if body.is_limited() {
            pose.turned[index] = (mounted * own(pose)).normalize();
        }
        for point in from..to {
            self.arms[point] = pose.turned[index] * self.points[point].at;
        }
    }

    /// How bodies are turned that were only moved: by the least turn from how they were.
    pub fn settle(&self, pose: &Configuration) -> Vec<Quat> {
        let mut turned = pose.turned.clone();
        if self.limited {
            return turned;
        }
        for (body, (from, to)) in self.of_body.iter().enumerate() {
            if let [point] = &self.points[*from..*to] {
                let arm = point.place(pose) - pose.bases[body];
                turned[body] =
                    (rotation_between(turned[body] * point.at, arm) * turned[body]).normalize();
            }
        }
        turned
    }
}

fn hold(points: &mut Vec<Point>, at: Vec3A, held: Held) {
    match points.iter_mut().find(|point| point.at == at) {
        Some(point) => {
            point.weight += held.weight;
            point.holds.push(held);
        }
        None => {
            let holds = vec![held];
            points.push(Point { at, reach: at.length(), weight: held.weight, holds });
        }
    }
}

impl Point {
    /// Where it is now.
    fn place(&self, pose: &Configuration) -> Vec3A {
        self.holds[0].what.place(pose)
    }
}

impl What {
    fn place(self, pose: &Configuration) -> Vec3A {
        match self {
            Self::Base(body) => pose.bases[body],
            Self::Tip(goal) => pose.tips[goal],
        }
    }
}
