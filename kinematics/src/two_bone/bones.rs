use core::fmt;

use thiserror::Error;

/// Two bones joined at an elbow, with the shoulder at the origin.
///
/// ```
/// use glam::Vec3;
/// use ik_arm_kinematics::two_bone::{Reach, TwoBone};
///
/// let arm = TwoBone::new(200.0, 300.0)?;
/// let pose = arm.solve(Vec3::new(250.0, 120.0, 60.0), 0.0);
///
/// assert_eq!(pose.reach, Some(Reach::Reached));
/// assert_eq!(pose.hand, Vec3::new(250.0, 120.0, 60.0));
/// assert!((pose.elbow.length() - 200.0).abs() < 1e-4);
/// assert!((pose.elbow.distance(pose.hand) - 300.0).abs() < 1e-4);
/// # Ok::<(), ik_arm_kinematics::two_bone::LengthError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "UncheckedBones")
)]
pub struct TwoBone {
    pub(crate) upper: f32,
    pub(crate) lower: f32,
}

/// One of the two bones.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum Bone {
    /// From shoulder to elbow.
    Upper,
    /// From elbow to hand.
    Lower,
}

/// An invalid bone length.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("{bone} length must be finite and above 0, got {value}")]
pub struct LengthError {
    /// The bone with the invalid length.
    pub bone: Bone,
    /// The refused length.
    pub value: f32,
}

impl TwoBone {
    /// Two bones of finite lengths above 0.
    ///
    /// # Errors
    ///
    /// [`LengthError`] for the first invalid length.
    pub fn new(upper: f32, lower: f32) -> Result<Self, LengthError> {
        for (bone, value) in [(Bone::Upper, upper), (Bone::Lower, lower)] {
            if !(value.is_finite() && value > 0.0) {
                return Err(LengthError { bone, value });
            }
        }
        Ok(Self { upper, lower })
    }

    /// Length d₁ from shoulder to elbow.
    pub fn upper(self) -> f32 {
        self.upper
    }

    /// Length d₂ from elbow to hand.
    pub fn lower(self) -> f32 {
        self.lower
    }

    /// The bones scaled by `factor`, with lengths of at most `f32::MAX`. The bones are unchanged if
    /// `factor` is NaN or a scaled length is not above 0.
    #[must_use]
    pub fn stretched(self, factor: f32) -> Self {
        if factor.is_nan() {
            return self;
        }
        let length = |length: f32| (length * factor).min(f32::MAX);
        Self::new(length(self.upper), length(self.lower)).unwrap_or(self)
    }

    /// L = d₁ + d₂, the hand's maximum distance (`f32::MAX` if the sum overflows).
    pub fn outer_limit(self) -> f32 {
        (self.upper + self.lower).min(f32::MAX)
    }

    /// |δ| = |d₁ − d₂|, the hand's minimum distance.
    pub fn inner_limit(self) -> f32 {
        (self.upper - self.lower).abs()
    }

    /// Distance of the hand from the shoulder if the elbow's inner angle is `elbow_angle` (φ,
    /// radians, from 0 to π).
    pub(crate) fn distance_at(self, elbow_angle: f64) -> f64 {
        opposite_side(f64::from(self.upper), f64::from(self.lower), elbow_angle)
    }
}

/// Length of the side of a triangle opposite to the angle (radians, from 0 to π) between two sides.
pub(crate) fn opposite_side(one: f64, other: f64, angle: f64) -> f64 {
    let (least, most) = ((one - other).abs(), one + other);
    // (a − b)² + 2 a b (1 − cos φ), which does not cancel.
    let half = (0.5 * angle).sin();
    let side = (least * least + 4.0 * one * other * half * half).sqrt();
    least.max(side).min(most)
}

impl fmt::Display for Bone {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Upper => "upper",
            Self::Lower => "lower",
        })
    }
}

/// Deserialized lengths, not yet checked.
#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
struct UncheckedBones {
    upper: f32,
    lower: f32,
}

#[cfg(feature = "serde")]
impl TryFrom<UncheckedBones> for TwoBone {
    type Error = LengthError;

    fn try_from(UncheckedBones { upper, lower }: UncheckedBones) -> Result<Self, LengthError> {
        Self::new(upper, lower)
    }
}
