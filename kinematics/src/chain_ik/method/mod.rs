//! Methods of solvers: one row of [`METHODS`] and one file for each.

mod ccd;
mod damped_least_squares;
mod fabrik;
mod points;
mod relaxation;
mod transpose;
mod two_bone;

use core::fmt;
use core::str::FromStr;

use thiserror::Error;

use self::ccd::Ccd;
pub(super) use self::damped_least_squares::{DampedLeastSquares, hold_in_cone};
use self::fabrik::Fabrik;
use self::relaxation::Relaxation;
use self::transpose::{Transpose, TransposeFixed};
pub use self::two_bone::TwoBoneRefusal;
use self::two_bone::TwoBones;
pub(super) use self::two_bone::TwoBonesRefused;
use super::configuration::Configuration;
use super::inside::Recorder;
use super::problem::{ChainTarget, EndEffector, Link, Orientation, Problem};
use super::stall::Patience;
use crate::skeleton::{JointId, Skeleton};

/// Method of a [`ChainSolver`](super::ChainSolver).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "String", into = "&'static str")
)]
pub enum Method {
    /// Jacobian transpose with a fixed step length.
    TransposeFixed,
    /// Jacobian transpose with a variable step length (Barzilai and Borwein).
    Transpose,
    /// Damped least squares (Levenberg–Marquardt).
    DampedLeastSquares,
    /// Cyclic coordinate descent.
    Ccd,
    /// Forward and backward reaching (FABRIK).
    #[default]
    Fabrik,
    /// Constraint relaxation: the length of each bone is restored in turn by moving both of its
    /// ends.
    Relaxation,
    /// Closed form for two joints: a target's joint and its parent.
    TwoBone,
}

/// What a method cannot do to turn a joint to an [`Orientation`](super::Orientation).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum OrientRefusal {
    /// Turn a joint to an orientation at all.
    Any,
    /// Aim an axis at a point.
    Aim,
    /// Turn a joint whose tip may be anywhere: a target with the weight 0.
    FreePlace,
    /// Turn a joint by hinges alone: no joint from the target's to the root has more than one angle
    /// that its limits let change.
    Hinges,
}

impl OrientRefusal {
    /// What a method cannot do with this joint, after "cannot".
    pub(super) fn of_joint(self, joint: JointId) -> String {
        match self {
            Self::Any => format!("turn joint {joint} to an orientation"),
            Self::Aim => format!("aim joint {joint} at a point"),
            Self::FreePlace => format!("turn joint {joint} while its place is free"),
            Self::Hinges => format!("turn joint {joint} to an orientation by hinges alone"),
        }
    }
}

/// Names, defaults and abilities of a method, and the function that prepares it.
pub(super) struct MethodRow {
    method: Method,
    name: &'static str,
    title: &'static str,
    short_title: &'static str,
    summary: &'static str,
    /// Default maximum number of iterations.
    budget: u32,
    pub patience: Patience,
    uses_damping: bool,
    uses_step: bool,
    is_closed_form: bool,
    /// What the method cannot do to turn joints to orientations.
    refused: &'static [OrientRefusal],
    /// True if the method moves a centre of mass. The fixed step would need too many iterations: it
    /// reaches 29 of 100 random places of tips and centre together, the others 89 and more.
    can_balance: bool,
    /// The stiffness of joints that the method respects.
    stiffness: ReadStiffness,
    /// True if the method works on orientations instead of angles.
    pub uses_orientations: bool,
    /// Distance of a target from the root, in lengths of the path to the tip, up to which the
    /// iteration is stable; infinite if it always is.
    pub stable_distance: f64,
    /// Work of one iteration: the joints and the pairs of a joint and a target that it visits, or
    /// what takes as long.
    pub work: fn(&Problem) -> u64,
    prepare: fn(&MethodInputs<'_>) -> Result<MethodState, TwoBonesRefused>,
}

/// The stiffness of joints that a method respects.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ReadStiffness {
    /// Each angle's own.
    PerAngle,
    /// One for all angles of a joint that can change.
    PerJoint,
    /// None; the closed form refuses stiff joints by itself, and only those of its limbs.
    Never,
}

/// Inputs of the first iteration of any method.
pub(super) struct MethodInputs<'a> {
    pub problem: &'a Problem,
    pub skeleton: &'a Skeleton,
    /// Initial damping λ, in chain lengths.
    pub damping: f32,
    /// Step length of the fixed step.
    pub step: f32,
}

impl MethodRow {
    /// A method on angles without parameters that is always stable.
    const fn new(
        method: Method,
        name: &'static str,
        budget: u32,
        prepare: fn(&MethodInputs<'_>) -> Result<MethodState, TwoBonesRefused>,
    ) -> Self {
        Self {
            method,
            name,
            title: name,
            short_title: name,
            summary: name,
            budget,
            patience: Patience::of_repeated_steps(20),
            uses_damping: false,
            uses_step: false,
            is_closed_form: false,
            refused: &[OrientRefusal::Any],
            can_balance: false,
            stiffness: ReadStiffness::PerAngle,
            uses_orientations: false,
            stable_distance: f64::INFINITY,
            work: visits,
            prepare,
        }
    }
}

impl MethodRow {
    /// True if the method respects one stiffness for each joint.
    pub fn respects_joints(&self) -> bool {
        self.stiffness != ReadStiffness::Never
    }
}

/// All methods, in the order in which lists show them.
const METHODS: [MethodRow; 7] = [
    MethodRow {
        title: "Jacobian transpose, fixed step",
        short_title: "Fixed step",
        summary: "Descend the gradient with a fixed step: smooth but slow",
        // The fixed step overshoots for longer before it settles.
        patience: Patience::of_repeated_steps(100),
        uses_step: true,
        // It reaches 63 to 83 % of the poses of robot arms, whose joints are hinges.
        refused: &[OrientRefusal::Hinges],
        // Up to about twice the distance; the direction is all that counts of a target out of
        // reach.
        stable_distance: 1.25,
        ..MethodRow::new(Method::TransposeFixed, "transpose-fixed", 4_000, |it| {
            Ok(MethodState::TransposeFixed(TransposeFixed::new(it.problem, it.step)))
        })
    },
    MethodRow {
        title: "Jacobian transpose",
        short_title: "Transpose",
        summary: "Descend the gradient with steps that fit its curvature",
        refused: &[],
        can_balance: true,
        ..MethodRow::new(Method::Transpose, "transpose", 500, |it| {
            Ok(MethodState::Transpose(Transpose::new(it.problem)))
        })
    },
    MethodRow {
        title: "Damped least squares",
        short_title: "Damped l. s.",
        summary: "Solve damped least squares: few iterations, handles limits and many targets",
        uses_damping: true,
        refused: &[],
        can_balance: true,
        work: |problem| visits(problem) + damped_least_squares::work(problem),
        ..MethodRow::new(Method::DampedLeastSquares, "dls", 500, |it| {
            let damped = DampedLeastSquares::new(it.problem, it.damping);
            Ok(MethodState::DampedLeastSquares(damped))
        })
    },
    MethodRow {
        title: "Cyclic coordinate descent",
        short_title: "CCD",
        summary: "Rotate one joint at a time, tip to root: cheap, bends tips",
        // In exact arithmetic no sweep increases the distance.
        patience: Patience::of_orientations(20, -(f32::EPSILON as f64)),
        refused: &[],
        can_balance: true,
        stiffness: ReadStiffness::PerJoint,
        uses_orientations: true,
        ..MethodRow::new(Method::Ccd, "ccd", 2_000, |it| Ok(MethodState::Ccd(Ccd::new(it.problem))))
    },
    MethodRow {
        title: "FABRIK",
        short_title: "FABRIK",
        summary: "Move joint positions along the chain: very cheap, may stall at limits",
        refused: &[OrientRefusal::Aim, OrientRefusal::FreePlace],
        stiffness: ReadStiffness::PerJoint,
        // With conflicting targets, FABRIK converges near the minimum, not at it.
        patience: Patience::of_orientations(20, -1e-5),
        uses_orientations: true,
        ..MethodRow::new(Method::Fabrik, "fabrik", 2_000, |it| {
            Ok(MethodState::Fabrik(Fabrik::new(it.problem)))
        })
    },
    MethodRow {
        title: "Constraint relaxation",
        short_title: "Relaxation",
        summary: "Move both ends of each bone in turn: smooth, many iterations",
        stiffness: ReadStiffness::Never,
        // The poses that points of relaxation give are not nearer after every pass.
        patience: Patience::of_orientations(100, f64::INFINITY),
        uses_orientations: true,
        ..MethodRow::new(Method::Relaxation, "relaxation", 2_000, |it| {
            Ok(MethodState::Relaxation(Relaxation::new(it.problem)))
        })
    },
    MethodRow {
        title: "Two-bone",
        short_title: "Two-bone",
        summary: "Solve the target's joint and its parent in closed form",
        is_closed_form: true,
        stiffness: ReadStiffness::Never,
        ..MethodRow::new(Method::TwoBone, "two-bone", 1, |it| {
            Ok(MethodState::TwoBone(TwoBones::new(it.problem, it.skeleton)?))
        })
    },
];

// Each row is where `Method::row` looks for it.
const _: () = {
    let mut index = 0;
    while index < METHODS.len() {
        let method = METHODS[index].method;
        assert!(method as usize == index && method.row().method as usize == index);
        index += 1;
    }
};

impl Method {
    /// All methods.
    pub const ALL: [Self; METHODS.len()] = {
        let mut all = [Self::Fabrik; METHODS.len()];
        let mut index = 0;
        while index < all.len() {
            all[index] = METHODS[index].method;
            index += 1;
        }
        all
    };

    /// A method without a row does not compile.
    pub(super) const fn row(self) -> &'static MethodRow {
        match self {
            Self::TransposeFixed => &METHODS[0],
            Self::Transpose => &METHODS[1],
            Self::DampedLeastSquares => &METHODS[2],
            Self::Ccd => &METHODS[3],
            Self::Fabrik => &METHODS[4],
            Self::Relaxation => &METHODS[5],
            Self::TwoBone => &METHODS[6],
        }
    }

    /// Name on screen.
    pub const fn title(self) -> &'static str {
        self.row().title
    }

    /// Name on screen where there is little space.
    pub const fn short_title(self) -> &'static str {
        self.row().short_title
    }

    /// A short description that begins with a verb.
    pub const fn summary(self) -> &'static str {
        self.row().summary
    }

    /// Name on the command line and in files.
    pub const fn name(self) -> &'static str {
        self.row().name
    }

    /// Default maximum number of iterations of [`ChainSolver::run`](super::ChainSolver::run).
    pub const fn budget(self) -> u32 {
        self.row().budget
    }

    /// True if the method reads [`SolverOptions::damping`](super::SolverOptions::damping).
    pub const fn uses_damping(self) -> bool {
        self.row().uses_damping
    }

    /// True if the method reads [`SolverOptions::step`](super::SolverOptions::step).
    pub const fn uses_step(self) -> bool {
        self.row().uses_step
    }

    /// True if the method turns joints to an [`Orientation`](super::Orientation); some orientations
    /// it may [refuse](Method::refuses).
    pub fn can_orient(self) -> bool {
        !self.refuses(OrientRefusal::Any)
    }

    /// True if the method cannot do this to turn a joint.
    pub fn refuses(self, reason: OrientRefusal) -> bool {
        let refused = self.row().refused;
        refused.contains(&OrientRefusal::Any) || refused.contains(&reason)
    }

    /// Why the method cannot turn the joint of a target, whatever its skeleton is; `None` if it can
    /// or need not.
    pub(crate) fn refusal_of(self, target: &ChainTarget) -> Option<OrientRefusal> {
        let is_aim = matches!(target.orientation?, Orientation::Aim { .. });
        let reasons = [
            (OrientRefusal::Any, true),
            (OrientRefusal::Aim, is_aim),
            (OrientRefusal::FreePlace, target.weight == 0.0),
        ];
        let refused = reasons.into_iter().filter(|(_, applies)| *applies);
        refused.map(|(reason, _)| reason).find(|reason| self.row().refused.contains(reason))
    }

    /// True if the method moves a [centre of mass](super::Effector::CentreOfMass).
    pub const fn can_balance(self) -> bool {
        self.row().can_balance
    }

    /// True if one iteration is all: the method solves limbs of two bones at once and refuses
    /// others.
    pub const fn is_closed_form(self) -> bool {
        self.row().is_closed_form
    }
}

/// The names of the methods that turn joints to orientations where others refuse it.
pub(super) fn orienting_methods(refused: OrientRefusal) -> String {
    let can_orient = Method::ALL.into_iter().filter(|method| !method.refuses(refused));
    can_orient.map(Method::name).collect::<Vec<_>>().join(", ")
}

/// The names of the methods that move a centre of mass.
pub(super) fn balancing_methods() -> String {
    let can_balance = Method::ALL.into_iter().filter(|method| method.can_balance());
    can_balance.map(Method::name).collect::<Vec<_>>().join(", ")
}

/// The joint of the first target that a method cannot turn to its orientation, since all joints
/// between it and its root are hinges.
pub(super) fn turned_by_hinges(
    method: Method,
    problem: &Problem,
    targets: &[ChainTarget],
) -> Option<JointId> {
    if !method.refuses(OrientRefusal::Hinges) {
        return None;
    }
    let is_on_hinges = |effector: &EndEffector| {
        let first = effector.link.map(|link| &problem.links[link]);
        let mut above = std::iter::successors(first, |link| Some(&problem.links[link.parent?]));
        first.is_some() && above.all(Link::is_hinge)
    };
    let mut effectors = problem.effectors.iter().zip(targets);
    let turned = effectors.find(|(it, target)| target.orientation.is_some() && is_on_hinges(it));
    turned.map(|(effector, _)| effector.joint)
}

/// The first link of a problem whose stiffness a method cannot respect.
pub(super) fn too_stiff(method: Method, problem: &Problem) -> Option<&Link> {
    let respects = |link: &&Link| match method.row().stiffness {
        ReadStiffness::PerAngle => true,
        ReadStiffness::PerJoint => link.uniform_compliance().is_some(),
        ReadStiffness::Never => method.is_closed_form() || !link.is_stiff(),
    };
    problem.links.iter().find(|link| !respects(link))
}

/// The names of the methods that respect a stiffness of each angle, or only one for each joint.
pub(super) fn methods_with_stiffness(per_angle: bool) -> String {
    let respects = |method: &Method| match method.row().stiffness {
        ReadStiffness::PerAngle => true,
        ReadStiffness::PerJoint => !per_angle,
        ReadStiffness::Never => false,
    };
    let respecting = Method::ALL.into_iter().filter(respects);
    respecting.map(Method::name).collect::<Vec<_>>().join(", ")
}

/// The joints and the pairs of a joint and a target.
fn visits(problem: &Problem) -> u64 {
    problem.links.len() as u64 + problem.below.len() as u64
}

/// Writes the [name](Method::name).
impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// Reads a [name](Method::name).
impl FromStr for Method {
    type Err = ParseMethodError;

    fn from_str(name: &str) -> Result<Self, ParseMethodError> {
        let found = Self::ALL.into_iter().find(|method| method.name() == name);
        found.ok_or_else(|| ParseMethodError(name.to_owned()))
    }
}

#[cfg(feature = "serde")]
impl TryFrom<String> for Method {
    type Error = ParseMethodError;

    fn try_from(name: String) -> Result<Self, ParseMethodError> {
        name.parse()
    }
}

#[cfg(feature = "serde")]
impl From<Method> for &'static str {
    fn from(method: Method) -> Self {
        method.name()
    }
}

/// Error for a text that is not the [name](Method::name) of a method.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("must be one of {names}, got {0:?}", names = Method::ALL.map(Method::name).join(", "))]
pub struct ParseMethodError(String);

/// A method with the state that it keeps between iterations.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum MethodState {
    TransposeFixed(TransposeFixed),
    Transpose(Transpose),
    DampedLeastSquares(DampedLeastSquares),
    Ccd(Ccd),
    Fabrik(Fabrik),
    Relaxation(Relaxation),
    TwoBone(TwoBones),
}

impl MethodState {
    pub fn new(method: Method, inputs: &MethodInputs<'_>) -> Result<Self, TwoBonesRefused> {
        (method.row().prepare)(inputs)
    }

    /// Makes one iteration. Returns whether another iteration could improve the result.
    pub fn iterate(
        &mut self,
        problem: &Problem,
        config: &mut Configuration,
        recorder: &mut Recorder,
    ) -> bool {
        match self {
            Self::TransposeFixed(transpose) => transpose.iterate(problem, config, recorder),
            Self::Transpose(descent) => descent.iterate(problem, config, recorder),
            Self::DampedLeastSquares(damped) => damped.iterate(problem, config, recorder),
            Self::Ccd(ccd) => ccd.iterate(problem, config, recorder),
            Self::Fabrik(fabrik) => fabrik.iterate(problem, config, recorder),
            Self::Relaxation(relaxation) => relaxation.iterate(problem, config, recorder),
            Self::TwoBone(limbs) => limbs.iterate(problem, config, recorder),
        }
    }

    /// Fits the method to a problem with other lengths, weights, mounts or limits of the same
    /// links; [restart](Self::restart) it then. `damping` and `step` are those of the solver's
    /// options.
    pub fn refit(
        &mut self,
        problem: &Problem,
        config: &Configuration,
        damping: f32,
        step: f32,
    ) -> Result<(), TwoBonesRefused> {
        match self {
            Self::TransposeFixed(transpose) => transpose.refit(problem, config, step),
            Self::Transpose(descent) => descent.refit(problem),
            Self::DampedLeastSquares(damped) => damped.refit(problem, damping),
            Self::Ccd(ccd) => ccd.refit(problem),
            Self::Fabrik(fabrik) => fabrik.refit(problem),
            Self::Relaxation(relaxation) => relaxation.refit(problem),
            Self::TwoBone(limbs) => limbs.refit(problem)?,
        }
        Ok(())
    }

    /// Updates orientations that iterations leave behind the points that they move.
    pub fn update_orientations(&self, config: &mut Configuration) {
        match self {
            Self::Fabrik(fabrik) => fabrik.update_orientations(config),
            Self::Relaxation(relaxation) => relaxation.update_orientations(config),
            Self::TransposeFixed(_)
            | Self::Transpose(_)
            | Self::DampedLeastSquares(_)
            | Self::Ccd(_)
            | Self::TwoBone(_) => {}
        }
    }

    /// Forgets what the method has kept from earlier iterations: step lengths that it has learnt,
    /// and points. Returns whether it keeps anything.
    pub fn restart(&mut self) -> bool {
        match self {
            Self::Transpose(descent) => descent.restart(),
            Self::DampedLeastSquares(damped) => damped.restart(),
            Self::Relaxation(relaxation) => relaxation.inward.restart(),
            Self::TransposeFixed(_) | Self::Ccd(_) | Self::Fabrik(_) | Self::TwoBone(_) => false,
        }
    }
}
