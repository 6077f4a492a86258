use super::run::SolverRun;
use crate::document::{BalanceTarget, Channel, SkeletonRig};
use crate::kinematics::Shared;
use crate::kinematics::chain_ik::SolverOptions;
use crate::rig::Posture;
use crate::session::outcome::{Consequence, Outcome};
use crate::session::session::Session;

/// A change of the solver's settings, or of the pose by a solver run.
#[derive(Clone, Debug, PartialEq)]
pub enum SolverEdit {
    /// Sets the solver and its options.
    SetSolver(SolverOptions),
    /// Sets the number of iterations that a solver run makes per frame.
    SetIterationsPerFrame(u32),
    /// Lets each frame of a motion continue from the one before, or solves each by itself.
    SetTracked(bool),
    /// Lets the body follow limb targets that are out of reach, or stay.
    SetBodyFollows(bool),
    /// Balances the figure, or leaves its centre of mass anywhere.
    SetBalance(Option<BalanceTarget>),
    /// Lets the motion begin with the pose that is solved from the joints' own angles, instead of
    /// the posture that drags have left.
    ResetPosture,
    /// Lets the motion begin with another posture.
    SetPosture(Shared<Posture>),
    /// Writes the shown iterate of the solver run to the joints' own angles and offsets, and ends
    /// the run.
    ApplyPose,
}

impl SolverEdit {
    /// Label of the edit's undo step.
    pub fn label(&self) -> &'static str {
        match self {
            Self::SetSolver(_) | Self::SetIterationsPerFrame(_) | Self::SetTracked(_) => {
                "Change solver"
            }
            Self::SetBodyFollows(true) => "Let body follow",
            Self::SetBodyFollows(false) => "Keep body",
            Self::SetBalance(Some(_)) => "Balance",
            Self::SetBalance(None) => "Remove balance",
            Self::ResetPosture => "Reset posture",
            Self::SetPosture(_) => "Change posture",
            Self::ApplyPose => "Apply pose",
        }
    }

    pub(in crate::session) fn apply(self, session: &Session) -> Outcome {
        match self {
            Self::SetSolver(solver) if is_valid(&solver) => {
                Outcome::change(session.shown(), |document| document.rig.solver = solver)
            }
            Self::SetSolver(_) => Outcome::fail(
                "Tolerance, damping, step and iterations must be above 0, the posture rate 0 or more",
            ),
            Self::SetIterationsPerFrame(iterations) => {
                let iterations = iterations.clamp(1, SkeletonRig::MAX_ITERATIONS_PER_FRAME);
                Outcome::change(session.shown(), |document| {
                    document.rig.iterations_per_frame = iterations;
                })
            }
            Self::SetTracked(is_tracked) => Outcome::change(session.shown(), |document| {
                document.rig.is_tracked = is_tracked;
            }),
            Self::SetBodyFollows(follows) => Outcome::change(session.shown(), |document| {
                document.rig.body_follows = follows;
            }),
            Self::SetBalance(Some(balance)) if !balance.is_valid() => Outcome::fail(
                "The influence of the balance must be from 0 to 1, its weight above 0, its point finite",
            ),
            Self::SetBalance(balance) => Outcome::change(session.shown(), |document| {
                document.rig.balance = balance;
                if balance.is_none() {
                    document.keys.clear(Channel::BalanceInfluence);
                }
            }),
            Self::ResetPosture => Outcome::from(Consequence::ResetPosture).and(Outcome::change(
                session.shown(),
                |document| {
                    document.rig.posture = None;
                },
            )),
            Self::SetPosture(_) if session.history().is_editing() => {
                Outcome::say("End the drag first")
            }
            Self::SetPosture(posture) => Outcome::change(session.shown(), |document| {
                let joints = document.skeleton().joints().len();
                let posture = Some(posture).filter(|posture| posture.fits(joints));
                document.rig.posture = posture;
            }),
            Self::ApplyPose => apply_pose(session),
        }
    }
}

fn is_valid(solver: &SolverOptions) -> bool {
    let above_0 = |value: f32| value.is_finite() && value > 0.0;
    above_0(solver.damping)
        && above_0(solver.step)
        && solver.posture_rate.is_finite()
        && solver.posture_rate >= 0.0
        && (0.0..1.0).contains(&solver.root_stiffness)
        && solver.tolerance.is_none_or(above_0)
        && solver.iterations.is_none_or(|iterations| iterations > 0)
}

/// Writes the shown iterate of the solver run to the joints' own angles and offsets, and ends the
/// run.
fn apply_pose(session: &Session) -> Outcome {
    let Some(posed) = session.solvers().run().map(SolverRun::skeleton) else {
        return Outcome::say("Run or step the solver first");
    };
    let written = Outcome::edit_rig(session.shown(), |rig| {
        for (joint, posed) in posed.iter() {
            let present = &rig.skeleton[joint];
            if (present.rotation, present.offset) != (posed.rotation, posed.offset) {
                rig.skeleton_mut().change(joint, |joint| {
                    (joint.rotation, joint.offset) = (posed.rotation, posed.offset);
                })?;
            }
        }
        Ok(())
    });
    Outcome::from(Consequence::EndSolvers).and(Consequence::ResetPosture).and(written)
}
