use glam::Vec3;

use crate::scene::Shadow;

/// Cuts off the part of a limb below the ground, since that part casts no shadow; `None` if the
/// whole limb is below.
pub(super) fn above_ground(limb: Shadow) -> Option<Shadow> {
    let at = |fraction: f32| {
        let radius = limb.base_radius + (limb.tip_radius - limb.base_radius) * fraction;
        (limb.base.lerp(limb.tip, fraction), radius)
    };
    let (base_y, tip_y) = (limb.base.y, limb.tip.y);
    let crossing = base_y / (base_y - tip_y);
    let (from, to) = match (base_y >= 0.0, tip_y >= 0.0) {
        (true, true) => return Some(limb),
        (true, false) => (0.0, crossing),
        (false, true) => (crossing, 1.0),
        (false, false) => return None,
    };
    let ((base, base_radius), (tip, tip_radius)) = (at(from), at(to));
    let flat = |v: Vec3| Vec3 { y: v.y.max(0.0), ..v };
    Some(Shadow { base: flat(base), base_radius, tip: flat(tip), tip_radius })
}
