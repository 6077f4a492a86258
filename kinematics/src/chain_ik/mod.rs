//! Inverse kinematics of skeletons: solvers that move tips of bones to targets, and turn joints to
//! orientations.
//!
//! A [`ChainTarget`] asks for a place of a joint's tip, for an orientation of the joint (its
//! rotation, or an axis that is aimed at a point), or for both. With p a tip, t its target, w its
//! weight, and φ the angle of the turn that an orientation of weight v misses, every method lowers
//!
//! ```text
//! f = Σ ½ w |p − t|² + Σ ½ v ℓ² φ²
//! ```
//!
//! with ℓ a quarter of the chain's length, by rotating the joints between targets and roots within
//! their limits. Locked joints, and joints that are not between a target and a root, are unchanged,
//! bit for bit; so are roots that are [locked](Root::Locked). Targets, errors and the tolerance are
//! in the world; solvers work in skeleton space, so that mirrored and scaled skeletons are solved
//! correctly.
//!
//! | method | moves | at limits | orientations |
//! | --- | --- | --- | --- |
//! | [`Method::TransposeFixed`] | all angles, along the gradient of f | stops at the limit | unless all joints are hinges |
//! | [`Method::Transpose`] | all angles, along the gradient of f | stops at the limit | yes |
//! | [`Method::DampedLeastSquares`] | all angles, to the minimum of a quadratic model of f | solves for the other angles | yes |
//! | [`Method::Ccd`] | one joint after the other | best angle within the limits | yes |
//! | [`Method::Fabrik`] | points, from targets to roots and back | nearest angles within the limits; may stop short | rotations with a place |
//! | [`Method::Relaxation`] | points: each bone in turn moves both of its ends | as FABRIK | refused |
//! | [`Method::TwoBone`] | two joints, at once | stops short | refused |
//!
//! A straight chain that must shorten is bent before the first iteration if no method can bend it:
//! with its target on its line, or with joints that the target pushes against their limits, as a
//! knee limited to 0 … 143°.
//!
//! A target out of reach is not an error: the chain straightens towards the target and the solver
//! stalls. Results are deterministic.
//!
//! [`ChainSolver::run`] solves one pose. Of neighbouring frames of a motion it may find different
//! minima, and joints jump. [`ChainSolver::track`] continues from the pose of the frame before.
//!
//! # What breaks
//!
//! - A solver stalls at a *local* minimum of f. Limits can cause such minima away from the target.
//!   There the angles at limits, then all limited angles, are moved inside their limits and the
//!   method starts again, up to six times; the best pose counts. That is no guarantee.
//! - Near y = ±90° (gimbal lock) two of a joint's angles rotate about the same axis; methods that
//!   move angles cannot rotate the joint in one direction there. CCD, FABRIK and relaxation
//!   can, at joints without limits.
//! - The offset of a free root has single precision, seven digits: a root that moves far from its
//!   start loses precision.

mod align;
mod configuration;
mod diagnose;
mod inside;
mod jacobian;
mod method;
mod null_space_drag;
mod options;
mod orientation;
mod perturb;
mod problem;
mod report;
mod solver;
mod stall;
mod tracker;

pub use diagnose::{diagnose, diagnose_targets};
pub use inside::{
    AngleChange, Column, Ellipsoid, Gradient, MissedTurn, StepTaken, SubStep, SubStepKind, TipMove,
    Turn, TurnColumn,
};
pub use jacobian::{Swing, jacobian, jacobian_of_point};
pub use method::{Method, OrientRefusal, ParseMethodError, TwoBoneRefusal};
pub use null_space_drag::{DragReport, NullSpaceDrag};
pub use options::{OptionField, Root, SolveError, SolverOptions};
pub(crate) use problem::HeldLimb;
pub use problem::{ChainTarget, Effector, Orientation};
pub use report::{Report, Status};
pub use solver::{ChainSolver, TrackStep, solve};
