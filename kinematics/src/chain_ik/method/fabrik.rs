//! Forward and backward reaching: points move towards their destinations, first from the targets to
//! the roots (inward), then back (outward). Each point keeps its distance r from its link's joint,
//! the base.
//!
//! ```text
//! inward    base' = q + r · unit(base − q)         q, the destination: the target, or the child's base'
//! outward   point = base + r · unit(q − base)      base: of the root, then the parent's point
//! ```
//!
//! A link with a wanted rotation R has base' = q − R · position instead, and keeps R outward.
//!
//! The destination of a point that several children share is the weighted mean of the destinations
//! of the children's bases. A link with several points takes the mean of the positions base' that
//! its points give. The links are laid out as [`points`](super::points) says.
//!
//! The inward pass ignores limits and may set destinations that the limits forbid, so that the
//! points oscillate or creep along a limit; a sweep of CCD goes on from there. The straight leg of
//! the example figure reaches 1000 of 1000 targets in this way; with a sweep only where the cost is
//! not lowered, it reaches 992.
//!
//! A tree whose root is free moves to where the inward pass brings its root.
//!
//! # Source
//!
//! A. Aristidou, J. Lasenby, *FABRIK: A fast, iterative solver for the Inverse Kinematics problem*,
//! 2011; sections 3 and 5 (several end effectors).

use glam::Vec3A;

use super::points::{InwardPass, LinkPoints, PointMethod};
use crate::chain_ik::configuration::Configuration;
use crate::chain_ik::inside::{Event, LinkSegment};
use crate::chain_ik::problem::Problem;
use crate::normalize;

pub(in crate::chain_ik) type Fabrik = PointMethod<ReachInward>;

/// The inward pass.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::chain_ik) struct ReachInward;

impl InwardPass for ReachInward {
    const EVENTS: [fn(Vec<LinkSegment>) -> Event; 2] = [Event::Backward, Event::Forward];

    fn new(_: &LinkPoints) -> Self {
        Self
    }

    fn run(&mut self, points: &mut LinkPoints, problem: &Problem, config: &Configuration) {
        for link in (0..problem.links.len()).rev() {
            reach(points, problem, config, link);
        }
    }
}

/// Sets the destinations of a link's points and, from these, the destination of its joint.
fn reach(points: &mut LinkPoints, problem: &Problem, config: &Configuration, link: usize) {
    let base = config.bases[link];
    let (mut sum, mut weights) = (Vec3A::ZERO, 0.0);
    for index in points.of_link(link) {
        let destination = points.destination_of(problem, config, index);
        points.destinations[index] = destination;
        let arm = points.posed_arm(config, link, index);
        points.arms[index] = arm;
        let point = points.point(index);
        let to_base = match points.wanted(link) {
            Some(wanted) => wanted * -point.position,
            None => {
                let back = normalize(base - destination).or_else(|| normalize(-arm));
                point.radius * back.unwrap_or(Vec3A::ZERO)
            }
        };
        sum += point.weight * (destination + to_base);
        weights += point.weight;
    }
    points.base_destinations[link] = sum / weights;
}
