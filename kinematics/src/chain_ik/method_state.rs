use super::barzilai_borwein::BarzilaiBorwein;
use super::ccd::Ccd;
use super::configuration::Configuration;
use super::damped_least_squares::DampedLeastSquares;
use super::fabrik::Fabrik;
use super::inside::Recorder;
use super::problem::Problem;
use super::relaxation::Relaxation;
use super::transpose::Transpose;
use super::two_bone::TwoBones;
use super::{Method, SolveError, SolverOptions};
use crate::skeleton::Skeleton;

/// A method with the state that it keeps between iterations.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum MethodState {
    Transpose(Transpose),
    BarzilaiBorwein(BarzilaiBorwein),
    DampedLeastSquares(DampedLeastSquares),
    Ccd(Ccd),
    Fabrik(Fabrik),
    Relaxation(Relaxation),
    TwoBone(TwoBones),
}

impl MethodState {
    pub fn new(
        problem: &Problem,
        skeleton: &Skeleton,
        options: &SolverOptions,
    ) -> Result<Self, SolveError> {
        Ok(match options.method {
            Method::TransposeFixed => Self::Transpose(Transpose::new(problem, options.step)),
            Method::Transpose => Self::BarzilaiBorwein(BarzilaiBorwein::new(problem)),
            Method::DampedLeastSquares => {
                Self::DampedLeastSquares(DampedLeastSquares::new(problem, options.damping))
            }
            Method::Ccd => Self::Ccd(Ccd::new(problem)),
            Method::Fabrik => Self::Fabrik(Fabrik::new(problem)),
            Method::Relaxation => Self::Relaxation(Relaxation::new(problem)),
            Method::TwoBone => Self::TwoBone(TwoBones::new(problem, skeleton)?),
        })
    }

    /// Whether the method works on orientations instead of angles.
    pub fn uses_orientations(&self) -> bool {
        matches!(self, Self::Ccd(_) | Self::Fabrik(_) | Self::Relaxation(_))
    }

    /// Updates orientations that iterations leave behind the points that they move.
    pub fn update_orientations(&self, config: &mut Configuration) {
        match self {
            Self::Fabrik(fabrik) => fabrik.points().update_orientations(config),
            Self::Relaxation(relaxation) => relaxation.points().update_orientations(config),
            Self::Transpose(_)
            | Self::BarzilaiBorwein(_)
            | Self::DampedLeastSquares(_)
            | Self::Ccd(_)
            | Self::TwoBone(_) => {}
        }
    }

    /// Forgets what the method has kept from earlier iterations: step lengths that it has learnt,
    /// and points. Returns whether it keeps anything.
    pub fn restart(&mut self) -> bool {
        match self {
            Self::BarzilaiBorwein(descent) => {
                descent.restart();
                true
            }
            Self::DampedLeastSquares(damped) => {
                damped.restart();
                true
            }
            Self::Relaxation(relaxation) => relaxation.restart(),
            Self::Transpose(_) | Self::Ccd(_) | Self::Fabrik(_) | Self::TwoBone(_) => false,
        }
    }

    /// Makes one iteration. Returns whether another iteration could improve the result.
    pub fn iterate(
        &mut self,
        problem: &Problem,
        config: &mut Configuration,
        recorder: &mut Recorder,
    ) -> bool {
        match self {
            Self::Transpose(transpose) => {
                transpose.iterate(problem, config, recorder);
                true
            }
            Self::BarzilaiBorwein(descent) => descent.iterate(problem, config, recorder),
            Self::DampedLeastSquares(damped) => damped.iterate(problem, config, recorder),
            Self::Ccd(ccd) => {
                ccd.iterate(problem, config, recorder);
                true
            }
            Self::Fabrik(fabrik) => {
                fabrik.iterate(problem, config, recorder);
                true
            }
            Self::Relaxation(relaxation) => {
                relaxation.iterate(problem, config, recorder);
                true
            }
            Self::TwoBone(limbs) => {
                limbs.solve(problem, config, recorder);
                false
            }
        }
    }
}
