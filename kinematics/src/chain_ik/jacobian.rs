//! The Jacobian: derivatives of tips with respect to joint angles.
//!
//! The column of the Jacobian J for one Euler angle of a joint with base b, for a tip p, is a × (p
//! − b), where the unit vector a is the angle's axis. A force F at p has the component Jᵀ F = a ·
//! ((p − b) × F) along that angle. Summing forces and moments from tips to roots gives this
//! component for all joints in one pass.
//!
//! A turn of the angle moves the tip on a circle; the column is the velocity on it, so that circle
//! and the line along the column part by about r φ²/2 after a turn by φ at the distance r from the
//! axis. A [`Swing`] shows both.
//!
//! # Source
//!
//! S. Buss, *Introduction to Inverse Kinematics with Jacobian Transpose, Pseudoinverse and Damped
//! Least Squares methods*, 2004.

use glam::{Mat3A, Vec3, Vec3A};

use super::configuration::{Configuration, Coordinates};
use super::orientation::MissingTurn;
use super::problem::{MassOnLink, Problem};
use crate::skeleton::{JointAngles, JointId, RotationAxis, Skeleton, equivalent_triples};

/// Derivatives of a joint's tip with respect to every joint's angles about x, y and z, in skeleton
/// space and per radian; zero for joints other than the joint and its ancestors.
///
/// # Panics
///
/// If there is no such joint.
pub fn jacobian(skeleton: &Skeleton, joint: JointId) -> Vec<[Vec3; 3]> {
    jacobian_of_point(skeleton, joint, skeleton[joint].axis)
}

/// [`jacobian`] for another point of the joint than its tip, in the joint's space.
///
/// # Panics
///
/// If there is no such joint.
pub fn jacobian_of_point(skeleton: &Skeleton, joint: JointId, point: Vec3) -> Vec<[Vec3; 3]> {
    let pose = skeleton.pose_in_skeleton();
    let tip = pose.full(joint).transform_point3(point);
    let mut columns = vec![[Vec3::ZERO; 3]; skeleton.joints().len()];
    for index in skeleton.ancestors(joint) {
        let Some(above) = skeleton.joint(index) else { continue };
        let parent = above.parent.map_or(Mat3A::IDENTITY, |parent| pose.full(parent).matrix3);
        let axes = parent * Mat3A::from(above.frame) * JointAngles(above.rotation).axes();
        let arm = Vec3A::from(tip - pose.base(index));
        columns[index.index()] =
            [axes.x_axis, axes.y_axis, axes.z_axis].map(|a| a.cross(arm).into());
    }
    columns
}

/// A turn of one angle of a joint, seen at the tip of a joint below it: its path against the line
/// that the Jacobian predicts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Swing {
    /// The joint that turns.
    pub joint: JointId,
    /// The axis of its angle.
    pub axis: RotationAxis,
    /// The joint whose tip is looked at: the joint itself or one below it.
    pub tip: JointId,
}

impl Swing {
    /// The skeleton with the angle changed by `by`, in radians, whatever its limits are.
    pub fn posed(&self, skeleton: &Skeleton, by: f32) -> Skeleton {
        let mut posed = skeleton.clone();
        posed.write_local(self.joint, |joint| joint.rotation[self.axis.index()] += by);
        posed
    }

    /// Position of the tip in the world with the angle changed by `by`, in radians.
    ///
    /// # Panics
    ///
    /// If the skeleton has no such joints.
    pub fn tip_at(&self, skeleton: &Skeleton, by: f32) -> Vec3 {
        self.posed(skeleton, by).tip(self.tip)
    }

    /// Position of the tip in the world that the Jacobian predicts for a change of the angle by
    /// `by`, in radians.
    ///
    /// # Panics
    ///
    /// If the skeleton has no such joints.
    pub fn predicted_at(&self, skeleton: &Skeleton, by: f32) -> Vec3 {
        let column = jacobian(skeleton, self.tip)[self.joint.index()][self.axis.index()];
        skeleton.tip(self.tip) + by * skeleton.transform().transform_vector3(column)
    }
}

/// Force and moment (about the tree's origin) on each link, from all end effectors at the link and
/// below.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Wrenches(Vec<(Vec3A, Vec3A)>);

impl Wrenches {
    /// Writes the negative gradient of the cost, Jᵀ W (target − p), to `descent`.
    pub fn descend(
        &mut self,
        problem: &Problem,
        config: &Configuration,
        descent: &mut Coordinates,
    ) {
        let force = |index: usize| {
            let effector = &problem.effectors[index];
            let tip = config.tips[index];
            (effector.destination(tip) - tip) * effector.weight
        };
        let moment = |index: usize| {
            let missing = config.missing_turn(&problem.effectors[index])?;
            Some((missing, missing.turn * missing.stiffness))
        };
        self.apply_transpose(problem, config, force, moment, descent);
    }

    /// Writes Jᵀ F for every link, and the sum of forces on every tree. `force` gives the force F
    /// at the tip of an end effector, `moment` the turn that it misses and the moment about it.
    pub fn apply_transpose(
        &mut self,
        problem: &Problem,
        config: &Configuration,
        force: impl Fn(usize) -> Vec3A,
        moment: impl Fn(usize) -> Option<(MissingTurn, Vec3A)>,
        Coordinates { angles, shifts }: &mut Coordinates,
    ) {
        self.0.clear();
        self.0.resize(problem.links.len(), (Vec3A::ZERO, Vec3A::ZERO));
        angles.clear();
        angles.resize(problem.links.len(), Vec3::ZERO);
        shifts.clear();
        shifts.resize(problem.trees.len(), Vec3A::ZERO);

        for (index, effector) in problem.effectors.iter().enumerate() {
            let force = force(index);
            shifts[effector.tree] += force * problem.part_of_shift(index);
            if let Some(masses) = problem.masses_of(index) {
                for (link, MassOnLink { mass, .. }) in masses.on_links.iter().enumerate() {
                    let moment = config.own_moment(masses, link).cross(force);
                    self.add(link, *mass * force, moment);
                }
            } else if let Some(link) = effector.link {
                self.add(link, force, config.tips[index].cross(force));
            }
            if let Some((missing, moment)) = moment(index) {
                let (force, moment, at) = missing.wrench(moment);
                shifts[effector.tree] += force;
                if let Some(link) = effector.link {
                    self.add(link, force, moment + at.cross(force));
                }
            }
        }
        for (index, link) in problem.links.iter().enumerate().rev() {
            let (force, moment) = self.0[index];
            let about_base = moment - config.bases[index].cross(force);
            angles[index] = (config.axes[index].transpose() * about_base).into();
            if let Some(parent) = link.parent {
                self.add(parent, force, moment);
            }
        }
    }

    /// Writes the way of steepest descent in the metric of the joints' stiffness, W⁻¹ Jᵀ W
    /// (target − p) with the compliances 1 − k of angles as W⁻¹, to `descent`. At the side of a cone,
    /// the way leads along the side.
    pub fn descend_compliantly(
        &mut self,
        problem: &Problem,
        config: &Configuration,
        descent: &mut Coordinates,
    ) {
        self.descend(problem, config, descent);
        descent.scale_by_compliance(problem);
        descent.hold_in_cones(problem, config);
    }

    fn add(&mut self, link: usize, force: Vec3A, moment: Vec3A) {
        self.0[link].0 += force;
        self.0[link].1 += moment;
    }
}

/// Applies a step within the limits; non-finite components are left unchanged.
pub(super) fn advance(
    problem: &Problem,
    from: &Coordinates,
    by: &Coordinates,
    factor: f32,
    config: &mut Configuration,
) {
    for (index, link) in problem.links.iter().enumerate() {
        let (before, angles) = (from.angles[index], from.angles[index] + factor * by.angles[index]);
        let angles = if angles.is_finite() { angles } else { before };
        let within = link.limits.project(angles);
        // In a cone, angles may go round and round, and lose their precision.
        config.angles[index] = match link.limits.as_cone() {
            Some(_) => equivalent_triples(within, before)[0],
            None => within,
        };
    }
    if problem.free_roots {
        // Converts the units of angles to those of shifts.
        let lever = factor * problem.shift_unit.powi(2);
        for (index, shifts) in config.shifts.iter_mut().enumerate() {
            let (before, moved) =
                (from.shifts[index], from.shifts[index] + lever * by.shifts[index]);
            *shifts = if problem.can_shift(index, moved) { moved } else { before };
        }
    }
    config.forward(problem);
}
