use core::array;
use core::f32::consts::PI;

use glam::{DMat3, Mat3A, Vec3, Vec3A};

use crate::angle;

/// Euler angles about x, y and z, applied in this order, radians.
#[derive(Clone, Copy, Debug)]
pub(crate) struct JointAngles(pub Vec3);

impl JointAngles {
    /// R_z · R_y · R_x.
    pub fn matrix(self) -> Mat3A {
        self.matrix_and_axes().0
    }

    /// Rotation axes of the angles as columns: R_z · R_y · e_x, R_z · e_y and e_z.
    pub fn axes(self) -> Mat3A {
        self.matrix_and_axes().1
    }

    /// [`Self::matrix`] and [`Self::axes`].
    pub fn matrix_and_axes(self) -> (Mat3A, Mat3A) {
        let (sx, cx) = self.0.x.sin_cos();
        let (sy, cy) = self.0.y.sin_cos();
        let (sz, cz) = self.0.z.sin_cos();
        let x_axis = Vec3A::new(cz * cy, sz * cy, -sy);
        let matrix = Mat3A::from_cols(
            x_axis,
            Vec3A::new(cz * sy * sx - sz * cx, sz * sy * sx + cz * cx, cy * sx),
            Vec3A::new(cz * sy * cx + sz * sx, sz * sy * cx - cz * sx, cy * cx),
        );
        (matrix, Mat3A::from_cols(x_axis, Vec3A::new(-sz, cz, 0.0), Vec3A::Z))
    }
}

/// Euler angles of the rotation R_z · R_y · R_x: of all equivalent triples, the one nearest to
/// `near`. Every rotation has two triples, and each may change by full turns. At y = ±90°, where x
/// and z rotate about the same axis, z is that of `near`.
pub fn nearest_angles(rotation: Mat3A, near: Vec3) -> Vec3 {
    angle_triples(rotation, near)[0]
}

/// [`nearest_angles`] of a rotation in f64: exact also near y = ±90°.
pub(crate) fn nearest_angles_f64(rotation: DMat3, near: Vec3) -> Vec3 {
    const GIMBAL: f64 = 1e-9;
    let DMat3 { x_axis, y_axis, z_axis } = rotation;
    let cos_y = x_axis.x.hypot(x_axis.y);
    let y = (-x_axis.z).atan2(cos_y);
    let z = if cos_y > GIMBAL { x_axis.y.atan2(x_axis.x) } else { near.z.into() };
    let (sin_z, cos_z) = z.sin_cos();
    let x = (sin_z * z_axis.x - cos_z * z_axis.y).atan2(cos_z * y_axis.y - sin_z * y_axis.x);
    equivalent_triples(glam::DVec3::new(x, y, z).as_vec3(), near)[0]
}

/// Both Euler triples of the rotation R_z · R_y · R_x, each shifted by full turns to be nearest to
/// `near`. The nearer triple is first.
pub(crate) fn angle_triples(rotation: Mat3A, near: Vec3) -> [Vec3; 2] {
    const GIMBAL: f32 = 1e-6;
    let Mat3A { x_axis, y_axis, z_axis } = rotation;
    let cos_y = x_axis.x.hypot(x_axis.y);
    let y = (-x_axis.z).atan2(cos_y);
    let z = if cos_y > GIMBAL { x_axis.y.atan2(x_axis.x) } else { near.z };
    let (sin_z, cos_z) = z.sin_cos();
    // From R_z⁻¹ · R, where sine and cosine of x are never both small.
    let x = (sin_z * z_axis.x - cos_z * z_axis.y).atan2(cos_z * y_axis.y - sin_z * y_axis.x);

    equivalent_triples(Vec3::new(x, y, z), near)
}

/// Both Euler triples of the rotation of `angles`, as [`angle_triples`] gives them.
pub(crate) fn equivalent_triples(angles: Vec3, near: Vec3) -> [Vec3; 2] {
    let Vec3 { x, y, z } = angles;
    let unwrapped =
        |angles: Vec3| Vec3::from_array(array::from_fn(|i| angle::nearest(angles[i], near[i])));
    let one = unwrapped(angles);
    let other = unwrapped(Vec3::new(x + PI, PI - y, z + PI));
    let is_nearer = one.distance_squared(near) <= other.distance_squared(near);
    if is_nearer { [one, other] } else { [other, one] }
}

#[cfg(test)]
mod tests {
    use glam::Mat3A;

    use super::*;

    fn angles() -> impl Iterator<Item = Vec3> {
        let steps = || (-7..=7).map(|step| step as f32 * PI / 6.0);
        steps().flat_map(move |x| steps().flat_map(move |y| steps().map(move |z| (x, y, z).into())))
    }

    #[test]
    fn the_matrix_is_the_product_of_three_rotations_x_first() {
        for a in angles() {
            let product = Mat3A::from_rotation_z(a.z)
                * Mat3A::from_rotation_y(a.y)
                * Mat3A::from_rotation_x(a.x);
            assert!(JointAngles(a).matrix().abs_diff_eq(product, 1e-6), "{a}");
        }
    }

    #[test]
    fn angles_read_from_a_rotation_make_that_rotation() {
        for a in angles() {
            let rotation = JointAngles(a).matrix();
            for near in [Vec3::ZERO, a, Vec3::new(40.0, -3.0, 9.0)] {
                let read = nearest_angles(rotation, near);
                let made = JointAngles(read).matrix();
                assert!(made.abs_diff_eq(rotation, 2e-5), "{a} read as {read} near {near}");
            }
        }
    }

    #[test]
    fn angles_away_from_the_gimbal_are_found_again_near_themselves() {
        for a in angles().filter(|a| a.y.cos().abs() > 0.1) {
            let read = nearest_angles(JointAngles(a).matrix(), a + 0.01);
            assert!(read.distance(a) < 1e-4, "{a} read as {read}");
        }
    }
}
