//! The Jacobian: derivatives of tips by angles.
//!
//! The column of the Jacobian J for one Euler angle of a joint with base b, for a tip p, is a × (p −
//! b), a the unit vector that the angle turns about. What a force F at p does to that angle, Jᵀ F,
//! is a · ((p − b) × F): the moments of all forces about one point, summed from tips to roots, give
//! it for all joints in one pass.
//!
//! # Source
//!
//! S. Buss, *Introduction to Inverse Kinematics with Jacobian Transpose, Pseudoinverse and Damped
//! Least Squares methods*, 2004.

use glam::{Mat3A, Vec3, Vec3A};

use super::configuration::Configuration;
use super::problem::Problem;
use crate::kinematics::skeleton::{EulerAngles, JointId, Skeleton};

/// Derivatives of a tip by every joint's angles about x, y and z, in skeleton space; zero for joints
/// that are not ancestors of the tip.
///
/// # Panics
///
/// If there is no such joint.
pub fn jacobian(skeleton: &Skeleton, joint: JointId) -> Vec<[Vec3; 3]> {
    let pose = skeleton.pose_in_skeleton();
    let mut columns = vec![[Vec3::ZERO; 3]; skeleton.joints().len()];
    for index in skeleton.ancestors(joint) {
        let Some(above) = skeleton.joint(index) else { continue };
        let parent = above.parent.map_or(Mat3A::IDENTITY, |parent| pose.full(parent).matrix3);
        let axes = parent * Mat3A::from(above.frame) * EulerAngles(above.rotation).axes();
        let arm = Vec3A::from(pose.tip(joint) - pose.base(index));
        columns[index.index()] =
            [axes.x_axis, axes.y_axis, axes.z_axis].map(|a| a.cross(arm).into());
    }
    columns
}

/// Force and moment (about the tree's origin) of what hangs on each body.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Wrenches(Vec<(Vec3A, Vec3A)>);

impl Wrenches {
    /// Jᵀ F for forces at tips: into `angles` for every body, and into `shift` the sum of forces on
    /// every tree.
    pub fn gather(
        &mut self,
        rig: &Problem,
        pose: &Configuration,
        force: impl Fn(usize) -> Vec3A,
        angles: &mut Vec<Vec3>,
        shift: &mut Vec<Vec3A>,
    ) {
        self.0.clear();
        self.0.resize(rig.bodies.len(), (Vec3A::ZERO, Vec3A::ZERO));
        angles.clear();
        angles.resize(rig.bodies.len(), Vec3::ZERO);
        shift.clear();
        shift.resize(rig.trees.len(), Vec3A::ZERO);

        for (index, goal) in rig.goals.iter().enumerate() {
            let force = force(index);
            shift[goal.tree] += force;
            if let Some(body) = goal.body {
                self.add(body, force, pose.tips[index].cross(force));
            }
        }
        for (index, body) in rig.bodies.iter().enumerate().rev() {
            let (force, moment) = self.0[index];
            let about_base = moment - pose.bases[index].cross(force);
            angles[index] = (pose.axes[index].transpose() * about_base).into();
            if let Some(parent) = body.parent {
                self.add(parent, force, moment);
            }
        }
    }

    fn add(&mut self, body: usize, force: Vec3A, moment: Vec3A) {
        self.0[body].0 += force;
        self.0[body].1 += moment;
    }
}

/// Applies a step within the limits; non-finite components are left unchanged.
pub(super) fn advance(
    rig: &Problem,
    from: (&[Vec3], &[Vec3A]),
    by: (&[Vec3], &[Vec3A]),
    factor: f32,
    pose: &mut Configuration,
) {
    for (index, body) in rig.bodies.iter().enumerate() {
        let (before, angles) = (from.0[index], from.0[index] + factor * by.0[index]);
        let angles = if angles.is_finite() { angles } else { before };
        pose.angles[index] = crate::kinematics::skeleton::within(&body.limits, angles);
    }
    if rig.free {
        // A root counts as a joint with an arm as long as the chain, so that lengths and angles
        // compare.
        let lever = factor * rig.length * rig.length;
        for (index, shift) in pose.shift.iter_mut().enumerate() {
            let (before, moved) = (from.1[index], from.1[index] + lever * by.1[index]);
            *shift = if rig.can_go(index, moved) { moved } else { before };
        }
    }
    pose.forward(rig);
}
