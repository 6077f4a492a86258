//! How far limits must be widened to contain a pose.

use super::{Remedy, WidenedLimit};
use crate::skeleton::{JointId, RotationAxis, Skeleton};

/// One of the three angles of a joint.
pub(crate) type Angle = (JointId, RotationAxis);

/// The angles of joints that have a limit.
pub(crate) fn limited_angles(
    skeleton: &Skeleton,
    joints: impl Iterator<Item = JointId>,
) -> Vec<Angle> {
    let limited = joints.flat_map(|joint| {
        let limits = skeleton[joint].limits;
        let is_limited = move |axis: &RotationAxis| limits.range(*axis).is_some();
        RotationAxis::ALL.into_iter().filter(is_limited).map(move |axis| (joint, axis))
    });
    limited.collect()
}

/// Whether the limits of an angle leave it one value.
pub(crate) fn is_fixed(skeleton: &Skeleton, (joint, axis): Angle) -> bool {
    skeleton[joint].limits.is_fixed(axis)
}

/// Removes the limits of some angles.
pub(crate) fn remove_limits(skeleton: &mut Skeleton, angles: &[Angle]) {
    for (joint, axis) in angles {
        skeleton.write_local(*joint, |joint| joint.limits.set_range(*axis, None));
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
        let limit = skeleton[*joint].limits.range(*axis)?;
        let widened = limit.widened_to(pose[*joint].rotation[axis.index()])?;
        let by = (limit.min - widened.min) + (widened.max - limit.max);
        Some(WidenedLimit { joint: *joint, axis: *axis, limit: widened, by })
    });
    let widened: Vec<_> = widened.collect();
    (!widened.is_empty()).then_some(Remedy::WidenLimits(widened))
}
