use glam::Vec3;
use nalgebra::{Matrix3, SymmetricEigen, Vector3};

use crate::skeleton::JointId;

/// The velocities that a tip has while all angles together turn at one radian per second: the
/// ellipsoid of J·Jᵀ, with the columns of the Jacobian J.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipsoid {
    /// The joint whose tip moves.
    pub tip: JointId,
    /// Position of the tip.
    pub centre: Vec3,
    /// Unit axes, perpendicular to each other, the longest first.
    pub axes: [Vec3; 3],
    /// The singular values σ of J, the lengths of the axes, the greatest first.
    pub values: [f32; 3],
}

impl Ellipsoid {
    /// The ellipsoid of a tip whose velocities, one for each angle, are `columns`.
    pub(super) fn of(tip: JointId, centre: Vec3, columns: impl Iterator<Item = Vec3>) -> Self {
        let mut square = Matrix3::<f64>::zeros();
        for column in columns {
            let by = Vector3::from(column.as_dvec3().to_array());
            square += by * by.transpose();
        }
        let eigen = SymmetricEigen::new(square);
        let mut order = [0, 1, 2];
        order.sort_by(|one, other| eigen.eigenvalues[*other].total_cmp(&eigen.eigenvalues[*one]));
        let axis = |index: usize| {
            let axis = eigen.eigenvectors.column(index);
            Vec3::new(axis[0] as f32, axis[1] as f32, axis[2] as f32)
        };
        let value = |index: usize| eigen.eigenvalues[index].max(0.0).sqrt() as f32;
        Self { tip, centre, axes: order.map(axis), values: order.map(value) }
    }

    /// Fraction of the residual along each axis that a step of damped least squares takes away:
    /// σ² / (σ² + λ²).
    pub fn gains(&self, damping: f32) -> [f32; 3] {
        self.values.map(|value| {
            let (square, damping) = (f64::from(value).powi(2), f64::from(damping).powi(2));
            if square > 0.0 { (square / (square + damping)) as f32 } else { 0.0 }
        })
    }
}
