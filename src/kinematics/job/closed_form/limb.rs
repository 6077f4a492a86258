use glam::{DQuat, DVec3};

use super::joint_axes::StartAxes;
use super::rotation::{NEAR_HALF_TURN, OPPOSITE, least_rotation, rotation_between};
use crate::kinematics::job::half_angle::HalfAngle;

/// Sine of the angle between pole and target up to which the pole gives no direction.
pub const ON_LINE: f64 = 1e-6;

/// Sine of the inner angle up to which a limb counts as straight or folded.
pub const IN_LINE: f64 = 1e-3;

/// The bones, their target, and the hand's distance from the start joint.
pub struct Limb {
    pub upper_ds: DVec3,
    pub lower_ds: DVec3,
    pub target_ds: DVec3,
    /// d₁, d₂ and the target's distance.
    pub upper: f64,
    pub lower: f64,
    pub target: f64,
    /// D.
    pub distance: f64,
    /// Square of the rounding of the joints' positions, estimated from above.
    rounding_squared: f64,
}

/// The limb after the middle joint is turned.
pub struct BentLimb {
    /// k, the unit axis about which a positive turn opens the limb.
    pub axis: DVec3,
    /// Half of the middle joint's turn about k.
    pub half_turn: HalfAngle,
    /// x̂, the unit vector from the start joint to the hand.
    hand_ds: DVec3,
    /// k × x̂, the unit vector to the side of the elbow.
    elbow_ds: DVec3,
    pub is_usual: bool,
}

impl Limb {
    #[inline(always)]
    pub fn new([start, middle, end]: [DVec3; 3], target: DVec3, axes: &StartAxes) -> Self {
        const EPSILON: f64 = f32::EPSILON as f64;
        let upper_ds = axes.adjugate * (middle - start);
        let lower_ds = axes.adjugate * (end - middle);
        let target_ds = axes.adjugate * (target - start);
        let (upper, lower, target) = (upper_ds.length(), lower_ds.length(), target_ds.length());
        let distance = between(target, (upper - lower).abs(), upper + lower);
        let largest = start.length_squared() + middle.length_squared() + end.length_squared();
        let rounding_squared = largest * axes.square * (EPSILON * EPSILON);
        Self { upper_ds, lower_ds, target_ds, upper, lower, target, distance, rounding_squared }
    }

    /// Turns the lower bone until the hand is at the distance D, on the side of the hinge.
    #[inline(always)]
    pub fn bend(&self, hinge: DVec3) -> BentLimb {
        let &Self { upper_ds, lower_ds, upper, lower, distance, .. } = self;
        let (length, difference, product) = (upper + lower, upper - lower, upper * lower);
        // Not of unit length: a processor computes these and their lengths while it computes those
        // of the bones.
        let normal = lower_ds.cross(upper_ds);
        let aside = normal.cross(upper_ds);
        let square = normal.length_squared();
        // The length of the normal, d₁d₂ times the sine of the inner angle.
        let sine = square.sqrt();
        let side = side(normal, square, hinge);
        let per_both = 1.0 / (sine * product);
        let (per_sine, per_product) = (per_both * product * side, per_both * sine);
        let per_upper = lower * per_product;

        // Sine and cosine of half the inner angle, now (times √(2 d₁d₂)) and then (times
        // √(4 d₁d₂)).
        let along = upper_ds.dot(lower_ds);
        let now = HalfAngle { sin: (product + along).sqrt() * side, cos: (product - along).sqrt() };
        let open = (distance - difference) * (distance + difference);
        let closed = (length - distance) * (length + distance);
        let then = HalfAngle { sin: open.sqrt(), cos: closed.sqrt() };
        let half_turn = then.minus(now).times(per_product * (0.25 * core::f64::consts::SQRT_2));

        // The hand is d₁ − d₂ cos φ along the upper bone, and d₂ sin φ beside it.
        let quarter = 0.25 * lower * per_product;
        let per_distance = per_upper * (1.0 / distance);
        let cos = (upper - (closed - open) * quarter) * per_distance;
        let sin = then.sin * then.cos * (2.0 * quarter * per_distance);
        BentLimb {
            axis: normal * per_sine,
            half_turn,
            hand_ds: upper_ds * cos - aside * (sin * per_sine),
            elbow_ds: upper_ds * sin + aside * (cos * per_sine),
            is_usual: self.is_usual(sine) & (hinge.dot(normal).abs() < f64::MAX),
        }
    }

    /// Whether the bones are of similar lengths and bent, and the hand not at the start joint, each
    /// by far. `sine` is d₁d₂ times the sine of the inner angle.
    #[inline(always)]
    fn is_usual(&self, sine: f64) -> bool {
        const LEAST: f64 = 1e-30;
        const MOST: f64 = 1e30;
        const LEAST_PRODUCT: f64 = 1e-6;
        const LEAST_DISTANCE: f64 = 1e-3;
        let &Self { upper, lower, target, distance, rounding_squared, .. } = self;
        let (length, product) = (upper + lower, upper * lower);
        let bent = (sine - IN_LINE * product) * if upper < lower { upper } else { lower };
        (bent > 0.0)
            & (bent * bent > 4.0 * rounding_squared * (product * product))
            & (product > LEAST_PRODUCT * (length * length))
            & (distance > LEAST_DISTANCE * length)
            & (length > LEAST)
            & (target > LEAST)
            & (length < MOST)
            & (target < MOST)
    }
}

impl BentLimb {
    /// The rotation that points the hand at the target and the elbow at the pole, and turns the
    /// limb by the twist; and whether the job is usual.
    #[inline(always)]
    pub fn aim_by_pole(&self, limb: &Limb, pole_ds: DVec3, [sin, cos]: [f64; 2]) -> (DQuat, bool) {
        let &Limb { target_ds, target, .. } = limb;
        let across = target_ds.cross(pole_ds);
        let aside = across.cross(target_ds);
        let square = across.length_squared();
        let longest = target * target * pole_ds.length_squared();
        let is_aside = (square > ON_LINE * ON_LINE * longest) & (square < f64::MAX);
        let across_length = square.sqrt();
        let per_both = 1.0 / (across_length * target);
        let (per_across, per_target) = (per_both * target, per_both * across_length);
        let outward = aside * (cos * per_both) + across * (sin * per_across);
        let third = across * (cos * per_across) - aside * (sin * per_both);
        let from = [self.hand_ds, self.elbow_ds, self.axis];
        let (turn, nearness) = rotation_between(from, [target_ds * per_target, outward, third]);
        (turn, is_aside & (nearness > NEAR_HALF_TURN))
    }

    /// The smallest rotation that points the hand at the target, with the twist after it; and
    /// whether the job is usual.
    #[inline(always)]
    pub fn aim(&self, limb: &Limb, [sin, cos]: [f64; 2]) -> (DQuat, bool) {
        let towards_ds = limb.target_ds * (1.0 / limb.target);
        let (turn, nearness) = least_rotation(self.hand_ds, towards_ds);
        (HalfAngle::of(sin, cos).about(towards_ds) * turn, nearness > OPPOSITE)
    }
}

/// −1 if the hinge axis is on the other side of the normal of the bones, whose squared length is
/// `square`, else 1.
#[inline(always)]
pub fn side(normal: DVec3, square: f64, hinge: DVec3) -> f64 {
    const IN_PLANE: f64 = 1e-3;
    let cos = hinge.dot(normal);
    let is_aside = cos * cos > IN_PLANE * IN_PLANE * hinge.length_squared() * square;
    if (cos < 0.0) & is_aside { -1.0 } else { 1.0 }
}

/// Clamps like `f64::clamp`, but without its check of the limits, whose panic would prevent
/// vectorisation.
#[inline(always)]
fn between(value: f64, least: f64, most: f64) -> f64 {
    let value = if value > least { value } else { least };
    if value < most { value } else { most }
}
