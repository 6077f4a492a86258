use crate::chain_ik::{ChainSolver, Report, SolveError, SolverOptions, TipTarget};
use crate::diagnosis::Remedy;
use crate::skeleton::{JointId, Skeleton};

/// A skeleton in its FK pose, the targets of its tips, and how they are solved for.
#[derive(Clone)]
pub(super) struct SolveInputs {
    pub skeleton: Skeleton,
    pub targets: Vec<TipTarget>,
    pub options: SolverOptions,
}

/// The pose that a solve comes to.
pub(super) struct Solved {
    pub skeleton: Skeleton,
    pub report: Report,
    pub tolerance: f32,
    /// Work of the solve, in the units of [`ChainSolver::bounded`].
    pub work: u64,
}

impl SolveInputs {
    pub fn solve(&self) -> Result<Solved, SolveError> {
        let Self { skeleton, targets, options } = self;
        let most = ChainSolver::POSE_WORK;
        let mut solver = ChainSolver::bounded(skeleton, targets, options, most)?;
        let report = solver.run();
        let mut skeleton = self.skeleton.clone();
        solver.write(&mut skeleton);
        Ok(Solved { skeleton, report, tolerance: solver.tolerance(), work: solver.work() })
    }

    /// These inputs after a remedy; `None` if it cannot be applied.
    pub fn with(&self, remedy: &Remedy) -> Option<Self> {
        let mut changed = self.clone();
        remedy.change_skeleton(&mut changed.skeleton).ok()?;
        remedy.change_options(&mut changed.options);
        remedy.change_targets(&mut changed.targets);
        Some(changed)
    }

    /// Distance in the world from a joint's tip to its target, after a solve; infinite if the
    /// inputs cannot be solved.
    pub fn residual_of(&self, joint: JointId) -> f32 {
        self.solve().map_or(f32::INFINITY, |solved| solved.residual(self, joint))
    }

    pub fn target_of(&self, joint: JointId) -> Option<&TipTarget> {
        self.targets.iter().find(|target| target.joint == joint)
    }
}

impl Solved {
    /// Distance in the world from a joint's tip to its target; 0 without a target.
    pub fn residual(&self, inputs: &SolveInputs, joint: JointId) -> f32 {
        inputs
            .target_of(joint)
            .map_or(0.0, |target| self.skeleton.tip(joint).distance(target.point).min(f32::MAX))
    }
}
