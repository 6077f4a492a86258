//! Rotations about a centre that bring points as near as possible to their destinations.

use glam::{DMat3, DQuat, DVec3, Quat, Vec3, Vec3A};
use nalgebra::Matrix4;

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

/// The rotation that brings points nearest to their destinations, of all rotations: that of the
/// greatest eigenvalue of Horn's matrix. Where several are as good, a small one.
///
/// # Source
///
/// B. Horn, *Closed-form solution of absolute orientation using unit quaternions*, 1987.
pub(super) fn align_best(pairs: &[PointPair]) -> Quat {
    /// Weight of the identity, relative to that of the pairs.
    const SMALL: f64 = 1e-6;
    let mut sums = DMat3::ZERO;
    let mut whole = 0.0;
    for PointPair { from, to, weight } in pairs {
        let (from, to) = (from.as_dvec3(), to.as_dvec3() * f64::from(*weight));
        sums += DMat3::from_cols(from * to.x, from * to.y, from * to.z);
        whole += from.length() * to.length();
    }
    let DMat3 { x_axis: x, y_axis: y, z_axis: z } = sums + DMat3::IDENTITY * (SMALL * whole);
    let trace = x.x + y.y + z.z;
    let skew = DVec3::new(z.y - y.z, x.z - z.x, y.x - x.y);
    #[rustfmt::skip]
    let horn = Matrix4::new(
        trace,  skew.x,              skew.y,              skew.z,
        skew.x, 2.0 * x.x - trace,   x.y + y.x,           z.x + x.z,
        skew.y, x.y + y.x,           2.0 * y.y - trace,   y.z + z.y,
        skew.z, z.x + x.z,           y.z + z.y,           2.0 * z.z - trace,
    );
    let eigen = horn.symmetric_eigen();
    let best = eigen.eigenvectors.column(eigen.eigenvalues.imax());
    let rotation = DQuat::from_xyzw(best[1], best[2], best[3], best[0]).as_quat();
    if rotation.is_finite() { rotation.normalize() } else { Quat::IDENTITY }
}

/// Sets each Euler angle in turn, x first, to its best value within its limits, which never
/// increases the weighted squared distance. Rotates the points `from` of the pairs and returns the
/// total rotation. With a `part` below 1, each angle changes by that part of its way alone.
///
/// `axes` are the rotation axes of the three angles before the call.
pub(super) fn align_within(
    limits: &JointLimits,
    axes: [Vec3A; 3],
    part: f32,
    angles: &mut Vec3,
    pairs: &mut [PointPair],
) -> Quat {
    let mut whole = Quat::IDENTITY;
    for (about, axis) in RotationAxis::ALL.into_iter().zip(axes) {
        let best = best_angle(axis, pairs);
        let by = match limits.room(*angles, about) {
            Some(room) => {
                let from = angles[about.index()];
                angles[about.index()] += part * best_within(best, *room.start(), *room.end());
                *angles = limits.project(*angles);
                angles[about.index()] - from
            }
            None => {
                angles[about.index()] += part * best;
                part * best
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
