//! Gradient descent: θ ← θ − τ Jᵀ W (p − target), with the angles θ, the tips p and their weights
//! W.
//!
//! The fixed step is τ = 1/Σ w r², with the distances r from joints to tips in the bind pose; it is
//! at most the reciprocal of the cost's greatest curvature near a solution. The line search starts
//! at twice the last successful step and halves the step until the cost falls.
//!
//! # Sources
//!
//! *Skeleton Kinematics*, wiki of Scotty3D (CMU 15-462), task 2b; Buss 2004, section 4.

use glam::{Vec3, Vec3A};

use super::configuration::Configuration;
use super::jacobian::{Wrenches, advance};
use super::problem::Problem;

#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Transpose {
    /// Whether the step is found by a line search.
    searched: bool,
    /// The step τ: the last successful one, or the initial step.
    step: f32,
    /// The step τ of the first iteration.
    initial_step: f32,
    wrenches: Wrenches,
    gradient: (Vec<Vec3>, Vec<Vec3A>),
    before: (Vec<Vec3>, Vec<Vec3A>),
}

impl Transpose {
    pub fn new(problem: &Problem, step: f32, searched: bool) -> Self {
        let step = if problem.inertia > 0.0 { step / problem.inertia } else { 0.0 };
        Self { searched, step, initial_step: step, ..Self::default() }
    }

    /// Resets the step. Returns whether the method searches for its step.
    pub fn restart(&mut self) -> bool {
        self.step = self.initial_step;
        self.searched
    }

    /// Makes a step. Returns whether the step lowers the cost; always `true` for a fixed step.
    pub fn iterate(&mut self, problem: &Problem, config: &mut Configuration) -> bool {
        let force = |index: usize| {
            let effector = &problem.effectors[index];
            (effector.target - config.tips[index]) * effector.weight
        };
        self.wrenches.apply_transpose(
            problem,
            config,
            force,
            &mut self.gradient.0,
            &mut self.gradient.1,
        );
        self.before.0.clone_from(&config.angles);
        self.before.1.clone_from(&config.shifts);
        if self.searched {
            self.search(problem, config)
        } else {
            self.advance(problem, self.step, config)
        }
    }

    fn search(&mut self, problem: &Problem, config: &mut Configuration) -> bool {
        // Number of halvings after which angles change by less than their rounding.
        const HALVINGS: u32 = 40;
        let cost = config.cost(problem);
        let mut step = 2.0 * self.step;
        for _ in 0..HALVINGS {
            self.advance(problem, step, config);
            if config.cost(problem) < cost {
                self.step = step;
                return true;
            }
            step *= 0.5;
        }
        self.advance(problem, 0.0, config);
        false
    }

    fn advance(&self, problem: &Problem, step: f32, config: &mut Configuration) -> bool {
        let (before, gradient) = (&self.before, &self.gradient);
        advance(problem, (&before.0, &before.1), (&gradient.0, &gradient.1), step, config);
        true
    }
}
