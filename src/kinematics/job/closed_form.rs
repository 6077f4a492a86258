//! The correction of a usual job in straight-line code: no call, no loop, and no branch that a
//! compiler cannot turn into a select, so that [`batch`](super::batch) can vectorise it.
//!
//! A usual job has a bent limb, hard limits and a weight of 1, and is far from all special cases:
//! [`Solved::is_usual`] tells. The others are solved by [`stages`](super::stages).
//!
//! Vectors are in start joint space *times det M_s* (`_ds`): M_s⁻¹ is the adjugate of M_s divided by
//! det M_s, and since only ratios of lengths count, nothing has to be divided. Under a negative
//! det M_s these vectors are reflected at the start joint. Rotations and cross products are those
//! of start joint space all the same; only a turn about a reflected vector changes its sense.

use glam::{DMat3, DQuat, DVec3};

use super::half_angle::HalfAngle;
use crate::kinematics::two_bone::Reach;

/// A distance, in chain lengths, up to which a hand is at its target: the rounding of the middle
/// joint's axes and of the rotations to f32.
pub(super) const NEAR: f64 = 7e-7;

/// A distance, in chain lengths, at which a limit may keep a hand that is at its target: the
/// rounding of the limits alone.
pub(super) const AT_LIMIT: f64 = 2e-7;

/// Sine of the angle between pole and target up to which the pole gives no direction.
pub(super) const ON_LINE: f64 = 1e-6;

/// Sine of the inner angle up to which a limb counts as straight or folded.
pub(super) const IN_LINE: f64 = 1e-3;

/// 1 + the trace of a rotation up to which it is nearly half a turn.
pub(super) const NEAR_HALF_TURN: f64 = 1e-4;

/// 1 + the cosine between two directions up to which they are nearly opposite.
pub(super) const OPPOSITE: f64 = 1e-6;

/// A job with hard limits and a weight of 1.
#[derive(Clone, Copy)]
pub(super) struct UsualJob {
    /// M_s and M_m, as columns.
    pub axes: [DMat3; 2],
    /// Positions of the start, middle and end joint.
    pub joints: [DVec3; 3],
    pub target: DVec3,
    /// Not used without `POLE`.
    pub pole: DVec3,
    /// 0 for none.
    pub hinge: DVec3,
    /// Sine and cosine of the twist.
    pub twist: [f64; 2],
}

/// Two rotations (x, y, z, w) and where they bring the hand. Meaningless if not `is_usual`.
#[derive(Clone, Copy)]
pub(super) struct Solved {
    pub start_correction: [f32; 4],
    pub middle_correction: [f32; 4],
    pub is_reached: bool,
    /// Whether the hand is farther from the start joint than the target is.
    pub is_too_close: bool,
    pub hand_error: f32,
    pub is_usual: bool,
}

/// The start joint's axes M_s.
struct StartAxes {
    /// M_s⁻¹ times det M_s.
    adjugate: DMat3,
    determinant: f64,
    per_determinant: f64,
    /// Sum of the squared elements of the adjugate.
    square: f64,
    is_usual: bool,
}

/// The middle joint's axes in start joint space, M = M_s⁻¹·M_m.
struct MiddleAxes {
    axes_ds: DMat3,
    /// M⁻ᵀ times det M.
    cofactors: DMat3,
    determinant: f64,
    per_determinant: f64,
    /// Scale, negative for a joint that mirrors.
    scale: f64,
    per_scale_squared: f64,
    is_usual: bool,
}

/// The bones, their target, and the hand's distance from the start joint.
struct Limb {
    upper_ds: DVec3,
    lower_ds: DVec3,
    target_ds: DVec3,
    /// d₁, d₂ and the target's distance.
    upper: f64,
    lower: f64,
    target: f64,
    /// D.
    distance: f64,
    /// Square of the rounding of the joints' positions, estimated from above.
    rounding_squared: f64,
}

/// The limb after the middle joint is turned.
struct BentLimb {
    /// k, the unit axis about which a positive turn opens the limb.
    axis: DVec3,
    /// Half of the middle joint's turn about k.
    half_turn: HalfAngle,
    /// x̂, the unit vector from the start joint to the hand.
    hand_ds: DVec3,
    /// k × x̂, the unit vector to the side of the elbow.
    elbow_ds: DVec3,
    is_usual: bool,
}

impl UsualJob {
    #[inline(always)]
    pub fn solve<const POLE: bool>(&self) -> Solved {
        let [start_axes, middle_axes] = self.axes;
        let start = StartAxes::new(start_axes);
        let middle = MiddleAxes::new(start.adjugate * middle_axes);
        let limb = Limb::new(self, &start);
        let bent = limb.bend(middle.axis(self.hinge));

        let [sin, cos] = self.twist;
        let twist = [sin * sign(start.determinant), cos];
        let (start_turn, is_aimed) = if POLE {
            bent.aim_by_pole(&limb, start.adjugate * self.pole, twist)
        } else {
            bent.aim(&limb, twist)
        };
        let middle_turn = bent.half_turn.about(middle.to_middle_space(bent.axis));
        let corrections = [rounded(start_turn), rounded(middle_turn)];
        let solved = self.measure(corrections, &start, &middle, &limb);
        let is_usual = start.is_usual & middle.is_usual & bent.is_usual & is_aimed;
        Solved { is_usual: is_usual & solved.is_usual, ..solved }
    }

    /// The corrections with the reach that these rounded rotations give.
    #[inline(always)]
    fn measure(
        &self,
        corrections: [[f32; 4]; 2],
        start: &StartAxes,
        middle: &MiddleAxes,
        limb: &Limb,
    ) -> Solved {
        let [start_correction, middle_correction] = corrections;
        let (start_turn, middle_turn) = (widened(start_correction), widened(middle_correction));
        let lower_ms = middle.cofactors.transpose_mul_vec3(limb.lower_ds) * middle.per_determinant;
        let lower_ds = middle.axes_ds * (middle_turn * lower_ms);
        let hand_ds = start_turn * (limb.upper_ds + lower_ds);
        let off_ds = hand_ds - limb.target_ds;
        let length = limb.upper + limb.lower;
        let near = NEAR * length;
        let is_near = off_ds.length_squared() <= near * near;
        let left = (limb.target - limb.distance).abs();
        let [start_axes, _] = self.axes;
        let hand_error = (start_axes * off_ds).length() * start.per_determinant.abs();
        Solved {
            start_correction,
            middle_correction,
            is_reached: is_near & (left <= AT_LIMIT * length),
            is_too_close: hand_ds.length_squared() > limb.target * limb.target,
            hand_error: hand_error as f32,
            is_usual: hand_error < f64::from(f32::MAX),
        }
    }
}

impl Solved {
    #[inline(always)]
    pub fn reach(&self) -> Reach {
        if self.is_reached {
            Reach::Reached
        } else if self.is_too_close {
            Reach::TooClose
        } else {
            Reach::TooFar
        }
    }
}

impl StartAxes {
    #[inline(always)]
    fn new(axes: DMat3) -> Self {
        const WORST_CONDITION: f64 = 1e6;
        const LEAST: f64 = 1e-40;
        const MOST: f64 = 1e40;
        let cofactors = cofactors(axes);
        let determinant = axes.x_axis.dot(cofactors.x_axis);
        let square = square(cofactors);
        // With the singular values a ≥ b ≥ c, the condition number a/c is at most (ab)³/(abc)².
        let worst = WORST_CONDITION * (determinant * determinant);
        let is_usual =
            (square * square * square <= worst * worst) & (square > LEAST) & (square < MOST);
        let per_determinant = 1.0 / determinant;
        Self { adjugate: cofactors.transpose(), determinant, per_determinant, square, is_usual }
    }
}

impl MiddleAxes {
    #[inline(always)]
    fn new(axes_ds: DMat3) -> Self {
        // Deviation of the singular values from their mean (root of the sum of squares, relative),
        // and the square of the scale.
        const DIFFERENT: f64 = 5e-6;
        const LEAST: f64 = 1e-60;
        const MOST: f64 = 1e60;
        let cofactors = cofactors(axes_ds);
        let determinant = axes_ds.x_axis.dot(cofactors.x_axis);
        let scale_squared = square(axes_ds) * (1.0 / 3.0);
        let per_product = 1.0 / (scale_squared * determinant);
        let per_scale_squared = per_product * determinant;
        let scale = determinant * per_scale_squared;
        // det²/s⁶ is the product of the squared singular values by the cube of their mean: 1 for a
        // similarity, and less by twice the sum of the squared deviations for any other matrix.
        let evenness = scale * scale * per_scale_squared;
        let is_usual = (evenness >= 1.0 - 2.0 * DIFFERENT * DIFFERENT)
            & (scale_squared > LEAST)
            & (scale_squared < MOST);
        let per_determinant = per_product * scale_squared;
        Self {
            axes_ds,
            cofactors,
            determinant,
            per_determinant,
            scale,
            per_scale_squared,
            is_usual,
        }
    }

    /// Converts an axis of turns from middle joint space, but for its length: see
    /// [`JointChain::axis_ss`](super::chain::JointChain::axis_ss).
    #[inline(always)]
    fn axis(&self, axis: DVec3) -> DVec3 {
        self.axes_ds * axis * sign(self.determinant)
    }

    /// Converts a unit axis of turns to middle joint space: see
    /// [`JointChain::axis_in_middle`](super::chain::JointChain::axis_in_middle).
    #[inline(always)]
    fn to_middle_space(&self, axis: DVec3) -> DVec3 {
        let doubled = self.axes_ds * self.scale + self.cofactors;
        near_unit(doubled.transpose_mul_vec3(axis) * (0.5 * self.per_scale_squared))
    }
}

impl Limb {
    #[inline(always)]
    fn new(job: &UsualJob, axes: &StartAxes) -> Self {
        const EPSILON: f64 = f32::EPSILON as f64;
        let [start, middle, end] = job.joints;
        let upper_ds = axes.adjugate * (middle - start);
        let lower_ds = axes.adjugate * (end - middle);
        let target_ds = axes.adjugate * (job.target - start);
        let (upper, lower, target) = (upper_ds.length(), lower_ds.length(), target_ds.length());
        let distance = between(target, (upper - lower).abs(), upper + lower);
        let largest = start.length_squared() + middle.length_squared() + end.length_squared();
        let rounding_squared = largest * axes.square * (EPSILON * EPSILON);
        Self { upper_ds, lower_ds, target_ds, upper, lower, target, distance, rounding_squared }
    }

    /// Turns the lower bone until the hand is at the distance D, on the side of the hinge.
    #[inline(always)]
    fn bend(&self, hinge: DVec3) -> BentLimb {
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
    fn aim_by_pole(&self, limb: &Limb, pole_ds: DVec3, [sin, cos]: [f64; 2]) -> (DQuat, bool) {
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
    fn aim(&self, limb: &Limb, [sin, cos]: [f64; 2]) -> (DQuat, bool) {
        let towards_ds = limb.target_ds * (1.0 / limb.target);
        let (turn, nearness) = least_rotation(self.hand_ds, towards_ds);
        (HalfAngle::of(sin, cos).about(towards_ds) * turn, nearness > OPPOSITE)
    }
}

/// The rotation that maps the axes of one right-handed frame to those of another, and 1 + its trace,
/// with which its precision decreases.
#[inline(always)]
pub(super) fn rotation_between(from: [DVec3; 3], to: [DVec3; 3]) -> (DQuat, f64) {
    let ([a, b, c], [x, y, z]) = (from, to);
    // 1 + the trace is 4 cos²(θ/2); the sum of the cross products is 2 sin θ along the axis.
    let nearness = 1.0 + a.dot(x) + b.dot(y) + c.dot(z);
    let sin = a.cross(x) + b.cross(y) + c.cross(z);
    let doubled = nearness.sqrt();
    (DQuat::from_vec4((sin * (0.5 / doubled)).extend(0.5 * doubled)), nearness)
}

/// Rotation by the smallest angle from one unit vector to another, and 1 + the cosine between them,
/// with which its precision decreases.
#[inline(always)]
pub(super) fn least_rotation(from: DVec3, to: DVec3) -> (DQuat, f64) {
    // 2 cos²(θ/2); the cross product is sin θ along the axis.
    let nearness = 1.0 + from.dot(to);
    let cos = (0.5 * nearness).sqrt();
    (DQuat::from_vec4((from.cross(to) * (0.5 / cos)).extend(cos)), nearness)
}

/// −1 if the hinge axis is on the other side of the normal of the bones, whose squared length is
/// `square`, else 1.
#[inline(always)]
pub(super) fn side(normal: DVec3, square: f64, hinge: DVec3) -> f64 {
    const IN_PLANE: f64 = 1e-3;
    let cos = hinge.dot(normal);
    let is_aside = cos * cos > IN_PLANE * IN_PLANE * hinge.length_squared() * square;
    if (cos < 0.0) & is_aside { -1.0 } else { 1.0 }
}

/// Normalises a vector whose length is 1 to within 1e-5.
#[inline(always)]
pub(super) fn near_unit(vector: DVec3) -> DVec3 {
    vector * (1.5 - 0.5 * vector.length_squared())
}

/// Cofactors of a matrix: its inverse's transpose times its determinant.
#[inline(always)]
pub(super) fn cofactors(DMat3 { x_axis: x, y_axis: y, z_axis: z }: DMat3) -> DMat3 {
    DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y))
}

/// Sum of the squared elements.
#[inline(always)]
fn square(DMat3 { x_axis: x, y_axis: y, z_axis: z }: DMat3) -> f64 {
    x.length_squared() + y.length_squared() + z.length_squared()
}

/// The quaternion (x, y, z, w) with w ≥ 0 of a rotation.
#[inline(always)]
fn rounded(turn: DQuat) -> [f32; 4] {
    let sign = if turn.w < 0.0 { -1.0 } else { 1.0 };
    let DQuat { x, y, z, w } = turn;
    [(x * sign) as f32, (y * sign) as f32, (z * sign) as f32, (w * sign) as f32]
}

#[inline(always)]
fn widened([x, y, z, w]: [f32; 4]) -> DQuat {
    DQuat::from_xyzw(x.into(), y.into(), z.into(), w.into())
}

#[inline(always)]
fn sign(of: f64) -> f64 {
    1.0_f64.copysign(of)
}

/// Clamps like `f64::clamp`, but without its check of the limits, whose panic would prevent
/// vectorisation.
#[inline(always)]
fn between(value: f64, least: f64, most: f64) -> f64 {
    let value = if value > least { value } else { least };
    if value < most { value } else { most }
}
