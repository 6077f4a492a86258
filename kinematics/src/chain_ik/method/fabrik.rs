//! Forward and backward reaching: points move towards their destinations, first from the targets to
//! the roots (inward), then back (outward). Each point keeps its distance r from its link's joint,
//! the base.
//!
//! ```text
//! inward    base' = q + r · unit(base − q)         q, the destination: the target, or the child's base'
//! outward   point = base + r · unit(q − base)      base: of the root, then the parent's point
//! ```
//!
//! The destination of a point that several children share is the weighted mean of the destinations
//! of the children's bases. A link with several points takes the mean of the positions base' that
//! its points give. [`LinkPoints`] makes the outward pass.
//!
//! The inward pass ignores limits and may set destinations that the limits forbid, so that the
//! points oscillate or creep along a limit; [`SweepAfterPasses`] goes on from there. The straight
//! leg of the example figure reaches 1000 of 1000 targets in this way; with a sweep only where the
//! cost is not lowered, it reaches 992.
//!
//! A chain whose only target is out of reach is laid out straight towards the target. A tree whose
//! root is free moves to where the inward pass brings its root.
//!
//! # Source
//!
//! A. Aristidou, J. Lasenby, *FABRIK: A fast, iterative solver for the Inverse Kinematics problem*,
//! 2011; sections 3 and 5 (several end effectors).

use glam::Vec3A;

use super::ccd::SweepAfterPasses;
use super::link_points::LinkPoints;
use crate::chain_ik::configuration::Configuration;
use crate::chain_ik::inside::{Event, Recorder};
use crate::chain_ik::problem::Problem;
use crate::normalize;

#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::chain_ik) struct Fabrik {
    points: LinkPoints,
    sweep: SweepAfterPasses,
}

impl Fabrik {
    pub fn new(problem: &Problem) -> Self {
        Self { points: LinkPoints::new(problem), sweep: SweepAfterPasses::new(problem) }
    }

    pub fn points(&self) -> &LinkPoints {
        &self.points
    }

    /// Makes the passes and returns `true`.
    pub fn iterate(
        &mut self,
        problem: &Problem,
        config: &mut Configuration,
        recorder: &mut Recorder,
    ) -> bool {
        if self.points.are_limited() {
            self.sweep.start(config);
            self.reach(problem, config, recorder);
            self.sweep.finish(problem, config, recorder);
        } else {
            self.reach(problem, config, recorder);
        }
        true
    }

    /// Makes the inward and the outward pass.
    fn reach(&mut self, problem: &Problem, config: &mut Configuration, recorder: &mut Recorder) {
        if self.points.is_out_of_reach(problem, config) {
            self.points.destinations.fill(problem.effectors[0].target);
        } else {
            for link in (0..problem.links.len()).rev() {
                self.reach_inward(problem, config, link);
            }
            recorder.record(config, || Event::Backward(self.points.destination_segments()));
        }
        self.points.lay_out(problem, config);
        recorder.record(config, || Event::Forward(self.points.segments(config)));
    }

    /// Sets the destinations of a link's points and, from these, the destination of its joint.
    fn reach_inward(&mut self, problem: &Problem, config: &Configuration, link: usize) {
        let base = config.bases[link];
        let (mut sum, mut weights) = (Vec3A::ZERO, 0.0);
        for index in self.points.of_link(link) {
            let destination = self.points.destination_of(problem, index);
            self.points.destinations[index] = destination;
            let arm = self.points.posed_arm(config, link, index);
            self.points.arms[index] = arm;
            let back = normalize(base - destination).or_else(|| normalize(-arm));
            let point = self.points.point(index);
            sum += point.weight * (destination + point.radius * back.unwrap_or(Vec3A::ZERO));
            weights += point.weight;
        }
        self.points.base_destinations[link] = sum / weights;
    }
}
