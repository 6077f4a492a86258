//! DampedLeastSquares least squares: Δθ = Jᵀ (JJᵀ + λ²I)⁻¹ (target − p).
//!
//! Rows count by √w. λ is a share of the chain's length; where a step would raise the cost it is
//! raised until one does not, and lowered again afterwards (Levenberg and Marquardt): out of reach
//! the chain comes to rest. Targets are brought near, to 0.3 of the chain's length from their tips.
//! Angles that stand at a limit and would go beyond it are left out and the rest solved again.
//!
//! # Sources
//!
//! Buss 2004, sections 6 and 10 (clamped targets); C. Wampler, *Manipulator inverse kinematic
//! solutions based on vector formulations and damped least-squares methods*, 1986.

use glam::{Mat3A, Vec3, Vec3A};
use nalgebra::{Cholesky, DMatrix, DVector};

use super::configuration::Configuration;
use super::jacobian::{Wrenches, advance};
use super::problem::Problem;

/// Of the chain's length: how far a step looks.
const NEAR: f32 = 0.3;

#[derive(Clone, Debug, PartialEq)]
pub(super) struct DampedLeastSquares {
    /// λ where nothing goes wrong.
    damping: f32,
    /// What it is multiplied by now.
    raised: f32,
    wrenches: Wrenches,
    step: (Vec<Vec3>, Vec<Vec3A>),
    before: (Vec<Vec3>, Vec<Vec3A>),
    /// The pose's axes, zero for angles that are left out.
    axes: Vec<Mat3A>,
    /// JJᵀ, and room to factor it with the damping.
    square: DMatrix<f32>,
    factored: DMatrix<f32>,
    missing: DVector<f32>,
    forces: DVector<f32>,
}

impl DampedLeastSquares {
    pub fn new(rig: &Problem, damping: f32) -> Self {
        let rows = 3 * rig.goals.len();
        Self {
            damping: damping * rig.length,
            raised: 1.0,
            wrenches: Wrenches::default(),
            step: Default::default(),
            before: Default::default(),
            axes: Vec::new(),
            square: DMatrix::zeros(rows, rows),
            factored: DMatrix::zeros(rows, rows),
            missing: DVector::zeros(rows),
            forces: DVector::zeros(rows),
        }
    }

    /// Forgets how far the damping was raised.
    pub fn renew(&mut self) {
        self.raised = 1.0;
    }

    /// Whether there was a step that lowers the cost.
    pub fn iterate(&mut self, rig: &Problem, pose: &mut Configuration) -> bool {
        // λ grows 4-fold each time: the last try moves by less than rounding.
        const TRIES: u32 = 12;
        const MORE: f32 = 4.0;
        self.look(rig, pose);
        let cost = pose.cost(rig);
        for _ in 0..TRIES {
            if self.solve_within(rig, pose) {
                let (from, by) = (&self.before, &self.step);
                advance(rig, (&from.0, &from.1), (&by.0, &by.1), 1.0, pose);
                if pose.cost(rig) < cost {
                    self.raised = (self.raised / MORE).max(1.0);
                    return true;
                }
                advance(rig, (&from.0, &from.1), (&by.0, &by.1), 0.0, pose);
            }
            self.raised *= MORE;
        }
        false
    }

    /// What is missing at every tip, brought near.
    fn look(&mut self, rig: &Problem, pose: &Configuration) {
        for (index, goal) in rig.goals.iter().enumerate() {
            let missing = (goal.point - pose.tips[index]).clamp_length_max(NEAR * rig.length);
            let row = missing * goal.weight.sqrt();
            self.missing.as_mut_slice()[3 * index..][..3].copy_from_slice(&row.to_array());
        }
        self.before.0.clone_from(&pose.angles);
        self.before.1.clone_from(&pose.shift);
    }

    /// Solves without the angles that would leave their limits. Whether there is a solution.
    fn solve_within(&mut self, rig: &Problem, pose: &mut Configuration) -> bool {
        self.axes.clone_from(&pose.axes);
        loop {
            self.multiply(rig, pose);
            if !self.solve(rig, pose) {
                return false;
            }
            if !self.leave_out(rig) {
                return true;
            }
        }
    }

    /// JJᵀ, joint by joint.
    fn multiply(&mut self, rig: &Problem, pose: &Configuration) {
        self.square.fill(0.0);
        for (index, body) in rig.bodies.iter().enumerate() {
            let below = &rig.below[body.below.0..body.below.1];
            let axes = self.axes[index];
            let base = pose.bases[index];
            let columns = |goal: usize| {
                let arm = (pose.tips[goal] - base) * rig.goals[goal].weight.sqrt();
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
        if rig.free {
            self.add_shifts(rig);
        }
    }

    /// Roots that may move have three columns more, as long as the chain.
    fn add_shifts(&mut self, rig: &Problem) {
        for (row, one) in rig.goals.iter().enumerate() {
            for (column, other) in rig.goals[..=row].iter().enumerate() {
                if one.tree == other.tree {
                    let lever = rig.length * rig.length * (one.weight * other.weight).sqrt();
                    self.add(row, column, Mat3A::from_diagonal(Vec3::splat(lever)));
                }
            }
        }
    }

    /// Into the lower triangle, which is all that is read.
    fn add(&mut self, row: usize, column: usize, block: Mat3A) {
        for (j, side) in block.to_cols_array_2d().iter().enumerate() {
            for (i, value) in side.iter().enumerate() {
                self.square[(3 * row + i, 3 * column + j)] += value;
            }
        }
    }

    fn solve(&mut self, rig: &Problem, pose: &Configuration) -> bool {
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
        self.forces.copy_from(&self.missing);
        cholesky.solve_mut(&mut self.forces);
        self.factored = cholesky.unpack_dirty();

        let forces = self.forces.as_slice();
        let force =
            |goal: usize| Vec3A::from_slice(&forces[3 * goal..]) * rig.goals[goal].weight.sqrt();
        self.wrenches.gather(rig, pose, force, &mut self.step.0, &mut self.step.1);
        true
    }

    /// Whether there was an angle to leave out that was not yet.
    fn leave_out(&mut self, rig: &Problem) -> bool {
        let mut any = false;
        for (index, body) in rig.bodies.iter().enumerate().filter(|(_, body)| body.is_limited()) {
            for (angle, limit) in body.limits.iter().enumerate() {
                let (from, by) = (self.before.0[index][angle], &mut self.step.0[index][angle]);
                let axis = self.axes[index].col_mut(angle);
                if *axis == Vec3A::ZERO {
                    *by = 0.0;
                } else if limit.is_some_and(|limit| {
                    (from <= limit.min && *by < 0.0) || (from >= limit.max && *by > 0.0)
                }) {
                    *axis = Vec3A::ZERO;
                    any = true;
                }
            }
        }
        any
    }
}
