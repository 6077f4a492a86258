use glam::{DMat3, DQuat, DVec3};

/// A vector to the tip of a limb, and the side of the elbow: the axes of the Pointer's frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Aim {
    /// Unit vector from the upper joint to the tip, or to the target.
    pub pointer: DVec3,
    /// Unit vector perpendicular to the Pointer, towards the elbow.
    pub outward: DVec3,
}

impl Aim {
    /// The Pointer and elbow of a bent limb with the upper bone `upper` and the vector `tip` from the
    /// upper joint to the tip. `bending` is the direction in which the elbow would move if the limb bent
    /// farther: it replaces the elbow's own direction where the limb is straight or folded.
    pub fn of_limb(upper: DVec3, tip: DVec3, bending: impl Fn() -> DVec3) -> Self {
        // Sine of the angle at the upper joint below which the elbow's direction is rounding.
        const STRAIGHT: f64 = 1e-6;
        let pointer = tip.try_normalize().unwrap_or_else(|| {
            let elbow = upper.try_normalize().unwrap_or(DVec3::X);
            bending().reject_from_normalized(elbow).normalize_or(elbow.any_orthonormal_vector())
        });
        let out = upper.reject_from_normalized(pointer);
        let out = if out.length() > STRAIGHT * upper.length() {
            out
        } else {
            bending().reject_from_normalized(pointer)
        };
        let outward = out.try_normalize().unwrap_or_else(|| pointer.any_orthonormal_vector());
        Self { pointer, outward }
    }

    /// This elbow direction, carried to another Pointer by the least rotation. For the opposite Pointer
    /// the direction stays.
    pub fn carried_to(self, pointer: DVec3) -> Self {
        let turned = DQuat::from_rotation_arc(self.pointer, pointer) * self.outward;
        let opposite = self.pointer.dot(pointer) < -1.0 + 1e-12;
        let outward = if opposite { self.outward } else { turned };
        Self { pointer, outward: orthonormal(outward, pointer) }
    }

    /// The elbow turned about the Pointer by an angle in radians.
    pub fn twisted(self, twist: f64) -> Self {
        let (sin, cos) = twist.sin_cos();
        let side = self.pointer.cross(self.outward);
        Self { outward: orthonormal(cos * self.outward + sin * side, self.pointer), ..self }
    }

    /// Angle in radians about the Pointer from the elbow of `from` to this one's; both have the same
    /// Pointer.
    pub fn twist_from(self, from: Self) -> f64 {
        let side = from.pointer.cross(from.outward);
        self.outward.dot(side).atan2(self.outward.dot(from.outward))
    }

    /// Both vectors in another space.
    pub fn rotated(self, rotation: DMat3) -> Self {
        Self { pointer: rotation * self.pointer, outward: rotation * self.outward }
    }

    /// The rotation that turns this Pointer and elbow to another one's.
    pub fn rotation_to(self, other: Self) -> DMat3 {
        other.frame() * self.frame().transpose()
    }

    fn frame(self) -> DMat3 {
        DMat3::from_cols(self.pointer, self.outward, self.pointer.cross(self.outward))
    }
}

fn orthonormal(v: DVec3, normal: DVec3) -> DVec3 {
    v.reject_from_normalized(normal).normalize_or(normal.any_orthonormal_vector())
}
