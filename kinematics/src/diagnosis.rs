//! Why a tip is not at its target, and what would bring it there.
//!
//! A [`Diagnosis`] names a [`Cause`] and the joints concerned. Its remedies have been tried: each
//! is told with the residual that it leaves. [`chain_ik::diagnose`](super::chain_ik::diagnose)
//! finds the causes for the solvers of chains;
//! [`SkeletonRig::diagnose`](crate::rig::SkeletonRig::diagnose) adds those of limbs and of targets
//! that share a pose with FK.

use core::num::NonZeroU32;

use glam::Vec3;

use crate::chain_ik::{ChainTarget, Method, Root, SolverOptions};
use crate::skeleton::{Cone, JointId, JointLimits, Limit, RotationAxis, Skeleton, SkeletonError};

/// A cause for which a tip is not at its target, or a hand not turned as its target asks.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnosis {
    /// The joint whose tip is not at its target.
    pub target: JointId,
    /// Distance from the tip to the target, in world units.
    pub residual: f32,
    /// The cause.
    pub cause: Cause,
    /// The joints concerned; those with the greatest effect first.
    pub joints: Vec<JointId>,
    /// Changes that bring the tip nearer, the best first; empty if none of those tried does.
    pub remedies: Vec<TriedRemedy>,
}

/// A remedy and what it leaves.
#[derive(Clone, Debug, PartialEq)]
pub struct TriedRemedy {
    /// The change.
    pub remedy: Remedy,
    /// Distance from the tip to the target after the change, in world units.
    pub residual: f32,
    /// Angle in radians from the rotation of the hand to that which its target asks for, after the
    /// change; 0 for a target that asks for no rotation.
    pub rotation_residual: f32,
}

impl Diagnosis {
    /// The residual that the best remedy leaves; without a remedy, the present one.
    pub fn residual_with_remedy(&self) -> f32 {
        self.remedies.first().map_or(self.residual, |tried| tried.residual)
    }
}

/// The most likely cause for each target, then the second one for each, and so on.
pub(crate) fn in_turn(mut lists: Vec<Vec<Diagnosis>>) -> Vec<Diagnosis> {
    let mut all = Vec::new();
    lists.iter_mut().for_each(|list| list.reverse());
    while lists.iter().any(|list| !list.is_empty()) {
        all.extend(lists.iter_mut().filter_map(Vec::pop));
    }
    all
}

/// The reason why a tip is not at its target, or a hand not turned as its target asks, with its
/// evidence. Lengths are in world units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cause {
    /// The target is farther from the chain's base than the bones reach, or closer than they fold.
    OutOfReach {
        /// The joint at the chain's base.
        base: JointId,
        /// Distance from the chain's base to the target.
        distance: f32,
        /// The nearest distance of the tip from the base.
        shortest: f32,
        /// The farthest distance of the tip from the base.
        longest: f32,
        /// The bound of the reach.
        boundary: Boundary,
    },
    /// The joints are at limits, and the target pulls them outwards.
    Limits,
    /// The limits of a hand's joint keep it from the rotation that the target asks for.
    RotationLimits {
        /// Angle in radians that is missing.
        missing: f32,
        /// The angles of the joint, x, y and z, whose limits are in the way.
        axes: [bool; 3],
    },
    /// The tip reaches the place of its target, but not together with the rotation or aim that the
    /// target asks for.
    Turn {
        /// Angle in radians that is missing.
        missing: f32,
        /// True if the rotation or aim can be had at another place.
        is_had_alone: bool,
    },
    /// The target pulls joints that are locked.
    Locked,
    /// The tip reaches its target alone, but not together with the tip of another joint.
    Conflict {
        /// The joint of the other target.
        with: JointId,
    },
    /// No small change of the angles brings the tip nearer, but another pose is at the target.
    Stalled,
    /// No joint moves the tip in the direction in which the target is.
    Singular {
        /// Speed of the tip towards the target, as a fraction of its speed in the direction in
        /// which it moves best, for the same angular speed of all joints.
        mobility: f32,
    },
    /// The tip was still coming nearer when the solver stopped.
    OutOfIterations {
        /// Number of iterations after which the solver stopped.
        iterations: u32,
    },
    /// The target can be reached, but not from the pose to which the motion has come.
    Lost,
    /// The target can be reached without the balance of the figure.
    Balance,
    /// The target of a chain turns too few joints.
    ShortChain {
        /// Number of joints that it turns.
        length: u32,
    },
    /// The pose is a mix of the FK pose and the solved one, which reaches the target.
    Influence {
        /// Fraction of the way from the FK pose to the solved one.
        influence: f32,
    },
}

/// A bound of the reach of a chain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Boundary {
    /// The lengths of the bones.
    Bones,
    /// A soft limit, which slows the tip down before the bones are straight or folded.
    SoftLimit,
    /// The smallest elbow angle.
    ElbowAngle,
}

impl Cause {
    /// Name on the command line, such as `out_of_reach`.
    pub fn name(self) -> &'static str {
        match self {
            Self::OutOfReach { .. } => "out_of_reach",
            Self::Limits => "limits",
            Self::RotationLimits { .. } => "rotation_limits",
            Self::Turn { .. } => "turn",
            Self::Locked => "locked",
            Self::Conflict { .. } => "conflict",
            Self::Stalled => "stalled",
            Self::Lost => "lost",
            Self::Singular { .. } => "singular",
            Self::OutOfIterations { .. } => "out_of_iterations",
            Self::Balance => "balance",
            Self::ShortChain { .. } => "short_chain",
            Self::Influence { .. } => "influence",
        }
    }
}

/// A change that brings a tip nearer to its target.
#[derive(Clone, Debug, PartialEq)]
pub enum Remedy {
    /// Moves the target of a joint.
    MoveTarget {
        /// The joint of the target.
        joint: JointId,
        /// The new position, in the world.
        point: Vec3,
    },
    /// Lengthens all bones from a root to the tip of a joint.
    Lengthen {
        /// The last joint.
        joint: JointId,
        /// Factor of the lengths.
        factor: f32,
    },
    /// Changes what solvers may do with roots.
    SetRoot(Root),
    /// Lets the body follow limb targets that are out of reach.
    FollowBody,
    /// Lets the centre of mass of the figure be anywhere.
    FreeBalance,
    /// Lets the target of a chain turn more joints.
    LengthenChain {
        /// The joint of the target.
        joint: JointId,
        /// Number of joints that it turns.
        length: NonZeroU32,
    },
    /// Widens limits of angles.
    WidenLimits(Vec<WidenedLimit>),
    /// Lets solvers turn joints.
    Unlock(Vec<JointId>),
    /// Disables the target of a joint.
    SwitchOff(JointId),
    /// Changes the weight of a target.
    SetWeight {
        /// The joint of the target.
        joint: JointId,
        /// The new weight.
        weight: f32,
    },
    /// Lets the target of a joint ask for a place alone, not for a rotation or an aim.
    FreeTurn(JointId),
    /// Lets the target of a joint ask for a rotation or an aim alone, not for a place.
    FreePlace(JointId),
    /// Solves by another method.
    UseMethod(Method),
    /// Solves from other joint angles.
    StartFrom(Start),
    /// Raises the maximum number of iterations.
    AllowIterations(u32),
    /// Gives a target full influence.
    FullInfluence(JointId),
    /// Lets a limb stretch.
    Stretch {
        /// The joint of the limb's target.
        joint: JointId,
        /// Maximum factor by which the bones are lengthened.
        max_stretch: f32,
    },
    /// Lets a limb move up to its limits without slowing down before them, and fold completely.
    HardLimits(JointId),
}

/// A limit that a remedy widens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WidenedLimit {
    /// The joint.
    pub joint: JointId,
    /// The wider limit.
    pub to: WiderLimit,
    /// Increase of the range, or the greatest one of an angle of the cone, in radians.
    pub by: f32,
}

/// The limit that replaces a narrower one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WiderLimit {
    /// A range of an angle.
    Range {
        /// The axis of the angle.
        axis: RotationAxis,
        /// The range.
        limit: Limit,
    },
    /// A cone.
    Cone(Cone),
}

/// Joint angles from which a solve starts.
#[derive(Clone, Debug, PartialEq)]
pub struct Start {
    /// True if the chain is only bent a little from where it is.
    pub is_bend: bool,
    /// Euler angles in radians.
    pub angles: Vec<(JointId, Vec3)>,
}

impl Remedy {
    /// Applies the part of the remedy that concerns joints.
    ///
    /// # Errors
    ///
    /// [`SkeletonError`] for joints that the skeleton does not have, and for lengths that overflow.
    pub fn change_skeleton(&self, skeleton: &mut Skeleton) -> Result<(), SkeletonError> {
        match self {
            Self::Lengthen { joint, factor } => lengthen(skeleton, *joint, *factor),
            Self::WidenLimits(widened) => widened.iter().try_for_each(|widened| {
                skeleton.change(widened.joint, |joint| match widened.to {
                    WiderLimit::Range { axis, limit } => {
                        joint.limits.set_range(axis, Some(limit));
                    }
                    WiderLimit::Cone(cone) => joint.limits = JointLimits::cone(cone),
                })
            }),
            Self::Unlock(joints) => joints
                .iter()
                .try_for_each(|joint| skeleton.change(*joint, |joint| joint.locked = false)),
            Self::StartFrom(start) => start
                .angles
                .iter()
                .try_for_each(|(joint, angles)| skeleton.set_rotation(*joint, *angles)),
            _ => Ok(()),
        }
    }

    /// Applies the part of the remedy that concerns the solver.
    pub fn change_options(&self, options: &mut SolverOptions) {
        match self {
            Self::SetRoot(root) => options.root = *root,
            Self::UseMethod(method) => options.method = *method,
            Self::AllowIterations(iterations) => options.iterations = Some(*iterations),
            _ => {}
        }
    }

    /// Applies the part of the remedy that concerns targets of chains.
    pub fn change_targets(&self, targets: &mut Vec<ChainTarget>) {
        let mut change = |joint: JointId, change: &dyn Fn(&mut ChainTarget)| {
            targets.iter_mut().filter(|target| target.joint == joint).for_each(change);
        };
        match self {
            Self::MoveTarget { joint, point } => change(*joint, &|target| target.point = *point),
            Self::SetWeight { joint, weight } => change(*joint, &|target| target.weight = *weight),
            Self::SwitchOff(joint) => targets.retain(|target| target.joint != *joint),
            Self::FreeTurn(joint) => change(*joint, &|target| target.orientation = None),
            Self::FreePlace(joint) => change(*joint, &|target| target.weight = 0.0),
            _ => {}
        }
    }
}

fn lengthen(skeleton: &mut Skeleton, joint: JointId, factor: f32) -> Result<(), SkeletonError> {
    let path: Vec<_> = skeleton.ancestors(joint).collect();
    for joint in &path {
        let bone = &skeleton[*joint];
        let (axis, offset) = (bone.axis * factor, bone.offset);
        let is_at_tip = bone.parent.is_some_and(|parent| offset == skeleton[parent].axis);
        let is_root = bone.parent.is_none();
        skeleton.set_axis(*joint, axis)?;
        // A joint at its parent's tip moves with the tip.
        if !is_root && !is_at_tip {
            skeleton.change(*joint, |joint| joint.offset = offset * factor)?;
        }
    }
    Ok(())
}

/// One of the three angles of a joint.
pub(crate) type Angle = (JointId, RotationAxis);

/// The angles of joints that have a limit; of a joint with a cone, all three.
pub(crate) fn limited_angles(
    skeleton: &Skeleton,
    joints: impl Iterator<Item = JointId>,
) -> Vec<Angle> {
    let limited = joints.flat_map(|joint| {
        let limits = skeleton[joint].limits;
        let has_cone = limits.as_cone().is_some();
        let is_limited = move |axis: &RotationAxis| has_cone || limits.range(*axis).is_some();
        RotationAxis::ALL.into_iter().filter(is_limited).map(move |axis| (joint, axis))
    });
    limited.collect()
}

/// True if the limits of an angle leave it one value.
pub(crate) fn is_fixed(skeleton: &Skeleton, (joint, axis): Angle) -> bool {
    skeleton[joint].limits.is_fixed(axis)
}

/// Removes the limits of some angles, and the cones of their joints.
pub(crate) fn remove_limits(skeleton: &mut Skeleton, angles: &[Angle]) {
    for (joint, axis) in angles {
        skeleton.write_local(*joint, |joint| joint.limits.set_range(*axis, None));
    }
}

/// The least widening, in whole degrees, of limits of `skeleton` that contains the angles of
/// `pose`; `None` if they contain these already.
pub(crate) fn widen_to_contain(
    skeleton: &Skeleton,
    pose: &Skeleton,
    angles: &[Angle],
) -> Option<Remedy> {
    let widened = angles.iter().filter_map(|(joint, axis)| {
        let (limits, rotation) = (skeleton[*joint].limits, pose[*joint].rotation);
        if let Some((cone, by)) = limits.widened_cone(rotation) {
            return Some(WidenedLimit { joint: *joint, to: WiderLimit::Cone(cone), by });
        }
        let limit = limits.range(*axis)?;
        let widened = limit.widened_to(rotation[axis.index()])?;
        let by = (limit.min - widened.min) + (widened.max - limit.max);
        let to = WiderLimit::Range { axis: *axis, limit: widened };
        Some(WidenedLimit { joint: *joint, to, by })
    });
    let mut widened: Vec<_> = widened.collect();
    // Once for each joint with a cone.
    widened.dedup();
    (!widened.is_empty()).then_some(Remedy::WidenLimits(widened))
}
