use glam::{Affine3A, Mat3, Vec3};

/// A tapered cylinder along +x from the origin.
///
/// [`TaperedCylinder::between`] builds the rotation from an orthonormal basis, without an arc
/// cosine, so that it is exact in every direction.
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
    /// Returns the cylinder from `base` to `tip` and the transform that places it there: a
    /// translation to `base`, and a rotation that turns +x towards `tip`, with any roll. If both
    /// points coincide, +x keeps its direction.
    pub fn between(base: Vec3, tip: Vec3, base_radius: f32, tip_radius: f32) -> (Affine3A, Self) {
        let (x, length) = direction_and_length(tip - base);
        let (y, z) = x.any_orthonormal_pair();
        let place = Affine3A::from_mat3_translation(Mat3::from_cols(x, y, z), base);
        (place, Self { length, base_radius, tip_radius })
    }

    /// As [`Self::between`], for ends in the xy-plane: the rotation is about z.
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

/// Direction and length of a vector; +x and 0 for the zero vector. The vector is scaled before it
/// is squared, so that neither huge nor tiny vectors lose their direction.
fn direction_and_length(v: Vec3) -> (Vec3, f32) {
    let size = v.abs().max_element();
    if size == 0.0 {
        return (Vec3::X, 0.0);
    }
    let (direction, length) = (v / size).normalize_and_length();
    (direction, length * size)
}
