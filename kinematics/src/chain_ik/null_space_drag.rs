//! Dragging in the null space: a point goes as near to a place as the targets of other joints let it,
//! which stay reached.
//!
//! With J₁ the Jacobian of the held targets, J₂ that of the dragged point and e₂ the way to its
//! place, both in coordinates of equal effort (angles times 1/√(1 − k) for the stiffness k), a step
//! is
//!
//! ```text
//! N = I − J₁ᵀ (J₁ J₁ᵀ)⁻¹ J₁        Δ₁ = J₁ᵀ (J₁ J₁ᵀ)⁻¹ r        B = J₂ N
//! Δ = Δ₁ + Bᵀ (B Bᵀ + μ²I)⁻¹ (e₂ − J₂ Δ₁)
//! ```
//!
//! r is the room of held places that are [reached at several distances](ChainTarget::distances) and
//! would leave them; 0 for others. Angles that would cross a limit are fixed, and the step is solved
//! again. Iterations of damped least squares then bring the held targets back, from which the step
//! leads away by its curvature. A step that does not come nearer is made again with more damping μ.
//!
//! For two bones whose tip is held, the dragged middle goes around the circle of elbows.
//!
//! # Source
//!
//! P. Baerlocher, R. Boulic, *An inverse kinematics architecture enforcing an arbitrary number of
//! strict priority levels*, 2004.

use glam::{DAffine3, DVec3, Mat3A, Vec3, Vec3A};
use nalgebra::{Cholesky, DMatrix, DVector, Dyn, Matrix3};

use super::configuration::{Configuration, Coordinates};
use super::inside::{Ellipsoid, Recorder};
use super::jacobian::advance;
use super::method::{DampedLeastSquares, hold_in_cone};
use super::problem::{Builder, EndEffector, HeldLimb, Link, Problem};
use super::{ChainTarget, Method, Root, SolveError, SolverOptions};
use crate::normalize;
use crate::skeleton::{JointId, RotationAxis, Skeleton};
use crate::vector::saturate;

/// The least damping μ, in chain lengths; singular values of B below it do not count.
const CUT: f64 = 1e-3;
/// Singular values of J₁ below this many chain lengths do not count: much less than `CUT`, so that no
/// part of J₁ is left in B.
const HELD_CUT: f64 = 1e-6;
/// Distance of held targets, in chain lengths, to which they are brought back.
const HELD: f64 = 1e-6;

/// A drag of a point of a skeleton whose targets stay reached.
///
/// ```
/// use glam::Vec3;
/// use ik_arm_kinematics::chain_ik::{ChainTarget, NullSpaceDrag, Root};
/// use ik_arm_kinematics::skeleton::{Joint, JointId, Skeleton};
///
/// let mut arm = Skeleton::with_root("shoulder");
/// let upper = arm.add(Joint::new("upper", Some(JointId::new(0)), Vec3::Y))?;
/// let lower = Joint { offset: Vec3::Y, ..Joint::new("lower", Some(upper), Vec3::X) };
/// let lower = arm.add(lower)?;
///
/// let hand = ChainTarget::at(lower, arm.tip(lower));
/// let elbow = ChainTarget::at(upper, Vec3::new(0.5, 0.5, 2.0));
/// let mut drag = NullSpaceDrag::new(&arm, &[hand], elbow, Root::Turns)?;
/// drag.run();
/// drag.write(&mut arm);
/// assert!(arm.tip(lower).distance(hand.point) < 1e-5, "the hand stays");
/// let nearest = Vec3::new(0.5, 0.5, 0.5_f32.sqrt());
/// assert!(arm.tip(upper).distance(nearest) < 1e-4, "the elbow is on its circle");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct NullSpaceDrag {
    /// The held targets, then the dragged point with the weight 0.
    problem: Problem,
    config: Configuration,
    /// Position to which the point is dragged.
    place: DVec3,
    restoring: DampedLeastSquares,
    to_world: DAffine3,
}

/// The result of a drag.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DragReport {
    /// Distance in the world from the dragged point to its place.
    pub distance: f32,
    /// Largest distance in the world from a held tip to its target.
    pub held_error: f32,
    /// Number of steps, those included that did not come nearer.
    pub steps: u32,
}

impl NullSpaceDrag {
    /// Prepares a drag of a point from the pose that `skeleton` has, in which the `held` targets are
    /// reached: those that are not are brought as near as they can be. `dragged` is the place of the
    /// tip or grip of a joint; its weight and its orientation are not read.
    ///
    /// # Errors
    ///
    /// See [`SolveError`].
    pub fn new(
        skeleton: &Skeleton,
        held: &[ChainTarget],
        dragged: ChainTarget,
        root: Root,
    ) -> Result<Self, SolveError> {
        Self::with_limbs(skeleton, held, &[], dragged, root)
    }

    /// [`NullSpaceDrag::new`] for a held centre of mass of a body with limbs whose tips are held.
    pub(crate) fn with_limbs(
        skeleton: &Skeleton,
        held: &[ChainTarget],
        limbs: &[HeldLimb],
        dragged: ChainTarget,
        root: Root,
    ) -> Result<Self, SolveError> {
        let dragged = ChainTarget { weight: 1.0, orientation: None, ..dragged };
        let targets = [held, &[dragged]].concat();
        let options = SolverOptions::new(Method::DampedLeastSquares).with_root(root);
        let mut problem = Problem::default();
        let mut builder = Builder::new(skeleton, &targets, &options)?;
        builder.held_limbs.extend_from_slice(limbs);
        builder.fill(&mut problem, skeleton, &targets)?;
        let place = problem.effectors[held.len()].target.as_dvec3();
        problem.effectors[held.len()].weight = 0.0;
        let (config, to_world) = (Configuration::new(&problem), skeleton.transform().as_daffine3());
        let restoring = DampedLeastSquares::new(&problem, CUT as f32);
        Ok(Self { problem, config, place, restoring, to_world })
    }

    /// Moves the point as near to its place as it comes, in skeleton space.
    pub fn run(&mut self) -> DragReport {
        /// Most steps, those included that do not come nearer.
        const STEPS: u32 = 200;
        const GROWTH: f64 = 4.0;
        /// Increase of the distance, in chain lengths, that held targets cause which are not quite at
        /// their places.
        const ROUNDING: f64 = 1e-5;
        /// Longest way to the place that a step sees, in chain lengths.
        const MOST_SIGHT: f64 = 0.3;
        /// Way of the point in a step, as a part of the way that it sees, below which the point has
        /// come as near as it can.
        const RESTS: f64 = 3e-7;
        /// Damping, in chain lengths, with which steps are below rounding.
        const MOST: f64 = 1e3;
        let length = f64::from(self.problem.length);
        self.restore();
        let (mut distance, mut damping, mut steps) = (self.distance(), CUT, 0);
        let mut sight = MOST_SIGHT;
        let mut before = self.config.clone();
        let mut last_way = DVec3::ZERO;
        while steps < STEPS && damping < MOST && distance > HELD * length {
            let Some(step) = self.step(damping * length, sight * length) else { break };
            steps += 1;
            before.copy_from(&self.config);
            let (mut from, way_before) = (Coordinates::default(), self.way());
            from.copy_from(&self.config);
            advance(&self.problem, &from, &step, 1.0, &mut self.config);
            self.restore();
            let way = way_before - self.way();
            if self.distance() > distance + ROUNDING * length || !self.is_held() {
                self.config.copy_from(&before);
                damping *= GROWTH;
                continue;
            }
            distance = self.distance();
            damping = (damping / GROWTH).max(CUT);
            if way.length() < RESTS * sight * length && damping == CUT {
                break;
            }
            // The farther a place is from the surface on which the point can be, the more do steps
            // along the surface lead too far: the point goes to and fro.
            let returns = way.dot(last_way) < 0.0;
            sight = if returns { 0.5 * sight } else { (1.5 * sight).min(MOST_SIGHT) };
            last_way = way;
        }
        let held_error = saturate(self.config.error(&self.problem));
        let distance = saturate(self.problem.length_to_world(distance));
        DragReport { distance, held_error, steps }
    }

    /// Velocities of the dragged point that the held targets leave it, with the angles turning at
    /// unit speed in all: an ellipsoid in the world, flat or a line where it cannot go everywhere.
    /// Values below a thousandth of the chain's length are 0.
    pub fn freedom(&self) -> Ellipsoid {
        let rows = Rows::new(&self.problem, &self.config, &self.config.axes);
        let effector = self.dragged();
        let centre = self.problem.point_in_skeleton(effector.tree, self.config.tips[self.index()]);
        let columns = rows.free(&rows.held(&self.counted())).map(|(free, _)| free);
        let columns = columns.unwrap_or_else(|| rows.dragged());
        let scale = self.to_world.matrix3 / self.problem.unit();
        let columns = columns
            .column_iter()
            .map(|column| (scale * DVec3::new(column[0], column[1], column[2])).as_vec3());
        let centre = self.to_world.transform_point3(centre).as_vec3();
        let mut ellipsoid = Ellipsoid::of(effector.joint, centre, columns);
        let least = (CUT * self.problem.world_length()) as f32;
        ellipsoid.values.iter_mut().filter(|value| **value < least).for_each(|it| *it = 0.0);
        ellipsoid
    }

    /// Euler angles in radians of the joints that the drag turns, within their limits.
    pub fn angles(&self) -> impl Iterator<Item = (JointId, Vec3)> {
        self.problem.links.iter().zip(&self.config.angles).map(|(link, it)| (link.joint, *it))
    }

    /// The joints that the drag turns or moves.
    pub fn joints(&self) -> impl Iterator<Item = JointId> {
        let roots = self.problem.trees.iter().filter(|_| self.problem.free_roots);
        let links = self.problem.links.iter().map(|link| link.joint);
        links.chain(roots.map(|tree| tree.root))
    }

    /// Writes the Euler angles of the joints that the drag turns, and the offsets of free roots,
    /// into `skeleton`, which must be the one for which the drag was made.
    pub fn write(&self, skeleton: &mut Skeleton) {
        for (joint, angles) in self.angles() {
            skeleton.write_local(joint, |joint| joint.rotation = angles);
        }
        let trees = self.problem.trees.iter().filter(|_| self.problem.free_roots).enumerate();
        for (index, tree) in trees {
            let offset = self.problem.root_offset(index, self.config.shifts[index]);
            skeleton.write_local(tree.root, |root| root.offset = offset);
        }
    }

    fn index(&self) -> usize {
        self.problem.effectors.len() - 1
    }

    fn dragged(&self) -> &EndEffector {
        &self.problem.effectors[self.index()]
    }

    /// Vector from the dragged point to its place, in the problem's units.
    fn way(&self) -> DVec3 {
        self.place - self.config.tips[self.index()].as_dvec3()
    }

    fn distance(&self) -> f64 {
        self.way().length()
    }

    fn is_held(&self) -> bool {
        /// Distance, in chain lengths, up to which a target counts as held.
        const STILL_HELD: f64 = 10.0 * HELD;
        self.config.farthest(&self.problem) <= STILL_HELD * f64::from(self.problem.length)
    }

    /// Brings the held targets back.
    fn restore(&mut self) {
        const ITERATIONS: u32 = 12;
        /// Distance of held targets, in chain lengths, that is rounding.
        const RESTORED: f64 = 2e-7;
        self.restoring.restart();
        let enough = RESTORED * f64::from(self.problem.length);
        for _ in 0..ITERATIONS {
            let is_there = self.config.farthest(&self.problem) <= enough;
            if is_there
                || !self.restoring.iterate(&self.problem, &mut self.config, &mut Recorder::off())
            {
                break;
            }
        }
    }

    /// The directions in which held places count: all, or none for free places, and for places of
    /// shells that are at a border or beyond, so that they may move inwards.
    fn counted(&self) -> Vec<Counted> {
        let held = &self.problem.effectors[..self.index()];
        let of_held = |it: &EndEffector| match it {
            it if it.has_shell() || it.weight == 0.0 => Counted::Free,
            it if it.is_of_mass() => Counted::Across(it.free_direction.as_dvec3()),
            _ => Counted::Whole,
        };
        held.iter().map(of_held).collect()
    }

    /// The step with the damping μ towards a place at most `sight` away, both in the problem's units;
    /// `None` if nothing can move.
    fn step(&self, damping: f64, sight: f64) -> Option<Coordinates> {
        let problem = &self.problem;
        let mut axes = self.config.axes.clone();
        let mut cone_ends = Vec::new();
        let mut counted = self.counted();
        let way = self.way().clamp_length_max(sight);
        loop {
            let rows = Rows::new(problem, &self.config, &axes);
            let held = rows.held(&counted);
            let (free, to_border) = rows.free(&held)?;
            let left = DVector::from_row_slice(&way.to_array()) - rows.dragged() * &to_border;
            let square = &free * free.transpose();
            let square = Matrix3::from_iterator(square.iter().copied());
            let damped = square + Matrix3::identity() * damping.powi(2);
            let force =
                damped.cholesky()?.solve(&nalgebra::Vector3::new(left[0], left[1], left[2]));
            let step = to_border + free.transpose() * force;
            let mut coordinates = rows.coordinates(problem, &step);
            let is_fixed =
                fix_angles(problem, &self.config, &mut coordinates, &mut axes, &mut cone_ends);
            let is_held = rows.hold(problem, &self.config, &step, &mut counted);
            if !(is_fixed || is_held) {
                return Some(coordinates);
            }
        }
    }
}

/// Fixes angles that a step would move out of their limits: makes their axes zero, and holds links at
/// the ends of their cones. Returns whether any was newly fixed.
fn fix_angles(
    problem: &Problem,
    config: &Configuration,
    step: &mut Coordinates,
    axes: &mut [Mat3A],
    cone_ends: &mut Vec<(usize, Vec3)>,
) -> bool {
    let mut any = false;
    for (index, link) in problem.links.iter().enumerate() {
        if link.limits.as_cone().is_some() {
            let (angles, by) = (config.angles[index], &mut step.angles[index]);
            any |= hold_in_cone(link, index, angles, by, &mut axes[index], cone_ends);
            continue;
        }
        for about in RotationAxis::ALL {
            let axis = axes[index].col_mut(about.index());
            let by = step.angles[index][about.index()];
            if *axis != Vec3A::ZERO && link.limits.stops(config.angles[index], about, by, 0.0) {
                *axis = Vec3A::ZERO;
                any = true;
            }
        }
    }
    any
}

/// The directions in which the place of a held target counts.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Counted {
    /// All.
    Whole,
    /// All but that of a unit vector.
    Across(DVec3),
    /// A unit vector, with the way that is left in it.
    Along(DVec3, f64),
    /// None.
    Free,
}

/// Rows of the Jacobian in coordinates of equal effort.
struct Rows {
    /// Of each place, three rows; of the dragged point last.
    places: Vec<DMatrix<f64>>,
    /// Of each turn that a held target asks for, three rows.
    turns: Vec<DMatrix<f64>>,
    /// The changes of angles and shifts by a unit of each coordinate.
    units: Vec<f64>,
    /// Length of the chain.
    length: f64,
}

/// Rows of held targets, with the ways that they are to go.
struct HeldRows {
    rows: DMatrix<f64>,
    ways: DVector<f64>,
}

impl Rows {
    /// The rows in a configuration whose links have these rotation axes, zero for fixed angles.
    fn new(problem: &Problem, config: &Configuration, axes: &[Mat3A]) -> Self {
        let (length, shift) = (f64::from(problem.length), f64::from(problem.shift_unit));
        let turning = 3 * problem.links.len();
        let shifting = if problem.free_roots { 3 * problem.trees.len() } else { 0 };
        let columns = turning + shifting;
        let compliance = |at: usize| f64::from(problem.links[at / 3].compliance[at % 3]).sqrt();
        let of_shifts = std::iter::repeat_n(shift, shifting);
        let units = (0..turning).map(compliance).chain(of_shifts).collect::<Vec<f64>>();
        let zero = || DMatrix::zeros(3, columns);
        let mut places = vec![zero(); problem.effectors.len()];
        let mut turns = Vec::new();
        for (index, effector) in problem.effectors.iter().enumerate() {
            let missing = config.missing_turn(effector);
            let mut turn = missing.map(|_| zero());
            let moves = |(_, link): &(usize, &Link)| problem.below(link).contains(&index);
            for (link, _) in problem.links.iter().enumerate().filter(moves) {
                let (base, axes) = (config.bases[link], axes[link]);
                let arm = config.tips[index] - config.pivot(problem, link, index);
                for axis in 0..3 {
                    let (at, about) = (3 * link + axis, axes.col(axis));
                    let place = about.cross(arm);
                    set_column(&mut places[index], at, place, units[at]);
                    if let (Some(turn), Some(missing)) = (&mut turn, missing) {
                        let weight = f64::from(missing.stiffness).sqrt();
                        set_column(turn, at, missing.column(about, base), weight * units[at]);
                    }
                }
            }
            if problem.free_roots {
                let from = turning + 3 * effector.tree;
                for (axis, unit) in Vec3A::AXES.into_iter().enumerate() {
                    let part = f64::from(problem.part_of_shift(index));
                    set_column(&mut places[index], from + axis, unit, part * shift);
                    if let (Some(turn), Some(missing)) = (&mut turn, missing) {
                        let weight = f64::from(missing.stiffness).sqrt();
                        let by = missing.of_velocity()[axis];
                        set_column(turn, from + axis, by, weight * shift);
                    }
                }
            }
            turns.extend(turn);
        }
        Self { places, turns, units, length }
    }

    fn dragged(&self) -> DMatrix<f64> {
        self.places[self.places.len() - 1].clone()
    }

    /// The rows of the held targets that count.
    fn held(&self, counted: &[Counted]) -> HeldRows {
        let columns = self.units.len();
        let mut rows = Vec::new();
        let mut ways = Vec::new();
        for (place, counted) in self.places.iter().zip(counted) {
            match counted {
                Counted::Whole => {
                    rows.extend((0..3).map(|row| place.row(row).into_owned()));
                    ways.extend([0.0; 3]);
                }
                Counted::Across(normal) => {
                    let (one, other) = normal.any_orthonormal_pair();
                    for way in [one, other] {
                        rows.push(nalgebra::RowVector3::new(way.x, way.y, way.z) * place);
                        ways.push(0.0);
                    }
                }
                Counted::Along(normal, room) => {
                    let normal = nalgebra::RowVector3::new(normal.x, normal.y, normal.z);
                    rows.push(normal * place);
                    ways.push(*room);
                }
                Counted::Free => {}
            }
        }
        for turn in &self.turns {
            rows.extend((0..3).map(|row| turn.row(row).into_owned()));
            ways.extend([0.0; 3]);
        }
        let rows =
            if rows.is_empty() { DMatrix::zeros(0, columns) } else { DMatrix::from_rows(&rows) };
        HeldRows { rows, ways: DVector::from_vec(ways) }
    }

    /// B, the rows of the dragged point in the null space of held rows, and Δ₁, the step that takes
    /// these along their ways; `None` if the rows are no numbers.
    fn free(&self, HeldRows { rows, ways }: &HeldRows) -> Option<(DMatrix<f64>, DVector<f64>)> {
        let dragged = self.dragged();
        if rows.nrows() == 0 {
            return Some((dragged, DVector::zeros(self.units.len())));
        }
        let cut = HELD_CUT * self.length;
        let mut square = rows * rows.transpose();
        for at in 0..square.nrows() {
            square[(at, at)] += cut * cut;
        }
        let factored: Cholesky<f64, Dyn> = Cholesky::new(square)?;
        let free = &dragged - (&dragged * rows.transpose()) * factored.solve(rows);
        Some((free, rows.transpose() * factored.solve(ways)))
    }

    /// Holds places that a step would move out of their shells. Returns whether any is newly held.
    fn hold(
        &self,
        problem: &Problem,
        config: &Configuration,
        step: &DVector<f64>,
        counted: &mut [Counted],
    ) -> bool {
        let mut any = false;
        for (index, counted) in counted.iter_mut().enumerate() {
            if *counted != Counted::Free {
                continue;
            }
            let (effector, tip) = (&problem.effectors[index], config.tips[index]);
            if effector.weight == 0.0 {
                continue;
            }
            let velocity = &self.places[index] * step;
            let velocity = DVec3::new(velocity[0], velocity[1], velocity[2]);
            let Some(out) = effector.way_out(tip, velocity.as_vec3a()).and_then(normalize) else {
                continue;
            };
            let room = f64::from(effector.room(tip, out).max(0.0));
            if velocity.dot(out.as_dvec3()) > room + HELD * f64::from(problem.length) {
                *counted = Counted::Along(out.as_dvec3(), room);
                any = true;
            }
        }
        any
    }

    /// The changes of angles and shifts that a step makes, as [`advance`] takes them.
    fn coordinates(&self, problem: &Problem, step: &DVector<f64>) -> Coordinates {
        let lever = f64::from(problem.shift_unit).powi(2);
        let by = |at: usize| (step[at] * self.units[at]) as f32;
        let mut coordinates = Coordinates::zero(problem);
        for (link, angles) in coordinates.angles.iter_mut().enumerate() {
            *angles = Vec3::from_array([0, 1, 2].map(|axis| by(3 * link + axis)));
        }
        if problem.free_roots {
            let from = 3 * problem.links.len();
            for (tree, shift) in coordinates.shifts.iter_mut().enumerate() {
                let by = |axis: usize| (f64::from(by(from + 3 * tree + axis)) / lever) as f32;
                *shift = Vec3A::new(by(0), by(1), by(2));
            }
        }
        coordinates
    }
}

fn set_column(matrix: &mut DMatrix<f64>, column: usize, by: Vec3A, factor: f64) {
    for (row, value) in by.to_array().into_iter().enumerate() {
        matrix[(row, column)] = f64::from(value) * factor;
    }
}
