use glam::{Mat3A, Vec3, Vec3A};

use super::configuration::{Configuration, Coordinates};
use super::method::DampedLeastSquares;
use super::problem::{Link, Problem};
use crate::skeleton::{JointAngles, equivalent_triples, nearest_angles};

/// Damping of the null space in chain lengths.
const NULL_SPACE_DAMPING: f32 = 1e-2;

/// State and space of [tracking](super::ChainSolver::track).
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tracker {
    /// The problem of the next step, in which it is built; after [`Tracker::take_along`], that of
    /// the last step.
    pub next: Problem,
    /// True if the last step held a target back and came nearer to it.
    pub was_held_back: bool,
    /// Motion of the targets in the last step, in world units.
    pub last_motion: f64,
    /// The configuration as the FK pose takes it along.
    taken: Configuration,
    /// The turns that joints missed before the step.
    turns: Vec<Vec3A>,
    posture: DampedLeastSquares,
}

impl Tracker {
    pub fn new(problem: &Problem, config: &Configuration) -> Self {
        Self {
            next: problem.clone(),
            was_held_back: false,
            last_motion: 0.0,
            taken: config.clone(),
            turns: Vec::new(),
            posture: DampedLeastSquares::new(problem, NULL_SPACE_DAMPING),
        }
    }

    /// Replaces a problem by the next one and takes the configuration along with the FK pose.
    /// Returns the largest change of a vector from target to tip, in the world; a change of a missing
    /// turn by φ counts as the distance ℓ φ.
    pub fn take_along(&mut self, problem: &mut Problem, config: &mut Configuration) -> f64 {
        std::mem::swap(problem, &mut self.next);
        let before = &self.next;
        let tips_before = &mut self.taken.tips;
        tips_before.clone_from(&config.tips);
        self.turns.clear();
        self.turns.extend(config.missing_turns(before).map(|missing| missing.turn));
        for (index, angles) in config.angles.iter_mut().enumerate() {
            *angles = taken_along(&before.links[index], &problem.links[index], *angles);
        }
        let scale = (problem.unit() / before.unit()) as f32;
        config.shifts.iter_mut().for_each(|shift| *shift *= scale);
        config.forward(problem);
        config.renew_orientations();
        // Of a shell, the way of its middle, so that poses return to FK in it, too.
        let offsets_before = before.offsets(tips_before);
        let changes = problem.offsets(&config.tips).zip(offsets_before);
        let moved = changes.map(|(now, before)| now.distance(before)).fold(0.0, f64::max);
        let turns = config.missing_turns(problem).zip(&self.turns);
        let turned = turns.map(|(now, before)| f64::from(now.turn.distance(*before)));
        let motion = moved.max(problem.turn_length_in_world() * turned.fold(0.0, f64::max));
        self.taken.copy_from(config);
        motion
    }

    /// Lets [`Tracker::displacement`] count from a configuration.
    pub fn mark(&mut self, config: &Configuration) {
        self.taken.copy_from(config);
    }

    /// Largest distance by which the configuration has moved since [`Tracker::take_along`] or
    /// [`Tracker::mark`], in the problem's units.
    pub fn displacement(&self, config: &Configuration) -> f64 {
        f64::from(config.max_displacement(&self.taken))
    }

    /// Moves a configuration towards the FK pose in the null space of the targets, by at most
    /// `most`.
    pub fn move_to_fk(&mut self, problem: &Problem, config: &mut Configuration, most: f32) {
        // Not for a chain without a length, which gives no number.
        if most > 0.0 {
            self.posture.refit(problem, NULL_SPACE_DAMPING);
            let wanted = |wanted: &mut Coordinates| set_fk(problem, wanted);
            self.posture.advance_in_null_space(problem, config, wanted, most);
            config.renew_orientations();
        }
    }
}

/// The angles of a link that keeps its rotation relative to the FK pose, within its limits.
fn taken_along(before: &Link, now: &Link, angles: Vec3) -> Vec3 {
    let angles = if before.start == now.start {
        angles
    } else if angles == before.start {
        now.start
    } else {
        let matrix = |angles: Vec3| JointAngles(angles).matrix();
        let turn: Mat3A = matrix(before.start).transpose() * matrix(now.start);
        nearest_angles(matrix(angles) * turn, angles + now.start - before.start)
    };
    now.limits.project(angles)
}

/// Sets the coordinates of the FK pose that are nearest to `coordinates`.
fn set_fk(problem: &Problem, coordinates: &mut Coordinates) {
    for (link, angles) in problem.links.iter().zip(&mut coordinates.angles) {
        let [nearest, _] = equivalent_triples(link.start, *angles);
        *angles = link.limits.project(nearest);
    }
    for (tree, shift) in problem.trees.iter().zip(&mut coordinates.shifts) {
        *shift = ((tree.offset - tree.origin) * problem.unit()).as_vec3a();
    }
}
