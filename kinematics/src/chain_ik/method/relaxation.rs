//! Constraint relaxation: joints are points that bones hold at a distance. One pass restores the
//! length r of each bone in turn, from the targets to the roots, by moving both ends of the bone;
//! this stretches or shortens the bones beside it, so that all lengths hold only once the passes
//! have settled.
//!
//! ```text
//! v = end − base,   e = v · (1 − r/|v|)
//! base' = base + e · w_base/(w_base + w_end)       end' = end − e · w_end/(w_base + w_end)
//! ```
//!
//! All joints have the same weight w, fixed roots and targets have the weight 0: the last bone
//! moves its joint alone, so that its tip is at the target, and the first bone its end alone.
//! Points stay where a pass has moved them; the next pass goes on from there. After each pass the
//! links are laid out from the roots towards the points: that is the pose.
//!
//! A point that several children share moves to the weighted mean of where their bones bring it. A
//! link with several points is restored as a whole, at the rotation that fits them best.
//!
//! If any link has limits, each pass starts from the pose, and a sweep of CCD goes on where it does
//! not help, as with FABRIK.
//!
//! # Source
//!
//! R. Juckett, *Constraint Relaxation IK in 2D*, 2009.

use glam::Vec3A;

use super::points::{InwardPass, LinkPoints, PointMethod};
use crate::chain_ik::align::{PointPair, ROTATIONS, align};
use crate::chain_ik::configuration::Configuration;
use crate::chain_ik::inside::{Event, LinkSegment};
use crate::chain_ik::problem::Problem;
use crate::normalize;

/// The destinations are the points as the last pass left them.
pub(in crate::chain_ik) type Relaxation = PointMethod<RestoreLengths>;

/// The pass that restores the length of each bone.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::chain_ik) struct RestoreLengths {
    pairs: Vec<PointPair>,
    /// True if the next pass goes on from the points of the last one, not from the pose.
    goes_on: bool,
}

impl InwardPass for RestoreLengths {
    const EVENTS: [fn(Vec<LinkSegment>) -> Event; 2] = [Event::Relaxed, Event::LaidOut];

    fn new(points: &LinkPoints) -> Self {
        Self { pairs: Vec::with_capacity(points.len()), goes_on: false }
    }

    fn run(&mut self, points: &mut LinkPoints, problem: &Problem, config: &Configuration) {
        self.start_pass(points, problem, config);
        for link in (0..problem.links.len()).rev() {
            self.restore(points, problem, config, link);
        }
        self.goes_on = !points.turns_whole(problem);
    }
}

impl RestoreLengths {
    /// Makes the next pass start from the pose. Returns whether it would not have.
    pub fn restart(&mut self) -> bool {
        std::mem::take(&mut self.goes_on)
    }

    /// Takes the joints from the pose: all of them, or those at fixed roots only.
    fn start_pass(&self, points: &mut LinkPoints, problem: &Problem, config: &Configuration) {
        for link in 0..problem.links.len() {
            if !self.goes_on || is_fixed(problem, link) {
                points.base_destinations[link] = config.bases[link];
            }
        }
    }

    /// Restores the distances of a link's points from its joint.
    fn restore(
        &mut self,
        points: &mut LinkPoints,
        problem: &Problem,
        config: &Configuration,
        link: usize,
    ) {
        let base = points.base_destinations[link];
        self.aim(points, problem, config, link);
        let is_fixed = is_fixed(problem, link);
        let (mut sum, mut weights) = (Vec3A::ZERO, 0.0);
        for index in points.of_link(link) {
            let error = points.destinations[index] - (base + points.arms[index]);
            // Joints have even weights; fixed roots and targets have the weight 0.
            let fraction = match (is_fixed, points.point(index).is_target()) {
                (true, _) => 0.0,
                (false, true) => 1.0,
                (false, false) => 0.5,
            };
            let weight = points.point(index).weight;
            sum += weight * fraction * error;
            weights += weight;
        }
        let base = base + sum / weights;
        points.base_destinations[link] = base;
        for index in points.of_link(link) {
            if !points.point(index).is_target() {
                points.move_point(index, base + points.arms[index]);
            }
        }
    }

    /// Points a link from its joint at its points: sets their destinations and the vectors to where
    /// the link has them.
    fn aim(
        &mut self,
        points: &mut LinkPoints,
        problem: &Problem,
        config: &Configuration,
        link: usize,
    ) {
        let base = points.base_destinations[link];
        self.pairs.clear();
        for index in points.of_link(link) {
            let destination = points.destination_of(problem, config, index);
            points.destinations[index] = destination;
            self.pairs.push(PointPair {
                from: points.posed_arm(config, link, index),
                to: destination - base,
                weight: points.point(index).weight,
            });
        }
        if let [pair] = self.pairs[..] {
            let index = points.of_link(link).start;
            let along = normalize(pair.to).or_else(|| normalize(pair.from));
            points.arms[index] = points.point(index).radius * along.unwrap_or(Vec3A::ZERO);
            return;
        }
        for _ in 0..ROTATIONS {
            let rotation = align(&self.pairs);
            self.pairs.iter_mut().for_each(|pair| pair.from = rotation * pair.from);
        }
        for (index, pair) in points.of_link(link).zip(&self.pairs) {
            points.arms[index] = pair.from;
        }
    }
}

/// True if the joint of a link is fixed to a root that cannot move.
fn is_fixed(problem: &Problem, link: usize) -> bool {
    problem.links[link].parent.is_none() && !problem.free_roots
}
