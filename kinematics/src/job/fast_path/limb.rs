use glam::{DQuat, DVec3};

use super::joint_axes::StartAxes;

/// Sine of the angle between pole and target up to which the pole gives no direction.
pub const ON_LINE: f64 = 1e-6;

/// Sine of the inner angle up to which a limb counts as straight or folded.
pub const IN_LINE: f64 = 1e-3;

/// The bones and their target.
pub struct FastLimb {
    pub upper_ds: DVec3,
    pub lower_ds: DVec3,
    pub target_ds: DVec3,
    /// d₁, d₂ and the target's distance.
    pub upper: f64,
    pub lower: f64,
    pub target: f64,
    /// D, the solved hand's distance from the start joint: the target's, clamped to the reach.
    pub distance: f64,
    /// Upper bound of the squared rounding error of the joints' positions.
    rounding_squared: f64,
}

/// The limb after the middle joint is turned.
pub struct FastBentLimb {
    /// k, the unit axis about which a positive turn opens the limb.
    pub axis: DVec3,
    /// Half of the middle joint's turn about k.
    pub half_turn: HalfAngle,
    /// x̂, the unit vector from the start joint to the hand.
    hand_ds: DVec3,
    /// k × x̂, the unit vector to the side of the elbow.
    elbow_ds: DVec3,
    pub is_regular: bool,
}

impl FastLimb {
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
    pub fn bend(&self, hinge: DVec3) -> FastBentLimb {
        let &Self { upper_ds, lower_ds, upper, lower, distance, .. } = self;
        let (length, difference, product) = (upper + lower, upper - lower, upper * lower);
        // Not normalised, so that a CPU can compute these and their lengths in parallel with the
        // lengths of the bones.
        let normal = lower_ds.cross(upper_ds);
        let aside = normal.cross(upper_ds);
        let square = normal.length_squared();
        // The length of the normal, d₁d₂ times the sine of the inner angle.
        let sine = square.sqrt();
        let side = side(normal, square, hinge);
        let inv_both = 1.0 / (sine * product);
        let (inv_sine, inv_product) = (inv_both * product * side, inv_both * sine);
        let inv_upper = lower * inv_product;

        // Sine and cosine of φ/2, half of the inner angle between the bones: in the given pose,
        // times √(2 d₁d₂), and in the solved pose, times √(4 d₁d₂).
        let along = upper_ds.dot(lower_ds);
        let given =
            HalfAngle { sin: (product + along).sqrt() * side, cos: (product - along).sqrt() };
        let open = (distance - difference) * (distance + difference);
        let closed = (length - distance) * (length + distance);
        let solved = HalfAngle { sin: open.sqrt(), cos: closed.sqrt() };
        let half_turn = solved.minus(given).times(inv_product * (0.25 * core::f64::consts::SQRT_2));

        // The hand is d₁ − d₂ cos φ along the upper bone, and d₂ sin φ beside it.
        let quarter = 0.25 * lower * inv_product;
        let inv_distance = inv_upper * (1.0 / distance);
        let cos = (upper - (closed - open) * quarter) * inv_distance;
        let sin = solved.sin * solved.cos * (2.0 * quarter * inv_distance);
        FastBentLimb {
            axis: normal * inv_sine,
            half_turn,
            hand_ds: upper_ds * cos - aside * (sin * inv_sine),
            elbow_ds: upper_ds * sin + aside * (cos * inv_sine),
            is_regular: self.is_regular(sine) & (hinge.dot(normal).abs() < f64::MAX),
        }
    }

    /// True if no bone is negligible, the limb is clearly bent, and the hand is clearly away from
    /// the start joint. `sine` is d₁d₂ times the sine of the inner angle.
    #[inline(always)]
    fn is_regular(&self, sine: f64) -> bool {
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

impl FastBentLimb {
    /// The start joint's rotation that brings the hand onto the line to the target and the elbow to
    /// the side of the pole, and turns the limb by the twist; and whether this is regular.
    #[inline(always)]
    pub fn aim_by_pole(
        &self,
        limb: &FastLimb,
        pole_ds: DVec3,
        [sin, cos]: [f64; 2],
    ) -> (DQuat, bool) {
        let &FastLimb { target_ds, target, .. } = limb;
        let across = target_ds.cross(pole_ds);
        let aside = across.cross(target_ds);
        let square = across.length_squared();
        let longest = target * target * pole_ds.length_squared();
        let is_aside = (square > ON_LINE * ON_LINE * longest) & (square < f64::MAX);
        let across_length = square.sqrt();
        let inv_both = 1.0 / (across_length * target);
        let (inv_across, inv_target) = (inv_both * target, inv_both * across_length);
        let outward = aside * (cos * inv_both) + across * (sin * inv_across);
        let third = across * (cos * inv_across) - aside * (sin * inv_both);
        let from = [self.hand_ds, self.elbow_ds, self.axis];
        let (turn, trace_plus_one) =
            rotation_between(from, [target_ds * inv_target, outward, third]);
        (turn, is_aside & (trace_plus_one > NEAR_HALF_TURN))
    }

    /// The start joint's smallest rotation that brings the hand onto the line to the target, with
    /// the twist after it; and whether this is regular.
    #[inline(always)]
    pub fn aim(&self, limb: &FastLimb, [sin, cos]: [f64; 2]) -> (DQuat, bool) {
        let towards_ds = limb.target_ds * (1.0 / limb.target);
        let (turn, cos_plus_one) = least_rotation(self.hand_ds, towards_ds);
        (HalfAngle::of(sin, cos).about(towards_ds) * turn, cos_plus_one > OPPOSITE)
    }
}

/// −1 if the hinge axis points against the normal of the bones, else 1. `square` is the normal's
/// squared length.
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

/// 1 + the trace of a rotation up to which it is nearly half a turn.
pub const NEAR_HALF_TURN: f64 = 1e-4;

/// 1 + the cosine between two directions up to which they are nearly opposite.
pub const OPPOSITE: f64 = 1e-6;

/// Half of an angle.
#[derive(Clone, Copy)]
pub struct HalfAngle {
    pub sin: f64,
    pub cos: f64,
}

impl HalfAngle {
    /// Half of the angle between −180° and 180° with this sine and cosine.
    #[inline(always)]
    pub fn of(sin: f64, cos: f64) -> Self {
        let larger = (0.5 + 0.5 * cos.abs()).sqrt();
        let smaller = 0.5 * sin / larger;
        let is_sharp = cos >= 0.0;
        // Beyond 90°, the half is between 45° and 90°, on the side of the angle.
        Self {
            sin: if is_sharp { smaller } else { larger.copysign(sin) },
            cos: if is_sharp { larger } else { smaller.abs() },
        }
    }

    #[inline(always)]
    pub fn minus(self, other: Self) -> Self {
        Self {
            sin: self.sin * other.cos - self.cos * other.sin,
            cos: self.cos * other.cos + self.sin * other.sin,
        }
    }

    #[inline(always)]
    pub fn times(self, factor: f64) -> Self {
        Self { sin: self.sin * factor, cos: self.cos * factor }
    }

    /// The rotation by the whole angle about a unit axis.
    #[inline(always)]
    pub fn about(self, axis: DVec3) -> DQuat {
        DQuat::from_vec4((axis * self.sin).extend(self.cos))
    }
}

/// The rotation that maps the axes of one right-handed frame to those of another, and 1 + the trace
/// of the rotation. The smaller this number is, the less precise the rotation; it is 0 for half a
/// turn.
#[inline(always)]
pub fn rotation_between(from: [DVec3; 3], to: [DVec3; 3]) -> (DQuat, f64) {
    let ([a, b, c], [x, y, z]) = (from, to);
    // 1 + the trace is 4 cos²(θ/2); the sum of the cross products is 2 sin θ along the axis.
    let trace_plus_one = 1.0 + a.dot(x) + b.dot(y) + c.dot(z);
    let sin = a.cross(x) + b.cross(y) + c.cross(z);
    let doubled = trace_plus_one.sqrt();
    (DQuat::from_vec4((sin * (0.5 / doubled)).extend(0.5 * doubled)), trace_plus_one)
}

/// The rotation by the smallest angle from one unit vector to another, and 1 + the cosine of this
/// angle. The smaller this number is, the less precise the rotation; it is 0 for half a turn.
#[inline(always)]
pub fn least_rotation(from: DVec3, to: DVec3) -> (DQuat, f64) {
    // 2 cos²(θ/2); the cross product is sin θ along the axis.
    let cos_plus_one = 1.0 + from.dot(to);
    let cos = (0.5 * cos_plus_one).sqrt();
    (DQuat::from_vec4((from.cross(to) * (0.5 / cos)).extend(cos)), cos_plus_one)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use glam::DMat3;

    use super::*;

    /// A limb with its start joint far from the origin.
    #[derive(Clone, Copy)]
    struct FarLimb {
        bones: [f64; 2],
        inner_angle: f64,
        target: f64,
        far: f64,
    }

    const REGULAR: FarLimb =
        FarLimb { bones: [2.0, 3.0], inner_angle: FRAC_PI_2, target: 4.0, far: 0.0 };

    impl FarLimb {
        fn limb(self, scale: f64) -> FastLimb {
            let [upper, lower] = self.bones;
            let (sin, cos) = self.inner_angle.sin_cos();
            let start = DVec3::X * self.far;
            let middle = start + DVec3::Y * upper;
            let end = middle + DVec3::new(sin, -cos, 0.0) * lower;
            let target = start + DVec3::Z * self.target;
            let joints = [start, middle, end].map(|joint| joint * scale);
            FastLimb::new(joints, target * scale, &StartAxes::new(DMat3::IDENTITY))
        }

        fn is_regular(self, scale: f64) -> bool {
            self.limb(scale).bend(DVec3::ZERO).is_regular
        }
    }

    /// Checks that a case is regular 1 % above a limit, and not 1 % below it.
    fn check(what: &str, scales: &[f64], limit: f64, case: impl Fn(f64) -> FarLimb) {
        for scale in scales {
            assert!(case(1.01 * limit).is_regular(*scale), "{what}, scaled by {scale}");
            assert!(!case(0.99 * limit).is_regular(*scale), "{what} missed, scaled by {scale}");
        }
    }

    #[test]
    fn a_limb_is_regular_up_to_each_limit_whatever_its_size() {
        let scales = [1e-20, 1e-3, 1.0, 1e3, 1e20];
        let bent = |sine: f64| FarLimb { inner_angle: sine.asin(), ..REGULAR };
        check("folded", &scales, IN_LINE, bent);
        let bent = |sine: f64| FarLimb { inner_angle: PI - sine.asin(), ..REGULAR };
        check("straight", &scales, IN_LINE, bent);
        for bones in [[1.0, 10.0], [10.0, 1.0]] {
            // The rounding of three far joints, along three axes, against the shorter bone.
            let near = (1.0 - IN_LINE) / (2.0 * 3.0 * f64::from(f32::EPSILON));
            let case = |limit: f64| FarLimb { bones, target: 9.5, far: near / limit, ..REGULAR };
            check("coordinates", &scales, 1.0, case);
        }
        for swaps in [false, true] {
            let bones = |ratio: f64| if swaps { [1.0, ratio] } else { [ratio, 1.0] };
            let case = |ratio: f64| FarLimb { bones: bones(ratio), target: 1.0, ..REGULAR };
            check("ratio of the bones", &scales, 1e-6, case);
        }
        let equal = FarLimb { bones: [1.0, 1.0], ..REGULAR };
        check("hand at the start joint", &scales, 2e-3, |target| FarLimb { target, ..equal });
    }

    #[test]
    fn a_limb_is_regular_for_numbers_whose_squares_and_cubes_are_finite() {
        let half = |length: f64| FarLimb { bones: [0.5 * length; 2], target: 0.5, ..REGULAR };
        check("least length", &[1.0], 1e-30, half);
        let most = |per_length: f64| FarLimb { target: 0.5 / per_length, ..half(1.0 / per_length) };
        check("greatest length", &[1.0], 1e-30, most);
        check("least distance", &[1.0], 1e-30, |target| FarLimb { target, ..REGULAR });
        let case = |inv_target: f64| FarLimb { target: 1.0 / inv_target, ..REGULAR };
        check("greatest distance", &[1.0], 1e-30, case);
    }

    #[test]
    fn a_pole_is_used_unless_it_is_on_the_line_to_the_target() {
        for scale in [1e-10, 1.0, 1e10] {
            for pole in [1e-10, 1.0, 1e10] {
                let aims = |sine: f64| {
                    let limb = REGULAR.limb(scale);
                    let pole_ds = DVec3::new(sine, 0.0, 1.0) * pole;
                    limb.bend(DVec3::ZERO).aim_by_pole(&limb, pole_ds, [0.0, 1.0]).1
                };
                assert!(aims(1.01 * ON_LINE) && !aims(0.99 * ON_LINE), "{scale}, {pole}");
            }
        }
    }
}
