use core::f32::consts::PI;

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

/// True if the hand reaches the cursor, and which limit prevents it if not.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum Reach {
    /// The hand is at the cursor: bit for bit with hard limits, within 1e-6·L with soft limits.
    Reached,
    /// The hand is nearer to the shoulder than the cursor. With hard limits, the cursor is beyond
    /// the outer limit L: the arm is straight and points at the cursor.
    TooFar,
    /// The hand is farther from the shoulder than the cursor. With hard limits, the cursor is
    /// inside the inner limit |δ|: the arm is folded and points at the cursor.
    TooClose,
}

/// A posed arm, in Root space. All fields are computed from the same hand distance D.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TwoBonePose {
    /// Position of the elbow.
    pub elbow: Vec3,
    /// Position of the hand. With hard limits it is the cursor if that is reached, otherwise a
    /// point on a limit sphere.
    pub hand: Vec3,
    /// True if the hand reaches the cursor; `None` for a pose without a cursor, such as one made
    /// from joint angles.
    pub reach: Option<Reach>,
    /// D, the distance from shoulder to hand.
    pub distance: f32,
    /// h_e, the elbow's x in Socket space, along the Pointer; negative when the lower bone reaches
    /// back past the shoulder.
    pub along: f32,
    /// o_e ≥ 0, the elbow's y in Socket space: its distance from the Pointer.
    pub out: f32,
    /// Angle about the Pointer from the Limb frame's +y to the elbow, radians: the Socket's
    /// rotation ψ_ref + ψ.
    pub twist: f32,
    /// Factor by which the bones are lengthened; 1 without stretch.
    pub stretch: f32,
    /// Direction and yaw of the Pointer. Pass it to the next
    /// [`TwoBone::solve_from`](super::TwoBone::solve_from).
    pub pointer: Pointer,
}

impl TwoBonePose {
    /// θ_z, the Pointer's angle about −y from +x: `atan2(z, x)`, in [−π, π].
    pub fn yaw(&self) -> f32 {
        self.pointer.heading.y.atan2(self.pointer.heading.x)
    }

    /// θ_y, the Pointer's angle above the xz-plane: `atan2(y, hypot(x, z))`, in [−π/2, π/2].
    pub fn pitch(&self) -> f32 {
        let Vec3 { x, y, z } = self.pointer.direction;
        y.atan2(x.hypot(z))
    }

    /// Unit vector perpendicular to the Pointer, on the side of the elbow; defined for a straight
    /// or folded arm, too.
    pub fn outward(&self) -> Vec3 {
        let limb = self.pointer.limb_frame();
        let (sin, cos) = self.twist.sin_cos();
        limb.y_axis * cos + limb.z_axis * sin
    }

    /// Angle about this pose's Pointer from this elbow to the elbow of `other`, in (−π, π].
    pub fn elbow_turn_to(&self, other: &Self) -> f32 {
        let (w, from, to) = (self.pointer.direction, self.outward(), other.outward());
        w.dot(from.cross(to)).atan2(from.dot(to))
    }

    /// θ_e, the angle at the shoulder between the Pointer and the upper bone, in [0, π].
    pub fn shoulder_angle(&self) -> f32 {
        self.out.atan2(self.along)
    }

    /// φ, the inner angle at the elbow, in [0, π]: π for a straight arm, 0 for a folded one.
    pub fn elbow_angle(&self) -> f32 {
        let at_hand = self.out.atan2(self.distance - self.along);
        PI - self.shoulder_angle() - at_hand
    }
}
