use glam::{Mat3, Vec2, Vec3};

/// Direction and yaw of the Pointer, the axis from the shoulder through the hand. A caller keeps it
/// from one pose to the next to resolve a cursor without a direction (at the shoulder) or without a
/// yaw (straight above or below it).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Pointer {
    /// Unit vector ŵ from the shoulder to the hand.
    pub direction: Vec3,
    /// Cosine and sine of the yaw θ_z: the direction seen from above, as (x, z), of unit length.
    pub heading: Vec2,
}

impl Default for Pointer {
    /// Along Root's +x.
    fn default() -> Self {
        Self { direction: Vec3::X, heading: Vec2::X }
    }
}

impl Pointer {
    /// The Limb's rotation, R_y(−θ_z)·R_z(θ_y): its +x is the Pointer, its +y the side of
    /// the elbow at ψ = 0, its +z horizontal.
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
