//! How far limits must be widened to contain a pose.

use core::f32::consts::TAU;

use super::{Remedy, WidenedLimit};
use crate::skeleton::{JointId, Limit, RotationAxis, Skeleton};

/// One of the three angles of a joint.
pub(crate) type Angle = (JointId, RotationAxis);

/// The angles of joints that have a limit.
pub(crate) fn limited_angles(
    skeleton: &Skeleton,
    joints: impl Iterator<Item = JointId>,
) -> Vec<Angle> {
    let limited = joints.flat_map(|joint| {
        let limits = RotationAxis::ALL.into_iter().zip(skeleton[joint].limits);
        limits.filter_map(move |(axis, limit)| limit.map(|_| (joint, axis)))
    });
    limited.collect()
}

/// Whether the limits of an angle leave it one value.
pub(crate) fn is_fixed(skeleton: &Skeleton, (joint, axis): Angle) -> bool {
    skeleton[joint].limits[axis as usize].is_some_and(|limit| limit.min == limit.max)
}

/// Removes the limits of some angles.
pub(crate) fn remove_limits(skeleton: &mut Skeleton, angles: &[Angle]) {
    for (joint, axis) in angles {
        skeleton.write_local(*joint, |joint| joint.limits[*axis as usize] = None);
    }
}

/// The least widening, in whole degrees, of limits of `skeleton` that contains the angles of `pose`;
/// `None` if they contain these already.
pub(crate) fn widen_to_contain(
    skeleton: &Skeleton,
    pose: &Skeleton,
    angles: &[Angle],
) -> Option<Remedy> {
    let widened = angles.iter().filter_map(|(joint, axis)| {
        let limit = skeleton[*joint].limits[*axis as usize]?;
        let widened = widened(limit, pose[*joint].rotation[*axis as usize])?;
        let by = (limit.min - widened.min) + (widened.max - limit.max);
        Some(WidenedLimit { joint: *joint, axis: *axis, limit: widened, by })
    });
    let widened: Vec<_> = widened.collect();
    (!widened.is_empty()).then_some(Remedy::WidenLimits(widened))
}

/// A limit widened by whole degrees to contain an angle or the same angle after a full turn, whichever
/// is nearer; `None` if it contains the angle.
fn widened(limit: Limit, angle: f32) -> Option<Limit> {
    let degrees = |by: f32| by.to_degrees().ceil().to_radians();
    let excess = |angle: f32| (limit.min - angle).max(angle - limit.max);
    let nearest = [angle, angle - TAU, angle + TAU]
        .into_iter()
        .min_by(|one, other| excess(*one).total_cmp(&excess(*other)))?;
    if nearest < limit.min {
        Some(Limit { min: limit.min - degrees(limit.min - nearest), ..limit })
    } else if nearest > limit.max {
        Some(Limit { max: limit.max + degrees(nearest - limit.max), ..limit })
    } else {
        None
    }
}
