//! The turn about a point that brings points nearest to others.

use glam::{Quat, Vec3, Vec3A};

use crate::kinematics::skeleton::Limit;
use crate::kinematics::{normalize, rotation_between};

/// A point to be turned, and where it is to come; both from the point that is turned about.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pair {
    pub arm: Vec3A,
    pub goal: Vec3A,
    pub weight: f32,
}

/// The best turn about the axis that the pairs' moments ask for. For one pair it is exact.
pub(super) fn align(pairs: &[Pair]) -> Quat {
    if let [pair] = pairs {
        return rotation_between(pair.arm, pair.goal);
    }
    let moment: Vec3A = pairs.iter().map(|pair| pair.weight * pair.arm.cross(pair.goal)).sum();
    let Some(axis) = normalize(moment) else { return Quat::IDENTITY };
    Quat::from_axis_angle(axis.into(), best_angle(axis, pairs))
}

/// Turns angle by angle, x first, each as far as its limits let it. Nothing gets worse. The turn of
/// the whole; the pairs' arms are turned with it.
///
/// `axes` are what the angles turn about, before.
pub(super) fn align_within(
    limits: &[Option<Limit>; 3],
    axes: [Vec3A; 3],
    angles: &mut Vec3,
    pairs: &mut [Pair],
) -> Quat {
    let mut whole = Quat::IDENTITY;
    for (index, axis) in axes.into_iter().enumerate() {
        let best = best_angle(axis, pairs);
        let by = match limits[index] {
            Some(Limit { min, max }) => {
                let from = angles[index];
                let to = (from + allowed(best, min - from, max - from)).clamp(min, max);
                angles[index] = to;
                to - from
            }
            None => {
                angles[index] += best;
                best
            }
        };
        if by != 0.0 {
            let turn = Quat::from_axis_angle(axis.into(), by);
            for pair in &mut *pairs {
                pair.arm = turn * pair.arm;
            }
            whole = turn * whole;
        }
    }
    whole
}

/// a cos θ + b sin θ is what Σ w arm·goal becomes when the arms turn by θ, less what does not
/// change.
fn best_angle(axis: Vec3A, pairs: &[Pair]) -> f32 {
    let (mut a, mut b) = (0.0, 0.0);
    for Pair { arm, goal, weight } in pairs {
        a += weight * (arm.dot(*goal) - axis.dot(*arm) * axis.dot(*goal));
        b += weight * axis.dot(arm.cross(*goal));
    }
    if a == 0.0 && b == 0.0 { 0.0 } else { b.atan2(a) }
}

/// Of −`least` … `most` around 0, what is nearest to `best` on the circle.
fn allowed(best: f32, least: f32, most: f32) -> f32 {
    use core::f32::consts::TAU;
    // What rounding of the angle gains or loses.
    const NOTHING: f32 = 1e-7;
    for turned in [best, best - TAU, best + TAU] {
        if (least..=most).contains(&turned) {
            return turned;
        }
    }
    let gain = |angle: f32| (angle - best).cos();
    let end = if gain(least) >= gain(most) { least } else { most };
    if gain(end) > gain(0.0) + NOTHING { end } else { 0.0 }
}
