//! Wrapped and equivalent angles, and Euler angles, in radians. Angles that differ by full turns
//! are equivalent.
//!
//! The Euler angles are those of the arm's ball joints: R = R_y · R_z · R_x, so that y is the yaw,
//! z the pitch and x the roll about the bone, which lies along +x. (Skeletons use another order:
//! see [`skeleton`](super::skeleton).)

use core::array;
use core::f32::consts::TAU;
use core::f64::consts::{PI, TAU as TAU_F64};

use glam::{DMat3, DQuat, DVec3, Vec3};

/// An angle wrapped to [0, 2π).
#[must_use]
pub fn wrapped(angle: f32) -> f32 {
    wrapped_to_turn(f64::from(angle))
}

/// An f64 angle wrapped to [0, 2π), then rounded to f32.
pub(crate) fn wrapped_to_turn(angle: f64) -> f32 {
    let wrapped = angle.rem_euclid(TAU_F64) as f32;
    // An f64 just below 2π may round up to 2π in f32.
    if wrapped >= TAU { 0.0 } else { wrapped }
}

/// The angle equivalent to `angle` that is nearest to `near`.
#[must_use]
pub fn nearest(angle: f32, near: f32) -> f32 {
    angle + ((near - angle) / TAU).round() * TAU
}

/// [`nearest`] in f64.
pub(crate) fn nearest_f64(angle: f64, near: f64) -> f64 {
    angle + ((near - angle) / TAU_F64).round() * TAU_F64
}

/// Rotation matrix of Euler angles about x, y and z, in radians.
pub fn euler_rotation(angles: Vec3) -> DMat3 {
    let angles = angles.as_dvec3();
    DMat3::from_rotation_y(angles.y)
        * DMat3::from_rotation_z(angles.z)
        * DMat3::from_rotation_x(angles.x)
}

/// Converts a rotation to Euler angles in radians. Of all equivalent angles, it returns those
/// nearest to `last`, the previous angles, so that angles continue past ±180° without a jump. If
/// the bone points straight up or down, its yaw is undetermined and taken from `last`. Angles in
/// `last` beyond ±540° are first reduced by full turns, so that f32 stays precise.
pub fn euler_angles(rotation: DMat3, last: Vec3) -> Vec3 {
    const VERTICAL: f64 = 1e-7;
    let (x, last) = (rotation.x_axis, last.as_dvec3().map(few_turns));
    let level = x.x.hypot(x.z);
    let pitch = x.y.atan2(level);
    let yaw = if level < VERTICAL { last.y } else { (-x.z).atan2(x.x) };
    let untwisted = DMat3::from_rotation_z(-pitch) * DMat3::from_rotation_y(-yaw) * rotation;
    let twist = untwisted.y_axis.z.atan2(untwisted.y_axis.y);

    let near =
        |angles: DVec3| DVec3::from_array(array::from_fn(|i| nearest_f64(angles[i], last[i])));
    let one = near(DVec3::new(twist, yaw, pitch));
    // The same rotation by a pitch beyond 90°.
    let other = near(DVec3::new(twist + PI, yaw + PI, PI - pitch));
    let far = |angles: DVec3| (angles - last).abs().element_sum();
    if far(other) < far(one) - 1e-6 { other.as_vec3() } else { one.as_vec3() }
}

/// The angle reduced by full turns if it is beyond ±540°.
pub(crate) fn few_turns(angle: f64) -> f64 {
    if angle.abs() > 3.0 * PI { angle % (2.0 * PI) } else { angle }
}

/// Roll of a rotation about +x, τ = 2·atan2(q·x̂, q_w), radians, the equivalent angle nearest to
/// `last`. A rotation that reverses +x has no roll and gives `last`.
pub fn roll(rotation: DMat3, last: f32) -> f32 {
    const NONE: f64 = 1e-9;
    let q = DQuat::from_mat3(&rotation);
    if q.x.hypot(q.w) < NONE {
        return last;
    }
    let (roll, last) = (2.0 * q.x.atan2(q.w), f64::from(last));
    nearest_f64(roll, last) as f32
}
