use glam::{Affine3A, Mat3, Vec3};

/// A tapered cylinder along +x from the origin.
///
/// [`TaperedCylinder::between`] builds its rotation from a basis, without an arc cosine, and is exact in every
/// direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TaperedCylinder {
    /// Length along +x.
    pub length: f32,
    /// Radius at the origin.
    pub base_radius: f32,
    /// Radius at `length`; 0 makes a true cone.
    pub tip_radius: f32,
}

impl TaperedCylinder {
    /// The cone from `base` to `tip`, with the transform that places it: a rotation whose +x points at
    /// the tip, with any roll, and a translation to the base. Coinciding ends keep +x.
    pub fn between(base: Vec3, tip: Vec3, base_radius: f32, tip_radius: f32) -> (Affine3A, Self) {
        let (x, length) = direction_and_length(tip - base);
        let (y, z) = x.any_orthonormal_pair();
        let place = Affine3A::from_mat3_translation(Mat3::from_cols(x, y, z), base);
        (place, Self { length, base_radius, tip_radius })
    }

    /// As [`Self::between`] for ends in the xy-plane, with a rotation about z.
    pub fn in_xy_plane(
        base: Vec3,
        tip: Vec3,
        base_radius: f32,
        tip_radius: f32,
    ) -> (Affine3A, Self) {
        let (x, length) = direction_and_length((tip - base).with_z(0.0));
        let y = Vec3::new(-x.y, x.x, 0.0);
        let place = Affine3A::from_mat3_translation(Mat3::from_cols(x, y, Vec3::Z), base);
        (place, Self { length, base_radius, tip_radius })
    }
}

/// Scaled before it is squared, so that neither huge nor tiny vectors lose their direction.
fn direction_and_length(v: Vec3) -> (Vec3, f32) {
    let size = v.abs().max_element();
    if size == 0.0 {
        return (Vec3::X, 0.0);
    }
    let (direction, length) = (v / size).normalize_and_length();
    (direction, length * size)
}
