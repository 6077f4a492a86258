//! Methods that move points of links instead of angles: FABRIK and relaxation.
//!
//! A pass from the targets to the roots sets a destination for each point ([`InwardPass`]); then
//! the links are laid out from the roots: each link keeps the distance of its points from its joint
//! and points at their destinations. A link with several points (a bone with children away from its
//! tip, or a locked fork) rotates as a whole, to the best fit. If any link has limits, stiffness or a
//! wanted rotation, every link rotates as a whole, and limited links angle by angle within their
//! limits. A link with a wanted rotation has it in both passes, so that its joint has a place, too,
//! where the links above it bring it; a weight w of the rotation below 1, of the greatest weight,
//! lays the link out on the part w of the way from its rotation before.
//!
//! Orientations of links with one point and no limits are computed on demand, by the smallest
//! rotation.
//!
//! A chain without limits and stiffness whose only target is out of reach is laid out straight
//! towards the target. The inward pass ignores limits. If links rotate as a whole for one of these
//! reasons, a sweep of CCD follows where the passes do not halve the cost, after passes that do not
//! lower it are undone. A link with the stiffness k makes the part 1 − k of its turn from its
//! rotation relative to its parent before the pass.

use core::ops::Range;

use glam::{Mat3A, Quat, Vec3, Vec3A};

use super::ccd::Ccd;
use crate::chain_ik::align::{PointPair, ROTATIONS, align, align_within};
use crate::chain_ik::configuration::Configuration;
use crate::chain_ik::inside::{Event, LinkSegment, Recorder};
use crate::chain_ik::problem::{Link, Orienting, Problem, Wanted};
use crate::skeleton::JointAngles;
use crate::{normalize, rotation_between};

/// The pass from the targets to the roots.
pub(in crate::chain_ik) trait InwardPass {
    /// The records of this pass and of the one back from the roots.
    const EVENTS: [fn(Vec<LinkSegment>) -> Event; 2];

    fn new(points: &LinkPoints) -> Self;

    /// Sets the destinations of all points.
    fn run(&mut self, points: &mut LinkPoints, problem: &Problem, config: &Configuration);
}

/// A method that moves points by an inward pass of its own.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::chain_ik) struct PointMethod<P> {
    pub inward: P,
    points: LinkPoints,
    /// The configuration before the passes.
    before: Configuration,
    sweep: Ccd,
}

impl<P: InwardPass> PointMethod<P> {
    pub fn new(problem: &Problem) -> Self {
        let points = LinkPoints::new(problem);
        let (inward, sweep) = (P::new(&points), Ccd::new(problem));
        Self { inward, points, before: Configuration::default(), sweep }
    }

    /// Fits the points and the sweep to other lengths and mounts.
    pub fn refit(&mut self, problem: &Problem) {
        self.points.refit(problem);
        self.sweep.refit(problem);
    }

    /// Makes the passes, and a sweep of CCD if they need one; returns `true`.
    pub fn iterate(
        &mut self,
        problem: &Problem,
        config: &mut Configuration,
        recorder: &mut Recorder,
    ) -> bool {
        // Fraction of the cost that passes may leave without a sweep.
        const ENOUGH: f64 = 0.5;
        if !self.points.turns_whole(problem) {
            self.pass(problem, config, recorder);
            return true;
        }
        self.points.want_rotations(problem, config);
        self.before.copy_from(config);
        self.pass(problem, config, recorder);
        let left = config.cost(problem) / self.before.cost(problem);
        if left <= ENOUGH {
            return true;
        }
        if left >= 1.0 {
            config.copy_from(&self.before);
            recorder.record(config, || Event::Undo);
        }
        self.sweep.iterate(problem, config, recorder)
    }

    /// Makes the inward pass and lays the links out.
    fn pass(&mut self, problem: &Problem, config: &mut Configuration, recorder: &mut Recorder) {
        let [inward, outward] = P::EVENTS;
        if self.points.is_out_of_reach(problem, config) {
            self.points.destinations.fill(problem.effectors[0].target);
        } else {
            self.inward.run(&mut self.points, problem, config);
            recorder.record(config, || inward(self.points.destination_segments()));
        }
        self.points.lay_out(problem, config);
        recorder.record(config, || outward(self.points.segments(config)));
    }

    /// Updates orientations that the passes leave behind the points that they move.
    pub fn update_orientations(&self, config: &mut Configuration) {
        self.points.update_orientations(config);
    }
}

/// A point fixed to a link, with the child joints and tips that are at this point.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::chain_ik) struct LinkPoint {
    /// Position in the link's space.
    pub position: Vec3A,
    /// Distance from the link's joint.
    pub radius: f32,
    /// Sum of the weights of `members`.
    pub weight: f32,
    pub members: Vec<PointMember>,
}

/// A child joint or a tip at a point of a link.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::chain_ik) struct PointMember {
    pub kind: MemberKind,
    /// Sum of the weights of the tip, or of all end effectors at the child joint and below.
    pub weight: f32,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::chain_ik) enum MemberKind {
    /// Joint of the link with this index.
    Base(usize),
    /// Tip of the end effector with this index.
    Tip(usize),
}

/// Points of all links, with their destinations.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::chain_ik) struct LinkPoints {
    all: Vec<LinkPoint>,
    /// Range of each link's points in `all`.
    ranges: Vec<(usize, usize)>,
    /// Joints and tips that are fixed to the root, for each tree.
    grounds: Vec<Vec<PointMember>>,
    mounts: Vec<Quat>,
    /// True if any link has limits, stiffness or a wanted rotation, so that each link rotates as a
    /// whole.
    turn_whole: bool,
    /// Orientation G that each link with a wanted rotation has in both passes, and the weight of
    /// the rotation, 0 for links without; empty if no rotation is wanted.
    wanted: Vec<(Quat, f32)>,
    /// Rotation E of each stiff link before a pass.
    locals: Vec<Quat>,
    /// Destination of each point.
    pub destinations: Vec<Vec3A>,
    /// Destination of each link's joint.
    pub base_destinations: Vec<Vec3A>,
    /// Vector to each point from the joint of the point's link: as a pass leaves it, then as the
    /// link is laid out. A link keeps it whose point has no other direction.
    pub arms: Vec<Vec3A>,
    pairs: Vec<PointPair>,
}

impl LinkPoints {
    pub fn new(problem: &Problem) -> Self {
        let mut points = Self {
            grounds: vec![Vec::new(); problem.trees.len()],
            mounts: problem.mounts().collect(),
            turn_whole: Self::must_turn_whole(problem),
            locals: vec![Quat::IDENTITY; problem.links.len()],
            base_destinations: vec![Vec3A::ZERO; problem.links.len()],
            ..Self::default()
        };
        for list in points.list(problem) {
            let from = points.all.len();
            points.all.extend(list);
            points.ranges.push((from, points.all.len()));
        }
        points.destinations = vec![Vec3A::ZERO; points.all.len()];
        points.arms = vec![Vec3A::ZERO; points.all.len()];
        points.pairs.reserve(points.all.len());
        points
    }

    /// Fits the points to other lengths, weights, mounts and limits. Allocates only if joints or
    /// tips come to share a point, or share one no longer.
    fn refit(&mut self, problem: &Problem) {
        let weight = |member: MemberKind| match member {
            MemberKind::Base(link) => {
                let below = problem.below(&problem.links[link]).iter();
                below.map(|effector| problem.effectors[*effector].weight).sum()
            }
            MemberKind::Tip(effector) => problem.effectors[effector].weight,
        };
        let refit = |member: &mut PointMember| member.weight = weight(member.kind);
        for point in &mut self.all {
            point.members.iter_mut().for_each(refit);
            point.position = point.members[0].kind.position_in_link(problem);
            point.radius = point.position.length();
            point.weight = point.members.iter().map(|member| member.weight).sum();
        }
        self.grounds.iter_mut().flatten().for_each(refit);
        if !self.are_points_apart(problem) {
            *self = Self::new(problem);
            return;
        }
        self.turn_whole = Self::must_turn_whole(problem);
        self.mounts.clear();
        self.mounts.extend(problem.mounts());
    }

    /// True if the members of each point are where it is, and those of other points are not.
    fn are_points_apart(&self, problem: &Problem) -> bool {
        let is_at = |point: &LinkPoint, member: &PointMember| {
            member.kind.position_in_link(problem) == point.position
        };
        self.all.iter().all(|point| point.members.iter().all(|member| is_at(point, member)))
            && self.ranges.iter().all(|(from, to)| {
                let points = &self.all[*from..*to];
                let others = |index: usize| points[..index].iter();
                (0..points.len())
                    .all(|index| others(index).all(|it| it.position != points[index].position))
            })
    }

    fn list(&mut self, problem: &Problem) -> Vec<Vec<LinkPoint>> {
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

    fn must_turn_whole(problem: &Problem) -> bool {
        let is_special = |link: &Link| link.limits.is_limited() || link.is_stiff();
        problem.orients || problem.links.iter().any(is_special)
    }

    /// True if links rotate as a whole, so that a pass starts from the pose.
    pub fn turns_whole(&self, problem: &Problem) -> bool {
        // Targets may ask for rotations that did not when the points were made.
        self.turn_whole || problem.orients
    }

    /// Sets the orientations of the links with wanted rotations. Of several rotations of a link, the
    /// weighted mean counts.
    fn want_rotations(&mut self, problem: &Problem, config: &mut Configuration) {
        self.wanted.clear();
        if !problem.orients {
            return;
        }
        self.update_orientations(config);
        self.wanted.resize(problem.links.len(), (Quat::IDENTITY, 0.0));
        for effector in &problem.effectors {
            let (Some(link), Some(orienting)) = (effector.link, effector.orientation) else {
                continue;
            };
            let Orienting { wanted: Wanted::Rotation(wanted), .. } = orienting else { continue };
            let weight = problem.weight_of(&orienting);
            let (mean, weights) = &mut self.wanted[link];
            *weights += weight;
            *mean = mean.slerp(wanted, if *weights > 0.0 { weight / *weights } else { 0.0 });
        }
        for ((wanted, weight), own) in self.wanted.iter_mut().zip(&config.orientations) {
            *wanted = own.slerp(*wanted, weight.min(1.0));
        }
    }

    /// The orientation that a link with a wanted rotation has in a pass.
    pub fn wanted(&self, link: usize) -> Option<Quat> {
        let wanted = self.wanted.get(link).filter(|(_, weight)| *weight > 0.0);
        wanted.map(|(orientation, _)| *orientation)
    }

    /// Number of points of all links.
    pub fn len(&self) -> usize {
        self.all.len()
    }

    /// Indices of the points of a link.
    pub fn of_link(&self, link: usize) -> Range<usize> {
        let (from, to) = self.ranges[link];
        from..to
    }

    pub fn point(&self, index: usize) -> &LinkPoint {
        &self.all[index]
    }

    /// Vector from a link's joint to one of its points in a pose.
    pub fn posed_arm(&self, config: &Configuration, link: usize, index: usize) -> Vec3A {
        self.all[index].position_in(config) - config.bases[link]
    }

    /// True if the problem is a chain without limits, with a fixed root, whose one target is out of
    /// reach.
    fn is_out_of_reach(&self, problem: &Problem, config: &Configuration) -> bool {
        let ([effector], false, false) =
            (&problem.effectors[..], self.turns_whole(problem), problem.free_roots)
        else {
            return false;
        };
        let length: f32 = self.all.iter().map(|point| point.radius).sum();
        effector.link.is_some()
            && !effector.has_shell()
            && effector.target.distance(config.bases[0]) >= length
    }

    /// Weighted mean of the destinations of a point's members.
    pub fn destination_of(&self, problem: &Problem, config: &Configuration, index: usize) -> Vec3A {
        let point = &self.all[index];
        if let [member] = point.members[..] {
            return self.member_destination(problem, config, member.kind);
        }
        let destinations = point.members.iter();
        let sum: Vec3A = destinations
            .map(|member| member.weight * self.member_destination(problem, config, member.kind))
            .sum();
        sum / point.weight
    }

    fn member_destination(
        &self,
        problem: &Problem,
        config: &Configuration,
        member: MemberKind,
    ) -> Vec3A {
        match member {
            MemberKind::Base(link) => self.base_destinations[link],
            MemberKind::Tip(effector) => {
                problem.effectors[effector].destination(config.tips[effector])
            }
        }
    }

    /// Sets the destination of a point and of the joints at it.
    pub fn move_point(&mut self, index: usize, to: Vec3A) {
        self.destinations[index] = to;
        for member in &self.all[index].members {
            if let MemberKind::Base(child) = member.kind {
                self.base_destinations[child] = to;
            }
        }
    }

    /// Lays the links out from the roots towards the destinations of their points.
    fn lay_out(&mut self, problem: &Problem, config: &mut Configuration) {
        if problem.free_roots {
            self.move_roots(problem, config);
        }
        self.keep_locals(problem, config);
        for (index, link) in problem.links.iter().enumerate() {
            if link.parent.is_none() {
                config.bases[index] = config.shifts[link.tree] + link.pivot;
            }
            self.lay_link(problem, config, index);
        }
    }

    /// Keeps the rotations of stiff links without limits, relative to their parents.
    fn keep_locals(&mut self, problem: &Problem, config: &Configuration) {
        for (index, link) in problem.links.iter().enumerate() {
            if link.is_stiff() && !link.limits.is_limited() {
                let mounted = self.mounted(problem, config, index);
                self.locals[index] = mounted.inverse() * config.orientations[index];
            }
        }
    }

    /// Rotation from a link's space to skeleton space, without the link's own rotation.
    fn mounted(&self, problem: &Problem, config: &Configuration, index: usize) -> Quat {
        let parent = problem.links[index].parent;
        parent.map_or(Quat::IDENTITY, |parent| config.orientations[parent]) * self.mounts[index]
    }

    /// Shifts each tree by the weighted mean vector from the joints and tips fixed to its root to
    /// their destinations, unless that overflows.
    fn move_roots(&self, problem: &Problem, config: &mut Configuration) {
        for (tree, ground) in self.grounds.iter().enumerate() {
            let weights: f32 = ground.iter().map(|member| member.weight).sum();
            let residual = |member: &PointMember| {
                self.member_destination(problem, config, member.kind)
                    - member.kind.position_in(config)
            };
            let sum: Vec3A = ground.iter().map(|member| member.weight * residual(member)).sum();
            let shift = config.shifts[tree] + problem.part_of_root() * sum / weights;
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

    /// Moves the points of a link towards their destinations, at their distances from the link's
    /// joint.
    fn lay_link(&mut self, problem: &Problem, config: &mut Configuration, link: usize) {
        let (from, to) = self.ranges[link];
        let base = config.bases[link];
        if self.turns_whole(problem) || to - from > 1 {
            self.rotate(problem, config, link);
        } else if let Some(towards) = normalize(self.destinations[from] - base) {
            self.arms[from] = self.all[from].radius * towards;
        }
        for index in from..to {
            let position = base + self.arms[index];
            for member in &self.all[index].members {
                match member.kind {
                    MemberKind::Base(child) => config.bases[child] = position,
                    MemberKind::Tip(effector) => config.tips[effector] = position,
                }
            }
        }
    }

    /// Rotates a link as a whole: to its wanted rotation, or so that its points come near their
    /// destinations.
    fn rotate(&mut self, problem: &Problem, config: &mut Configuration, index: usize) {
        let link = &problem.links[index];
        let mounted = self.mounted(problem, config, index);
        if link.limits.is_limited() {
            let own = Quat::from_mat3a(&JointAngles(config.angles[index]).matrix());
            config.orientations[index] = (mounted * own).normalize();
            self.find_pairs(config, index);
            self.turn_angles(link, mounted, &mut config.angles[index]);
            let own = Quat::from_mat3a(&JointAngles(config.angles[index]).matrix());
            config.orientations[index] = (mounted * own).normalize();
        } else {
            if link.is_stiff() {
                config.orientations[index] = (mounted * self.locals[index]).normalize();
            }
            let start = config.orientations[index];
            let turned = self.wanted(index).unwrap_or_else(|| {
                self.find_pairs(config, index);
                self.turned(start)
            });
            let part = link.part_of_turn();
            let is_whole = part == 1.0;
            config.orientations[index] = if is_whole { turned } else { start.slerp(turned, part) };
        }
        for point in self.of_link(index) {
            self.arms[point] = config.orientations[index] * self.all[point].position;
        }
    }

    /// Finds the vectors that a link turns from its orientation, and where to: those to its points,
    /// or its axes if it has a wanted rotation.
    fn find_pairs(&mut self, config: &Configuration, index: usize) {
        let (from, to) = self.ranges[index];
        let own = config.orientations[index];
        let wanted = self.wanted(index);
        self.pairs.clear();
        if let Some(wanted) = wanted {
            let axes = [Vec3A::X, Vec3A::Y, Vec3A::Z];
            let pair = |axis| PointPair { from: own * axis, to: wanted * axis, weight: 1.0 };
            self.pairs.extend(axes.map(pair));
            return;
        }
        for (point, destination) in self.all[from..to].iter().zip(&self.destinations[from..to]) {
            let from = own * point.position;
            let to = *destination - config.bases[index];
            self.pairs.push(PointPair { from, to, weight: point.weight });
        }
    }

    /// An orientation turned by the rotation that fits the pairs.
    fn turned(&mut self, mut orientation: Quat) -> Quat {
        for _ in 0..if self.pairs.len() > 1 { ROTATIONS } else { 1 } {
            let rotation = align(&self.pairs);
            self.pairs.iter_mut().for_each(|pair| pair.from = rotation * pair.from);
            orientation = (rotation * orientation).normalize();
        }
        orientation
    }

    /// Turns the angles of a link within its limits, so that they fit the pairs.
    fn turn_angles(&mut self, link: &Link, mounted: Quat, angles: &mut Vec3) {
        let before = *angles;
        for _ in 0..ROTATIONS {
            let axes = Mat3A::from_quat(mounted) * JointAngles(*angles).axes();
            let axes = [axes.x_axis, axes.y_axis, axes.z_axis];
            align_within(&link.limits, axes, 1.0, angles, &mut self.pairs);
        }
        let part = link.part_of_turn();
        if part < 1.0 {
            *angles = before.lerp(*angles, part);
        }
    }

    /// Updates the orientations of links with one point, which passes move only: turns each, by
    /// the smallest angle, until the link points at its point.
    fn update_orientations(&self, config: &mut Configuration) {
        if self.turn_whole {
            return;
        }
        for (link, (from, to)) in self.ranges.iter().enumerate() {
            if let [point] = &self.all[*from..*to] {
                let arm = point.position_in(config) - config.bases[link];
                let orientation = &mut config.orientations[link];
                let rotation = rotation_between(*orientation * point.position, arm);
                *orientation = (rotation * *orientation).normalize();
            }
        }
    }

    /// Each link as the pairs of its joint and its points, where their destinations are.
    fn destination_segments(&self) -> Vec<LinkSegment> {
        let links = self.ranges.iter().zip(&self.base_destinations).enumerate();
        let segments = |(link, (range, base)): (usize, (&(usize, usize), &Vec3A))| {
            let base = *base;
            let points = &self.destinations[range.0..range.1];
            points.iter().map(move |point| LinkSegment { link, ends: [base, *point] })
        };
        links.flat_map(segments).collect()
    }

    /// Each link as the pairs of its joint and its points.
    fn segments(&self, config: &Configuration) -> Vec<LinkSegment> {
        let links = self.ranges.iter().zip(&config.bases).enumerate();
        let segments = |(link, (range, base)): (usize, (&(usize, usize), &Vec3A))| {
            let ends = |point: &LinkPoint| [*base, point.position_in(config)];
            let points = self.all[range.0..range.1].iter();
            points.map(|point| LinkSegment { link, ends: ends(point) }).collect::<Vec<_>>()
        };
        links.flat_map(segments).collect()
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
    /// True if only tips are at the point, which have targets.
    pub fn is_target(&self) -> bool {
        self.members.iter().all(|member| matches!(member.kind, MemberKind::Tip(_)))
    }

    /// Position in problem space.
    pub fn position_in(&self, config: &Configuration) -> Vec3A {
        self.members[0].kind.position_in(config)
    }
}

impl MemberKind {
    /// Position in the space of the link that has it.
    fn position_in_link(self, problem: &Problem) -> Vec3A {
        match self {
            Self::Base(link) => problem.links[link].pivot,
            Self::Tip(effector) => problem.effectors[effector].tip,
        }
    }

    /// Position in problem space.
    fn position_in(self, config: &Configuration) -> Vec3A {
        match self {
            Self::Base(link) => config.bases[link],
            Self::Tip(effector) => config.tips[effector],
        }
    }
}
