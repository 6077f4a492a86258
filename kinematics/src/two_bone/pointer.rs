use glam::{Mat3, Vec2, Vec3};

/// Direction and yaw of the Pointer, the axis from the shoulder through the hand. A caller keeps it
/// from one pose to the next: it supplies the direction for a cursor at the shoulder, and the yaw
/// for a cursor straight above or below the shoulder.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Pointer {
    /// Unit vector ŵ from the shoulder to the hand.
    pub direction: Vec3,
    /// Cosine and sine of the yaw θ_z: the (x, z) part of the direction, normalised.
    pub heading: Vec2,
}

impl Default for Pointer {
    /// A Pointer along +x of Root space.
    fn default() -> Self {
        Self { direction: Vec3::X, heading: Vec2::X }
    }
}

impl Pointer {
    /// The rotation of the Limb frame, R_y(−θ_z)·R_z(θ_y): +x is along the Pointer, +y is the side
    /// of the elbow at ψ = 0, and +z is horizontal.
    #[inline(always)]
    #[must_use]
    pub fn limb_frame(self) -> Mat3 {
        let Vec2 { x: cos_yaw, y: sin_yaw } = self.heading;
        let sin_pitch = self.direction.y;
        let cos_pitch = self.direction.x * cos_yaw + self.direction.z * sin_yaw;
        Mat3::from_cols(
            self.direction,
            Vec3::new(-sin_pitch * cos_yaw, cos_pitch, -sin_pitch * sin_yaw),
            Vec3::new(-sin_yaw, 0.0, cos_yaw),
        )
    }
}
