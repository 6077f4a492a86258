use glam::{Affine3A, DVec3, Mat3A, Quat, Vec3, Vec4};

use super::dual_quaternion::{DualQuaternion, motion_and_scale};
use super::roll::roll;
use super::skinning::Skinning;
use super::vertex_weights::VertexWeights;
use crate::skeleton::{Joint, Skeleton, SkeletonPose};

/// How each joint of a posed skeleton moves a mesh, for all ways of blending.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SkinPose {
    joints: Vec<JointDeform>,
    to_world: Affine3A,
    /// Transforms of the joints in skeleton space.
    spaces: SkeletonPose,
}

/// How one joint moves a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointDeform {
    /// J = X·B⁻¹ from mesh space to skeleton space.
    pub matrix: Affine3A,
    /// Rotation of J without its scale, a unit quaternion as (x, y, z, w).
    pub real: Vec4,
    /// Dual part of the unit dual quaternion of J without its scale.
    pub dual: Vec4,
    /// Scale of J in mesh space, applied before its rigid motion.
    pub scale: Mat3A,
    /// Roll τ of the joint about its bone, in (−π, π].
    pub roll: f32,
    /// Fraction t of the bone at a point v of mesh space, before clamping to [0, 1]: this · (v, 1).
    pub along: Vec4,
    /// X·K·B⁻¹, where K·p = â × p with the unit vector â along the bone.
    pub turn: Affine3A,
    /// X·K²·B⁻¹.
    pub turn_twice: Affine3A,
}

impl SkinPose {
    /// Writes the joints of a posed skeleton, with their inverse bind transforms. Joints beyond these, which
    /// no vertex follows, are left out.
    pub(super) fn refill(&mut self, inverse_binds: &[Affine3A], skeleton: &Skeleton) {
        skeleton.write_pose_in_skeleton(&mut self.spaces);
        let deform = |((joint, parameters), inverse_bind)| {
            JointDeform::new(parameters, self.spaces.full(joint), inverse_bind)
        };
        self.joints.clear();
        self.joints.extend(skeleton.iter().zip(inverse_binds.iter().copied()).map(deform));
        self.to_world = skeleton.transform();
    }

    /// The joints in their order.
    pub fn joints(&self) -> &[JointDeform] {
        &self.joints
    }

    /// Transform from skeleton space to the world, applied after blending.
    pub fn to_world(&self) -> Affine3A {
        self.to_world
    }

    /// The transform of a vertex at `position` in mesh space, to skeleton space.
    pub(super) fn blend(
        &self,
        weights: &VertexWeights,
        position: Vec3,
        skinning: Skinning,
    ) -> Affine3A {
        match skinning {
            Skinning::Linear => self.linear(weights),
            Skinning::DualQuaternion => self.dual_quaternion(weights),
            Skinning::SpreadTwist => self.spread_twist(weights, position),
        }
    }

    /// Linear blend of the joints of a vertex.
    fn linear(&self, weights: &VertexWeights) -> Affine3A {
        self.sum(weights, |joint| joint.matrix)
    }

    /// Blend of the joints' unit dual quaternions, after the linear blend of their scales.
    fn dual_quaternion(&self, weights: &VertexWeights) -> Affine3A {
        let Some(first) = self.joints.get(weights.first().index()) else {
            return Affine3A::IDENTITY;
        };
        let mut scale = Mat3A::ZERO;
        let mut sum = DualQuaternion::ZERO;
        for (joint, weight) in weights.iter() {
            let Some(joint) = self.joints.get(joint.index()) else { continue };
            scale += joint.scale * weight;
            let motion = DualQuaternion { real: joint.real, dual: joint.dual };
            sum.add(weight, &motion, first.real);
        }
        let mut motion = sum.motion();
        motion.matrix3 *= scale;
        motion
    }

    /// Linear blend of the joints of a vertex, each with the part of its roll at that vertex.
    fn spread_twist(&self, weights: &VertexWeights, vertex: Vec3) -> Affine3A {
        self.sum(weights, |joint| joint.with_spread_roll(vertex))
    }

    fn sum(
        &self,
        weights: &VertexWeights,
        transform: impl Fn(&JointDeform) -> Affine3A,
    ) -> Affine3A {
        let mut sum = [0.0; 12];
        for (joint, weight) in weights.iter() {
            let Some(joint) = self.joints.get(joint.index()) else { continue };
            for (total, value) in sum.iter_mut().zip(transform(joint).to_cols_array()) {
                *total += weight * value;
            }
        }
        Affine3A::from_cols_array(&sum)
    }
}

impl JointDeform {
    fn new(joint: &Joint, space: Affine3A, inverse_bind: Affine3A) -> Self {
        let matrix = space * inverse_bind;
        let (DualQuaternion { real, dual }, scale) = motion_and_scale(matrix);
        let length = joint.axis.as_dvec3().length();
        let axis = joint.axis.as_dvec3() / length;
        if !axis.is_finite() {
            let none = Affine3A::from_cols_array(&[0.0; 12]);
            let (along, roll) = (Vec4::ZERO, 0.0);
            return Self { matrix, real, dual, scale, roll, along, turn: none, turn_twice: none };
        }
        let rotation = Quat::from_mat3a(&joint.local_rotation()).as_dquat();
        let cross = cross_matrix(axis);
        let turn = |by: Mat3A| {
            let Affine3A { matrix3, translation } = inverse_bind;
            let by = space.matrix3 * by;
            Affine3A { matrix3: by * matrix3, translation: by * translation }
        };
        Self {
            matrix,
            real,
            dual,
            scale,
            roll: roll(rotation.normalize(), axis) as f32,
            along: along(inverse_bind, axis / length),
            turn: turn(cross),
            turn_twice: turn(cross * cross),
        }
    }

    /// J with the roll t·τ instead of τ, where t is the fraction of the bone at a point of mesh space:
    /// X·Rot(â, φ)·B⁻¹ with φ = −(1 − t)·τ, by Rodrigues' formula Rot = 1 + sin φ·K + (1 − cos φ)·K².
    fn with_spread_roll(&self, vertex: Vec3) -> Affine3A {
        let fraction = self.along.dot(vertex.extend(1.0)).clamp(0.0, 1.0);
        let (sin, cos) = (-(1.0 - fraction) * self.roll).sin_cos();
        let parts = self
            .matrix
            .to_cols_array()
            .into_iter()
            .zip(self.turn.to_cols_array().into_iter().zip(self.turn_twice.to_cols_array()));
        let mut sum = [0.0; 12];
        for (total, (matrix, (turn, turn_twice))) in sum.iter_mut().zip(parts) {
            *total = matrix + sin * turn + (1.0 - cos) * turn_twice;
        }
        Affine3A::from_cols_array(&sum)
    }
}

/// The row that gives the coordinate along `axis` in joint space of a point of mesh space.
fn along(inverse_bind: Affine3A, axis: DVec3) -> Vec4 {
    let inverse_bind = inverse_bind.as_daffine3();
    let row = inverse_bind.matrix3.transpose() * axis;
    row.extend(inverse_bind.translation.dot(axis)).as_vec4()
}

/// The matrix K with K·p = axis × p.
fn cross_matrix(axis: DVec3) -> Mat3A {
    let DVec3 { x, y, z } = axis;
    let columns = [DVec3::new(0.0, z, -y), DVec3::new(-z, 0.0, x), DVec3::new(y, -x, 0.0)]
        .map(DVec3::as_vec3a);
    Mat3A::from_cols(columns[0], columns[1], columns[2])
}
