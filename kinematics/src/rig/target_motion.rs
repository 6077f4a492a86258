use core::f32::consts::TAU;

use glam::Vec3;

/// Motion of a target along a closed curve through its home, in a plane perpendicular to z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TargetMotion {
    /// Shape of the curve.
    pub path: TargetPath,
    /// Radius of the curve, in units of the world.
    pub radius: f32,
    /// Duration of one revolution in seconds.
    pub period: f32,
}

/// The shape of a target's path.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum TargetPath {
    /// The target stays at its home.
    #[default]
    Still,
    /// A circle.
    Circle,
    /// An eight: the lemniscate of Gerono.
    FigureEight,
}

impl TargetMotion {
    /// Vector in the world from the target's home to its position at a time in seconds; zero at
    /// time 0.
    pub fn offset(&self, time: f64) -> Vec3 {
        let angle = (time / f64::from(self.period)).fract() as f32 * TAU;
        let (sin, cos) = angle.sin_cos();
        self.radius
            * match self.path {
                TargetPath::Still => Vec3::ZERO,
                TargetPath::Circle => Vec3::new(sin, cos - 1.0, 0.0),
                TargetPath::FigureEight => Vec3::new(sin, sin * cos, 0.0),
            }
    }
}
