//! Normalization of vectors whose squares underflow (below 1e-19) or overflow (above 1e19) in f32.

use glam::Vec3A;

/// Unit vector in the direction of `v`; `None` if `v` is zero or not finite.
pub(crate) fn normalize(v: Vec3A) -> Option<Vec3A> {
    if squares_safely(v) { v.try_normalize() } else { scaled_near_1(v)?.try_normalize() }
}

/// True if the squared length, and the product of two such squares, neither overflows nor
/// underflows.
pub(super) fn squares_safely(v: Vec3A) -> bool {
    (1e-15..=1e15).contains(&v.length_squared())
}

/// The vector scaled by the power of two that brings its largest coordinate into 1 … 2, or as near
/// to that range as f32 allows for subnormal vectors; `None` for a vector without a direction.
pub(super) fn scaled_near_1(v: Vec3A) -> Option<Vec3A> {
    let largest = v.abs().max_element();
    (largest > 0.0 && v.is_finite()).then(|| v * power_of_two_near(largest).1)
}

/// The power of two at or below `value` ≥ 0, and its reciprocal; clamped so that both are normal
/// numbers. Scaling by either is exact.
#[inline(always)]
pub(super) fn power_of_two_near(value: f32) -> (f32, f32) {
    const EXPONENT: u32 = 0xff << 23;
    const LEAST: u32 = 1 << 23;
    const MOST: u32 = 253 << 23;
    let power = (value.to_bits() & EXPONENT).clamp(LEAST, MOST);
    (f32::from_bits(power), f32::from_bits(LEAST + MOST - power))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_of_every_length_are_normalized() {
        let expected = Vec3A::new(2.0, -3.0, 6.0) / 7.0;
        for exponent in -125..=125 {
            let v = Vec3A::new(2.0, -3.0, 6.0) * 2_f32.powi(exponent);
            let found = normalize(v).expect("a direction");
            assert!(found.distance(expected) < 1e-6, "{found} for {v}");
        }
        let least = f32::from_bits(1);
        assert_eq!(normalize(Vec3A::Y * least), Some(Vec3A::Y));
        assert_eq!(normalize(Vec3A::NEG_Z * f32::MAX), Some(Vec3A::NEG_Z));
    }

    #[test]
    fn vectors_without_a_direction_normalize_to_none() {
        for v in [Vec3A::ZERO, Vec3A::NAN, Vec3A::INFINITY, Vec3A::new(f32::NAN, 1.0, 0.0)] {
            assert_eq!(normalize(v), None, "{v}");
        }
    }
}
