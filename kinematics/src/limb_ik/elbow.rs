use core::f64::consts::{PI, TAU};

use glam::{DMat3, DQuat, DVec3};

use crate::angle;

/// Rotation of a lower bone about one axis, in the upper joint's space.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bend {
    /// â, a unit vector.
    pub axis: DVec3,
    /// p, from the base of the upper bone to the base of the lower bone.
    pub upper: DVec3,
    /// r, from the base of the lower bone to its tip, at β = 0.
    pub lower: DVec3,
    /// Limits of β in radians; infinite where β is not limited.
    pub limits: (f64, f64),
    /// The side of straight that the limb keeps; `None` for that of the FK pose.
    pub kept_side: Option<f64>,
    law: Law,
}

impl Bend {
    /// The rotation of a bone about `axis`, with the fields of [`Bend`].
    pub fn new(axis: DVec3, upper: DVec3, lower: DVec3, limits: (f64, f64)) -> Self {
        let law = Law::new(axis, upper, lower);
        Self { axis, upper, lower, limits, kept_side: None, law }
    }

    /// The vector from the base of the upper bone to the tip of the lower bone, at the angle β.
    pub fn tip(&self, angle: f64) -> DVec3 {
        self.upper + DMat3::from_axis_angle(self.axis, angle) * self.lower
    }

    /// Minimum and maximum distance of the tip from the base of the upper bone, over the angles
    /// that the limits allow.
    pub fn reach(&self) -> (f64, f64) {
        let (from, to) = self.limits;
        let Law { straight, .. } = self.law;
        let (from, to) = (from - straight, to - straight);
        let passes = |phase: f64| phase + ((from - phase) / TAU).ceil() * TAU <= to;
        let ends = (from.cos(), to.cos());
        // Infinite limits pass both.
        let most = if !from.is_finite() || passes(0.0) { 1.0 } else { f64::max(ends.0, ends.1) };
        let least = if !from.is_finite() || passes(PI) { -1.0 } else { f64::min(ends.0, ends.1) };
        (self.distance_at(least), self.distance_at(most))
    }

    /// The two angles β at which the tip is at `distance`, which [`Self::reach`] contains, clamped
    /// to the limits; the one within the limits first. If both are, the first is the one on the
    /// side of `near`, or, if the limb is straight at `near`, on the side towards which it may bend
    /// farther.
    pub fn angles_at(&self, distance: f64, near: f64) -> [f64; 2] {
        const ROUNDING: f64 = 1e-9;
        let Law { squares, half_range, straight } = self.law;
        let k = (distance * distance - squares) / 2.0;
        let turn = (half_range * half_range - k * k).max(0.0).sqrt().atan2(k);
        let side = self.side(near);
        let [first, second] = [side, -side].map(|side| {
            let angle = angle::nearest_f64(straight + side * turn, self.middle(near));
            let clamped = angle.clamp(self.limits.0, self.limits.1);
            (clamped, (angle - clamped).abs())
        });
        if second.1 + ROUNDING < first.1 { [second.0, first.0] } else { [first.0, second.0] }
    }

    /// Direction in which the base of the lower bone moves, seen from the Pointer, if the limb
    /// bends from `angle` farther to the side of `near`.
    pub fn bending(&self, angle: f64, near: f64) -> DVec3 {
        let lower = DMat3::from_axis_angle(self.axis, angle) * self.lower;
        -self.side(near) * self.axis.cross(lower)
    }

    /// The side of straight that the limb keeps, or on which it is bent at `near`, or to which it
    /// may bend farther: 1 for a positive rotation, else −1.
    pub fn side(&self, near: f64) -> f64 {
        const STRAIGHT: f64 = 1e-6;
        if let Some(side) = self.kept_side {
            return side;
        }
        let straight = angle::nearest_f64(self.law.straight, near);
        let bent = near - straight;
        if bent.abs() > STRAIGHT {
            return bent.signum();
        }
        let (from, to) = self.limits;
        if to - straight >= straight - from { 1.0 } else { -1.0 }
    }

    /// Angle in radians between the two bones at β = `angle`; 0 for a straight limb.
    pub fn bent_by(&self, angle: f64) -> f64 {
        let lower = self.tip(angle) - self.upper;
        self.upper.cross(lower).length().atan2(self.upper.dot(lower))
    }

    /// True if the limb is straight at β = `angle`, but for rounding.
    pub fn is_straight_at(&self, angle: f64) -> bool {
        (angle::nearest_f64(self.law.straight, angle) - angle).abs() < 1e-3
    }

    /// True if the limits let the limb bend to both sides of straight.
    pub fn has_both_sides(&self, near: f64) -> bool {
        const ROUNDING: f64 = 1e-6;
        let (from, to) = self.limits;
        let straight = angle::nearest_f64(self.law.straight, self.middle(near));
        from < straight - ROUNDING && straight + ROUNDING < to
    }

    /// An angle within the limits that equivalent angles are chosen near to.
    fn middle(&self, near: f64) -> f64 {
        let (from, to) = self.limits;
        if from.is_finite() && to.is_finite() { (from + to) / 2.0 } else { near }
    }

    /// The tip's distance, for the cosine of the angle from straight.
    fn distance_at(&self, cos: f64) -> f64 {
        let Law { squares, half_range, .. } = self.law;
        (squares + 2.0 * half_range * cos).max(0.0).sqrt()
    }
}

/// The law of cosines for any axis: distance² = `squares` + 2 · `half_range` · cos(β − `straight`).
#[derive(Clone, Copy, Debug)]
struct Law {
    squares: f64,
    half_range: f64,
    straight: f64,
}

impl Law {
    fn new(axis: DVec3, upper: DVec3, lower: DVec3) -> Self {
        let along = upper.dot(axis) * lower.dot(axis);
        let cos = upper.dot(lower) - along;
        let sin = upper.dot(axis.cross(lower));
        Self {
            squares: upper.length_squared() + lower.length_squared() + 2.0 * along,
            half_range: cos.hypot(sin),
            straight: sin.atan2(cos),
        }
    }
}

/// Directions of a limb's tip and elbow from its base.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LimbAim {
    /// The Pointer: the unit vector from the upper joint to the tip, or to the target.
    pub pointer: DVec3,
    /// Unit vector perpendicular to the Pointer, towards the elbow; of a straight or folded limb,
    /// the direction in which the elbow moves when the limb bends farther.
    pub outward: DVec3,
}

impl LimbAim {
    /// The Pointer and elbow of a bent limb with the upper bone `upper` and the vector `tip` from
    /// the upper joint to the tip. `bending` is the direction in which the elbow would move if the
    /// limb bent farther: it replaces the elbow's own direction where the limb is straight or
    /// folded.
    pub(super) fn of_limb(upper: DVec3, tip: DVec3, bending: impl Fn() -> DVec3) -> Self {
        // Sine of the angle at the upper joint below which the elbow's direction is rounding.
        const STRAIGHT: f64 = 1e-6;
        let pointer = tip.try_normalize().unwrap_or_else(|| {
            let elbow = upper.try_normalize().unwrap_or(DVec3::X);
            bending().reject_from_normalized(elbow).normalize_or(elbow.any_orthonormal_vector())
        });
        let out = upper.reject_from_normalized(pointer);
        let out = if out.length() > STRAIGHT * upper.length() {
            out
        } else {
            bending().reject_from_normalized(pointer)
        };
        let outward = out.try_normalize().unwrap_or_else(|| pointer.any_orthonormal_vector());
        Self { pointer, outward }
    }

    /// This elbow direction, carried to another Pointer by the least rotation. For the opposite
    /// Pointer the direction stays.
    pub(super) fn carried_to(self, pointer: DVec3) -> Self {
        let turned = DQuat::from_rotation_arc(self.pointer, pointer) * self.outward;
        let opposite = self.pointer.dot(pointer) < -1.0 + 1e-12;
        let outward = if opposite { self.outward } else { turned };
        Self { pointer, outward: orthonormal(outward, pointer) }
    }

    /// The elbow turned about the Pointer by an angle in radians.
    pub(super) fn twisted(self, twist: f64) -> Self {
        let (sin, cos) = twist.sin_cos();
        let side = self.pointer.cross(self.outward);
        Self { outward: orthonormal(cos * self.outward + sin * side, self.pointer), ..self }
    }

    /// Angle in radians about the Pointer from the elbow of `from` to this one's; both have the
    /// same Pointer.
    pub(super) fn twist_from(self, from: Self) -> f64 {
        let side = from.pointer.cross(from.outward);
        self.outward.dot(side).atan2(self.outward.dot(from.outward))
    }

    /// Both vectors in another space.
    pub(super) fn rotated(self, rotation: DMat3) -> Self {
        Self { pointer: rotation * self.pointer, outward: rotation * self.outward }
    }

    /// The rotation that turns this Pointer and elbow to another one's.
    pub(super) fn rotation_to(self, other: Self) -> DMat3 {
        other.frame() * self.frame().transpose()
    }

    /// The rotation whose x axis is the Pointer and whose y axis points towards the elbow.
    pub fn frame(self) -> DMat3 {
        DMat3::from_cols(self.pointer, self.outward, self.pointer.cross(self.outward))
    }
}

pub(super) fn orthonormal(v: DVec3, normal: DVec3) -> DVec3 {
    v.reject_from_normalized(normal).normalize_or(normal.any_orthonormal_vector())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use proptest::test_runner::RngSeed;

    use super::*;

    fn vector() -> impl Strategy<Value = DVec3> {
        prop::array::uniform3(-1.0..1.0).prop_map(DVec3::from_array)
    }

    fn bend() -> impl Strategy<Value = Bend> {
        let limits = prop_oneof![
            Just((f64::NEG_INFINITY, f64::INFINITY)),
            (-4.0..4.0, 0.0..6.0).prop_map(|(from, range)| (from, from + range)),
        ];
        (vector(), vector(), vector(), limits)
            .prop_filter("unit axis, bones with length", |(axis, upper, lower, _)| {
                [axis, upper, lower].into_iter().all(|v| v.length() > 0.1)
            })
            .prop_map(|(axis, upper, lower, limits)| {
                Bend::new(axis.normalize(), upper, lower, limits)
            })
    }

    proptest! {
        #![proptest_config(ProptestConfig {
            cases: 2_000,
            rng_seed: RngSeed::Fixed(15),
            failure_persistence: None,
            ..ProptestConfig::default()
        })]

        #[test]
        fn the_tip_is_at_every_distance_within_reach(
            bend in bend(), part in 0.0..1.0, near in -4.0..4.0,
        ) {
            let (least, most) = bend.reach();
            let distance = least + (most - least) * part;
            let angle = bend.angles_at(distance, near)[0];
            prop_assert!((bend.limits.0..=bend.limits.1).contains(&angle), "{angle}");
            prop_assert!((bend.tip(angle).length() - distance).abs() < 1e-7, "{bend:?} {distance}");
        }

        #[test]
        fn no_angle_within_the_limits_leaves_the_reach(bend in bend(), part in 0.0..1.0) {
            let (from, to) = (bend.limits.0.max(-10.0), bend.limits.1.min(10.0));
            let distance = bend.tip(from + (to - from) * part).length();
            let (least, most) = bend.reach();
            prop_assert!((least - 1e-9..=most + 1e-9).contains(&distance), "{distance}");
        }

        #[test]
        fn a_bent_limb_gets_its_own_angle_back(bend in bend(), part in 0.001..0.999) {
            let (from, to) = (bend.limits.0.max(-10.0), bend.limits.1.min(10.0));
            let near = from + (to - from) * part;
            let [again, _] = bend.angles_at(bend.tip(near).length(), near);
            prop_assume!((near - bend.law.straight).sin().abs() > 1e-3);
            prop_assume!(bend.law.half_range > 1e-3);
            prop_assert!((bend.tip(again) - bend.tip(near)).length() < 1e-6, "{near} is {again}");
        }
    }
}
