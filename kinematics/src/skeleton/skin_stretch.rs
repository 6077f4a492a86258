use glam::{DMat3, DVec3, Mat3A, Vec3};

/// How a joint stretches the skin that follows it, before it moves it: squash and stretch, a heart
/// that beats. Other joints and bones stay as they are.
///
/// With the frame A of the joint, the matrix A·M·Aᵀ acts in the joint's own space, where
///
/// ```text
///     ⎛ scale.x    0       shear.y ⎞
/// M = ⎜ shear.x  scale.y   shear.z ⎟
///     ⎝   0        0       scale.z ⎠
/// ```
///
/// M leaves the direction of the frame's y and the plane of x and y as they are. So every invertible
/// matrix is a rotation after one M.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SkinStretch {
    /// Factors along x, y and z; below 0 to mirror.
    pub scale: Vec3,
    /// Factors of the sideways movement: a point at (x, y, z) moves by `shear.x`·x and by `shear.z`·z
    /// along y, and by `shear.y`·z along x.
    pub shear: Vec3,
}

impl Default for SkinStretch {
    fn default() -> Self {
        Self::NONE
    }
}

impl SkinStretch {
    /// The skin as it is.
    pub const NONE: Self = Self { scale: Vec3::ONE, shear: Vec3::ZERO };

    /// M.
    pub fn matrix(&self) -> Mat3A {
        let Self { scale, shear } = *self;
        Mat3A::from_cols_array_2d(&[
            [scale.x, shear.x, 0.0],
            [0.0, scale.y, 0.0],
            [shear.y, shear.z, scale.z],
        ])
    }

    /// The stretch whose matrix is the given one, but for the entries that are 0 in every M.
    pub fn of_matrix(matrix: DMat3) -> Self {
        let DMat3 { x_axis: x, y_axis: y, z_axis: z } = matrix;
        Self {
            scale: DVec3::new(x.x, y.y, z.z).as_vec3(),
            shear: DVec3::new(x.y, z.x, z.y).as_vec3(),
        }
    }
}
