//! Gradient descent: θ ← θ − τ Jᵀ W (p − target).
//!
//! The fixed step is τ = 1/Σ w r², r the distances from joints to tips in the bind pose: no more
//! than the reciprocal of the cost's greatest curvature near a solution. The variable one is searched
//! for: from twice the last good one, halved until the cost falls.
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
    searched: bool,
    /// τ, and what it was at first.
    step: f32,
    first: f32,
    wrenches: Wrenches,
    slope: (Vec<Vec3>, Vec<Vec3A>),
    before: (Vec<Vec3>, Vec<Vec3A>),
}

impl Transpose {
    pub fn new(rig: &Problem, step: f32, searched: bool) -> Self {
        let step = if rig.inertia > 0.0 { step / rig.inertia } else { 0.0 };
        Self { searched, step, first: step, ..Self::default() }
    }

    /// Forgets the last good step. Whether it searches for one.
    pub fn renew(&mut self) -> bool {
        self.step = self.first;
        self.searched
    }

    /// Whether there was anything to do.
    pub fn iterate(&mut self, rig: &Problem, pose: &mut Configuration) -> bool {
        let force = |index: usize| {
            let goal = &rig.goals[index];
            (goal.point - pose.tips[index]) * goal.weight
        };
        self.wrenches.gather(rig, pose, force, &mut self.slope.0, &mut self.slope.1);
        self.before.0.clone_from(&pose.angles);
        self.before.1.clone_from(&pose.shift);
        if self.searched { self.search(rig, pose) } else { self.advance(rig, self.step, pose) }
    }

    fn search(&mut self, rig: &Problem, pose: &mut Configuration) -> bool {
        // From twice a step down to where an angle would change by less than its rounding.
        const HALVINGS: u32 = 40;
        let cost = pose.cost(rig);
        let mut step = 2.0 * self.step;
        for _ in 0..HALVINGS {
            self.advance(rig, step, pose);
            if pose.cost(rig) < cost {
                self.step = step;
                return true;
            }
            step *= 0.5;
        }
        self.advance(rig, 0.0, pose);
        false
    }

    fn advance(&self, rig: &Problem, step: f32, pose: &mut Configuration) -> bool {
        let (before, slope) = (&self.before, &self.slope);
        advance(rig, (&before.0, &before.1), (&slope.0, &slope.1), step, pose);
        true
    }
}
