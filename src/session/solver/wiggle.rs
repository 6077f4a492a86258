use core::f64::consts::TAU;

use glam::Vec3;

use crate::kinematics::chain_ik::Swing;
use crate::kinematics::skeleton::{JointId, RotationAxis, SkeletonPose};
use crate::rig::{EvaluatedSkeleton, SkeletonRig, Target};

/// An angle that swings to and fro in the view, to show what the Jacobian is; the document does not
/// change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::session) struct Wiggle {
    joint: JointId,
    axis: RotationAxis,
    /// Seconds since it began.
    time: f64,
}

/// A wiggle as the view shows it, in the world.
#[derive(Clone, Debug, PartialEq)]
pub struct WiggleView {
    /// The turn.
    pub swing: Swing,
    /// The pose at this moment.
    pub pose: SkeletonPose,
    /// The path of the tip, from the end of the swing to its other end and a little beyond.
    pub path: Vec<Vec3>,
    /// The ends of the line along which the Jacobian moves the tip by the same angles.
    pub predicted: [Vec3; 2],
    /// The change of the angle at this moment, in radians.
    pub by: f32,
    /// The point that the tip should reach; `None` without a target.
    pub target: Option<WiggleTarget>,
}

/// The residual of a tip that swings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WiggleTarget {
    /// Position of the target.
    pub position: Vec3,
    /// Distance from the tip to the target before the turn.
    pub before: f32,
    /// Distance at this moment.
    pub now: f32,
    /// Distance that the Jacobian predicts for this moment.
    pub predicted: f32,
}

impl Wiggle {
    /// Greatest change of the angle, in radians, and seconds for a swing to and fro.
    pub const MOST: f32 = 5.0 * core::f32::consts::PI / 180.0;
    const PERIOD: f64 = 1.8;

    pub fn new(joint: JointId, axis: RotationAxis) -> Self {
        Self { joint, axis, time: 0.0 }
    }

    /// The angle: the joint and the axis.
    pub fn angle(self) -> (JointId, RotationAxis) {
        (self.joint, self.axis)
    }

    /// The wiggle on an evaluated rig, with the paths of the tip; `None` if the joint is missing.
    pub fn view(self, rig: &SkeletonRig, evaluated: &EvaluatedSkeleton) -> Option<WiggleView> {
        /// Number of points of the path, and its length as a multiple of the swing.
        const POINTS: usize = 33;
        const LONGER: f32 = 4.0;
        let skeleton = &*evaluated.solved;
        skeleton.joint(self.joint)?;
        let (tip, target) = wiggled_tip(rig, evaluated, self.joint);
        let swing = Swing { joint: self.joint, axis: self.axis, tip };
        let by = self.by();
        let most = LONGER * Self::MOST;
        let angle = |nth: usize| most * (2.0 * nth as f32 / (POINTS - 1) as f32 - 1.0);
        let path = (0..POINTS).map(|nth| swing.tip_at(skeleton, angle(nth))).collect();
        let target = target.map(|position| WiggleTarget {
            position,
            before: skeleton.tip(tip).distance(position),
            now: swing.tip_at(skeleton, by).distance(position),
            predicted: swing.predicted_at(skeleton, by).distance(position),
        });
        Some(WiggleView {
            swing,
            pose: swing.posed(skeleton, by).pose(),
            path,
            predicted: [-most, most].map(|by| swing.predicted_at(skeleton, by)),
            by,
            target,
        })
    }

    pub fn advance(&mut self, passed: f64) {
        self.time = (self.time + passed) % Self::PERIOD;
    }

    /// The present change of the angle, in radians.
    pub fn by(self) -> f32 {
        Self::MOST * (TAU * self.time / Self::PERIOD).sin() as f32
    }
}

/// The joint at or below `joint` whose tip is farthest from its target, with the target; without
/// targets there, the joint whose tip is farthest away.
fn wiggled_tip(
    rig: &SkeletonRig,
    evaluated: &EvaluatedSkeleton,
    joint: JointId,
) -> (JointId, Option<Vec3>) {
    let skeleton = &*evaluated.solved;
    let targets = rig.targets.iter().zip(&evaluated.targets);
    let is_below =
        |it: &Target| it.enabled && !it.has_free_place() && skeleton.is_in_subtree(it.joint, joint);
    let below = targets.filter(|(it, _)| is_below(it));
    let farthest = below.max_by(|(_, one), (_, other)| one.error.total_cmp(&other.error));
    if let Some((target, report)) = farthest {
        return (target.joint, Some(report.position));
    }
    let base = skeleton.base(joint);
    let below = skeleton.ids().filter(|it| skeleton.is_in_subtree(*it, joint));
    let distance = |it: &JointId| skeleton.tip(*it).distance(base);
    let farthest = below.max_by(|one, other| distance(one).total_cmp(&distance(other)));
    (farthest.unwrap_or(joint), None)
}
