use glam::Vec3;

use super::solve_inputs::SolveInputs;
use crate::chain_ik::{TipTarget, jacobian};
use crate::skeleton::{Joint, JointId, RotationAxis, Skeleton};

/// The moment about one angle of a joint with which a target pulls at a tip, as a fraction of the
/// longest lever arm times the residual.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pull {
    pub joint: JointId,
    pub axis: RotationAxis,
    /// Positive if the target pulls towards greater angles.
    pub moment: f32,
}

/// Moments below this fraction do not count.
const LEAST: f32 = 1e-3;

/// The moments of a target about all angles between a root and a tip in a pose.
#[derive(Default)]
pub(super) struct Pulls {
    all: Vec<Pull>,
    /// Speed of the tip towards the target, as a fraction of its greatest speed in any direction.
    pub mobility: f32,
}

impl Pulls {
    pub fn new(pose: &Skeleton, target: &TipTarget) -> Self {
        let to_skeleton = pose.transform().inverse();
        let residual = to_skeleton.transform_vector3(target.point - pose.tip(target.joint));
        let direction = residual.try_normalize().unwrap_or(Vec3::ZERO);
        let columns = jacobian(pose, target.joint);
        let longest = columns.iter().flatten().map(|column| column.length()).fold(0.0, f32::max);
        let all = pose.ancestors(target.joint).flat_map(|joint| {
            RotationAxis::ALL.into_iter().zip(columns[joint.index()]).map(move |(axis, column)| {
                Pull { joint, axis, moment: column.dot(direction) / longest.max(f32::MIN_POSITIVE) }
            })
        });
        let mut all: Vec<Pull> = all.collect();
        let free = |pull: &&Pull| !pose[pull.joint].locked;
        let speed = |towards: Vec3| {
            let columns =
                all.iter().filter(free).map(|it| columns[it.joint.index()][it.axis.index()]);
            columns.map(|column| column.dot(towards).powi(2)).sum::<f32>().sqrt()
        };
        let greatest = [Vec3::X, Vec3::Y, Vec3::Z].map(speed).into_iter().fold(0.0, f32::max);
        let mobility = if greatest > 0.0 { speed(direction) / greatest } else { 0.0 };
        all.sort_by(|one, other| other.strength().total_cmp(&one.strength()));
        Self { all, mobility }
    }

    /// Pulls that push limited angles outwards of joints that may turn, the strongest first.
    pub fn against_limits<'a>(&'a self, pose: &'a Skeleton) -> impl Iterator<Item = Pull> + 'a {
        self.all.iter().copied().filter(|pull| {
            let joint = &pose[pull.joint];
            pull.strength() > 0.0 && !joint.locked && pull.is_outward(joint)
        })
    }

    /// Joints between the root and the tip, the most strongly pulled first; those that are not pulled,
    /// as in a straight chain, from the tip to the root.
    pub fn joints(&self) -> Vec<JointId> {
        let mut joints = Vec::new();
        for Pull { joint, .. } in &self.all {
            if !joints.contains(joint) {
                joints.push(*joint);
            }
        }
        joints
    }
}

impl Pull {
    /// The moment's size, or 0 if it does not count.
    fn strength(&self) -> f32 {
        let size = self.moment.abs();
        if size > LEAST { size } else { 0.0 }
    }

    /// True if a limit of the joint is in the way.
    fn is_outward(&self, joint: &Joint) -> bool {
        // Angles this near to a limit are at it.
        const AT: f32 = 1e-4;
        joint.limits.stops(joint.rotation, self.axis, self.moment, AT)
    }
}

/// The other target that pulls most against a target: with the most opposite moments about the
/// joints that both turn.
pub(super) fn opponent(inputs: &SolveInputs, pose: &Skeleton, joint: JointId) -> Option<JointId> {
    let moments = |target: &TipTarget| -> Vec<Vec3> {
        let to_skeleton = pose.transform().inverse();
        let force =
            to_skeleton.transform_vector3(target.point - pose.tip(target.joint)) * target.weight;
        let columns = jacobian(pose, target.joint);
        let moment =
            |columns: &[Vec3; 3]| Vec3::from_array(columns.map(|column| column.dot(force)));
        columns.iter().map(moment).collect()
    };
    let own = moments(inputs.target_of(joint)?);
    let agreement = |target: &TipTarget| -> f32 {
        own.iter().zip(moments(target)).map(|(own, other)| own.dot(other)).sum()
    };
    let others = inputs.targets.iter().filter(|target| target.joint != joint);
    let opposed = others.map(|target| (target.joint, agreement(target)));
    opposed.min_by(|(_, one), (_, other)| one.total_cmp(other)).map(|(joint, _)| joint)
}
