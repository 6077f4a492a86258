//! Rotations about a centre that bring points as near as possible to their destinations.

use glam::{Quat, Vec3, Vec3A};

use crate::skeleton::{JointLimits, RotationAxis};
use crate::{normalize, rotation_between};

/// A point to be rotated and its destination, both relative to the centre of rotation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PointPair {
    pub from: Vec3A,
    pub to: Vec3A,
    pub weight: f32,
}

/// Number of rotations by [`align`]: for several pairs, one is the best about one axis only; a few
/// come near the best of all.
pub(super) const ROTATIONS: usize = 3;

/// Rotation by the best angle about the axis of the total moment Σ w from × to; exact for a single
/// pair.
pub(super) fn align(pairs: &[PointPair]) -> Quat {
    if let [pair] = pairs {
        return rotation_between(pair.from, pair.to);
    }
    let moment: Vec3A = pairs.iter().map(|pair| pair.weight * pair.from.cross(pair.to)).sum();
    let Some(axis) = normalize(moment) else { return Quat::IDENTITY };
    Quat::from_axis_angle(axis.into(), best_angle(axis, pairs))
}

/// Sets each Euler angle in turn, x first, to its best value within its limits, which never
/// increases the weighted squared distance. Rotates the points `from` of the pairs and returns the
/// total rotation.
///
/// `axes` are the rotation axes of the three angles before the call.
pub(super) fn align_within(
    limits: &JointLimits,
    axes: [Vec3A; 3],
    angles: &mut Vec3,
    pairs: &mut [PointPair],
) -> Quat {
    let mut whole = Quat::IDENTITY;
    for (about, axis) in RotationAxis::ALL.into_iter().zip(axes) {
        let best = best_angle(axis, pairs);
        let by = match limits.room(*angles, about) {
            Some(room) => {
                let from = angles[about.index()];
                angles[about.index()] += best_within(best, *room.start(), *room.end());
                *angles = limits.project(*angles);
                angles[about.index()] - from
            }
            None => {
                angles[about.index()] += best;
                best
            }
        };
        if by != 0.0 {
            let rotation = Quat::from_axis_angle(axis.into(), by);
            for pair in &mut *pairs {
                pair.from = rotation * pair.from;
            }
            whole = rotation * whole;
        }
    }
    whole
}

/// Angle of a rotation about `axis` that maximizes Σ w from·to. This sum is a cos θ + b sin θ, up
/// to a constant.
fn best_angle(axis: Vec3A, pairs: &[PointPair]) -> f32 {
    let (mut a, mut b) = (0.0, 0.0);
    for PointPair { from, to, weight } in pairs {
        a += weight * (from.dot(*to) - axis.dot(*from) * axis.dot(*to));
        b += weight * axis.dot(from.cross(*to));
    }
    if a == 0.0 && b == 0.0 { 0.0 } else { b.atan2(a) }
}

/// Of the angles from `least` to `most`, a range that contains 0, the one nearest to `best` on the
/// circle; 0 if no other angle is nearer.
fn best_within(best: f32, least: f32, most: f32) -> f32 {
    use core::f32::consts::TAU;
    // Gain or loss that rounding of the angle alone can cause.
    const ROUNDING: f32 = 1e-7;
    for angle in [best, best - TAU, best + TAU] {
        if (least..=most).contains(&angle) {
            return angle;
        }
    }
    let gain = |angle: f32| (angle - best).cos();
    let end = if gain(least) >= gain(most) { least } else { most };
    if gain(end) > gain(0.0) + ROUNDING { end } else { 0.0 }
}
