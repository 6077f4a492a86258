use glam::{Affine3A, DAffine3, DMat3, DQuat, DVec3, Mat3A, Quat, Vec4};

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

    /// Adds a weighted motion; with a negative weight if its rotation is in the other hemisphere than
    /// `near`. q and −q are the same motion.
    pub fn add(&mut self, weight: f32, other: &Self, near: Vec4) {
        let weight = if other.real.dot(near) < 0.0 { -weight } else { weight };
        self.real += weight * other.real;
        self.dual += weight * other.dual;
    }

    /// The rigid motion of a sum, scaled to unit length. Rotations in one hemisphere do not cancel out.
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

/// A transform as a rigid motion after a scale: `motion · scale`. The polar decomposition of the linear
/// part; a mirroring transform has a mirroring scale. A singular transform has no rotation.
pub fn motion_and_scale(transform: Affine3A) -> (DualQuaternion, Mat3A) {
    let DAffine3 { matrix3, translation } = transform.as_daffine3();
    let rotation = nearest_rotation(matrix3);
    // Exact for rigid transforms, so that their scale does not blur the mesh.
    let is_rigid = matrix3.abs_diff_eq(rotation, 1e-6);
    let scale = if is_rigid { DMat3::IDENTITY } else { rotation.transpose() * matrix3 };
    let motion = DualQuaternion::new(DQuat::from_mat3(&rotation).normalize(), translation);
    (motion, Mat3A::from(scale.as_mat3()))
}

/// The rotation nearest to a matrix, by Newton's iteration R ← (R + R⁻ᵀ)/2 (Higham 1986), which squares
/// the error in each step.
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
