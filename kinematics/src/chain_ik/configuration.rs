use glam::{DVec3, Mat3A, Quat, Vec3, Vec3A};

use super::orientation::MissingTurn;
use super::problem::{EndEffector, Link, MassOnLink, Masses, Problem};
use crate::skeleton::{JointAngles, nearest_angles};

/// Angles of all links, shifts of all trees, and the positions that follow from both, in problem
/// space (see [`Problem`]).
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Configuration {
    pub angles: Vec<Vec3>,
    /// Translation of each tree from its origin.
    pub shifts: Vec<Vec3A>,
    /// G, the rotation from a link's space to skeleton space.
    pub frames: Vec<Mat3A>,
    /// Rotation axes of each link's three angles in skeleton space, as columns.
    pub axes: Vec<Mat3A>,
    /// G as quaternions, for methods that use orientations instead of angles; empty for other
    /// methods. While they are used, `frames` and `axes` are stale.
    pub orientations: Vec<Quat>,
    /// Position of each link's joint, the base of its bone.
    pub bases: Vec<Vec3A>,
    /// Position of each end effector's tip.
    pub tips: Vec<Vec3A>,
    /// S of each link: see [`Masses`](super::problem::Masses). Empty without a centre of mass.
    pub moments: Vec<Vec3A>,
}

impl Configuration {
    pub fn new(problem: &Problem) -> Self {
        let links = problem.links.len();
        let mut config = Self {
            angles: problem.links.iter().map(|link| link.start).collect(),
            shifts: vec![Vec3A::ZERO; problem.trees.len()],
            frames: vec![Mat3A::IDENTITY; links],
            axes: vec![Mat3A::IDENTITY; links],
            orientations: Vec::new(),
            bases: vec![Vec3A::ZERO; links],
            tips: vec![Vec3A::ZERO; problem.effectors.len()],
            moments: Vec::new(),
        };
        config.forward(problem);
        config
    }

    /// Forward kinematics: updates `frames`, `axes`, `bases` and `tips` from angles and shifts.
    pub fn forward(&mut self, problem: &Problem) {
        for (index, link) in problem.links.iter().enumerate() {
            let (parent, base) = match link.parent {
                Some(parent) => {
                    let frame = self.frames[parent];
                    (frame, self.bases[parent] + frame * link.pivot)
                }
                None => (Mat3A::IDENTITY, self.shifts[link.tree] + link.pivot),
            };
            let (rotation, axes) = JointAngles(self.angles[index]).matrix_and_axes();
            let mounted = parent * link.mount;
            self.bases[index] = base;
            self.axes[index] = mounted * axes;
            self.frames[index] = mounted * rotation;
        }
        for (effector, tip) in problem.effectors.iter().zip(&mut self.tips) {
            *tip = match effector.link {
                Some(link) => self.bases[link] + self.frames[link] * effector.tip,
                None => self.shifts[effector.tree] + effector.tip,
            };
        }
        // Of the frames: orientations may be those from before.
        let orientations = std::mem::take(&mut self.orientations);
        self.update_centre(problem);
        self.orientations = orientations;
    }

    /// Updates the centre of mass and `moments` from the positions and rotations of links.
    pub fn update_centre(&mut self, problem: &Problem) {
        let Some(masses) = &problem.masses else { return };
        let mut moments = std::mem::take(&mut self.moments);
        moments.clear();
        moments.extend((0..problem.links.len()).map(|link| self.own_moment(masses, link)));
        let tree = problem.effectors[masses.effector].tree;
        let held = masses.held_from(problem.trees[tree].origin, problem.unit());
        let mut centre = held + masses.fixed + masses.fixed_mass * self.shifts[tree];
        for (index, link) in problem.links.iter().enumerate().rev() {
            match link.parent {
                Some(parent) => {
                    let moment = moments[index];
                    moments[parent] += moment;
                }
                None => centre += moments[index],
            }
        }
        self.tips[masses.effector] = centre;
        self.moments = moments;
    }

    /// Σ m c of the bones that are rigidly attached to a link.
    pub fn own_moment(&self, masses: &Masses, link: usize) -> Vec3A {
        let MassOnLink { mass, moment, .. } = masses.on_links[link];
        let turned = match self.orientations.get(link) {
            Some(orientation) => *orientation * moment,
            None => self.frames[link] * moment,
        };
        mass * self.bases[link] + turned
    }

    /// The point about which a link turns a tip: the link's base, or its counterpart for the centre
    /// of mass.
    #[inline]
    pub fn pivot(&self, problem: &Problem, link: usize, effector: usize) -> Vec3A {
        self.pivot_with(&self.moments, problem, link, effector)
    }

    /// [`pivot`](Self::pivot) with other moments of the links.
    #[inline]
    pub fn pivot_with(
        &self,
        moments: &[Vec3A],
        problem: &Problem,
        link: usize,
        effector: usize,
    ) -> Vec3A {
        match problem.masses_of(effector) {
            Some(masses) => {
                let arm = moments[link] - masses.on_links[link].below * self.bases[link];
                self.tips[effector] - arm
            }
            None => self.bases[link],
        }
    }

    /// Sets `orientations` from `frames`.
    pub fn set_orientations(&mut self) {
        self.orientations.clear();
        self.orientations.extend(self.frames.iter().map(Quat::from_mat3a));
    }

    /// Sets `orientations` from `frames` if the method uses them.
    pub fn renew_orientations(&mut self) {
        if !self.orientations.is_empty() {
            self.set_orientations();
        }
    }

    /// Euler angles of a link. If they follow from orientations, they are those nearest to `near`.
    pub fn angles_near(&self, problem: &Problem, index: usize, near: Vec3) -> Vec3 {
        let link = &problem.links[index];
        if link.limits.is_limited() || self.orientations.is_empty() {
            return self.angles[index];
        }
        let parent = link.parent.map_or(Quat::IDENTITY, |parent| self.orientations[parent]);
        let mounted = Mat3A::from_quat(parent) * link.mount;
        nearest_angles(mounted.transpose() * Mat3A::from_quat(self.orientations[index]), near)
    }

    /// Sets the angles that follow from `orientations`.
    pub fn update_angles(&mut self, problem: &Problem) {
        for index in 0..problem.links.len() {
            self.angles[index] = self.angles_near(problem, index, self.angles[index]);
        }
    }

    /// G of the link of an end effector; without a link, no rotation.
    pub fn orientation_of(&self, effector: &EndEffector) -> Quat {
        match effector.link {
            Some(link) if self.orientations.is_empty() => Quat::from_mat3a(&self.frames[link]),
            Some(link) => self.orientations[link],
            None => Quat::IDENTITY,
        }
    }

    /// The turn that the joint of an end effector misses; `None` if no orientation is wanted.
    #[inline]
    pub fn missing_turn(&self, effector: &EndEffector) -> Option<MissingTurn> {
        effector.orientation?;
        MissingTurn::new(effector, self.orientation_of(effector), self.base_of(effector))
    }

    /// Base of the link of an end effector; without a link, the tree's origin.
    pub fn base_of(&self, effector: &EndEffector) -> Vec3A {
        effector.link.map_or(self.shifts[effector.tree], |link| self.bases[link])
    }

    /// Base of the joint of an end effector, which may be fused with its link.
    pub fn joint_of(&self, effector: &EndEffector) -> Vec3A {
        self.base_of(effector) + self.orientation_of(effector) * effector.space.translation
    }

    /// The turns that joints miss, of all end effectors with a wanted orientation.
    pub fn missing_turns<'a>(
        &'a self,
        problem: &'a Problem,
    ) -> impl Iterator<Item = MissingTurn> + 'a {
        problem.effectors.iter().filter_map(|effector| self.missing_turn(effector))
    }

    /// The cost f = Σ ½ w |tip − target|² + Σ ½ w ℓ² φ².
    pub fn cost(&self, problem: &Problem) -> f64 {
        let costs = problem.effectors.iter().zip(&self.tips).map(|(effector, tip)| {
            let residual = tip.as_dvec3() - effector.destination(*tip).as_dvec3();
            0.5 * f64::from(effector.weight) * residual.length_squared()
        });
        let turned = || self.missing_turns(problem).map(|missing| missing.cost()).sum::<f64>();
        costs.sum::<f64>() + if problem.orients { turned() } else { 0.0 }
    }

    /// Largest angle of a missing turn, in radians.
    pub fn orientation_error(&self, problem: &Problem) -> f64 {
        if !problem.orients {
            return 0.0;
        }
        let angles = self.missing_turns(problem).map(|missing| f64::from(missing.turn.length()));
        angles.fold(0.0, f64::max)
    }

    /// Largest distance from a tip to its target, in world units.
    pub fn error(&self, problem: &Problem) -> f64 {
        problem.residuals(&self.tips).map(DVec3::length).fold(0.0, f64::max)
    }

    /// Σ w r² with the distances r from joints to the tips below them, in the problem's units, and
    /// what orientations add; as [`Problem::inertia`] in this pose.
    pub fn inertia(&self, problem: &Problem) -> f32 {
        let of_link = |(at, link): (usize, &Link)| {
            let squares = problem.below(link).iter().map(|index| {
                let effector = &problem.effectors[*index];
                let arm = self.tips[*index] - self.pivot(problem, at, *index);
                let of_turn = self.missing_turn(effector).map_or(0.0, |missing| {
                    missing.stiffness * missing.longest_column(self.bases[at]).powi(2)
                });
                effector.weight * arm.length_squared() + of_turn
            });
            link.compliance.max_element() * squares.sum::<f32>()
        };
        let turning: f32 = problem.links.iter().enumerate().map(of_link).sum();
        turning + problem.inertia_of_shifts()
    }

    /// Largest distance from a tip to the point to which methods move it, in the problem's units; a
    /// missing turn by φ counts as the distance ℓ φ.
    pub fn farthest(&self, problem: &Problem) -> f64 {
        let tips = problem.effectors.iter().zip(&self.tips);
        let placed = tips.filter(|(effector, _)| effector.weight > 0.0);
        let distances = placed.map(|(effector, tip)| effector.destination(*tip).distance(*tip));
        let farthest = f64::from(distances.fold(0.0, f32::max));
        farthest.max(problem.turn_length() * self.orientation_error(problem))
    }

    /// Sum of the distances from tips to requested targets, in world units, and of the missing turns
    /// times ℓ.
    pub fn total_error(&self, problem: &Problem) -> f64 {
        let placed: f64 = problem.residuals(&self.tips).map(DVec3::length).sum();
        if !problem.orients {
            return placed;
        }
        let turns = self.missing_turns(problem).map(|missing| f64::from(missing.turn.length()));
        placed + problem.turn_length_in_world() * turns.sum::<f64>()
    }

    /// Weighted root mean square distance from tips to targets, in the problem's units; a missing
    /// turn by φ counts as the distance ℓ φ.
    pub fn distance(&self, problem: &Problem) -> f64 {
        (2.0 * self.cost(problem) / problem.weights).sqrt()
    }

    /// Weighted mean distance from tips to targets, in the problem's units. One far target does not
    /// hide how much nearer the other tips are.
    pub fn mean_distance(&self, problem: &Problem) -> f64 {
        let of_effector = |(effector, tip): (&EndEffector, &Vec3A)| {
            f64::from(effector.weight) * f64::from(effector.destination(*tip).distance(*tip))
        };
        let sum: f64 = problem.effectors.iter().zip(&self.tips).map(of_effector).sum();
        if !problem.orients {
            return sum / problem.weights;
        }
        let length = problem.turn_length().max(f64::MIN_POSITIVE);
        let turned = self
            .missing_turns(problem)
            .map(|missing| f64::from(missing.stiffness * missing.turn.length()) / length);
        (sum + turned.sum::<f64>()) / problem.weights
    }

    /// Largest distance of a joint or tip from its position in another configuration.
    pub fn max_displacement(&self, from: &Self) -> f32 {
        let bases = self.bases.iter().zip(&from.bases);
        let both = bases.chain(self.tips.iter().zip(&from.tips));
        both.map(|(here, there)| here.distance_squared(*there)).fold(0.0, f32::max).sqrt()
    }

    /// True if both configurations have equal angles, orientations and positions.
    pub fn is_same(&self, other: &Self) -> bool {
        self.angles == other.angles
            && self.orientations == other.orientations
            && self.bases == other.bases
            && self.tips == other.tips
    }

    pub fn copy_from(&mut self, from: &Self) {
        self.angles.clone_from(&from.angles);
        self.shifts.clone_from(&from.shifts);
        self.orientations.clone_from(&from.orientations);
        if from.orientations.is_empty() {
            self.frames.clone_from(&from.frames);
            self.axes.clone_from(&from.axes);
        }
        self.bases.clone_from(&from.bases);
        self.tips.clone_from(&from.tips);
        self.moments.clone_from(&from.moments);
    }
}

/// Angles of all links and shifts of all trees; also their derivatives or changes.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Coordinates {
    pub angles: Vec<Vec3>,
    pub shifts: Vec<Vec3A>,
}

impl Coordinates {
    pub fn zero(problem: &Problem) -> Self {
        Self {
            angles: vec![Vec3::ZERO; problem.links.len()],
            shifts: vec![Vec3A::ZERO; problem.trees.len()],
        }
    }

    pub fn copy_from(&mut self, config: &Configuration) {
        self.angles.clone_from(&config.angles);
        self.shifts.clone_from(&config.shifts);
    }

    pub fn subtract(&mut self, other: &Self) {
        let angles = self.angles.iter_mut().zip(&other.angles);
        angles.for_each(|(angles, other)| *angles -= *other);
        let shifts = self.shifts.iter_mut().zip(&other.shifts);
        shifts.for_each(|(shift, other)| *shift -= *other);
    }

    /// Multiplies the angles by the compliances of their links.
    pub fn scale_by_compliance(&mut self, problem: &Problem) {
        for (angles, link) in self.angles.iter_mut().zip(&problem.links) {
            *angles *= Vec3::from(link.compliance);
        }
    }

    /// Takes from the changes of angles the parts that lead out of the cones of their links.
    pub fn hold_in_cones(&mut self, problem: &Problem, config: &Configuration) {
        let links = problem.links.iter().zip(&config.angles).zip(&mut self.angles);
        for ((link, angles), by) in links.filter(|it| it.0.0.limits.as_cone().is_some()) {
            link.limits.hold(*angles, by);
        }
    }

    /// Euclidean norm of a step as [`advance`](super::jacobian::advance) takes it: of the changes
    /// of angles, and of shifts in this unit.
    pub fn norm(&self, unit: f32) -> f32 {
        let angles: f32 = self.angles.iter().map(|angles| angles.length_squared()).sum();
        let shifts: f32 = self.shifts.iter().map(|shift| (*shift * unit).length_squared()).sum();
        (angles + shifts).sqrt()
    }
}
