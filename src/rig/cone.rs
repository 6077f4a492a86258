use glam::{Affine3A, Mat3, Vec3};

/// A cylinder that tapers, lying along its own +x from the origin: a limb, a bone, an axis.
///
/// The seed places its cylinders by an axis and an angle from an arc cosine, which needs a special
/// case near ±y; [`Cone::between`] builds a basis from the axis instead and is exact everywhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    pub length: f32,
    /// Radius at the origin.
    pub base_radius: f32,
    /// Radius at `length`; 0 makes a true cone.
    pub tip_radius: f32,
}

impl Cone {
    /// The cone from `base` to `tip`, and where it stands: a rotation whose +x points at the tip
    /// (any of those there are), and a translation to the base. Where the ends meet, +x is kept.
    pub fn between(base: Vec3, tip: Vec3, base_radius: f32, tip_radius: f32) -> (Affine3A, Self) {
        let (x, length) = direction_and_length(tip - base);
        let (y, z) = x.any_orthonormal_pair();
        let place = Affine3A::from_mat3_translation(Mat3::from_cols(x, y, z), base);
        (place, Self { length, base_radius, tip_radius })
    }

    /// As [`Self::between`] for ends in the xy-plane; the +z axis is kept, so that the rotation is
    /// the turn about z that a hinge in that plane makes.
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
