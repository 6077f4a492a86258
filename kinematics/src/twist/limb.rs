use glam::Vec3;

use crate::angle::wrapped_to_turn;
use crate::two_bone::Pointer;

/// Angle about the Pointer from the Limb frame's +y to a direction perpendicular to the Pointer, in
/// (−π, π].
#[must_use]
pub fn angle_from_limb(pointer: Pointer, outward: Vec3) -> f32 {
    let limb = pointer.limb_frame();
    outward.dot(limb.z_axis).atan2(outward.dot(limb.y_axis))
}

/// The twist ψ, in [0, 2π), that keeps the elbow in place when the twist reference changes. `from`
/// and `to` are the angles of the old and the new reference from the Limb frame's +y.
#[must_use]
pub fn remeasured(twist: f32, from: f32, to: f32) -> f32 {
    wrapped_to_turn(f64::from(twist) + f64::from(from) - f64::from(to))
}
