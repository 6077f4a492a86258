//! Stages of a job of any kind. Vectors are in start joint space, lengths in units of the chain's
//! length.

use glam::{DMat3, DQuat, DVec3};

use super::chain::LimbBones;
use super::fast_path;
use super::fast_path::{HalfAngle, IN_LINE, NEAR_HALF_TURN, ON_LINE, OPPOSITE, side};
use crate::soft_reach::SoftReach;
use crate::two_bone::TwoBone;
use crate::vector::saturate;

/// The limb after the middle joint is turned.
pub(super) struct BentLimb {
    /// Rotation of the lower bone about the middle joint.
    pub turn_ss: DQuat,
    /// x̂, the unit vector from the start joint to the hand.
    hand_ss: DVec3,
    /// k, the unit axis about which a positive turn opens the limb; `None` for a limb that cannot
    /// bend. The elbow is on the side of k × x̂.
    axis_ss: Option<DVec3>,
}

/// D, the hand's distance from the start joint for a target at the distance `target`.
pub(super) fn soften(limb: &LimbBones, target: f64, soft_reach: SoftReach) -> f64 {
    let (upper, lower) = (limb.upper, limb.lower);
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
        let hand_ss = limb.hand_ss.normalize();
        return BentLimb { turn_ss: DQuat::IDENTITY, hand_ss, axis_ss: None };
    }
    let bend = ClosedBend::new(limb, distance);
    let (axis_ss, turn_ss) = match normal(limb) {
        Some((normal_ss, sin)) => {
            let side = side(normal_ss, 1.0, hinge_ss.unwrap_or_default());
            let now = HalfAngle::of(side * sin, -limb.upper_ss.dot(limb.lower_ss));
            let axis_ss = side * normal_ss;
            (axis_ss, bend.inner_angle.minus(now).about(axis_ss))
        }
        None => {
            let axis_ss = bending_axis(limb.upper_ss, hinge_ss, pole_ss);
            let is_straight = limb.upper_ss.dot(limb.lower_ss) > 0.0;
            let (flat_ss, now) = if is_straight {
                (limb.upper_ss, HalfAngle { sin: 1.0, cos: 0.0 })
            } else {
                (-limb.upper_ss, HalfAngle { sin: 0.0, cos: 1.0 })
            };
            let turn = bend.inner_angle.minus(now).about(axis_ss);
            (axis_ss, turn * least_rotation(limb.lower_ss, flat_ss))
        }
    };
    let hand_ss = bend.along * limb.upper_ss - bend.out * axis_ss.cross(limb.upper_ss);
    BentLimb { turn_ss, hand_ss, axis_ss: Some(axis_ss) }
}

/// The closed form of the bent limb.
struct ClosedBend {
    /// φ/2, half of the inner angle of the middle joint.
    inner_angle: HalfAngle,
    /// hₑ and oₑ, divided by d₁.
    along: f64,
    out: f64,
}

impl ClosedBend {
    fn new(limb: &LimbBones, distance: f64) -> Self {
        let (upper, lower) = (limb.upper, limb.lower);
        // L is 1.
        let difference = upper - lower;
        let open = ((distance - difference) * (distance + difference)).max(0.0);
        let closed = ((1.0 - distance) * (1.0 + distance)).max(0.0);
        // 4 d₁ d₂, which is 0 for a bone that is lost in the rounding of the other.
        let sum = open + closed;
        let (open, closed) = if sum > 0.0 { (open / sum, closed / sum) } else { (1.0, 0.0) };
        let inner_angle = HalfAngle { sin: open.sqrt(), cos: closed.sqrt() };
        let doubled = distance + if distance > 0.0 { difference / distance } else { 0.0 };
        let along = (0.5 * doubled / upper).clamp(-1.0, 1.0);
        let out = ((1.0 - along) * (1.0 + along)).sqrt();
        Self { inner_angle, along, out }
    }
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
    let towards = target_ss.unwrap_or(bend.hand_ss);
    let (sin, cos) = if twist == 0.0 { (0.0, 1.0) } else { twist.sin_cos() };
    let aside = pole_ss.map(|pole| (pole, pole.reject_from_normalized(towards)));
    match (bend.axis_ss, aside) {
        (Some(axis), Some((pole, aside)))
            if aside.length_squared() > ON_LINE * ON_LINE * pole.length_squared() =>
        {
            let aside = aside.normalize();
            let across = towards.cross(aside);
            let outward = aside * cos + across * sin;
            let to = [towards, outward, towards.cross(outward)];
            let from = [bend.hand_ss, axis.cross(bend.hand_ss), axis];
            rotation_between(from, to)
        }
        _ => HalfAngle::of(sin, cos).about(towards) * least_rotation(bend.hand_ss, towards),
    }
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

/// Unit normal of the plane of the bones, about which a positive turn opens the limb, and the sine
/// of the inner angle; `None` if the bones are in one line, to within rounding.
fn normal(limb: &LimbBones) -> Option<(DVec3, f64)> {
    let shorter = limb.upper.min(limb.lower);
    let normal_ss = limb.lower_ss.cross(limb.upper_ss);
    let sin = normal_ss.length();
    (sin * shorter > IN_LINE * shorter + 2.0 * limb.rounding).then(|| (normal_ss / sin, sin))
}

/// Unit axis, perpendicular to the bones, about which bones in one line bend: from the hinge axis,
/// else from the pole, else arbitrary.
fn bending_axis(upper_ss: DVec3, hinge_ss: Option<DVec3>, pole_ss: Option<DVec3>) -> DVec3 {
    const ALONG: f64 = 1e-3;
    let across = |axis: DVec3| {
        let axis = axis.try_normalize()?.reject_from_normalized(upper_ss);
        (axis.length() > ALONG).then(|| axis.normalize())
    };
    let to_pole = || across(upper_ss.cross(pole_ss?.try_normalize()?));
    hinge_ss.and_then(across).or_else(to_pole).unwrap_or_else(|| upper_ss.any_orthonormal_vector())
}

/// The rotation that maps the axes of one right-handed frame to those of another.
fn rotation_between(from: [DVec3; 3], to: [DVec3; 3]) -> DQuat {
    let (turn, trace_plus_one) = fast_path::rotation_between(from, to);
    if trace_plus_one > NEAR_HALF_TURN {
        return turn;
    }
    let [from, to] = [from, to].map(|[x, y, z]| DMat3::from_cols(x, y, z));
    DQuat::from_mat3(&(to * from.transpose())).normalize()
}

/// Rotation by the smallest angle from one unit vector to another; about any perpendicular axis if
/// they are opposite.
fn least_rotation(from: DVec3, to: DVec3) -> DQuat {
    let (turn, cos_plus_one) = fast_path::least_rotation(from, to);
    if cos_plus_one > OPPOSITE {
        return turn;
    }
    // Half a turn about an exactly perpendicular axis, then the small remainder.
    let half = DQuat::from_vec4(from.any_orthonormal_vector().extend(0.0));
    least_rotation(-from, to) * half
}
