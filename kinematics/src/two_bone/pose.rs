use core::f32::consts::PI;

use glam::Vec3;

use super::pointer::Pointer;
use super::reach::Reach;

/// A posed arm, in Root space. All fields are computed from the same hand distance D.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TwoBonePose {
    /// Position of the elbow.
    pub elbow: Vec3,
    /// Position of the hand. With hard limits it is the cursor if that is reached, otherwise a
    /// point on a limit sphere.
    pub hand: Vec3,
    /// Whether the hand reaches the cursor; `None` for a pose without a cursor, such as one made
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
