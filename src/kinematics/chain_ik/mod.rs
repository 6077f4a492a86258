//! Inverse kinematics of skeletons: moves tips of bones to targets.
//!
//! With p a tip, t its target and w its weight, every method lowers
//!
//! ```text
//! f = Σ ½ w |p − t|²
//! ```
//!
//! by rotating the joints between targets and roots within their limits. Locked joints and joints on no
//! such path are unchanged, bit for bit. Targets, errors and the tolerance are in the world; the solve
//! runs in skeleton space, so that mirrored and scaled skeletons are right.
//!
//! | method | moves | at limits |
//! | --- | --- | --- |
//! | [`Method::TransposeFixed`], [`Method::Transpose`] | all angles, along the gradient of f | stops at the limit |
//! | [`Method::DampedLeastSquares`] | all angles, to the minimum of a quadratic model of f | solves for the other angles |
//! | [`Method::Ccd`] | one joint after the other | best angle within the limits |
//! | [`Method::Fabrik`] | points, from targets to roots and back | nearest angles within the limits; may stop short |
//! | [`Method::TwoBone`] | two joints, at once | stops short |
//!
//! A target out of reach is not an error: the chain straightens towards it and the solve stalls. Results
//! are deterministic.
//!
//! # What breaks
//!
//! - A solve stalls at a *local* minimum of f, which limits can cause away from the target.
//! - Near y = ±90° (gimbal lock) two of a joint's angles rotate about one axis; methods that move
//!   angles lose a direction there. CCD and FABRIK do not, without limits.
//! - A root that moves far from its start has an offset of single precision, seven digits.

mod align;
mod ccd;
mod configuration;
mod damped_least_squares;
mod error;
mod fabrik;
mod jacobian;
mod method;
mod method_state;
mod options;
mod perturb;
mod problem;
mod report;
mod solver;
mod stall;
mod target;
mod transpose;
mod two_bone;

pub use error::{OptionField, SolveError, TwoBoneRefusal};
pub use jacobian::jacobian;
pub use method::{Method, ParseMethodError};
pub use options::{Root, SolverOptions};
pub use report::{Report, Status};
pub use solver::{ChainSolver, solve};
pub use target::TipTarget;
