use glam::{Affine3A, DMat3, DVec3, Mat3};
use nalgebra::Matrix3;

/// A skeleton's transform M · p + t, decomposed for BVH, which has rotations but no scale and
/// shear.
///
/// If M = s·Q with Q orthogonal (possibly a mirror), a rotation R in the skeleton is the rotation
/// Q·R·Qᵀ in the world. If M has uneven scale, shear or zero scale, no such rotation exists. A
/// joint then gets the rotation W for which W·M is nearest to M·G, where G is the joint's rotation
/// in the skeleton. The joints' positions are exact all the same: they are written as offsets that
/// change over time.
pub struct SkeletonTransform {
    matrix: DMat3,
    translation: DVec3,
    /// The orthogonal Q of M = s·Q; `None` if M has uneven scale, shear or zero scale.
    orthogonal: Option<DMat3>,
}

impl SkeletonTransform {
    pub fn new(transform: Affine3A) -> Self {
        let matrix = Mat3::from(transform.matrix3).as_dmat3();
        let translation = transform.translation.as_dvec3();
        Self { matrix, translation, orthogonal: orthogonal(matrix) }
    }

    /// Returns whether the transform makes every rotation in the skeleton a rotation in the world,
    /// as it does without uneven scale, shear and zero scale.
    pub fn is_even(&self) -> bool {
        self.orthogonal.is_some()
    }

    pub fn origin(&self) -> DVec3 {
        self.translation
    }

    /// Converts a vector of the space in which a joint without a parent has its offset.
    pub fn vector(&self, vector: DVec3) -> DVec3 {
        self.matrix * vector
    }

    /// Converts the joints' rotations relative to their parents from the skeleton's axes to world
    /// axes. Parents come before their children.
    pub fn nodes(&self, parents: &[Option<usize>], locals: &[DMat3]) -> Vec<BvhNodeTransform> {
        if let Some(orthogonal) = self.orthogonal {
            let node = |local: &DMat3| BvhNodeTransform {
                rotation: orthogonal * *local * orthogonal.transpose(),
                vectors: self.matrix,
            };
            return locals.iter().map(node).collect();
        }
        let (mut globals, mut worlds, mut nodes) = (Vec::new(), Vec::new(), Vec::new());
        for (local, parent) in locals.iter().zip(parents) {
            let parent_of = |all: &[DMat3]| parent.map_or(DMat3::IDENTITY, |parent| all[parent]);
            let global = parent_of(&globals) * *local;
            let world = nearest(self.matrix * global * self.matrix.transpose());
            nodes.push(BvhNodeTransform {
                rotation: parent_of(&worlds).transpose() * world,
                vectors: world.transpose() * self.matrix * global,
            });
            globals.push(global);
            worlds.push(world);
        }
        nodes
    }
}

/// The transform of a node of the file in one frame.
pub struct BvhNodeTransform {
    /// Rotation relative to the parent, in world axes.
    pub rotation: DMat3,
    /// Converts a vector of the joint's space to the node's space: an offset of a child, or the
    /// bone.
    pub vectors: DMat3,
}

/// The orthogonal Q of a matrix s·Q; `None` if the matrix has uneven scale, shear or zero scale.
fn orthogonal(matrix: DMat3) -> Option<DMat3> {
    /// Tolerance for right angles and equal lengths; the same as for the frames of joints.
    const EVEN: f64 = 1e-5;
    let square = matrix.transpose() * matrix;
    let size = (square.x_axis.x + square.y_axis.y + square.z_axis.z) / 3.0;
    let is_even = size > 0.0 && (square * size.recip()).abs_diff_eq(DMat3::IDENTITY, EVEN);
    // The matrix was rounded to f32 and is orthogonal only nearly. The nearest rotation is
    // orthogonal in f64.
    let sign = matrix.determinant().signum();
    is_even.then(|| nearest(matrix * (sign / size.sqrt())) * sign)
}

/// The rotation W that minimizes ‖W − matrix‖; the identity for a zero or non-finite matrix.
fn nearest(matrix: DMat3) -> DMat3 {
    const PRECISION: f64 = 1e-15;
    const STEPS: usize = 1000;
    let size = matrix.to_cols_array().into_iter().map(f64::abs).fold(0.0, f64::max);
    if !(size.is_normal() && size.recip().is_normal()) {
        return DMat3::IDENTITY;
    }
    let unit = matrix * size.recip();
    let decomposed = Matrix3::from_column_slice(&unit.to_cols_array())
        .try_svd(true, true, PRECISION, STEPS)
        .and_then(|svd| Some((svd.u?, svd.v_t?)));
    let Some((u, v_t)) = decomposed else {
        return DMat3::IDENTITY;
    };
    // The singular values are in descending order. The mirror is applied to the last, smallest one.
    let mirror = (u * v_t).determinant().signum();
    let rotation = u * Matrix3::from_diagonal(&[1.0, 1.0, mirror].into()) * v_t;
    let rotation = DMat3::from_cols_slice(rotation.as_slice());
    if rotation.is_finite() { rotation } else { DMat3::IDENTITY }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_rotation_to_a_rotation_is_itself() {
        let rotation = DMat3::from_rotation_z(1.0) * DMat3::from_rotation_x(-2.0);
        assert!(nearest(rotation * 7.0).abs_diff_eq(rotation, 1e-12));
        assert_eq!(nearest(DMat3::ZERO), DMat3::IDENTITY);
    }

    #[test]
    fn a_mirrored_and_scaled_transform_is_even_and_a_stretched_one_is_not() {
        let turned = Affine3A::from_rotation_x(0.7) * Affine3A::from_rotation_z(2.0);
        let scaled = |x, y, z| Affine3A::from_scale((x, y, z).into()) * turned;
        assert!(SkeletonTransform::new(scaled(-0.3, 0.3, 0.3)).is_even());
        assert!(!SkeletonTransform::new(scaled(0.3, 0.3, 0.301)).is_even());
        assert!(!SkeletonTransform::new(scaled(0.0, 1.0, 1.0)).is_even());
        assert!(!SkeletonTransform::new(scaled(0.0, 0.0, 0.0)).is_even());
    }
}
