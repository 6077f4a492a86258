use core::f32::consts::TAU;

use glam::{EulerRot, Quat, Vec3};

use crate::kinematics::limb_ik::ElbowReference;
use crate::kinematics::skeleton::JointId;
use crate::kinematics::soft_reach::SoftReach;

/// A target of a skeleton: a point that the tip of a joint's bone should reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// Joint whose tip should reach the target.
    pub joint: JointId,
    /// Position at time 0, in the world.
    pub home: Vec3,
    /// The joints that the target moves, and how.
    pub kind: TargetKind,
    /// Fraction of the way from the FK pose, 0, to the solved pose, 1.
    pub influence: f32,
    /// Weight relative to the other whole-body targets, above 0.
    pub weight: f32,
    /// Whether the target has any effect.
    pub enabled: bool,
    /// Motion in time.
    pub motion: TargetMotion,
}

/// The joints that a target moves, and how.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum TargetKind {
    /// All joints from the root to the target's joint, together with those of the other whole-body
    /// targets, by the rig's solver.
    #[default]
    WholeBody,
    /// The two bones of the [`Limb`](crate::kinematics::limb_ik::Limb) that ends at the tip of the
    /// target's joint, in closed form.
    Limb(LimbSettings),
}

/// Settings of a limb target.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LimbSettings {
    /// Direction of the elbow at twist 0.
    pub reference: ElbowReference,
    /// Angle in radians by which the elbow is turned about the axis from the limb's base to the target.
    pub twist: f32,
    /// Behaviour near the limits of the reach.
    pub soft_reach: SoftReach,
    /// Euler angles in radians of the hand or foot in the world, R_z · R_y · R_x; `None` for a hand
    /// that follows the lower bone.
    pub orientation: Option<Vec3>,
}

impl LimbSettings {
    /// Rotation of the hand in the world; `None` for a hand that follows the lower bone.
    pub fn hand(&self) -> Option<Quat> {
        self.orientation.map(|Vec3 { x, y, z }| Quat::from_euler(EulerRot::ZYX, z, y, x))
    }
}

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

impl Target {
    /// An enabled whole-body target without influence that stays at its home. `radius` is the radius of the path that it will
    /// have once it moves.
    pub fn new(joint: JointId, home: Vec3, radius: f32) -> Self {
        let motion = TargetMotion { path: TargetPath::Still, radius, period: 4.0 };
        let kind = TargetKind::WholeBody;
        Self { joint, home, kind, influence: 0.0, weight: 1.0, enabled: true, motion }
    }

    /// Whether the settings of a limb target are finite.
    pub fn has_finite_kind(&self) -> bool {
        let TargetKind::Limb(settings) = &self.kind else { return true };
        let is_pole_finite = match settings.reference {
            ElbowReference::Pole(pole) => pole.is_finite(),
            _ => true,
        };
        is_pole_finite
            && settings.twist.is_finite()
            && settings.orientation.is_none_or(Vec3::is_finite)
    }

    /// Whether the target poses the skeleton.
    pub fn is_posing(&self) -> bool {
        self.enabled && self.influence > 0.0
    }

    /// Position at a time in seconds, in the world.
    pub fn at(&self, time: f64) -> Vec3 {
        self.home + self.motion.offset(time)
    }
}
