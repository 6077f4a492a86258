use crate::document::{Document, RigKind};
use crate::kinematics::Shared;
use crate::kinematics::chain_ik::{ChainSolver, SolveError, SolverOptions, TipTarget};
use crate::kinematics::skeleton::Skeleton;

/// What a solver run solves: the FK pose, the targets and the options of a document at a time.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SolverInputs {
    pub fk: Shared<Skeleton>,
    pub targets: Vec<TipTarget>,
    pub options: SolverOptions,
}

impl SolverInputs {
    /// The inputs of a document that is evaluated at `time`, in seconds.
    ///
    /// # Errors
    ///
    /// The reason why there is nothing to solve.
    pub fn of(shown: &Document, time: f64) -> Result<Self, &'static str> {
        let rig = &shown.skeleton_rig;
        if shown.rig != RigKind::Skeleton {
            return Err("Show the skeleton to solve it");
        }
        let targets = rig.targets_at(time);
        if targets.iter().any(|target| rig.is_joint_on_path(target.joint, time)) {
            return Err("A chain that follows a path has nothing to solve");
        }
        if targets.is_empty() {
            return Err("There is no target to solve for; add one to a joint");
        }
        Ok(Self { fk: rig.fk_at(time), targets, options: rig.solver })
    }

    /// A solver with the bound of a pose, so that the window stays responsive.
    pub fn solver(&self) -> Result<ChainSolver, SolveError> {
        let Self { fk, targets, options } = self;
        ChainSolver::bounded(fk, targets, options, ChainSolver::POSE_WORK)
    }
}
