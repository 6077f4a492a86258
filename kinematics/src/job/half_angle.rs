use glam::{DQuat, DVec3};

/// Half of an angle.
#[derive(Clone, Copy)]
pub(super) struct HalfAngle {
    pub sin: f64,
    pub cos: f64,
}

impl HalfAngle {
    /// Half of the angle between −180° and 180° with this sine and cosine.
    #[inline(always)]
    pub fn of(sin: f64, cos: f64) -> Self {
        let larger = (0.5 + 0.5 * cos.abs()).sqrt();
        let smaller = 0.5 * sin / larger;
        let is_sharp = cos >= 0.0;
        // Beyond 90°, the half is between 45° and 90°, on the side of the angle.
        Self {
            sin: if is_sharp { smaller } else { larger.copysign(sin) },
            cos: if is_sharp { larger } else { smaller.abs() },
        }
    }

    #[inline(always)]
    pub fn minus(self, other: Self) -> Self {
        Self {
            sin: self.sin * other.cos - self.cos * other.sin,
            cos: self.cos * other.cos + self.sin * other.sin,
        }
    }

    #[inline(always)]
    pub fn times(self, factor: f64) -> Self {
        Self { sin: self.sin * factor, cos: self.cos * factor }
    }

    /// The rotation by the whole angle about a unit axis.
    #[inline(always)]
    pub fn about(self, axis: DVec3) -> DQuat {
        DQuat::from_vec4((axis * self.sin).extend(self.cos))
    }
}
