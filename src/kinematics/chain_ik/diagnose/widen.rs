//! Limits that keep a tip from its target, and how far they must be widened.

use super::pull::Pull;
use super::solve_inputs::SolveInputs;
use crate::kinematics::diagnosis::{Remedy, WidenedLimit};
use crate::kinematics::skeleton::{JointId, Limit, RotationAxis, Skeleton};

/// Angle of a joint.
pub(super) type Angle = (JointId, RotationAxis);

/// The inputs without the limits of some angles.
pub(super) fn without_limits(inputs: &SolveInputs, angles: &[Angle]) -> SolveInputs {
    let mut free = inputs.clone();
    for (joint, axis) in angles {
        // Removing a limit of a joint that is there cannot fail.
        let _ = free.skeleton.change(*joint, |joint| joint.limits[*axis as usize] = None);
    }
    free
}

/// The angles that pulls push outwards, and all limited angles of the chain.
pub(super) fn pushed(pulls: impl Iterator<Item = Pull>) -> Vec<Angle> {
    pulls.map(|pull| (pull.joint, pull.axis)).collect()
}

pub(super) fn all_limited(skeleton: &Skeleton, joint: JointId) -> Vec<Angle> {
    let free = skeleton.ancestors(joint).filter(|joint| !skeleton[*joint].locked);
    let limited = free.flat_map(|joint| {
        let limits = RotationAxis::ALL.into_iter().zip(skeleton[joint].limits);
        limits.filter_map(move |(axis, limit)| limit.map(|_| (joint, axis)))
    });
    limited.collect()
}

/// The least widening, in whole degrees, of limits of `skeleton` that contains the angles of `pose`;
/// `None` if it contains them already.
pub(super) fn to_contain(skeleton: &Skeleton, pose: &Skeleton, angles: &[Angle]) -> Option<Remedy> {
    let widened = angles.iter().filter_map(|(joint, axis)| {
        let limit = skeleton[*joint].limits[*axis as usize]?;
        let angle = pose[*joint].rotation[*axis as usize];
        let degrees = |by: f32| by.to_degrees().ceil().to_radians();
        let (below, above) = (limit.min - angle, angle - limit.max);
        let widened = match (below > 0.0, above > 0.0) {
            (true, _) => Limit { min: limit.min - degrees(below), ..limit },
            (_, true) => Limit { max: limit.max + degrees(above), ..limit },
            _ => return None,
        };
        let by = (limit.min - widened.min) + (widened.max - limit.max);
        Some(WidenedLimit { joint: *joint, axis: *axis, limit: widened, by })
    });
    let widened: Vec<_> = widened.collect();
    (!widened.is_empty()).then_some(Remedy::WidenLimits(widened))
}
