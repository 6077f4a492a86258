//! Damped least squares: Δθ = Jᵀ (JJᵀ + λ²I)⁻¹ (target − p).
//!
//! J is the Jacobian of the tips p. Rows of J and residuals target − p are weighted by √w. The
//! damping λ is a fraction of the chain's length: it grows while a step would raise the cost and
//! shrinks again afterwards (Levenberg and Marquardt), so that a chain out of reach converges, too.
//! Residuals are clamped to 0.3 of the chain's length. Angles that are at a limit and would cross
//! it are fixed, and the step is solved again for the other angles.
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
use crate::chain_ik::problem::{Link, Problem};
use crate::skeleton::RotationAxis;

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
    /// JJᵀ; only the lower triangle is used.
    square: DMatrix<f32>,
    /// JJᵀ + λ²I, then its factorization.
    factored: DMatrix<f32>,
    residuals: DVector<f32>,
    forces: DVector<f32>,
}

impl DampedLeastSquares {
    pub fn new(problem: &Problem, damping: f32) -> Self {
        let rows = 3 * problem.effectors.len();
        Self {
            damping: damping * problem.length,
            raised: 1.0,
            wrenches: Wrenches::default(),
            step: Coordinates::default(),
            before: Coordinates::default(),
            wanted: Coordinates::default(),
            velocities: Vec::new(),
            axes: Vec::new(),
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
    /// by the part of the way d that is in the null space, (I − Jᵀ (JJᵀ + λ²I)⁻¹ J) d, and by at
    /// most `most`, the Euclidean norm of the changes of angles in radians and of shifts in chain
    /// lengths. Angles that would cross a limit are fixed.
    pub fn advance_in_null_space(
        &mut self,
        problem: &Problem,
        config: &mut Configuration,
        wanted: impl Fn(&mut Coordinates),
        most: f32,
    ) {
        self.before.copy_from(config);
        self.axes.clone_from(&config.axes);
        self.wanted.copy_from(config);
        wanted(&mut self.wanted);
        self.wanted.subtract(&self.before);
        loop {
            self.multiply(problem, config);
            self.set_velocities_as_residuals(problem, config);
            if !self.solve(problem, config) {
                return;
            }
            self.take_from_wanted(problem);
            if !self.fix_angles(problem) {
                break;
            }
        }
        let norm = self.step.norm(problem.length);
        let factor = if norm > most { most / norm } else { 1.0 };
        advance(problem, &self.before, &self.step, factor, config);
    }

    /// Sets the residuals to J d, the weighted velocities of the tips on the wanted way.
    fn set_velocities_as_residuals(&mut self, problem: &Problem, config: &Configuration) {
        self.velocities.clear();
        for (index, link) in problem.links.iter().enumerate() {
            let (spin, velocity) = match link.parent {
                Some(parent) => {
                    let (spin, velocity) = self.velocities[parent];
                    (spin, velocity + spin.cross(config.bases[index] - config.bases[parent]))
                }
                None => (Vec3A::ZERO, self.wanted.shifts[link.tree]),
            };
            let own = self.axes[index] * Vec3A::from(self.wanted.angles[index]);
            self.velocities.push((spin + own, velocity));
        }
        for (index, effector) in problem.effectors.iter().enumerate() {
            let velocity = match effector.link {
                Some(link) => {
                    let (spin, velocity) = self.velocities[link];
                    velocity + spin.cross(config.tips[index] - config.bases[link])
                }
                None => self.wanted.shifts[effector.tree],
            };
            let row = velocity * effector.weight.sqrt();
            self.residuals.as_mut_slice()[3 * index..][..3].copy_from_slice(&row.to_array());
        }
    }

    /// Turns the step Jᵀ F into the rest of the wanted way; fixed angles do not move.
    fn take_from_wanted(&mut self, problem: &Problem) {
        let lever = problem.length * problem.length;
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
        for (index, effector) in problem.effectors.iter().enumerate() {
            let residual = (effector.target - config.tips[index])
                .clamp_length_max(MAX_RESIDUAL * problem.length);
            let row = residual * effector.weight.sqrt();
            self.residuals.as_mut_slice()[3 * index..][..3].copy_from_slice(&row.to_array());
        }
        self.before.copy_from(config);
    }

    /// Solves for the step, with those angles fixed that would leave their limits. Returns whether
    /// there is a solution.
    fn solve_within(&mut self, problem: &Problem, config: &mut Configuration) -> bool {
        self.axes.clone_from(&config.axes);
        loop {
            self.multiply(problem, config);
            if !self.solve(problem, config) {
                return false;
            }
            if !self.fix_angles(problem) {
                return true;
            }
        }
    }

    /// Sets JJᵀ, link by link.
    fn multiply(&mut self, problem: &Problem, config: &Configuration) {
        self.square.fill(0.0);
        for (index, link) in problem.links.iter().enumerate() {
            let below = problem.below(link);
            let axes = self.axes[index];
            let base = config.bases[index];
            let columns = |effector: usize| {
                let arm =
                    (config.tips[effector] - base) * problem.effectors[effector].weight.sqrt();
                Mat3A::from_cols(
                    axes.x_axis.cross(arm),
                    axes.y_axis.cross(arm),
                    axes.z_axis.cross(arm),
                )
            };
            for (nth, row) in below.iter().enumerate() {
                let left = columns(*row);
                for column in &below[..=nth] {
                    self.add(*row, *column, left * columns(*column).transpose());
                }
            }
        }
        if problem.free_roots {
            self.add_shifts(problem);
        }
    }

    /// Adds the shifts of each free root to JJᵀ: three columns of one chain length.
    fn add_shifts(&mut self, problem: &Problem) {
        for (row, one) in problem.effectors.iter().enumerate() {
            for (column, other) in problem.effectors[..=row].iter().enumerate() {
                if one.tree == other.tree {
                    let lever =
                        problem.length * problem.length * (one.weight * other.weight).sqrt();
                    self.add(row, column, Mat3A::from_diagonal(Vec3::splat(lever)));
                }
            }
        }
    }

    /// Adds a 3 × 3 block to the lower triangle of JJᵀ; the upper triangle is not read.
    fn add(&mut self, row: usize, column: usize, block: Mat3A) {
        for (j, side) in block.to_cols_array_2d().iter().enumerate() {
            for (i, value) in side.iter().enumerate() {
                self.square[(3 * row + i, 3 * column + j)] += value;
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
            Vec3A::from_slice(&forces[3 * effector..]) * problem.effectors[effector].weight.sqrt()
        };
        self.wrenches.apply_transpose(problem, config, force, &mut self.step);
        true
    }

    /// Fixes angles that would leave their limits. Returns whether any angle was newly fixed.
    fn fix_angles(&mut self, problem: &Problem) -> bool {
        let mut any = false;
        for (index, link) in
            problem.links.iter().enumerate().filter(|(_, link)| link.limits.is_limited())
        {
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

/// Work of the pairs of targets at each joint, and of the factorization of a matrix with three rows
/// for each target.
pub(super) fn work(problem: &Problem) -> u64 {
    /// Multiplications that take as long as a visit of a joint.
    const MULTIPLICATIONS: u64 = 64;
    let pairs = |link: &Link| (problem.below(link).len() as u64).pow(2);
    let rows = 3 * problem.effectors.len() as u64;
    let factor = rows.saturating_pow(3) / (3 * MULTIPLICATIONS);
    problem.links.iter().map(pairs).sum::<u64>() + factor
}
