use glam::{Quat, Vec3A};

use super::normalize::{normalize, scaled_near_1, squares_safely};

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

#[cfg(test)]
mod tests {
    use super::*;

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
