use glam::{DMat3, DVec3};

/// The start joint's axes M_s.
pub struct StartAxes {
    /// M_s⁻¹ times det M_s.
    pub adjugate: DMat3,
    pub determinant: f64,
    pub inv_determinant: f64,
    /// Sum of the squared elements of the adjugate.
    pub square: f64,
    pub is_regular: bool,
}

/// The middle joint's axes in start joint space, M = M_s⁻¹·M_m.
pub struct MiddleAxes {
    pub axes_ds: DMat3,
    /// M⁻ᵀ times det M.
    pub cofactors: DMat3,
    pub determinant: f64,
    pub inv_determinant: f64,
    /// Scale, negative for a joint that mirrors.
    pub scale: f64,
    pub inv_scale_squared: f64,
    pub is_regular: bool,
}

impl StartAxes {
    #[inline(always)]
    pub fn new(axes: DMat3) -> Self {
        // Limit of the bound ab/c² on the condition number a/c, which is then 1000 for a = b.
        const MAX_BOUND: f64 = 1e6;
        const MIN_SQUARE: f64 = 1e-40;
        const MAX_SQUARE: f64 = 1e40;
        let cofactors = cofactors(axes);
        let determinant = axes.x_axis.dot(cofactors.x_axis);
        let square = square(cofactors);
        // With the singular values a ≥ b ≥ c, a/c is at most ab/c² = (ab)³/(abc)².
        let worst = MAX_BOUND * (determinant * determinant);
        let is_regular = (square * square * square <= worst * worst)
            & (square > MIN_SQUARE)
            & (square < MAX_SQUARE);
        let inv_determinant = 1.0 / determinant;
        Self { adjugate: cofactors.transpose(), determinant, inv_determinant, square, is_regular }
    }
}

impl MiddleAxes {
    #[inline(always)]
    pub fn new(axes_ds: DMat3) -> Self {
        // Root of the sum of the squared relative deviations of the singular values from their
        // mean.
        const MAX_DEVIATION: f64 = 5e-6;
        const MIN_SQUARE: f64 = 1e-60;
        const MAX_SQUARE: f64 = 1e60;
        let cofactors = cofactors(axes_ds);
        let determinant = axes_ds.x_axis.dot(cofactors.x_axis);
        let scale_squared = square(axes_ds) * (1.0 / 3.0);
        let inv_product = 1.0 / (scale_squared * determinant);
        let inv_scale_squared = inv_product * determinant;
        let scale = determinant * inv_scale_squared;
        // det²/s⁶, the product of the squared singular values divided by the cube of their mean: 1
        // for a similarity, else 1 − 2 Σ deviation², to second order.
        let similarity = scale * scale * inv_scale_squared;
        let is_regular = (similarity >= 1.0 - 2.0 * MAX_DEVIATION * MAX_DEVIATION)
            & (scale_squared > MIN_SQUARE)
            & (scale_squared < MAX_SQUARE);
        let inv_determinant = inv_product * scale_squared;
        Self {
            axes_ds,
            cofactors,
            determinant,
            inv_determinant,
            scale,
            inv_scale_squared,
            is_regular,
        }
    }

    /// Converts an axis of turns from middle joint space, but for its length: see
    /// [`JointChain::axis_ss`](crate::job::chain::JointChain::axis_ss).
    #[inline(always)]
    pub fn axis(&self, axis: DVec3) -> DVec3 {
        self.axes_ds * axis * sign(self.determinant)
    }

    /// Converts a unit axis of turns to middle joint space: see
    /// [`JointChain::axis_in_middle`](crate::job::chain::JointChain::axis_in_middle). For regular
    /// axes, its length stays 1 to about the square of their deviation from a similarity.
    #[inline(always)]
    pub fn to_middle_space(&self, axis: DVec3) -> DVec3 {
        let doubled = self.axes_ds * self.scale + self.cofactors;
        doubled.transpose_mul_vec3(axis) * (0.5 * self.inv_scale_squared)
    }
}

/// Cofactors of a matrix: its inverse's transpose times its determinant.
#[inline(always)]
pub fn cofactors(DMat3 { x_axis: x, y_axis: y, z_axis: z }: DMat3) -> DMat3 {
    DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y))
}

/// Sum of the squared elements.
#[inline(always)]
fn square(DMat3 { x_axis: x, y_axis: y, z_axis: z }: DMat3) -> f64 {
    x.length_squared() + y.length_squared() + z.length_squared()
}

#[inline(always)]
pub fn sign(of: f64) -> f64 {
    1.0_f64.copysign(of)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Axes in a turned space, with these lengths.
    fn axes(lengths: [f64; 3]) -> DMat3 {
        let turn = DMat3::from_axis_angle(DVec3::new(0.48, 0.6, 0.64), 0.7);
        turn * DMat3::from_diagonal(lengths.into()) * DMat3::from_rotation_x(0.4)
    }

    #[test]
    fn start_axes_are_regular_up_to_a_condition_number_and_within_a_range_of_lengths() {
        let is_regular = |lengths| StartAxes::new(axes(lengths)).is_regular;
        for scale in [1e-6, 1.0, -1.0, 1e6] {
            for flat in [1e-3, -1e-3] {
                assert!(is_regular([scale, scale, 1.01 * flat * scale]), "{scale}, {flat}");
                assert!(!is_regular([scale, scale, 0.99 * flat * scale]), "{scale}, {flat}");
            }
        }
        // The squares of three products of two lengths are added.
        let least = 1e-10 / 3_f64.sqrt().sqrt();
        let most = 1e10 / 3_f64.sqrt().sqrt();
        assert!(is_regular([1.01 * least; 3]) && !is_regular([0.99 * least; 3]));
        assert!(is_regular([0.99 * most; 3]) && !is_regular([1.01 * most; 3]));
        assert!(!is_regular([0.0; 3]) && !is_regular([f64::NAN; 3]));
    }

    #[test]
    fn middle_axes_are_regular_if_they_are_a_similarity_within_a_range_of_lengths() {
        let is_regular = |lengths| MiddleAxes::new(axes(lengths)).is_regular;
        // One length longer by d: deviations of 2d/3, −d/3 and −d/3 from the mean.
        let different = 5e-6 / (6_f64.sqrt() / 3.0);
        for scale in [1e-25, 1e-3, 1.0, -1.0, 1e3, 1e25] {
            assert!(is_regular([scale * (1.0 + 0.98 * different), scale, scale]), "{scale}");
            assert!(!is_regular([scale * (1.0 + 1.02 * different), scale, scale]), "{scale}");
        }
        for [regular, irregular] in [[1.01e-30, 0.99e-30], [0.99e30, 1.01e30]] {
            assert!(is_regular([regular; 3]) && !is_regular([irregular; 3]), "{regular}");
        }
        assert!(!is_regular([0.0; 3]) && !is_regular([f64::NAN; 3]));
    }
}
