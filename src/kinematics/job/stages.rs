//! Stages of a job. Vectors are in start joint space, lengths in units of the chain's length.

use glam::{DMat3, DQuat, DVec3};

use super::chain::LimbBones;
use crate::kinematics::saturate::saturate;
use crate::kinematics::soft_reach::SoftReach;
use crate::kinematics::two_bone::TwoBone;

/// The limb after the middle joint is turned.
pub(super) struct BentLimb {
    /// Rotation of the lower bone about the middle joint.
    pub turn_ss: DQuat,
    /// x̂, the unit vector from the start joint to the hand.
    hand_ss: DVec3,
    /// Unit vector perpendicular to x̂ on the side of the elbow; `None` for a limb that cannot
    /// bend.
    outward_ss: Option<DVec3>,
}

/// D, the hand's distance from the start joint for a target at the distance `target`.
pub(super) fn soften(limb: &LimbBones, target: f64, soft_reach: SoftReach) -> f64 {
    let (upper, lower) = limb.lengths();
    let hard = target.clamp((upper - lower).abs(), upper + lower);
    if soft_reach.is_hard() {
        return hard;
    }
    // A bone that underflows f32 leaves no soft zone.
    let Ok(bones) = TwoBone::new(upper as f32, lower as f32) else {
        return hard;
    };
    let wanted = saturate(target);
    let softened = soft_reach.hand_distance(bones, wanted).distance;
    if softened == wanted {
        return hard;
    }
    f64::from(softened).clamp((upper - lower).abs(), upper + lower)
}

/// Opens or closes the middle joint until the hand is at `distance` from the start joint.
pub(super) fn middle_joint(
    limb: &LimbBones,
    distance: f64,
    hinge_ss: Option<DVec3>,
    pole_ss: Option<DVec3>,
) -> BentLimb {
    if !limb.is_jointed {
        let hand_ss = limb.hand_ss().normalize();
        return BentLimb { turn_ss: DQuat::IDENTITY, hand_ss, outward_ss: None };
    }
    let (upper, lower) = limb.lengths();
    let (upper_ss, lower_ss) = (limb.upper_ss / upper, limb.lower_ss / lower);
    let angle = inner_angle(upper, lower, distance);

    let (axis_ss, turn_ss) = match normal(limb, upper_ss, lower_ss) {
        Some(normal_ss) => {
            let axis_ss = on_side_of(normal_ss, hinge_ss);
            let sin = axis_ss.dot(lower_ss.cross(upper_ss));
            let now = sin.atan2(-upper_ss.dot(lower_ss));
            (axis_ss, DQuat::from_axis_angle(axis_ss, angle - now))
        }
        None => {
            let axis_ss = bending_axis(upper_ss, hinge_ss, pole_ss);
            let is_straight = upper_ss.dot(lower_ss) > 0.0;
            let (flat_ss, now) =
                if is_straight { (upper_ss, core::f64::consts::PI) } else { (-upper_ss, 0.0) };
            let bend = DQuat::from_axis_angle(axis_ss, angle - now);
            (axis_ss, bend * least_rotation(lower_ss, flat_ss))
        }
    };

    let hand_ss = limb.upper_ss + turn_ss * limb.lower_ss;
    let hand_ss = hand_direction(hand_ss, limb.upper_ss, axis_ss, distance);
    BentLimb { turn_ss, hand_ss, outward_ss: Some(axis_ss.cross(hand_ss).normalize()) }
}

/// Rotation of the start joint that points the bent limb's hand at the target and its elbow in the
/// direction of the pole, and then turns the limb by `twist` (radians) about the line to the
/// target.
pub(super) fn start_joint(
    bend: &BentLimb,
    target_ss: Option<DVec3>,
    pole_ss: Option<DVec3>,
    twist: f64,
) -> DQuat {
    const ON_LINE: f64 = 1e-6;
    let towards = target_ss.unwrap_or(bend.hand_ss);
    let least = least_rotation(bend.hand_ss, towards);
    let aside = pole_ss.map(|pole| pole.reject_from_normalized(towards));
    let to_pole = match (bend.outward_ss, aside) {
        (Some(outward), Some(aside)) if aside.length() > ON_LINE => {
            frame(towards, aside.normalize()) * frame(bend.hand_ss, outward).inverse()
        }
        _ => least,
    };
    (DQuat::from_axis_angle(towards, twist) * to_pole).normalize()
}

/// The rotation about the axis of `turn` by the fraction `part` of its angle, taken as at most
/// 180°. The result has w ≥ 0.
pub(super) fn weight(turn: DQuat, part: f64) -> DQuat {
    let turn = if turn.w < 0.0 { -turn } else { turn };
    if part >= 1.0 {
        return turn;
    }
    let half = turn.xyz().length().atan2(turn.w);
    let axis = turn.xyz().normalize_or_zero();
    let (sin, cos) = (half * part).sin_cos();
    DQuat::from_vec4((axis * sin).extend(cos))
}

/// Inner angle φ of the middle joint for a hand at `distance`, computed from half the angle, so
/// that it is exact for straight and folded limbs.
fn inner_angle(upper: f64, lower: f64, distance: f64) -> f64 {
    let (sum, difference) = (upper + lower, upper - lower);
    let open = (distance - difference) * (distance + difference);
    let closed = (sum - distance) * (sum + distance);
    2.0 * open.max(0.0).sqrt().atan2(closed.max(0.0).sqrt())
}

/// Unit normal of the plane of the bones, about which a positive turn opens the limb; `None` if the
/// bones are in one line, to within rounding.
fn normal(limb: &LimbBones, upper_ss: DVec3, lower_ss: DVec3) -> Option<DVec3> {
    const IN_LINE: f64 = 1e-3;
    let (upper, lower) = limb.lengths();
    let blurred = 2.0 * limb.rounding / upper.min(lower);
    let normal_ss = lower_ss.cross(upper_ss);
    (normal_ss.length() > IN_LINE + blurred).then(|| normal_ss.normalize())
}

/// The normal, negated if the hinge axis is on its other side.
fn on_side_of(normal_ss: DVec3, hinge_ss: Option<DVec3>) -> DVec3 {
    const IN_PLANE: f64 = 1e-3;
    let is_opposite = hinge_ss.is_some_and(|hinge| hinge.dot(normal_ss) < -IN_PLANE);
    if is_opposite { -normal_ss } else { normal_ss }
}

/// Unit axis, perpendicular to the bones, about which bones in one line bend: from the hinge axis,
/// else from the pole, else arbitrary.
fn bending_axis(upper_ss: DVec3, hinge_ss: Option<DVec3>, pole_ss: Option<DVec3>) -> DVec3 {
    const ALONG: f64 = 1e-3;
    let across = |axis: DVec3| {
        let axis = axis.reject_from_normalized(upper_ss);
        (axis.length() > ALONG).then(|| axis.normalize())
    };
    let to_pole = || across(upper_ss.cross(pole_ss?));
    hinge_ss.and_then(across).or_else(to_pole).unwrap_or_else(|| upper_ss.any_orthonormal_vector())
}

/// x̂, the direction of the hand. For a hand near the start joint it is computed by the closed
/// form: there both bones have nearly the same length, and oₑ is nearly d₁.
fn hand_direction(hand_ss: DVec3, upper_ss: DVec3, axis_ss: DVec3, distance: f64) -> DVec3 {
    const NEAR: f64 = 1e-6;
    if distance > NEAR {
        return hand_ss.normalize();
    }
    let upper = upper_ss.length();
    let along = 0.5 * if distance == 0.0 { 0.0 } else { distance + (2.0 * upper - 1.0) / distance };
    let along = along.clamp(-upper, upper);
    let out = (upper * upper - along * along).sqrt();
    (upper_ss * along - axis_ss.cross(upper_ss) * out).normalize()
}

/// The rotation that maps +x to the unit vector `x`, and +y to the unit vector `y`, which is
/// perpendicular to `x`.
fn frame(x: DVec3, y: DVec3) -> DQuat {
    let z = x.cross(y).normalize();
    DQuat::from_mat3(&DMat3::from_cols(x, z.cross(x), z)).normalize()
}

/// Rotation by the smallest angle from one unit vector to another; about any perpendicular axis if
/// they are opposite.
fn least_rotation(from: DVec3, to: DVec3) -> DQuat {
    const OPPOSITE: f64 = 1e-6;
    let nearness = 1.0 + from.dot(to);
    if nearness <= OPPOSITE {
        // Half a turn about an exactly perpendicular axis, then the small remainder.
        let half = DQuat::from_vec4(from.any_orthonormal_vector().extend(0.0));
        return least_rotation(-from, to) * half;
    }
    DQuat::from_vec4(from.cross(to).extend(nearness)).normalize()
}
