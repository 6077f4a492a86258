//! Cyclic coordinate descent: from the tips to the roots, each joint rotates as if it were the only
//! one.
//!
//! Let r be the vectors from the joint to the tips below it, and t the vectors from the joint to
//! the targets of these tips. For one tip, the joint rotates the tip exactly onto the line to its
//! target; for several tips, the joint rotates by the best angle about Σ w r × t. The best angle
//! about a unit axis a has tan θ = Σ w a·(r × t) / Σ w (r·t − (a·r)(a·t)). A joint with limits is
//! treated as three hinges, x, y and z, each with its best angle within the limits. No rotation
//! increases the cost.
//!
//! A wanted rotation counts like three points on the axes of the joint, a wanted aim like one on its
//! axis, each with the weight that gives the cost of a small turn. Where such a rotation raises the
//! cost, it is halved.
//!
//! A joint with the stiffness k makes the part 1 − k of its rotation.
//!
//! During a sweep only the tips are moved. The joints are updated afterwards, in one pass from the
//! roots, so that the time of an iteration is linear in the number of joints.
//!
//! # Source
//!
//! L. Wang, C. Chen, *A combined optimization method for solving the inverse kinematics problem of
//! mechanical manipulators*, 1991.

use glam::{Mat3A, Quat, Vec3, Vec3A};

use crate::chain_ik::align::{PointPair, align, align_best, align_within};
use crate::chain_ik::configuration::Configuration;
use crate::chain_ik::inside::{Event, Recorder};
use crate::chain_ik::orientation::MissingTurn;
use crate::chain_ik::problem::{EndEffector, Link, Orienting, Problem, Wanted};
use crate::skeleton::JointAngles;

#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::chain_ik) struct Ccd {
    /// Rotation `mount` of each link: from the link's space to its parent's, without the link's own
    /// rotation E.
    mounts: Vec<Quat>,
    /// Rotation of each link in this sweep; after the sweep, with the rotations of its ancestors.
    rotations: Vec<Quat>,
    pairs: Vec<PointPair>,
    /// Where the tip of each end effector goes, as the last link found it.
    destinations: Vec<Vec3A>,
    /// S of each link in this sweep, with the rotations of the links below it; empty without a centre
    /// of mass.
    moments: Vec<Vec3A>,
    /// Orientation of each end effector's link, and position of the link's base, in this sweep;
    /// empty without wanted orientations.
    turned: Vec<(Quat, Vec3A)>,
}

impl Ccd {
    pub fn new(problem: &Problem) -> Self {
        Self {
            mounts: problem.mounts().collect(),
            rotations: vec![Quat::IDENTITY; problem.links.len()],
            pairs: Vec::with_capacity(4 * problem.effectors.len()),
            destinations: vec![Vec3A::ZERO; problem.effectors.len()],
            moments: Vec::new(),
            turned: Vec::new(),
        }
    }

    /// Fits the sweep to links that are mounted otherwise.
    pub fn refit(&mut self, problem: &Problem) {
        self.mounts.clear();
        self.mounts.extend(problem.mounts());
    }

    /// Makes a sweep and returns `true`.
    pub fn iterate(
        &mut self,
        problem: &Problem,
        config: &mut Configuration,
        recorder: &mut Recorder,
    ) -> bool {
        self.turned.clear();
        if problem.orients {
            let link_of = |effector: &EndEffector| {
                (config.orientation_of(effector), config.base_of(effector))
            };
            self.turned.extend(problem.effectors.iter().map(link_of));
        }
        self.moments.clear();
        if let Some(masses) = &problem.masses {
            let links = 0..problem.links.len();
            self.moments.extend(links.map(|link| config.own_moment(masses, link)));
        }
        for index in (0..problem.links.len()).rev() {
            self.rotations[index] = self.rotate(problem, config, index);
            self.carry_moment(problem, config, index);
            self.record(problem, config, index, recorder);
        }
        self.update(problem, config);
        if problem.free_roots {
            move_roots(problem, config);
            recorder.record(config, || Event::MoveRoots);
        }
        true
    }

    /// Adds the moment of a link, with its rotation, to that of its parent.
    fn carry_moment(&mut self, problem: &Problem, config: &Configuration, index: usize) {
        if let Some(masses) = &problem.masses {
            let of_base = masses.on_links[index].below * config.bases[index];
            let turned = of_base + self.rotations[index] * (self.moments[index] - of_base);
            if let Some(parent) = problem.links[index].parent {
                self.moments[parent] += turned;
            }
        }
    }

    /// The point about which a link turns a tip in this sweep.
    fn pivot(
        &self,
        problem: &Problem,
        config: &Configuration,
        index: usize,
        effector: usize,
    ) -> Vec3A {
        config.pivot_with(&self.moments, problem, index, effector)
    }

    /// Records the rotation of a link, with the configuration in which the links before it in the
    /// sweep have not been rotated yet.
    fn record(
        &self,
        problem: &Problem,
        config: &Configuration,
        index: usize,
        recorder: &mut Recorder,
    ) {
        if !recorder.is_on() {
            return;
        }
        let mut part = self.clone();
        part.rotations[..index].fill(Quat::IDENTITY);
        let mut turned = config.clone();
        part.update(problem, &mut turned);
        let link = &problem.links[index];
        let targets = problem.below(link).iter().map(|effector| self.destinations[*effector]);
        let pairs = self.pairs.iter().zip(targets);
        let rotation = self.rotations[index];
        let bases = problem.below(link).iter().map(|it| self.pivot(problem, config, index, *it));
        let pairs = pairs.zip(bases);
        let pairs =
            pairs.map(|((pair, target), base)| [base + rotation.inverse() * pair.from, target]);
        recorder.record(&turned, || Event::Turn { link: index, rotation, pairs: pairs.collect() });
    }

    /// Finds the rotation of one link that brings the tips below it nearest to their targets,
    /// applies it to these tips, and returns it.
    fn rotate(&mut self, problem: &Problem, config: &mut Configuration, index: usize) -> Quat {
        let link = &problem.links[index];
        let below = problem.below(link);
        self.pairs.clear();
        for effector in below {
            let tip = config.tips[*effector];
            let destination = problem.effectors[*effector].destination(tip);
            self.destinations[*effector] = destination;
            // A place in its shell is free to move.
            let is_free = destination == tip && problem.effectors[*effector].has_shell();
            let weight = if is_free { 0.0 } else { problem.effectors[*effector].weight };
            let pivot = self.pivot(problem, config, index, *effector);
            self.pairs.push(PointPair { from: tip - pivot, to: destination - pivot, weight });
        }
        if !self.turned.is_empty() || problem.masses.is_some() {
            return self.rotate_with_orientations(problem, config, index);
        }
        let rotation = if link.limits.is_limited() {
            let axes = axes(self.mounted(problem, config, index), config.angles[index]);
            let angles = &mut config.angles[index];
            align_within(&link.limits, axes, link.part_of_turn(), angles, &mut self.pairs)
        } else {
            let rotation = part_of(align(&self.pairs), link);
            self.pairs.iter_mut().for_each(|pair| pair.from = rotation * pair.from);
            rotation
        };
        for (effector, pair) in below.iter().zip(&self.pairs) {
            config.tips[*effector] = config.bases[index] + pair.from;
        }
        rotation
    }

    /// As [`Ccd::rotate`], with the pairs of the places made, for problems with orientations or a
    /// centre of mass.
    fn rotate_with_orientations(
        &mut self,
        problem: &Problem,
        config: &mut Configuration,
        index: usize,
    ) -> Quat {
        /// Halvings after which a rotation is within rounding.
        const HALVINGS: u32 = 20;
        let link = &problem.links[index];
        let places = self.pairs.len();
        self.add_pairs_of_turns(problem, index);
        let mounted = self.mounted(problem, config, index);
        let before = config.angles[index];
        let mut rotation = if link.limits.is_limited() {
            let (axes, pairs) = (axes(mounted, before), &mut self.pairs.clone());
            let angles = &mut config.angles[index];
            align_within(&link.limits, axes, link.part_of_turn(), angles, pairs)
        } else {
            part_of(align_best(&self.pairs), link)
        };
        let cost = self.cost_below(problem, config, index, Quat::IDENTITY);
        let mut halvings = 0;
        while self.cost_below(problem, config, index, rotation) > cost {
            halvings += 1;
            if halvings == HALVINGS {
                (config.angles[index], rotation) = (before, Quat::IDENTITY);
                break;
            }
            if link.limits.is_limited() {
                let angles = link.limits.project(before.lerp(config.angles[index], 0.5));
                config.angles[index] = angles;
                let own = |angles| Quat::from_mat3a(&JointAngles(angles).matrix());
                let turned = own(angles) * own(before).inverse();
                rotation = mounted * turned * mounted.inverse();
            } else {
                rotation = Quat::IDENTITY.slerp(rotation, 0.5);
            }
        }
        let base = config.bases[index];
        for (effector, pair) in problem.below(link).iter().zip(&self.pairs[..places]) {
            let pivot = self.pivot(problem, config, index, *effector);
            config.tips[*effector] = pivot + rotation * pair.from;
            if self.turned.is_empty() {
                continue;
            }
            let (orientation, at) = &mut self.turned[*effector];
            *orientation = rotation * *orientation;
            *at = base + rotation * (*at - base);
        }
        self.pairs.truncate(places);
        self.pairs.iter_mut().for_each(|pair| pair.from = rotation * pair.from);
        rotation
    }

    /// Adds the pairs that stand for the wanted orientations below a link.
    fn add_pairs_of_turns(&mut self, problem: &Problem, index: usize) {
        for effector in problem.below(&problem.links[index]) {
            let Some((orientation, base)) = self.turned.get(*effector).copied() else { continue };
            let effector = &problem.effectors[*effector];
            let Some(Orienting { wanted, stiffness }) = effector.orientation else { continue };
            match wanted {
                Wanted::Rotation(wanted) => {
                    let axes = [Vec3A::X, Vec3A::Y, Vec3A::Z];
                    self.pairs.extend(axes.map(|axis| PointPair {
                        from: orientation * axis,
                        to: wanted * axis,
                        weight: 0.5 * stiffness,
                    }));
                }
                Wanted::Aim { axis, point } => {
                    let way = point - (base + orientation * effector.space.translation);
                    let from = orientation * axis;
                    self.pairs.push(PointPair {
                        from,
                        to: way.try_normalize().unwrap_or(from),
                        weight: stiffness,
                    });
                }
            }
        }
    }

    /// The cost of the targets below a link that rotates.
    fn cost_below(
        &self,
        problem: &Problem,
        config: &Configuration,
        index: usize,
        rotation: Quat,
    ) -> f64 {
        let base = config.bases[index];
        let of_effector = |at: &usize| {
            let effector = &problem.effectors[*at];
            let pivot = self.pivot(problem, config, index, *at);
            let tip = pivot + rotation * (config.tips[*at] - pivot);
            let off = (tip - effector.destination(tip)).as_dvec3().length_squared();
            let turned = self.turned.get(*at);
            let missing = turned.and_then(|(orientation, at)| {
                let at = base + rotation * (*at - base);
                MissingTurn::new(effector, rotation * *orientation, at)
            });
            0.5 * f64::from(effector.weight) * off + missing.map_or(0.0, |it| it.cost())
        };
        problem.below(&problem.links[index]).iter().map(of_effector).sum()
    }

    /// Rotation from a link's space to skeleton space, without the link's own rotation.
    fn mounted(&self, problem: &Problem, config: &Configuration, index: usize) -> Quat {
        let parent = problem.links[index].parent;
        let parent = parent.map_or(Quat::IDENTITY, |parent| config.orientations[parent]);
        parent * self.mounts[index]
    }

    /// Applies the sweep's rotations to the configuration.
    fn update(&mut self, problem: &Problem, config: &mut Configuration) {
        for (index, link) in problem.links.iter().enumerate() {
            if let Some(parent) = link.parent {
                self.rotations[index] = self.rotations[parent] * self.rotations[index];
            }
            config.orientations[index] = if link.limits.is_limited() {
                let own = Quat::from_mat3a(&JointAngles(config.angles[index]).matrix());
                (self.mounted(problem, config, index) * own).normalize()
            } else {
                (self.rotations[index] * config.orientations[index]).normalize()
            };
        }
        update_points(problem, config);
    }
}

/// The part of a rotation that a stiff link makes.
fn part_of(rotation: Quat, link: &Link) -> Quat {
    let part = link.part_of_turn();
    if part < 1.0 { Quat::IDENTITY.slerp(rotation, part) } else { rotation }
}

/// Rotation axes of a link's three angles in skeleton space.
fn axes(mounted: Quat, angles: Vec3) -> [Vec3A; 3] {
    let axes = Mat3A::from_quat(mounted) * JointAngles(angles).axes();
    [axes.x_axis, axes.y_axis, axes.z_axis]
}

/// Updates the positions of joints and tips from the links' orientations.
fn update_points(problem: &Problem, config: &mut Configuration) {
    for (index, link) in problem.links.iter().enumerate() {
        config.bases[index] = match link.parent {
            Some(parent) => config.bases[parent] + config.orientations[parent] * link.pivot,
            None => config.shifts[link.tree] + link.pivot,
        };
    }
    for (effector, tip) in problem.effectors.iter().zip(&mut config.tips) {
        *tip = match effector.link {
            Some(link) => config.bases[link] + config.orientations[link] * effector.tip,
            None => config.shifts[effector.tree] + effector.tip,
        };
    }
    config.update_centre(problem);
}

/// Shifts each tree by the weighted mean vector from its tips to their targets, unless that
/// overflows.
pub(in crate::chain_ik) fn move_roots(problem: &Problem, config: &mut Configuration) {
    for tree in 0..problem.trees.len() {
        let (mut sum, mut weights) = (Vec3A::ZERO, 0.0);
        for (index, (effector, tip)) in problem.effectors.iter().zip(&config.tips).enumerate() {
            if effector.tree != tree {
                continue;
            }
            let part = problem.part_of_shift(index);
            sum += part * effector.weight * (effector.destination(*tip) - *tip);
            weights += part * part * effector.weight;
        }
        if weights == 0.0 {
            continue;
        }
        let by = problem.part_of_root() * sum / weights;
        if !problem.can_shift(tree, config.shifts[tree] + by) {
            continue;
        }
        config.shifts[tree] += by;
        let bases = problem.links.iter().zip(&mut config.bases);
        bases.filter(|(link, _)| link.tree == tree).for_each(|(_, base)| *base += by);
        let tips = problem.effectors.iter().zip(&mut config.tips);
        tips.filter(|(effector, _)| effector.tree == tree).for_each(|(_, tip)| *tip += by);
        config.update_centre(problem);
    }
}
