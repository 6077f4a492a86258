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
//! of the children's bases. A link with several points (a bone with children away from its tip, or a
//! locked fork) takes the mean of the positions base' that its points give, and rotates as a whole,
//! to the best fit.
//!
//! If any link has limits, every link rotates as a whole on the outward pass, and limited links
//! angle by angle within their limits. The inward pass ignores limits and may set destinations that
//! the limits forbid, so that the points oscillate or creep along a limit. Therefore passes that do
//! not halve the cost are followed by a sweep of cyclic coordinate descent, and passes that do not
//! lower it are undone before the sweep. The straight leg of the example figure reaches 1000 of 1000
//! targets in this way; with a sweep only where the cost is not lowered, it reaches 992.
//!
//! A chain whose only target is out of reach is laid out straight towards the target.
//!
//! Orientations of links with one point and no limits are computed on demand, by the smallest
//! rotation. A tree whose root is free moves to where the inward pass brings its root.
//!
//! # Source
//!
//! A. Aristidou, J. Lasenby, *FABRIK: A fast, iterative solver for the Inverse Kinematics problem*,
//! 2011; sections 3 and 5 (several end effectors).

use glam::{Mat3A, Quat, Vec3A};

use super::align::{PointPair, align, align_within};
use super::ccd::Ccd;
use super::configuration::Configuration;
use super::inside::{Event, LinkSegment, Recorder};
use super::problem::{Link, Problem};
use crate::skeleton::JointAngles;
use crate::{normalize, rotation_between};

/// A point fixed to a link, with the child joints and tips that are at this point.
#[derive(Clone, Debug, PartialEq)]
struct LinkPoint {
    /// Position in the link's space.
    position: Vec3A,
    /// Distance from the link's joint.
    radius: f32,
    /// Sum of the weights of `members`.
    weight: f32,
    members: Vec<PointMember>,
}

/// A child joint or a tip at a point of a link.
#[derive(Clone, Copy, Debug, PartialEq)]
struct PointMember {
    kind: MemberKind,
    /// Sum of the weights of the tip, or of all end effectors at the child joint and below.
    weight: f32,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum MemberKind {
    /// Joint of the link with this index.
    Base(usize),
    /// Tip of the end effector with this index.
    Tip(usize),
}

#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Fabrik {
    points: Vec<LinkPoint>,
    /// Range of each link's points in `points`.
    ranges: Vec<(usize, usize)>,
    /// Joints and tips that are fixed to the root, for each tree.
    grounds: Vec<Vec<PointMember>>,
    mounts: Vec<Quat>,
    limited: bool,
    /// The configuration before the iteration; used if any link has limits.
    before: Configuration,
    /// The sweep after passes that did not lower the cost enough; used if any link has limits.
    ccd: Ccd,
    /// Goal of each point.
    destinations: Vec<Vec3A>,
    /// Goal of each link's joint.
    base_destinations: Vec<Vec3A>,
    /// Vector to each point from the joint of the point's link.
    arms: Vec<Vec3A>,
    pairs: Vec<PointPair>,
}

impl Fabrik {
    pub fn new(problem: &Problem) -> Self {
        let mut fabrik = Self {
            grounds: vec![Vec::new(); problem.trees.len()],
            mounts: problem.links.iter().map(|link| Quat::from_mat3a(&link.mount)).collect(),
            limited: problem.links.iter().any(Link::is_limited),
            ccd: Ccd::new(problem),
            base_destinations: vec![Vec3A::ZERO; problem.links.len()],
            ..Self::default()
        };
        let lists = fabrik.list_points(problem);
        for points in lists {
            let from = fabrik.points.len();
            fabrik.points.extend(points);
            fabrik.ranges.push((from, fabrik.points.len()));
        }
        fabrik.destinations = vec![Vec3A::ZERO; fabrik.points.len()];
        fabrik.arms = vec![Vec3A::ZERO; fabrik.points.len()];
        fabrik.pairs.reserve(fabrik.points.len());
        fabrik
    }

    fn list_points(&mut self, problem: &Problem) -> Vec<Vec<LinkPoint>> {
        let mut lists: Vec<Vec<LinkPoint>> = vec![Vec::new(); problem.links.len()];
        let mut add =
            |link: Option<usize>, tree: usize, position: Vec3A, member: PointMember| match link {
                Some(link) => add_member(&mut lists[link], position, member),
                None => self.grounds[tree].push(member),
            };
        for (index, link) in problem.links.iter().enumerate() {
            let weights =
                problem.below(link).iter().map(|effector| problem.effectors[*effector].weight);
            let member = PointMember { kind: MemberKind::Base(index), weight: weights.sum() };
            add(link.parent, link.tree, link.pivot, member);
        }
        for (index, effector) in problem.effectors.iter().enumerate() {
            let member = PointMember { kind: MemberKind::Tip(index), weight: effector.weight };
            add(effector.link, effector.tree, effector.tip, member);
        }
        lists
    }

    pub fn iterate(
        &mut self,
        problem: &Problem,
        config: &mut Configuration,
        recorder: &mut Recorder,
    ) {
        if !self.limited {
            return self.reach(problem, config, recorder);
        }
        // Fraction of the cost that passes may leave without a sweep.
        const ENOUGH: f64 = 0.5;
        self.before.copy_from(config);
        self.reach(problem, config, recorder);
        let left = config.cost(problem) / self.before.cost(problem);
        if left <= ENOUGH {
            return;
        }
        if left >= 1.0 {
            config.copy_from(&self.before);
            recorder.record(config, || Event::Undo);
        }
        self.ccd.iterate(problem, config, recorder);
    }

    /// Makes the inward and the outward pass.
    fn reach(&mut self, problem: &Problem, config: &mut Configuration, recorder: &mut Recorder) {
        if self.is_out_of_reach(problem, config) {
            self.destinations.fill(problem.effectors[0].target);
        } else {
            for link in (0..problem.links.len()).rev() {
                self.reach_inward(problem, config, link);
            }
            recorder.record(config, || Event::Backward(self.inward_chain()));
        }
        if problem.free_roots {
            self.move_roots(problem, config);
        }
        for (index, link) in problem.links.iter().enumerate() {
            if link.parent.is_none() {
                config.bases[index] = config.shifts[link.tree] + link.pivot;
            }
            self.reach_outward(problem, config, index);
        }
        recorder.record(config, || Event::Forward(self.outward_chain(config)));
    }

    /// Each link as the pairs of its joint and its points after the inward pass.
    fn inward_chain(&self) -> Vec<LinkSegment> {
        let links = self.ranges.iter().zip(&self.base_destinations).enumerate();
        let segments = |(link, (range, base)): (usize, (&(usize, usize), &Vec3A))| {
            let base = *base;
            let points = &self.destinations[range.0..range.1];
            points.iter().map(move |point| LinkSegment { link, ends: [base, *point] })
        };
        links.flat_map(segments).collect()
    }

    /// Each link as the pairs of its joint and its points.
    fn outward_chain(&self, config: &Configuration) -> Vec<LinkSegment> {
        let links = self.ranges.iter().zip(&config.bases).enumerate();
        let segments = |(link, (range, base)): (usize, (&(usize, usize), &Vec3A))| {
            let ends = |point: &LinkPoint| [*base, point.position_in(config)];
            let points = self.points[range.0..range.1].iter();
            points.map(|point| LinkSegment { link, ends: ends(point) }).collect::<Vec<_>>()
        };
        links.flat_map(segments).collect()
    }

    /// Whether the problem is a chain without limits, with a fixed root, whose one target is out of
    /// reach.
    fn is_out_of_reach(&self, problem: &Problem, config: &Configuration) -> bool {
        let ([effector], false, false) = (&problem.effectors[..], self.limited, problem.free_roots)
        else {
            return false;
        };
        let length: f32 = self.points.iter().map(|point| point.radius).sum();
        effector.link.is_some() && effector.target.distance(config.bases[0]) >= length
    }

    /// Sets the destinations of a link's points and, from these, the destination of its joint.
    fn reach_inward(&mut self, problem: &Problem, config: &Configuration, link: usize) {
        let (from, to) = self.ranges[link];
        let base = config.bases[link];
        let (mut sum, mut weights) = (Vec3A::ZERO, 0.0);
        for index in from..to {
            let point = &self.points[index];
            let destination = self.destination_of(problem, point);
            self.destinations[index] = destination;
            self.arms[index] = point.position_in(config) - base;
            let back = normalize(base - destination).or_else(|| normalize(-self.arms[index]));
            sum += point.weight * (destination + point.radius * back.unwrap_or(Vec3A::ZERO));
            weights += point.weight;
        }
        self.base_destinations[link] = sum / weights;
    }

    /// Weighted mean of the destinations of a point's members.
    fn destination_of(&self, problem: &Problem, point: &LinkPoint) -> Vec3A {
        if let [member] = point.members[..] {
            return self.member_destination(problem, member.kind);
        }
        let destinations = point.members.iter();
        let sum: Vec3A = destinations
            .map(|member| member.weight * self.member_destination(problem, member.kind))
            .sum();
        sum / point.weight
    }

    fn member_destination(&self, problem: &Problem, member: MemberKind) -> Vec3A {
        match member {
            MemberKind::Base(link) => self.base_destinations[link],
            MemberKind::Tip(effector) => problem.effectors[effector].target,
        }
    }

    /// Shifts each tree by the weighted mean vector from the joints and tips fixed to its root to
    /// their destinations, unless that overflows.
    fn move_roots(&self, problem: &Problem, config: &mut Configuration) {
        for (tree, ground) in self.grounds.iter().enumerate() {
            let weights: f32 = ground.iter().map(|member| member.weight).sum();
            let residual = |member: &PointMember| {
                self.member_destination(problem, member.kind) - member.kind.position_in(config)
            };
            let sum: Vec3A = ground.iter().map(|member| member.weight * residual(member)).sum();
            let shift = config.shifts[tree] + sum / weights;
            if problem.can_shift(tree, shift) {
                config.shifts[tree] = shift;
            }
            for member in ground {
                if let MemberKind::Tip(effector) = member.kind {
                    config.tips[effector] = config.shifts[tree] + problem.effectors[effector].tip;
                }
            }
        }
    }

    /// Moves the points of a link towards their destinations, at their distances from the link's joint.
    fn reach_outward(&mut self, problem: &Problem, config: &mut Configuration, link: usize) {
        let (from, to) = self.ranges[link];
        let base = config.bases[link];
        if self.limited || to - from > 1 {
            self.rotate(problem, config, link);
        } else if let Some(towards) = normalize(self.destinations[from] - base) {
            self.arms[from] = self.points[from].radius * towards;
        }
        for index in from..to {
            let position = base + self.arms[index];
            for member in &self.points[index].members {
                match member.kind {
                    MemberKind::Base(child) => config.bases[child] = position,
                    MemberKind::Tip(effector) => config.tips[effector] = position,
                }
            }
        }
    }

    /// Rotates a link as a whole, so that its points come near their destinations.
    fn rotate(&mut self, problem: &Problem, config: &mut Configuration, index: usize) {
        // For several points, one rotation is the best about one axis only; a few rotations come
        // near the best of all.
        const ROTATIONS: usize = 3;
        let (from, to) = self.ranges[index];
        let link = &problem.links[index];
        let parent = link.parent.map_or(Quat::IDENTITY, |parent| config.orientations[parent]);
        let mounted = parent * self.mounts[index];
        let own =
            |config: &Configuration| Quat::from_mat3a(&JointAngles(config.angles[index]).matrix());
        if link.is_limited() {
            config.orientations[index] = (mounted * own(config)).normalize();
        }
        self.pairs.clear();
        for point in from..to {
            let LinkPoint { position, weight, .. } = self.points[point];
            self.pairs.push(PointPair {
                from: config.orientations[index] * position,
                to: self.destinations[point] - config.bases[index],
                weight,
            });
        }
        for _ in 0..if to - from > 1 || link.is_limited() { ROTATIONS } else { 1 } {
            if link.is_limited() {
                let axes = Mat3A::from_quat(mounted) * JointAngles(config.angles[index]).axes();
                let axes = [axes.x_axis, axes.y_axis, axes.z_axis];
                align_within(&link.limits, axes, &mut config.angles[index], &mut self.pairs);
            } else {
                let rotation = align(&self.pairs);
                self.pairs.iter_mut().for_each(|pair| pair.from = rotation * pair.from);
                config.orientations[index] = (rotation * config.orientations[index]).normalize();
            }
        }
        if link.is_limited() {
            config.orientations[index] = (mounted * own(config)).normalize();
        }
        for point in from..to {
            self.arms[point] = config.orientations[index] * self.points[point].position;
        }
    }

    /// Updates the orientations of links with one point, which iterations move only: turns each, by
    /// the smallest angle, until the link points at its point.
    pub fn update_orientations(&self, config: &mut Configuration) {
        if self.limited {
            return;
        }
        for (link, (from, to)) in self.ranges.iter().enumerate() {
            if let [point] = &self.points[*from..*to] {
                let arm = point.position_in(config) - config.bases[link];
                let orientation = &mut config.orientations[link];
                let rotation = rotation_between(*orientation * point.position, arm);
                *orientation = (rotation * *orientation).normalize();
            }
        }
    }
}

fn add_member(points: &mut Vec<LinkPoint>, position: Vec3A, member: PointMember) {
    match points.iter_mut().find(|point| point.position == position) {
        Some(point) => {
            point.weight += member.weight;
            point.members.push(member);
        }
        None => points.push(LinkPoint {
            position,
            radius: position.length(),
            weight: member.weight,
            members: vec![member],
        }),
    }
}

impl LinkPoint {
    /// Position in problem space.
    fn position_in(&self, config: &Configuration) -> Vec3A {
        self.members[0].kind.position_in(config)
    }
}

impl MemberKind {
    /// Position in problem space.
    fn position_in(self, config: &Configuration) -> Vec3A {
        match self {
            Self::Base(link) => config.bases[link],
            Self::Tip(effector) => config.tips[effector],
        }
    }
}
