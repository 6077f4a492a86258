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
mod fabrik;
mod jacobian;
mod options;
mod perturb;
mod problem;
mod stall;
mod transpose;
mod two_bone;

use glam::{Mat3A, Quat, Vec3};

use super::skeleton::{Skeleton, nearest_angles};
use ccd::Ccd;
use configuration::Configuration;
use damped_least_squares::DampedLeastSquares;
use fabrik::Fabrik;
pub use jacobian::jacobian;
pub use options::{Method, ParseMethodError, Report, Root, SolveError, SolverOptions, TipTarget};
use problem::Problem;
use stall::Stall;
use transpose::Transpose;
use two_bone::TwoBones;

/// An iterative solve of a skeleton and its targets.
///
/// ```
/// use glam::Vec3;
/// use ik_arm::kinematics::skeleton::{Joint, JointId, Skeleton};
/// use ik_arm::kinematics::chain_ik::{SolverOptions, ChainSolver, TipTarget};
///
/// let mut skeleton = Skeleton::with_root("root");
/// let upper = skeleton.add(Joint::new("upper", Some(JointId::new(0)), Vec3::Y))?;
/// let lower = Joint { offset: Vec3::Y, ..Joint::new("lower", Some(upper), Vec3::Y) };
/// let lower = skeleton.add(lower)?;
///
/// let target = TipTarget { joint: lower, point: Vec3::new(1.0, 0.5, 0.0), weight: 1.0 };
/// let mut solve = ChainSolver::new(&skeleton, &[target], &SolverOptions::default())?;
/// assert!(solve.run().converged);
/// solve.write(&mut skeleton);
/// assert!(skeleton.tip(lower).distance(target.point) < 1e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ChainSolver {
    report: Report,
    budget: u32,
    /// In the world.
    tolerance: f64,
    rig: Problem,
    pose: Configuration,
    /// Before the solve.
    start: Configuration,
    worker: Worker,
    rest: Stall,
}

/// What each method keeps.
#[derive(Clone, Debug, PartialEq)]
enum Worker {
    Transpose(Transpose),
    DampedLeastSquares(DampedLeastSquares),
    Ccd(Ccd),
    Fabrik(Fabrik),
    TwoBone(TwoBones),
}

impl ChainSolver {
    /// Prepares a solve; no iteration is made.
    ///
    /// # Errors
    ///
    /// See [`SolveError`].
    pub fn new(
        skeleton: &Skeleton,
        targets: &[TipTarget],
        options: &SolverOptions,
    ) -> Result<Self, SolveError> {
        options.check()?;
        let rig = Problem::new(skeleton, targets, options)?;
        let tolerance = options.tolerance.map_or(1e-4 * rig.world_length(), f64::from);
        let worker = Worker::new(&rig, skeleton, options)?;
        let mut pose = Configuration::new(&rig);
        if worker.turns_without_angles() {
            pose.turn();
        }
        let rest = Stall::new(options.method, rig.to_rig(tolerance), &pose);
        let report = Report {
            method: options.method,
            iterations: 0,
            error: 0.0,
            converged: false,
            resting: false,
        };
        let budget = options.iterations.unwrap_or(options.method.budget());
        let start = pose.clone();
        let mut solve = Self { report, budget, tolerance, rig, pose, start, worker, rest };
        solve.aim(targets);
        Ok(solve)
    }

    /// Progress so far.
    pub fn report(&self) -> Report {
        self.report
    }

    /// Makes one iteration, unless the solve has converged or stalled.
    pub fn step(&mut self) -> Report {
        if self.is_done() {
            return self.report;
        }
        if self.report.iterations == 0 {
            self.bend();
        }
        let moved = self.worker.iterate(&self.rig, &mut self.pose);
        self.report.iterations += 1;
        self.measure();
        if !self.report.converged && (!moved || self.rest.watch(&self.rig, &self.pose)) {
            self.come_to_rest();
        }
        self.report
    }

    /// Iterates until the solve converges, stalls or is out of iterations.
    pub fn run(&mut self) -> Report {
        while !self.is_over() {
            self.step();
        }
        self.report
    }

    /// Whether the solve has converged, stalled or is out of iterations.
    pub fn is_over(&self) -> bool {
        self.is_done() || self.report.iterations >= self.budget
    }

    /// Moves the targets of the same joints, in the same order and with the same weights, and restarts
    /// from the current pose with no iterations made.
    ///
    /// # Errors
    ///
    /// [`SolveError::NoJoint`] for other joints; [`SolveError::Point`]; [`SolveError::Weight`].
    pub fn retarget(&mut self, targets: &[TipTarget]) -> Result<(), SolveError> {
        for (index, goal) in self.rig.goals.iter().enumerate() {
            if targets.get(index).map(|target| target.joint) != Some(goal.joint) {
                return Err(SolveError::NoJoint(
                    targets.get(index).map_or(goal.joint, |t| t.joint),
                ));
            }
        }
        if let Some(more) = targets.get(self.rig.goals.len()) {
            return Err(SolveError::NoJoint(more.joint));
        }
        for target in targets {
            problem::check_numbers(target.joint, target.point, target.weight)?;
        }
        self.aim(targets);
        Ok(())
    }

    /// Writes the solved angles, each triple nearest to the present one, and the offsets of free roots
    /// into the skeleton of the solve.
    pub fn write(&self, skeleton: &mut Skeleton) {
        if self.rig.free {
            for (index, tree) in self.rig.trees.iter().enumerate() {
                let offset = self.rig.root_offset(index, self.pose.shift[index]);
                skeleton.turn(tree.root, |root| root.offset = offset);
            }
        } else if self.pose.is_like(&self.start) {
            // As they were, bit for bit, also where they have been written otherwise since.
            for body in &self.rig.bodies {
                skeleton.turn(body.joint, |joint| joint.rotation = body.start);
            }
            return;
        }
        let near = |body: usize| {
            let joint = skeleton.joint(self.rig.bodies[body].joint);
            joint.map_or(Vec3::ZERO, |joint| joint.rotation)
        };
        let angles = self.angles(near);
        for (body, angles) in self.rig.bodies.iter().zip(angles) {
            skeleton.turn(body.joint, |joint| joint.rotation = angles);
        }
    }

    fn is_done(&self) -> bool {
        self.report.converged || self.report.resting
    }

    fn aim(&mut self, targets: &[TipTarget]) {
        if self.rig.free {
            self.rig.approach(targets, &self.pose.tips);
        } else {
            self.rig.aim(targets);
        }
        self.report.iterations = 0;
        self.report.resting = false;
        self.measure();
        self.rest.mark(&self.rig, &self.pose);
    }

    fn measure(&mut self) {
        let error = self.pose.error(&self.rig);
        self.report.error = error.min(f64::from(f32::MAX)) as f32;
        self.report.converged = error <= self.tolerance;
    }

    /// Before the first iteration: see [`bend`].
    fn bend(&mut self) {
        let is_closed_form = matches!(self.worker, Worker::TwoBone(_));
        if is_closed_form || self.rig.free || !perturb::is_stuck(&self.rig, &self.pose) {
            return;
        }
        let without_angles = self.worker.turns_without_angles();
        if without_angles {
            self.pose.angles = self.angles(|body| self.pose.angles[body]);
            self.pose.forward(&self.rig);
        }
        perturb::bend(&self.rig, &mut self.pose);
        self.pose.forward(&self.rig);
        if without_angles {
            self.pose.turn();
        }
    }

    /// Goes back to where something got better last. Rests there if the method, begun anew, would
    /// not get on either: then another solve from there changes nothing.
    fn come_to_rest(&mut self) {
        if matches!(self.worker, Worker::TwoBone(_)) {
            self.report.resting = true;
            return;
        }
        self.pose.copy(&self.rest.pose);
        self.measure();
        self.report.resting = self.rest.renewed || !self.worker.renew();
        self.rest.since = 0;
        self.rest.renewed = true;
    }

    /// Of every body, near given ones.
    fn angles(&self, near: impl Fn(usize) -> Vec3) -> Vec<Vec3> {
        let settled;
        let turned = match &self.worker {
            Worker::Fabrik(fabrik) => {
                settled = fabrik.settle(&self.pose);
                &settled
            }
            _ => &self.pose.turned,
        };
        let angles_of = |index: usize| {
            let body = &self.rig.bodies[index];
            if body.is_limited() || turned.is_empty() {
                return self.pose.angles[index];
            }
            let above = body.parent.map_or(Quat::IDENTITY, |parent| turned[parent]);
            let mounted = Mat3A::from_quat(above) * body.mount;
            nearest_angles(mounted.transpose() * Mat3A::from_quat(turned[index]), near(index))
        };
        (0..self.rig.bodies.len()).map(angles_of).collect()
    }
}

impl Worker {
    fn new(
        rig: &Problem,
        skeleton: &Skeleton,
        options: &SolverOptions,
    ) -> Result<Self, SolveError> {
        Ok(match options.method {
            Method::TransposeFixed => Self::Transpose(Transpose::new(rig, options.step, false)),
            Method::Transpose => Self::Transpose(Transpose::new(rig, 1.0, true)),
            Method::DampedLeastSquares => {
                Self::DampedLeastSquares(DampedLeastSquares::new(rig, options.damping))
            }
            Method::Ccd => Self::Ccd(Ccd::new(rig)),
            Method::Fabrik => Self::Fabrik(Fabrik::new(rig)),
            Method::TwoBone => Self::TwoBone(TwoBones::new(rig, skeleton)?),
        })
    }

    fn turns_without_angles(&self) -> bool {
        matches!(self, Self::Ccd(_) | Self::Fabrik(_))
    }

    /// Forgets what was learnt about steps. Whether it learns.
    fn renew(&mut self) -> bool {
        match self {
            Self::Transpose(transpose) => transpose.renew(),
            Self::DampedLeastSquares(damped) => {
                damped.renew();
                true
            }
            Self::Ccd(_) | Self::Fabrik(_) | Self::TwoBone(_) => false,
        }
    }

    /// Whether another iteration could do more.
    fn iterate(&mut self, rig: &Problem, pose: &mut Configuration) -> bool {
        match self {
            Self::Transpose(transpose) => transpose.iterate(rig, pose),
            Self::DampedLeastSquares(damped) => damped.iterate(rig, pose),
            Self::Ccd(ccd) => {
                ccd.iterate(rig, pose);
                true
            }
            Self::Fabrik(fabrik) => {
                fabrik.iterate(rig, pose);
                true
            }
            Self::TwoBone(pairs) => {
                pairs.solve(rig, pose);
                false
            }
        }
    }
}

/// Solves a skeleton in place with a new [`ChainSolver`].
///
/// # Errors
///
/// See [`SolveError`].
pub fn solve(
    skeleton: &mut Skeleton,
    targets: &[TipTarget],
    options: &SolverOptions,
) -> Result<Report, SolveError> {
    let mut solve = ChainSolver::new(skeleton, targets, options)?;
    let report = solve.run();
    solve.write(skeleton);
    Ok(report)
}
