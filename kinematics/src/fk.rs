//! Forward kinematics (FK) of the arm: converts between a pose and joint angles (the shoulder's
//! three angles and the elbow's bend), and blends FK angles with a solved pose.
//!
//! ```text
//! U     = R_y(−θ_z) R_z(θ_y) R_x(ψ_ref + ψ) R_z(θ_e)        the upper limb's rotation, by IK
//!       = R_y · R_z · R_x                                   by the shoulder's angles
//! Lower = U · R_z(−β),   β = 180° − φ                        the bend: 0 straight, 180° folded
//! ```
//!
//! A negative bend gives the same pose as the positive one with the shoulder rotated by 180° about
//! the limb. Root space, right-handed, radians.
//!
//! # Accuracy
//!
//! After a conversion from a pose to angles and back, the hand is within 1e-6·L, and the elbow
//! within 1e-5·L for 1° ≤ φ ≤ 179°. For a straighter or more folded arm the elbow is within 5e-4·L,
//! because there an f32 hand does not determine the elbow better.

use core::f64::consts::{PI, TAU};

use glam::{DMat3, DQuat, DVec2, DVec3, Vec2, Vec3};

use super::angle;
use super::ik::{length, reach};
use super::soft_reach::{ReachLimits, SoftReach};
use super::twist::angle_from_limb;
use super::two_bone::{Pointer, Reach, TwoBone, TwoBonePose};
use super::vector::{saturate, saturate_vector};

/// Joint angles of the arm.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Fk {
    /// Shoulder angles about x, y and z in radians, not wrapped to one turn: see [`angle`].
    pub shoulder: Vec3,
    /// Elbow bend β in radians, not wrapped to one turn; 0 for a straight arm.
    pub bend: f32,
    /// Factor by which the limbs are lengthened.
    pub stretch: f32,
}

impl Default for Fk {
    /// A straight arm along +x, without stretch.
    fn default() -> Self {
        Self { shoulder: Vec3::ZERO, bend: 0.0, stretch: 1.0 }
    }
}

impl Fk {
    /// Joint angles of a pose: of all equivalent angles, those nearest to `last`.
    #[must_use]
    pub fn matching(pose: &TwoBonePose, last: Self) -> Self {
        let turned = ArmRotations::of_pose(pose);
        let last_bend = angle::few_turns(f64::from(last.bend));
        // A negative bend stays negative.
        let is_back = (last_bend / TAU).round() * TAU > last_bend;
        let (upper, bend) = if is_back && turned.bend > 0.0 {
            (turned.upper * DQuat::from_rotation_x(PI), -turned.bend)
        } else {
            (turned.upper, turned.bend)
        };
        Self {
            shoulder: angle::euler_angles(DMat3::from_quat(upper), last.shoulder),
            bend: angle::nearest_f64(bend, last_bend) as f32,
            stretch: pose.stretch,
        }
    }

    /// The pose with these angles, in Root space. Where the Pointer is vertical, the pose takes the
    /// yaw of `last`. The pose has no cursor, so its reach is `None`.
    #[must_use]
    pub fn pose(self, bones: TwoBone, last: Pointer) -> TwoBonePose {
        ArmRotations::of_fk(self).pose(bones, last)
    }
}

/// Rotations of the upper and the lower limb in Root space, with +x along the limb and +z along the
/// elbow's hinge axis.
pub fn limb_rotations(pose: &TwoBonePose) -> (DMat3, DMat3) {
    let ArmRotations { upper, bend, .. } = ArmRotations::of_pose(pose);
    let upper = DMat3::from_quat(upper);
    (upper, upper * DMat3::from_rotation_z(-bend))
}

/// Blends FK angles (`influence` 0) with a solved pose (`influence` 1) by interpolating rotation,
/// bend and stretch. `influence` is clamped to 0 … 1.
///
/// The reach of the blend is [`Reach::Reached`] if its hand is within 1e-6·L of the cursor.
#[must_use]
pub fn blended(
    fk: Fk,
    solved: &TwoBonePose,
    influence: f32,
    bones: TwoBone,
    cursor: Vec3,
) -> TwoBonePose {
    if influence >= 1.0 {
        return *solved;
    }
    let (fk, ik) = (ArmRotations::of_fk(fk), ArmRotations::of_pose(solved));
    let between = if influence > 0.0 { fk.to(ik, f64::from(influence)) } else { fk };
    let pose = between.pose(bones, solved.pointer);
    let missed = length(pose.hand - cursor);
    let reach = match reach(0.0, missed, bones) {
        Reach::Reached => Reach::Reached,
        _ if pose.distance > length(cursor) => Reach::TooClose,
        _ => Reach::TooFar,
    };
    TwoBonePose { reach: Some(reach), ..pose }
}

/// Limits of the hand's distance from the shoulder in a blend of FK angles and IK poses, as
/// [`blended`] makes it: whatever the FK bend and the cursor, the hand is within them. Stretch and
/// minimum elbow angle are blended as the poses are; FK has the stretch of `fk`, and its elbow
/// folds to 0°.
#[must_use]
pub fn blended_limits(
    fk: Fk,
    soft_reach: SoftReach,
    influence: f32,
    bones: TwoBone,
) -> ReachLimits {
    if influence >= 1.0 {
        return soft_reach.limits(bones);
    }
    let influence = influence.max(0.0);
    let stretched = |ik: f32| bones.stretched(fk.stretch + (ik - fk.stretch) * influence);
    let elbow_angle = f64::from(soft_reach.min_elbow_angle() * influence);
    ReachLimits {
        inner: saturate(stretched(1.0).distance_at(elbow_angle)),
        outer: stretched(soft_reach.max_stretch()).outer_limit(),
    }
}

/// The upper limb's rotation and the elbow's bend, in f64 because a long limb magnifies the
/// rounding of an angle.
#[derive(Clone, Copy)]
struct ArmRotations {
    /// U, the rotation of the upper limb.
    upper: DQuat,
    /// Bend β, from 0 to π radians.
    bend: f64,
    stretch: f64,
}

impl ArmRotations {
    fn of_fk(fk: Fk) -> Self {
        let bend = angle::nearest_f64(f64::from(fk.bend) % TAU, 0.0);
        let upper = DQuat::from_mat3(&angle::euler_rotation(fk.shoulder));
        let upper = if bend < 0.0 { upper * DQuat::from_rotation_x(PI) } else { upper };
        Self { upper, bend: bend.abs(), stretch: f64::from(fk.stretch) }
    }

    fn of_pose(pose: &TwoBonePose) -> Self {
        let [along, out, distance] = [pose.along, pose.out, pose.distance].map(f64::from);
        let at_shoulder = out.atan2(along);
        let at_hand = out.atan2(distance - along);
        let upper =
            DMat3::from_cols_array(&pose.pointer.limb_frame().to_cols_array().map(f64::from))
                * DMat3::from_rotation_x(f64::from(pose.twist))
                * DMat3::from_rotation_z(at_shoulder);
        Self {
            upper: DQuat::from_mat3(&upper).normalize(),
            bend: at_shoulder + at_hand,
            stretch: f64::from(pose.stretch),
        }
    }

    fn to(self, other: Self, part: f64) -> Self {
        let between = |a: f64, b: f64| a + (b - a) * part;
        Self {
            upper: self.upper.slerp(other.upper, part),
            bend: between(self.bend, other.bend),
            stretch: between(self.stretch, other.stretch),
        }
    }

    fn pose(self, bones: TwoBone, last: Pointer) -> TwoBonePose {
        let bones = bones.stretched(self.stretch as f32);
        let [upper, lower] = [bones.upper(), bones.lower()].map(f64::from);
        let (sin, _) = self.bend.sin_cos();
        let half = (0.5 * self.bend).cos();
        // d₁ + d₂ cos β, in a form that does not cancel where equal bones are folded.
        let ahead = (upper - lower) + 2.0 * lower * half * half;
        let aside = lower * sin;
        let (distance, at_shoulder) = (ahead.hypot(aside), aside.atan2(ahead));

        let axes = DMat3::from_quat(self.upper);
        let (sin, cos) = at_shoulder.sin_cos();
        let direction = axes.x_axis * cos - axes.y_axis * sin;
        let outward = axes.x_axis * sin + axes.y_axis * cos;
        let pointer = Pointer {
            direction: direction.as_vec3().normalize(),
            heading: heading(direction).unwrap_or(last.heading),
        };
        TwoBonePose {
            elbow: saturate_vector(axes.x_axis * upper),
            hand: saturate_vector(direction * distance),
            reach: None,
            distance: saturate(distance),
            along: saturate(upper * cos),
            out: saturate(upper * sin),
            twist: angle_from_limb(pointer, outward.as_vec3()),
            stretch: self.stretch as f32,
            pointer,
        }
    }
}

/// Cosine and sine of a direction's yaw; `None` if the direction is vertical to within rounding.
fn heading(direction: DVec3) -> Option<Vec2> {
    const VERTICAL: f64 = 1e-7;
    let flat = DVec2::new(direction.x, direction.z);
    (flat.length() > VERTICAL).then(|| flat.normalize().as_vec2())
}
