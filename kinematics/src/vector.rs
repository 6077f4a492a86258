//! Vectors of any length in f32: unit vectors and rotations between vectors whose squares underflow
//! (below 1e-19) or overflow (above 1e19), and conversions from f64 that clamp overflow.

use glam::{DVec3, Quat, Vec3, Vec3A};

/// Unit vector in the direction of `v`; `None` if `v` is zero or not finite.
pub(crate) fn normalize(v: Vec3A) -> Option<Vec3A> {
    if squares_safely(v) { v.try_normalize() } else { scaled_near_1(v)?.try_normalize() }
}

/// True if the squared length, and the product of two such squares, neither overflows nor
/// underflows.
fn squares_safely(v: Vec3A) -> bool {
    (1e-15..=1e15).contains(&v.length_squared())
}

/// The vector scaled by the power of two that brings its largest coordinate into 1 … 2, or as near
/// to that range as f32 allows for subnormal vectors; `None` for a vector without a direction.
fn scaled_near_1(v: Vec3A) -> Option<Vec3A> {
    let largest = v.abs().max_element();
    (largest > 0.0 && v.is_finite()).then(|| v * power_of_two_near(largest).1)
}

/// The power of two at or below `value` ≥ 0, and its reciprocal; clamped so that both are normal
/// numbers. Scaling by either is exact.
#[inline(always)]
pub(crate) fn power_of_two_near(value: f32) -> (f32, f32) {
    const EXPONENT: u32 = 0xff << 23;
    const LEAST: u32 = 1 << 23;
    const MOST: u32 = 253 << 23;
    let power = (value.to_bits() & EXPONENT).clamp(LEAST, MOST);
    (f32::from_bits(power), f32::from_bits(LEAST + MOST - power))
}

/// Rotation by the smallest angle that turns one direction to another, for vectors of any length.
/// The identity if either has no direction; about any perpendicular axis if they are opposite.
pub(crate) fn rotation_between(from: Vec3A, to: Vec3A) -> Quat {
    // Cosine of the angle; below it, `both + dot` cancels.
    const NEARLY_OPPOSITE: f32 = -0.9;
    if !(squares_safely(from) && squares_safely(to)) {
        let both = scaled_near_1(from).zip(scaled_near_1(to));
        return both.map_or(Quat::IDENTITY, |(from, to)| rotation_between(from, to));
    }
    let both = (from.length_squared() * to.length_squared()).sqrt();
    let (cross, dot) = (from.cross(to), from.dot(to));
    if dot < NEARLY_OPPOSITE * both {
        // Half a turn about an exactly perpendicular axis, then the small remainder.
        let unit = from.normalize();
        let axis = normalize(cross.reject_from_normalized(unit));
        let axis = axis.unwrap_or_else(|| unit.any_orthonormal_vector());
        let half = Quat::from_xyzw(axis.x, axis.y, axis.z, 0.0);
        return (rotation_between(-from, to) * half).normalize();
    }
    Quat::from_xyzw(cross.x, cross.y, cross.z, both + dot).normalize()
}

/// Converts a number of at least −`f32::MAX` to f32; numbers above `f32::MAX` become `f32::MAX`.
pub(crate) fn saturate(value: f64) -> f32 {
    value.min(f64::from(f32::MAX)) as f32
}

/// Converts a vector to f32, with its coordinates clamped to ±`f32::MAX`.
pub(crate) fn saturate_vector(v: DVec3) -> Vec3 {
    v.clamp(Vec3::MIN.as_dvec3(), Vec3::MAX.as_dvec3()).as_vec3()
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

    fn directions() -> impl Iterator<Item = Vec3A> {
        let steps = || (-2..=2).map(|step| step as f32);
        let all =
            steps().flat_map(move |x| steps().flat_map(move |y| steps().map(move |z| (x, y, z))));
        all.map(|(x, y, z)| Vec3A::new(x, y, z)).filter(|v| *v != Vec3A::ZERO)
    }

    #[test]
    fn every_direction_turns_to_every_other_also_to_its_opposite() {
        for from in directions() {
            for to in directions() {
                let turned = rotation_between(from, to) * from.normalize();
                assert!(turned.distance(to.normalize()) < 1e-6, "{from} to {to} is {turned}");
            }
        }
    }

    #[test]
    fn a_small_turn_is_as_exact_as_a_large_one() {
        for exponent in 1..7 {
            let to = Vec3A::new(1.0, 10_f32.powi(-exponent), 0.0);
            let turned = rotation_between(Vec3A::X, to) * Vec3A::X;
            assert!((turned.y / turned.x / to.y - 1.0).abs() < 1e-5, "{turned} for {to}");
        }
    }

    #[test]
    fn the_length_of_vectors_does_not_change_the_rotation() {
        let (from, to) = (Vec3A::new(1.0, 2.0, -2.0), Vec3A::new(-6.0, 2.0, 3.0));
        for exponents in [(-126, -126), (-126, 120), (120, 120), (-80, 0), (0, -70), (70, 0)] {
            let [one, other] = [exponents.0, exponents.1].map(|power| 2_f32.powi(power));
            assert_eq!(
                rotation_between(from * one, to * other),
                rotation_between(from, to),
                "{exponents:?}"
            );
        }
    }

    #[test]
    fn a_vector_without_a_direction_gives_the_identity() {
        assert_eq!(rotation_between(Vec3A::ZERO, Vec3A::X), Quat::IDENTITY);
        assert_eq!(rotation_between(Vec3A::X, Vec3A::ZERO), Quat::IDENTITY);
    }
}
