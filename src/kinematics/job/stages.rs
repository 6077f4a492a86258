//! All vectors are in start joint space, lengths in units of the chain's.

use glam::{DMat3, DQuat, DVec3};

use super::chain::Limb;
use crate::kinematics::soft_reach::SoftReach;
use crate::kinematics::two_bone::TwoBone;

/// The limb as it is after the middle joint is turned.
pub(super) struct Bend {
    /// What turns the lower bone about the middle joint.
    pub turn_ss: DQuat,
    /// x̂, from the start joint to the hand; a unit vector.
    hand_ss: DVec3,
    /// The side that the elbow is on, perpendicular to x̂; none where nothing bends.
    outward_ss: Option<DVec3>,
}

/// D, for a target at a distance.
pub(super) fn soften(limb: &Limb, target: f64, soft_reach: SoftReach) -> f64 {
    let (upper, lower) = limb.lengths();
    let hard = target.clamp((upper - lower).abs(), upper + lower);
    if soft_reach.is_hard() {
        return hard;
    }
    // A bone that f32 cannot tell from none leaves no room to be soft in.
    let Ok(bones) = TwoBone::new(upper as f32, lower as f32) else {
        return hard;
    };
    let asked = target.min(f64::from(f32::MAX)) as f32;
    let softened = soft_reach.extent(bones, asked).distance;
    if softened == asked {
        return hard;
    }
    f64::from(softened).clamp((upper - lower).abs(), upper + lower)
}

/// Opens or closes the middle joint until the hand is at a distance.
pub(super) fn middle_joint(
    limb: &Limb,
    distance: f64,
    hinge_ss: Option<DVec3>,
    pole_ss: Option<DVec3>,
) -> Bend {
    if !limb.is_jointed {
        let hand_ss = limb.hand_ss().normalize();
        return Bend { turn_ss: DQuat::IDENTITY, hand_ss, outward_ss: None };
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
            (axis_ss, bend * least_turn(lower_ss, flat_ss))
        }
    };

    let hand_ss = limb.upper_ss + turn_ss * limb.lower_ss;
    let hand_ss = hand_direction(hand_ss, limb.upper_ss, axis_ss, distance);
    Bend { turn_ss, hand_ss, outward_ss: Some(axis_ss.cross(hand_ss).normalize()) }
}

/// Turns the bent limb until the hand points at the target and the elbow at the pole.
pub(super) fn start_joint(
    bend: &Bend,
    target_ss: Option<DVec3>,
    pole_ss: Option<DVec3>,
    twist: f64,
) -> DQuat {
    const ON_LINE: f64 = 1e-6;
    let towards = target_ss.unwrap_or(bend.hand_ss);
    let least = least_turn(bend.hand_ss, towards);
    let aside = pole_ss.map(|pole| pole.reject_from_normalized(towards));
    let to_pole = match (bend.outward_ss, aside) {
        (Some(outward), Some(aside)) if aside.length() > ON_LINE => {
            frame(towards, aside.normalize()) * frame(bend.hand_ss, outward).inverse()
        }
        _ => least,
    };
    (DQuat::from_axis_angle(towards, twist) * to_pole).normalize()
}

/// Part of a turn, the short way round; of the whole, with w ≥ 0.
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

/// φ, by half of it: exact for straight and folded limbs.
fn inner_angle(upper: f64, lower: f64, distance: f64) -> f64 {
    let (sum, difference) = (upper + lower, upper - lower);
    let open = (distance - difference) * (distance + difference);
    let closed = (sum - distance) * (sum + distance);
    2.0 * open.max(0.0).sqrt().atan2(closed.max(0.0).sqrt())
}

/// The normal of the plane of the bones, about which a positive turn opens them; none where they are
/// as good as in one line.
fn normal(limb: &Limb, upper_ss: DVec3, lower_ss: DVec3) -> Option<DVec3> {
    const IN_LINE: f64 = 1e-3;
    let (upper, lower) = limb.lengths();
    let blurred = 2.0 * limb.rounding / upper.min(lower);
    let normal_ss = lower_ss.cross(upper_ss);
    (normal_ss.length() > IN_LINE + blurred).then(|| normal_ss.normalize())
}

/// The normal, turned round where the hinge axis says so.
fn on_side_of(normal_ss: DVec3, hinge_ss: Option<DVec3>) -> DVec3 {
    const IN_PLANE: f64 = 1e-3;
    let is_opposite = hinge_ss.is_some_and(|hinge| hinge.dot(normal_ss) < -IN_PLANE);
    if is_opposite { -normal_ss } else { normal_ss }
}

/// What bones in one line bend about: perpendicular to them.
fn bending_axis(upper_ss: DVec3, hinge_ss: Option<DVec3>, pole_ss: Option<DVec3>) -> DVec3 {
    const ALONG: f64 = 1e-3;
    let across = |axis: DVec3| {
        let axis = axis.reject_from_normalized(upper_ss);
        (axis.length() > ALONG).then(|| axis.normalize())
    };
    let to_pole = || across(upper_ss.cross(pole_ss?));
    hinge_ss.and_then(across).or_else(to_pole).unwrap_or_else(|| upper_ss.any_orthonormal_vector())
}

/// x̂. Where the hand is too near the start joint to say, by the closed form: there the bones are of
/// like length, and oₑ is as good as d₁.
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

/// The rotation of a frame with a direction as its x and another, perpendicular one as its y.
fn frame(x: DVec3, y: DVec3) -> DQuat {
    let z = x.cross(y).normalize();
    DQuat::from_mat3(&DMat3::from_cols(x, z.cross(x), z)).normalize()
}

/// The least turn from one unit vector to another; about any perpendicular where they are opposite.
fn least_turn(from: DVec3, to: DVec3) -> DQuat {
    const OPPOSITE: f64 = 1e-6;
    let nearness = 1.0 + from.dot(to);
    if nearness <= OPPOSITE {
        // Half a turn about what is exactly perpendicular, then the little that is left.
        let half = DQuat::from_vec4(from.any_orthonormal_vector().extend(0.0));
        return least_turn(-from, to) * half;
    }
    DQuat::from_vec4(from.cross(to).extend(nearness)).normalize()
}
