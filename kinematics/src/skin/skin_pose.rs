use core::fmt;
use core::str::FromStr;

use glam::{Affine3A, DAffine3, DMat3, DQuat, DVec3, Mat3A, Quat, Vec3, Vec4};

use super::vertex_weights::VertexWeights;
use crate::skeleton::{Joint, Skeleton, SkeletonPose};

/// A way of blending the joints of a vertex. See [the module](super).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Skinning {
    /// Weighted sum of the joints' matrices.
    Linear,
    /// Weighted sum of the joints' unit dual quaternions, after their scales.
    #[default]
    DualQuaternion,
    /// Linear, with each bone's roll spread along the bone.
    SpreadTwist,
}

impl Skinning {
    /// All methods.
    pub const ALL: [Self; 3] = [Self::Linear, Self::DualQuaternion, Self::SpreadTwist];

    /// Name on screen.
    pub fn title(self) -> &'static str {
        match self {
            Self::Linear => "Linear",
            Self::DualQuaternion => "Dual quaternions",
            Self::SpreadTwist => "Spread twist",
        }
    }
}

impl fmt::Display for Skinning {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(match self {
            Self::Linear => "linear",
            Self::DualQuaternion => "dual-quaternion",
            Self::SpreadTwist => "spread-twist",
        })
    }
}

/// A text names no way to blend joints.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("skinning must be linear, dual-quaternion or spread-twist, got {0}")]
pub struct UnknownSkinning(pub String);

impl FromStr for Skinning {
    type Err = UnknownSkinning;

    fn from_str(text: &str) -> Result<Self, UnknownSkinning> {
        let named = Self::ALL.into_iter().find(|skinning| skinning.to_string() == text);
        named.ok_or_else(|| UnknownSkinning(text.to_owned()))
    }
}

/// The motion that each joint of a posed skeleton gives to a mesh, for all ways of blending.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SkinPose {
    joints: Vec<JointDeform>,
    to_world: Affine3A,
    /// Transforms of the joints in skeleton space.
    spaces: SkeletonPose,
}

/// The motion that one joint gives to a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointDeform {
    /// J = X·S·B⁻¹ from mesh space to skeleton space.
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
    /// X·K·S·B⁻¹, where K·p = â × p with the unit vector â along the bone.
    pub turn: Affine3A,
    /// X·K²·S·B⁻¹.
    pub turn_twice: Affine3A,
}

impl SkinPose {
    /// Writes the joints of a posed skeleton, for each set of inverse bind transforms. Joints beyond
    /// these, which no vertex follows, are left out.
    pub(super) fn refill<'a>(
        &mut self,
        bind_sets: impl Iterator<Item = &'a [Affine3A]>,
        skeleton: &Skeleton,
    ) {
        skeleton.write_pose_in_skeleton(&mut self.spaces);
        let deform = |((joint, parameters), inverse_bind)| {
            JointDeform::new(parameters, self.spaces.full(joint), inverse_bind)
        };
        self.joints.clear();
        for inverse_binds in bind_sets {
            self.joints.extend(skeleton.iter().zip(inverse_binds.iter().copied()).map(deform));
        }
        self.to_world = skeleton.transform();
    }

    /// The joints in their order, for each [set](super::BindSet) of inverse bind transforms.
    pub fn joints(&self) -> &[JointDeform] {
        &self.joints
    }

    /// Transform from skeleton space to the world, applied after blending.
    pub fn to_world(&self) -> Affine3A {
        self.to_world
    }

    /// The transform of a vertex at `position` in mesh space, to skeleton space. `first` is the index
    /// of the first joint of its set.
    pub(super) fn blend(
        &self,
        first: usize,
        weights: &VertexWeights,
        position: Vec3,
        skinning: Skinning,
    ) -> Affine3A {
        let joints = SetJoints(self.joints.get(first..).unwrap_or_default());
        match skinning {
            Skinning::Linear => joints.sum(weights, |joint| joint.matrix),
            Skinning::DualQuaternion => joints.dual_quaternion(weights),
            Skinning::SpreadTwist => joints.sum(weights, |joint| joint.with_spread_roll(position)),
        }
    }
}

/// The joints of a set of inverse bind transforms, and those of the sets after it.
struct SetJoints<'a>(&'a [JointDeform]);

impl SetJoints<'_> {
    /// Blend of the joints' unit dual quaternions, after the linear blend of their scales.
    fn dual_quaternion(&self, weights: &VertexWeights) -> Affine3A {
        let Some(first) = self.0.get(weights.first().index()) else {
            return Affine3A::IDENTITY;
        };
        let mut scale = Mat3A::ZERO;
        let mut sum = DualQuaternion::ZERO;
        for (joint, weight) in weights.iter() {
            let Some(joint) = self.0.get(joint.index()) else { continue };
            scale += joint.scale * weight;
            let motion = DualQuaternion { real: joint.real, dual: joint.dual };
            sum.add(weight, &motion, first.real);
        }
        let mut motion = sum.motion();
        motion.matrix3 *= scale;
        motion
    }

    /// Linear blend of transforms of the joints of a vertex.
    fn sum(
        &self,
        weights: &VertexWeights,
        transform: impl Fn(&JointDeform) -> Affine3A,
    ) -> Affine3A {
        let mut sum = [0.0; 12];
        for (joint, weight) in weights.iter() {
            let Some(joint) = self.0.get(joint.index()) else { continue };
            for (total, value) in sum.iter_mut().zip(transform(joint).to_cols_array()) {
                *total += weight * value;
            }
        }
        Affine3A::from_cols_array(&sum)
    }
}

impl JointDeform {
    fn new(joint: &Joint, space: Affine3A, inverse_bind: Affine3A) -> Self {
        let fraction = |axis| along(inverse_bind, axis);
        let inverse_bind = joint.stretched(inverse_bind);
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
            along: fraction(axis / length),
            turn: turn(cross),
            turn_twice: turn(cross * cross),
        }
    }

    /// J with the roll t·τ instead of τ, where t is the fraction of the bone at a point of mesh
    /// space: X·Rot(â, φ)·S·B⁻¹ with φ = −(1 − t)·τ, by Rodrigues' formula Rot = 1 + sin φ·K + (1 −
    /// cos φ)·K².
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

/// A rigid motion as a unit dual quaternion: rotation `real`, then translation `2·dual·real*`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DualQuaternion {
    /// The rotation.
    pub real: Vec4,
    /// Half the translation (as a quaternion with w = 0) times the rotation.
    pub dual: Vec4,
}

impl DualQuaternion {
    pub fn new(rotation: DQuat, translation: DVec3) -> Self {
        let dual = DQuat::from_vec4((translation * 0.5).extend(0.0)) * rotation;
        Self { real: Vec4::from(rotation.as_quat()), dual: Vec4::from(dual.as_quat()) }
    }

    /// The zero of [`DualQuaternion::add`]; not a motion.
    pub const ZERO: Self = Self { real: Vec4::ZERO, dual: Vec4::ZERO };

    /// Adds a weighted motion; with a negative weight if its rotation is in the other hemisphere
    /// than `near`. q and −q are the same motion.
    pub fn add(&mut self, weight: f32, other: &Self, near: Vec4) {
        let weight = if other.real.dot(near) < 0.0 { -weight } else { weight };
        self.real += weight * other.real;
        self.dual += weight * other.dual;
    }

    /// The rigid motion of a sum, scaled to unit length. Rotations in one hemisphere do not cancel
    /// out.
    pub fn motion(&self) -> Affine3A {
        let length = self.real.length();
        if length == 0.0 {
            return Affine3A::IDENTITY;
        }
        let (real, dual) = (self.real / length, self.dual / length);
        let (vector, dual_vector) = (real.truncate(), dual.truncate());
        let translation =
            2.0 * (real.w * dual_vector - dual.w * vector + vector.cross(dual_vector));
        Affine3A::from_rotation_translation(Quat::from_vec4(real), translation)
    }
}

/// A transform as a rigid motion after a scale: `motion · scale`. The polar decomposition of the
/// linear part; a mirroring transform has a mirroring scale. A singular transform has no rotation.
pub fn motion_and_scale(transform: Affine3A) -> (DualQuaternion, Mat3A) {
    let DAffine3 { matrix3, translation } = transform.as_daffine3();
    let rotation = nearest_rotation(matrix3);
    // Exact for rigid transforms, so that their scale does not blur the mesh.
    let is_rigid = matrix3.abs_diff_eq(rotation, 1e-6);
    let scale = if is_rigid { DMat3::IDENTITY } else { rotation.transpose() * matrix3 };
    let motion = DualQuaternion::new(DQuat::from_mat3(&rotation).normalize(), translation);
    (motion, Mat3A::from(scale.as_mat3()))
}

/// The rotation nearest to a matrix, by Newton's iteration R ← (R + R⁻ᵀ)/2 (Higham 1986), which
/// squares the error in each step.
fn nearest_rotation(matrix: DMat3) -> DMat3 {
    let determinant = matrix.determinant();
    let size = determinant.abs().cbrt();
    if !(size.is_finite() && size > 1e-30) {
        return DMat3::IDENTITY;
    }
    let mut rotation = matrix * (1.0 / size).copysign(determinant);
    for _ in 0..50 {
        let next = (rotation + rotation.inverse().transpose()) * 0.5;
        if !next.is_finite() {
            return DMat3::IDENTITY;
        }
        let is_settled = next.abs_diff_eq(rotation, 1e-14);
        rotation = next;
        if is_settled {
            break;
        }
    }
    rotation
}

/// The roll τ of a rotation about a unit axis, in (−π, π]: the rotation is a swing of the axis
/// after a rotation about the axis by τ. It is 0 where the rotation turns the axis around by 180°,
/// where any roll would do.
pub fn roll(rotation: DQuat, axis: DVec3) -> f64 {
    let (cos, sin) = (rotation.w, rotation.xyz().dot(axis));
    let sign = if cos < 0.0 { -1.0 } else { 1.0 };
    if cos.hypot(sin) > 1e-9 { 2.0 * (sign * sin).atan2(sign * cos) } else { 0.0 }
}
