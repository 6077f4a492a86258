//! Gradient descent with a fixed step: θ ← θ − τ Jᵀ W (p − target), with the angles θ, the tips p and
//! their weights W.
//!
//! The step τ is 1/Σ w r², with the distances r from joints to tips in the bind pose; it is at most
//! the reciprocal of the cost's greatest curvature near a solution.
//!
//! Each iteration leaves a fraction of about 1 − τ κ of the error along a direction of curvature κ,
//! so that an error along a direction of little curvature remains for long. A nearly straight leg has
//! such a direction: bending the knee hardly moves the ankle. From the straight bind pose, the
//! example figure's ankle reaches 953 of 1000 random targets in 500 iterations, 977 in 1000, 996 in
//! 2000 and all in the default 4000, and never stalls. A variable step reaches them all in 500
//! ([`Method::Transpose`](crate::chain_ik::Method::Transpose)).
//!
//! # Sources
//!
//! *Skeleton Kinematics*, wiki of Scotty3D (CMU 15-462), task 2b; Buss 2004, section 4.

use crate::chain_ik::configuration::{Configuration, Coordinates};
use crate::chain_ik::inside::{Event, Recorder};
use crate::chain_ik::jacobian::{Wrenches, advance};
use crate::chain_ik::problem::Problem;

#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::chain_ik) struct Transpose {
    /// The step τ.
    step: f32,
    wrenches: Wrenches,
    descent: Coordinates,
    before: Coordinates,
}

impl Transpose {
    pub fn new(problem: &Problem, step: f32) -> Self {
        let step = if problem.inertia > 0.0 { step / problem.inertia } else { 0.0 };
        Self { step, ..Self::default() }
    }

    /// Makes a step and returns `true`.
    pub fn iterate(
        &mut self,
        problem: &Problem,
        config: &mut Configuration,
        recorder: &mut Recorder,
    ) -> bool {
        self.wrenches.descend(problem, config, &mut self.descent);
        recorder
            .record(config, || Event::Gradient { descent: self.descent.clone(), damping: None });
        self.before.copy_from(config);
        advance(problem, &self.before, &self.descent, self.step, config);
        recorder.record(config, || Event::Step {
            by: self.descent.clone(),
            factor: self.step,
            tries: 0,
            damping: None,
        });
        true
    }
}
