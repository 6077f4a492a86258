use glam::{Affine3A, Mat3A, Vec3};

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
        let x = (tip - base).try_normalize().unwrap_or(Vec3::X);
        let (y, z) = x.any_orthonormal_pair();
        let placed = Affine3A::from_mat3_translation(glam::Mat3::from_cols(x, y, z), base);
        (placed, Self { length: base.distance(tip), base_radius, tip_radius })
    }

    /// As [`Self::between`] for ends in the xy-plane; the +z axis is kept, so that the rotation is
    /// the turn about z that a hinge in that plane makes.
    pub fn in_xy_plane(
        base: Vec3,
        tip: Vec3,
        base_radius: f32,
        tip_radius: f32,
    ) -> (Affine3A, Self) {
        let x = (tip - base).truncate().try_normalize().unwrap_or(glam::Vec2::X);
        let y = x.perp();
        let rotation = Mat3A::from_cols(x.extend(0.0).into(), y.extend(0.0).into(), glam::Vec3A::Z);
        let placed = Affine3A { matrix3: rotation, translation: base.into() };
        (placed, Self { length: base.distance(tip), base_radius, tip_radius })
    }
}
