//! Damped least squares: Δθ = W⁻¹ Jᵀ (J W⁻¹ Jᵀ + λ²I)⁻¹ (target − p).
//!
//! J is the Jacobian of the tips p and of the [missing turns](crate::chain_ik::orientation). Rows
//! of J and residuals target − p are weighted by √w, those of turns by ℓ √w. W is the diagonal
//! matrix of 1/(1 − k) with the stiffness k of each angle: of all steps that bring the tips equally
//! near, this one has the least Δθᵀ W Δθ.
//!
//! The damping λ is a fraction of the chain's length: it grows while a step would raise the cost
//! and shrinks again afterwards (Levenberg and Marquardt), so that a chain out of reach converges,
//! too. Residuals are clamped to 0.3 of the chain's length, also those of turns. Angles that are at
//! a limit and would cross it are fixed, and the step is solved again for the other angles.
//!
//! A place at several distances from a target counts only along the way to the nearest of them, and
//! not at all while it is reached. A place that the step would move out of its shell is held along
//! that way, and the step is solved again.
//!
//! # Sources
//!
//! Buss 2004, sections 6 and 10 (clamped targets); C. Wampler, *Manipulator inverse kinematic
//! solutions based on vector formulations and damped least-squares methods*, 1986.

use glam::{Mat3A, Vec3, Vec3A};
use nalgebra::{Cholesky, DMatrix, DVector};

use crate::chain_ik::configuration::{Configuration, Coordinates};
use crate::chain_ik::inside::{Event, Recorder};
use crate::chain_ik::jacobian::{Wrenches, advance};
use crate::chain_ik::orientation::MissingTurn;
use crate::chain_ik::problem::{EndEffector, Link, Problem};
use crate::normalize;
use crate::skeleton::RotationAxis;

/// Distance beyond a shell that counts as on it, in chain lengths.
const ROUNDING: f32 = 1e-6;
/// Maximum length of a residual, in chain lengths; longer residuals are clamped.
const MAX_RESIDUAL: f32 = 0.3;

#[derive(Clone, Debug, PartialEq)]
pub(in crate::chain_ik) struct DampedLeastSquares {
    /// λ before it is raised, in the problem's units.
    damping: f32,
    /// Factor by which λ is raised, at least 1.
    raised: f32,
    wrenches: Wrenches,
    step: Coordinates,
    before: Coordinates,
    /// Of a move in the null space: the way to the wanted coordinates.
    wanted: Coordinates,
    /// Of a move in the null space: angular velocity of each link and velocity of its joint.
    velocities: Vec<(Vec3A, Vec3A)>,
    /// Rotation axes of the configuration, as columns; zero for fixed angles.
    axes: Vec<Mat3A>,
    /// The ends of cones at which links are held, as unit vectors of changes of their angles.
    cone_ends: Vec<(usize, Vec3)>,
    /// The turns that joints miss in the configuration.
    missing: Vec<Option<MissingTurn>>,
    /// The directions in which places count.
    counted: Vec<Counted>,
    /// The places that are held in their shells.
    held: Vec<Held>,
    /// Space for the weighted columns of a link: for each block of three rows, the first row, and
    /// the columns of three coordinates.
    blocks: Vec<(usize, Mat3A)>,
    /// J W⁻¹ Jᵀ; only the lower triangle is used.
    square: DMatrix<f32>,
    /// J W⁻¹ Jᵀ + λ²I, then its factorization.
    factored: DMatrix<f32>,
    residuals: DVector<f32>,
    forces: DVector<f32>,
}

impl DampedLeastSquares {
    pub fn new(problem: &Problem, damping: f32) -> Self {
        let rows = rows(problem);
        Self {
            damping: damping * problem.length,
            raised: 1.0,
            wrenches: Wrenches::default(),
            step: Coordinates::default(),
            before: Coordinates::default(),
            wanted: Coordinates::default(),
            velocities: Vec::new(),
            axes: Vec::new(),
            cone_ends: Vec::new(),
            missing: Vec::new(),
            counted: Vec::new(),
            held: Vec::new(),
            blocks: Vec::new(),
            square: DMatrix::zeros(rows, rows),
            factored: DMatrix::zeros(rows, rows),
            residuals: DVector::zeros(rows),
            forces: DVector::zeros(rows),
        }
    }

    /// Fits λ to other lengths.
    pub fn refit(&mut self, problem: &Problem, damping: f32) {
        self.damping = damping * problem.length;
    }

    /// Resets λ to its initial value and returns `true`.
    pub fn restart(&mut self) -> bool {
        self.raised = 1.0;
        true
    }

    /// Makes a step that lowers the cost and returns `true`. If there is no such step, restores the
    /// configuration and returns `false`.
    pub fn iterate(
        &mut self,
        problem: &Problem,
        config: &mut Configuration,
        recorder: &mut Recorder,
    ) -> bool {
        // Number of tries after which the step is below rounding.
        const TRIES: u32 = 12;
        const GROWTH: f32 = 4.0;
        self.set_residuals(problem, config);
        let cost = config.cost(problem);
        self.record_gradient(problem, config, recorder);
        for tries in 0..TRIES {
            if self.solve_within(problem, config) {
                advance(problem, &self.before, &self.step, 1.0, config);
                if config.cost(problem) < cost {
                    recorder.record(config, || Event::Step {
                        by: self.step.clone(),
                        factor: 1.0,
                        tries,
                        damping: Some(self.damping * self.raised),
                    });
                    self.raised = (self.raised / GROWTH).max(1.0);
                    return true;
                }
                advance(problem, &self.before, &self.step, 0.0, config);
            }
            self.raised *= GROWTH;
        }
        false
    }

    /// Moves the configuration towards wanted coordinates without moving the tips, to first order:
    /// by the part of the way d that is in the null space, (I − W⁻¹ Jᵀ (J W⁻¹ Jᵀ + λ²I)⁻¹ J) d, and by at
    /// most `most`, the Euclidean norm of the changes of angles in radians and of shifts in chain
    /// lengths. Angles that would cross a limit are fixed.
    pub fn advance_in_null_space(
        &mut self,
        problem: &Problem,
        config: &mut Configuration,
        wanted: impl Fn(&mut Coordinates),
        most: f32,
    ) {
        self.look(problem, config);
        // Also places at or outside the borders of their shells may move inwards.
        let places = self.counted.iter_mut().zip(&problem.effectors);
        let shells = places.filter(|(_, effector)| effector.has_shell());
        shells.for_each(|(counted, _)| *counted = Counted::Nowhere);
        self.axes.clone_from(&config.axes);
        self.cone_ends.clear();
        self.wanted.copy_from(config);
        wanted(&mut self.wanted);
        self.wanted.subtract(&self.before);
        let mut factor;
        loop {
            self.multiply(problem, config);
            self.set_velocities_as_residuals(problem, config);
            if !self.solve(problem, config) {
                return;
            }
            self.take_from_wanted(problem);
            let is_fixed = self.fix_angles(problem);
            let norm = self.step.norm(problem.shift_unit);
            factor = if norm > most { most / norm } else { 1.0 };
            if !(self.hold_in_shells(problem, config, 1.0) || is_fixed) {
                break;
            }
        }
        advance(problem, &self.before, &self.step, factor, config);
    }

    /// Finds the missing turns, stores the angles and shifts before the step, and makes room for
    /// all rows.
    fn look(&mut self, problem: &Problem, config: &Configuration) {
        self.before.copy_from(config);
        self.missing.clear();
        self.missing.extend(problem.effectors.iter().map(|it| config.missing_turn(it)));
        self.counted.clear();
        let places = problem.effectors.iter().zip(&config.tips);
        self.counted.extend(places.map(|(effector, tip)| Counted::new(effector, *tip)));
        self.held.clear();
        self.held.resize(problem.effectors.len(), Held::default());
        let rows = rows(problem);
        if self.square.nrows() != rows {
            self.square = DMatrix::zeros(rows, rows);
            self.factored = DMatrix::zeros(rows, rows);
            self.residuals = DVector::zeros(rows);
            self.forces = DVector::zeros(rows);
        }
    }

    fn set_residual(&mut self, row: usize, residual: Vec3A) {
        self.residuals.as_mut_slice()[row..][..3].copy_from_slice(&residual.to_array());
    }

    /// Sets the velocities of links for a motion, with shifts as `shift` makes them from those of
    /// the motion.
    fn set_velocities(
        &mut self,
        problem: &Problem,
        config: &Configuration,
        motion: &Coordinates,
        shift: f32,
    ) {
        self.velocities.clear();
        for (index, link) in problem.links.iter().enumerate() {
            let (spin, velocity) = match link.parent {
                Some(parent) => {
                    let (spin, velocity) = self.velocities[parent];
                    (spin, velocity + spin.cross(config.bases[index] - config.bases[parent]))
                }
                None => (Vec3A::ZERO, shift * motion.shifts[link.tree]),
            };
            let own = self.axes[index] * Vec3A::from(motion.angles[index]);
            self.velocities.push((spin + own, velocity));
        }
    }

    /// The velocity of the tip of an end effector, for the velocities of links and the shift of its
    /// tree.
    fn velocity_of_tip(
        &self,
        problem: &Problem,
        config: &Configuration,
        index: usize,
        shift: Vec3A,
    ) -> Vec3A {
        if let Some(masses) = problem.masses_of(index) {
            let of_links = masses.on_links.iter().enumerate().map(|(link, on_link)| {
                let (spin, velocity) = self.velocities[link];
                let arm = config.own_moment(masses, link) - on_link.mass * config.bases[link];
                on_link.mass * velocity + spin.cross(arm)
            });
            return masses.fixed_mass * shift + of_links.sum::<Vec3A>();
        }
        let (spin, velocity, base) = self.velocity_at(config, &problem.effectors[index], shift);
        velocity + spin.cross(config.tips[index] - base)
    }

    /// The velocity of the base of an end effector's link, its spin, and the base, for the
    /// velocities of links; without a link, for the shift of the tree.
    fn velocity_at(
        &self,
        config: &Configuration,
        effector: &EndEffector,
        shift: Vec3A,
    ) -> (Vec3A, Vec3A, Vec3A) {
        match effector.link {
            Some(link) => {
                let (spin, velocity) = self.velocities[link];
                (spin, velocity, config.bases[link])
            }
            None => (Vec3A::ZERO, shift, Vec3A::ZERO),
        }
    }

    /// Sets the residuals to J d, the weighted velocities of the tips and missing turns on the
    /// wanted way.
    fn set_velocities_as_residuals(&mut self, problem: &Problem, config: &Configuration) {
        let wanted = std::mem::take(&mut self.wanted);
        self.set_velocities(problem, config, &wanted, 1.0);
        for (index, effector) in problem.effectors.iter().enumerate() {
            let shift = wanted.shifts[effector.tree];
            let (spin, velocity, base) = self.velocity_at(config, effector, shift);
            let velocity_of_tip = self.velocity_of_tip(problem, config, index, shift);
            let allowed = self.held[index].allowed.unwrap_or(Vec3A::ZERO);
            let residual = self.counted[index].of(velocity_of_tip) - allowed;
            self.set_residual(place_row(problem, index), residual * effector.weight.sqrt());
            if let Some(missing) = self.missing[index] {
                let taken = missing.taken(spin, velocity + spin.cross(missing.at - base));
                self.set_residual(turn_row(index), taken * missing.stiffness.sqrt());
            }
        }
        self.wanted = wanted;
    }

    /// Holds places in their shells: those that the step would move out, in the direction that leads
    /// out, with the room that is left; lets those go that the force on them would push out. A force
    /// restrains a place from moving with its sign times `restrains`. Returns whether any is newly
    /// held or let go.
    fn hold_in_shells(
        &mut self,
        problem: &Problem,
        config: &Configuration,
        restrains: f32,
    ) -> bool {
        if !problem.has_shells {
            return false;
        }
        let step = std::mem::take(&mut self.step);
        let lever = problem.shift_unit.powi(2);
        self.set_velocities(problem, config, &step, lever);
        let mut any = false;
        for (index, effector) in problem.effectors.iter().enumerate().filter(|it| it.1.has_shell())
        {
            let tip = config.tips[index];
            let row = place_row(problem, index);
            match (self.counted[index], self.held[index]) {
                (Counted::Nowhere, held) if held.releases < Held::MOST_RELEASES => {
                    let shift = lever * step.shifts[effector.tree];
                    let velocity = self.velocity_of_tip(problem, config, index, shift);
                    let Some(out) = effector.way_out(tip, velocity) else { continue };
                    let room = effector.room(tip, out).max(0.0);
                    if velocity.dot(out) > room + ROUNDING * problem.length {
                        self.counted[index] = Counted::Along(out);
                        self.held[index].allowed = Some(out * room);
                        self.set_residual(row, out * room * effector.weight.sqrt());
                        any = true;
                    }
                }
                (Counted::Along(out), Held { allowed: Some(_), releases }) => {
                    let force = Vec3A::from_slice(&self.forces.as_slice()[row..]);
                    if restrains * force.dot(out) < 0.0 {
                        self.counted[index] = Counted::Nowhere;
                        self.held[index] = Held { allowed: None, releases: releases + 1 };
                        self.set_residual(row, Vec3A::ZERO);
                        any = true;
                    }
                }
                _ => {}
            }
        }
        self.step = step;
        any
    }

    /// Turns the step Jᵀ F into the rest of the wanted way; fixed angles do not move.
    fn take_from_wanted(&mut self, problem: &Problem) {
        let lever = problem.shift_unit.powi(2);
        let Coordinates { angles, shifts } = &mut self.step;
        for (by, wanted) in angles.iter_mut().zip(&self.wanted.angles) {
            *by = *wanted - *by;
        }
        for (by, wanted) in shifts.iter_mut().zip(&self.wanted.shifts) {
            // The unit of a step's shifts: see `advance`.
            *by = *wanted / lever - *by;
        }
    }

    fn record_gradient(
        &mut self,
        problem: &Problem,
        config: &Configuration,
        recorder: &mut Recorder,
    ) {
        if recorder.is_on() {
            let mut descent = Coordinates::default();
            self.wrenches.descend(problem, config, &mut descent);
            let damping = Some(self.damping * self.raised);
            recorder.record(config, || Event::Gradient { descent, damping });
        }
    }

    /// Sets the weighted and clamped residuals, and stores the angles and shifts before the step.
    fn set_residuals(&mut self, problem: &Problem, config: &Configuration) {
        self.look(problem, config);
        let most = MAX_RESIDUAL * problem.length;
        let most_turn = most / problem.turn_length() as f32;
        for (index, effector) in problem.effectors.iter().enumerate() {
            let tip = config.tips[index];
            let residual = (effector.destination(tip) - tip).clamp_length_max(most);
            self.set_residual(place_row(problem, index), residual * effector.weight.sqrt());
            if let Some(missing) = self.missing[index] {
                let turn = missing.turn.clamp_length_max(most_turn);
                self.set_residual(turn_row(index), turn * missing.stiffness.sqrt());
            }
        }
    }

    /// Solves for the step, with those angles fixed that would leave their limits. Returns whether
    /// there is a solution.
    fn solve_within(&mut self, problem: &Problem, config: &mut Configuration) -> bool {
        self.axes.clone_from(&config.axes);
        self.cone_ends.clear();
        loop {
            self.multiply(problem, config);
            if !self.solve(problem, config) {
                return false;
            }
            let is_fixed = self.fix_angles(problem);
            if !(self.hold_in_shells(problem, config, -1.0) || is_fixed) {
                return true;
            }
        }
    }

    /// Sets J W⁻¹ Jᵀ, link by link.
    fn multiply(&mut self, problem: &Problem, config: &Configuration) {
        self.square.fill(0.0);
        for (index, link) in problem.links.iter().enumerate() {
            let base = config.bases[index];
            let axes = scaled(self.axes[index], link.compliance);
            self.blocks.clear();
            for effector in problem.below(link) {
                let pivot = config.pivot(problem, index, *effector);
                let arm =
                    (config.tips[*effector] - pivot) * problem.effectors[*effector].weight.sqrt();
                let counted = self.counted[*effector];
                let place = columns(axes, |axis| counted.of(axis.cross(arm)));
                self.blocks.push((place_row(problem, *effector), place));
                if let Some(missing) = self.missing[*effector] {
                    let weight = missing.stiffness.sqrt();
                    let turn = columns(axes, |axis| missing.column(axis, base) * weight);
                    self.blocks.push((turn_row(*effector), turn));
                }
            }
            self.add_blocks();
        }
        if problem.free_roots {
            self.add_shifts(problem);
        }
    }

    /// Adds the shifts of each free root to J W⁻¹ Jᵀ: three columns of one
    /// [`Problem::shift_unit`].
    fn add_shifts(&mut self, problem: &Problem) {
        for tree in 0..problem.trees.len() {
            self.blocks.clear();
            for (index, effector) in problem.effectors.iter().enumerate() {
                if effector.tree != tree {
                    continue;
                }
                let part = problem.part_of_shift(index);
                let lever = part * problem.shift_unit * effector.weight.sqrt();
                let place = columns(Mat3A::IDENTITY * lever, |axis| self.counted[index].of(axis));
                self.blocks.push((place_row(problem, index), place));
                if let Some(missing) = self.missing[index] {
                    let weight = problem.shift_unit * missing.stiffness.sqrt();
                    let [x, y, z] = missing.of_velocity().map(|column| column * weight);
                    self.blocks.push((turn_row(index), Mat3A::from_cols(x, y, z)));
                }
            }
            self.add_blocks();
        }
    }

    /// Adds the products of all pairs of blocks of the same coordinates to the lower triangle of
    /// J W⁻¹ Jᵀ; the upper triangle is not read.
    fn add_blocks(&mut self) {
        for (nth, (row, left)) in self.blocks.iter().enumerate() {
            for (column, right) in &self.blocks[..=nth] {
                let block = *left * right.transpose();
                for (j, side) in block.to_cols_array_2d().iter().enumerate() {
                    for (i, value) in side.iter().enumerate() {
                        self.square[(row + i, column + j)] += value;
                    }
                }
            }
        }
    }

    fn solve(&mut self, problem: &Problem, config: &Configuration) -> bool {
        let damping = self.damping * self.raised;
        self.factored.copy_from(&self.square);
        for row in 0..self.factored.nrows() {
            self.factored[(row, row)] += damping * damping;
        }
        let matrix = std::mem::replace(&mut self.factored, DMatrix::zeros(0, 0));
        let Some(cholesky) = Cholesky::new(matrix) else {
            self.factored = self.square.clone();
            return false;
        };
        self.forces.copy_from(&self.residuals);
        cholesky.solve_mut(&mut self.forces);
        self.factored = cholesky.unpack_dirty();

        let forces = self.forces.as_slice();
        let force = |effector: usize| {
            let weight = problem.effectors[effector].weight.sqrt();
            let row = Vec3A::from_slice(&forces[place_row(problem, effector)..]);
            self.counted[effector].of(row) * weight
        };
        let moment = |effector: usize| {
            let missing = self.missing[effector]?;
            let row = Vec3A::from_slice(&forces[turn_row(effector)..]);
            Some((missing, row * missing.stiffness.sqrt()))
        };
        self.wrenches.apply_transpose(problem, config, force, moment, &mut self.step);
        self.step.scale_by_compliance(problem);
        true
    }

    /// Fixes angles that would leave their limits. Returns whether any angle was newly fixed.
    fn fix_angles(&mut self, problem: &Problem) -> bool {
        let mut any = false;
        for (index, link) in
            problem.links.iter().enumerate().filter(|(_, link)| link.limits.is_limited())
        {
            if link.limits.as_cone().is_some() {
                let by = &mut self.step.angles[index];
                let (axes, ends) = (&mut self.axes[index], &mut self.cone_ends);
                any |= hold_in_cone(link, index, self.before.angles[index], by, axes, ends);
                continue;
            }
            for about in RotationAxis::ALL {
                let by = &mut self.step.angles[index][about.index()];
                let axis = self.axes[index].col_mut(about.index());
                if *axis == Vec3A::ZERO {
                    *by = 0.0;
                } else if link.limits.stops(self.before.angles[index], about, *by, 0.0) {
                    *axis = Vec3A::ZERO;
                    any = true;
                }
            }
        }
        any
    }
}

/// The directions in which the place of an end effector counts.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Counted {
    /// All.
    Everywhere,
    /// All but that of a unit vector, the vertical of a centre of mass.
    Across(Vec3A),
    /// A unit vector: the place is outside its shell, or at its border.
    Along(Vec3A),
    /// None: the place is in its shell.
    Nowhere,
}

/// How a place is held in its shell.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Held {
    /// The way that it may move until it is at the border; `None` if it is not held.
    allowed: Option<Vec3A>,
    /// How often it was let go.
    releases: u8,
}

impl Held {
    /// Releases after which a place is not held any more in a step, so that the search for the
    /// places that must be held ends.
    const MOST_RELEASES: u8 = 2;
}

impl Counted {
    fn new(effector: &EndEffector, tip: Vec3A) -> Self {
        if !effector.has_shell() {
            return match effector.is_of_mass() {
                true => Self::Across(effector.free_direction),
                false => Self::Everywhere,
            };
        }
        normalize(effector.destination(tip) - tip).map_or(Self::Nowhere, Self::Along)
    }

    /// The part of a velocity or force that counts.
    #[inline]
    fn of(self, vector: Vec3A) -> Vec3A {
        match self {
            Self::Everywhere => vector,
            Self::Across(normal) => vector - normal * normal.dot(vector),
            Self::Along(normal) => normal * normal.dot(vector),
            Self::Nowhere => Vec3A::ZERO,
        }
    }
}

/// Rows of J: three for each place and, if a target asks for an orientation, three for each turn,
/// those of a target side by side.
fn rows(problem: &Problem) -> usize {
    place_row(problem, problem.effectors.len())
}

/// The first row of an end effector's place.
fn place_row(problem: &Problem, effector: usize) -> usize {
    if problem.orients { 6 * effector } else { 3 * effector }
}

/// The first row of an end effector's turn.
fn turn_row(effector: usize) -> usize {
    6 * effector + 3
}

/// Takes from a step the part that leads out of the cone of a link, and from the link's axes the
/// turns that do. Returns whether the link is held at an end at which it was not held before.
pub(in crate::chain_ik) fn hold_in_cone(
    link: &Link,
    index: usize,
    angles: Vec3,
    by: &mut Vec3,
    axes: &mut Mat3A,
    ends: &mut Vec<(usize, Vec3)>,
) -> bool {
    let of_link = |ends: &[(usize, Vec3)]| -> Vec<Vec3> {
        ends.iter().filter(|(at, _)| *at == index).map(|(_, out)| *out).collect()
    };
    for out in of_link(ends) {
        *by -= out * out.dot(*by);
    }
    let Some(out) = link.limits.most_crossed(angles, *by, &of_link(ends)) else { return false };
    let along = Mat3A::from_cols(
        Vec3A::from(out) * out.x,
        Vec3A::from(out) * out.y,
        Vec3A::from(out) * out.z,
    );
    *axes = *axes - *axes * along;
    *by -= out * out.dot(*by);
    ends.push((index, out));
    true
}

/// Axes times the roots of compliances, as columns.
fn scaled(axes: Mat3A, compliance: Vec3A) -> Mat3A {
    let Vec3 { x, y, z } = compliance.into();
    Mat3A::from_cols(axes.x_axis * x.sqrt(), axes.y_axis * y.sqrt(), axes.z_axis * z.sqrt())
}

/// Columns made from the rotation axes of a link; zero for fixed angles, whose axis is zero.
fn columns(axes: Mat3A, column: impl Fn(Vec3A) -> Vec3A) -> Mat3A {
    Mat3A::from_cols(column(axes.x_axis), column(axes.y_axis), column(axes.z_axis))
}

/// Work of the pairs of targets at each joint, and of the factorization of a matrix with three rows
/// for each target.
pub(super) fn work(problem: &Problem) -> u64 {
    /// Multiplications that take as long as a visit of a joint.
    const MULTIPLICATIONS: u64 = 64;
    let pairs = |link: &Link| (problem.below(link).len() as u64).pow(2);
    let rows = rows(problem) as u64;
    let factor = rows.saturating_pow(3) / (3 * MULTIPLICATIONS);
    problem.links.iter().map(pairs).sum::<u64>() + factor
}
