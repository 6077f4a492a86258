//! Euler angles of joints in f64, so that errors do not add up along a long chain.

use core::array;
use core::f64::consts::PI;

use glam::{DMat3, DQuat, DVec3};

use crate::angle;

/// Of all angles about x, y and z for which R_z · R_y · R_x is `rotation`, returns those nearest to
/// `near`, in radians. Every rotation has two such triples of angles, and each angle is determined
/// up to whole turns. At y = ±90°, where x and z turn about the same axis, z is taken from `near`.
///
/// This is [`nearest_angles`](super::nearest_angles), but in f64.
pub fn nearest(rotation: DMat3, near: DVec3) -> DVec3 {
    const GIMBAL: f64 = 1e-9;
    let DMat3 { x_axis, y_axis, z_axis } = rotation;
    let cos_y = x_axis.x.hypot(x_axis.y);
    let y = (-x_axis.z).atan2(cos_y);
    let z = if cos_y > GIMBAL { x_axis.y.atan2(x_axis.x) } else { near.z };
    let (sin_z, cos_z) = z.sin_cos();
    let x = (sin_z * z_axis.x - cos_z * z_axis.y).atan2(cos_z * y_axis.y - sin_z * y_axis.x);

    let unwrap = |angles: DVec3| {
        DVec3::from_array(array::from_fn(|i| angle::nearest_f64(angles[i], near[i])))
    };
    let first = unwrap(DVec3::new(x, y, z));
    let second = unwrap(DVec3::new(x + PI, PI - y, z + PI));
    if first.distance_squared(near) <= second.distance_squared(near) { first } else { second }
}

/// The rotation R_z · R_y · R_x for angles about x, y and z, in radians.
pub fn matrix(angles: DVec3) -> DMat3 {
    DMat3::from_rotation_z(angles.z)
        * DMat3::from_rotation_y(angles.y)
        * DMat3::from_rotation_x(angles.x)
}

/// Angles between those of two rotations, at the part `s` of the way along the shortest turn: the
/// ones nearest to the straight line from `from` to `to`. All in radians.
pub fn slerp(from: DVec3, to: DVec3, s: f64) -> DVec3 {
    let [start, end] = [from, to].map(|angles| DQuat::from_mat3(&matrix(angles)));
    let between = start.slerp(end, s).normalize();
    nearest(DMat3::from_quat(between), from.lerp(to, s))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_read_from_a_rotation_make_that_rotation_and_are_near() {
        let steps = || (-7..=7).map(|step| f64::from(step) * PI / 6.0);
        for x in steps() {
            for y in steps() {
                for z in steps() {
                    let angles = DVec3::new(x, y, z);
                    for near in [DVec3::ZERO, angles, DVec3::new(40.0, -3.0, 9.0)] {
                        let read = nearest(matrix(angles), near);
                        assert!(matrix(read).abs_diff_eq(matrix(angles), 1e-8), "{angles} {read}");
                        assert!((read - near).abs().max_element() < 1.5 * PI + 1e-6);
                    }
                }
            }
        }
    }
}
