//! Where the bodies of a rig are.

use glam::{Mat3A, Quat, Vec3, Vec3A};

use super::problem::{Goal, Problem};
use crate::kinematics::skeleton::EulerAngles;

/// Angles, and what follows from them.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Configuration {
    pub angles: Vec<Vec3>,
    /// How far each tree has moved.
    pub shift: Vec<Vec3A>,
    /// G: from a body's space to skeleton space.
    pub frames: Vec<Mat3A>,
    /// What each body's angles turn about, in skeleton space, as columns.
    pub axes: Vec<Mat3A>,
    /// G again, for methods that turn bodies without angles; then frames and axes are old.
    pub turned: Vec<Quat>,
    /// Where each body turns.
    pub bases: Vec<Vec3A>,
    /// Of the goals.
    pub tips: Vec<Vec3A>,
}

impl Configuration {
    pub fn new(rig: &Problem) -> Self {
        let bodies = rig.bodies.len();
        let mut pose = Self {
            angles: rig.bodies.iter().map(|body| body.start).collect(),
            shift: vec![Vec3A::ZERO; rig.trees.len()],
            frames: vec![Mat3A::IDENTITY; bodies],
            axes: vec![Mat3A::IDENTITY; bodies],
            turned: Vec::new(),
            bases: vec![Vec3A::ZERO; bodies],
            tips: vec![Vec3A::ZERO; rig.goals.len()],
        };
        pose.forward(rig);
        pose
    }

    /// Everything else from angles and shift.
    pub fn forward(&mut self, rig: &Problem) {
        for (index, body) in rig.bodies.iter().enumerate() {
            let (above, base) = match body.parent {
                Some(parent) => {
                    let above = self.frames[parent];
                    (above, self.bases[parent] + above * body.pivot)
                }
                None => (Mat3A::IDENTITY, self.shift[body.tree] + body.pivot),
            };
            let (turn, axes) = EulerAngles(self.angles[index]).matrix_and_axes();
            let mounted = above * body.mount;
            self.bases[index] = base;
            self.axes[index] = mounted * axes;
            self.frames[index] = mounted * turn;
        }
        for (goal, tip) in rig.goals.iter().zip(&mut self.tips) {
            *tip = match goal.body {
                Some(body) => self.bases[body] + self.frames[body] * goal.tip,
                None => self.shift[goal.tree] + goal.tip,
            };
        }
    }

    /// Turns from frames.
    pub fn turn(&mut self) {
        self.turned.clear();
        self.turned.extend(self.frames.iter().map(Quat::from_mat3a));
    }

    /// f = Σ ½ w |tip − target|².
    pub fn cost(&self, rig: &Problem) -> f64 {
        let costs = rig.goals.iter().zip(&self.tips).map(|(goal, tip)| {
            let missing = tip.as_dvec3() - goal.point.as_dvec3();
            0.5 * f64::from(goal.weight) * missing.length_squared()
        });
        costs.sum()
    }

    /// The largest distance from a tip to its target, in the world.
    pub fn error(&self, rig: &Problem) -> f64 {
        let errors = rig.goals.iter().zip(&self.tips).map(|(goal, tip)| rig.error(goal, *tip));
        errors.fold(0.0, f64::max)
    }

    /// Root mean square distance from tips to targets.
    pub fn distance(&self, rig: &Problem) -> f64 {
        let weights: f64 = rig.goals.iter().map(|goal| f64::from(goal.weight)).sum();
        (2.0 * self.cost(rig) / weights.max(f64::MIN_POSITIVE)).sqrt()
    }

    /// Mean distance from tips to targets: where one is far, it shows what the others still gain.
    pub fn mean_distance(&self, rig: &Problem) -> f64 {
        let of_goal = |(goal, tip): (&Goal, &Vec3A)| {
            let weight = f64::from(goal.weight);
            (weight * f64::from(goal.point.distance(*tip)), weight)
        };
        let all = rig.goals.iter().zip(&self.tips).map(of_goal);
        let (sum, weights) =
            all.fold((0.0, 0.0), |(sum, weights), (far, weight)| (sum + far, weights + weight));
        sum / f64::max(weights, f64::MIN_POSITIVE)
    }

    /// Of all bases and tips.
    pub fn farthest_move(&self, from: &Self) -> f32 {
        let bases = self.bases.iter().zip(&from.bases);
        let both = bases.chain(self.tips.iter().zip(&from.tips));
        both.map(|(here, there)| here.distance_squared(*there)).fold(0.0, f32::max).sqrt()
    }

    /// Whether all is where it is there.
    pub fn is_like(&self, other: &Self) -> bool {
        self.angles == other.angles
            && self.turned == other.turned
            && self.bases == other.bases
            && self.tips == other.tips
    }

    pub fn copy(&mut self, from: &Self) {
        self.angles.clone_from(&from.angles);
        self.shift.clone_from(&from.shift);
        self.turned.clone_from(&from.turned);
        if from.turned.is_empty() {
            self.frames.clone_from(&from.frames);
            self.axes.clone_from(&from.axes);
        }
        self.bases.clone_from(&from.bases);
        self.tips.clone_from(&from.tips);
    }
}
