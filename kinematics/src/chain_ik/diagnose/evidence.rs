use glam::Vec3;

use crate::chain_ik::{
    ChainSolver, ChainTarget, Report, Root, SolveError, SolverOptions, jacobian_of_point,
};
use crate::diagnosis::{Boundary, Cause, Remedy};
use crate::skeleton::{Joint, JointId, RotationAxis, Skeleton};

/// A skeleton in its FK pose, the targets of its tips, and how they are solved for.
#[derive(Clone)]
pub(super) struct SolveInputs {
    pub skeleton: Skeleton,
    pub targets: Vec<ChainTarget>,
    pub options: SolverOptions,
}

/// The pose that a solve comes to.
pub(super) struct SettledPose {
    pub skeleton: Skeleton,
    pub report: Report,
    pub tolerance: f32,
    /// Work of the solve, in the units of [`ChainSolver::bounded`].
    pub work: u64,
}

impl SolveInputs {
    pub fn solve(&self) -> Result<SettledPose, SolveError> {
        let Self { skeleton, targets, options } = self;
        let most = ChainSolver::POSE_WORK;
        let mut solver = ChainSolver::bounded(skeleton, targets, options, most)?;
        let report = solver.run();
        let mut skeleton = self.skeleton.clone();
        solver.write(&mut skeleton);
        Ok(SettledPose { skeleton, report, tolerance: solver.tolerance(), work: solver.work() })
    }

    /// These inputs after a remedy; `None` if it cannot be applied.
    pub fn with(&self, remedy: &Remedy) -> Option<Self> {
        let mut changed = self.clone();
        remedy.change_skeleton(&mut changed.skeleton).ok()?;
        remedy.change_options(&mut changed.options);
        remedy.change_targets(&mut changed.targets);
        Some(changed)
    }

    /// Distance in the world from a joint's tip to its target, after a solve; infinite if the
    /// inputs cannot be solved.
    pub fn residual_of(&self, joint: JointId) -> f32 {
        self.solve().map_or(f32::INFINITY, |solved| solved.residual(self, joint))
    }

    pub fn target_of(&self, joint: JointId) -> Option<&ChainTarget> {
        self.targets.iter().find(|target| target.joint == joint)
    }
}

impl SettledPose {
    /// Distance in the world from a joint's tip to its target; 0 without a target.
    pub fn residual(&self, inputs: &SolveInputs, joint: JointId) -> f32 {
        inputs.target_of(joint).map_or(0.0, |target| target.distance_in(&self.skeleton))
    }
}

/// Distances that the tip of a chain can have from the base of its root, whatever the joints turn,
/// in skeleton space.
struct ChainReach {
    root: JointId,
    base: Vec3,
    shortest: f32,
    longest: f32,
}

/// A target that the bones do not reach.
pub(super) struct OutOfReach {
    pub cause: Cause,
    /// The nearest point that they do reach, in the world.
    point: Vec3,
    /// Factor of the lengths with which they reach the target; `None` if longer bones do not help.
    factor: Option<f32>,
    target: ChainTarget,
}

impl ChainReach {
    fn new(skeleton: &Skeleton, target: &ChainTarget) -> Self {
        let path = || skeleton.ancestors(target.joint);
        let inner = path().filter(|joint| skeleton[*joint].parent.is_some());
        let segments = inner.map(|joint| skeleton[joint].offset.length());
        let segments = segments.chain([skeleton[target.joint].axis.length()]);
        let (longest, greatest) =
            segments.fold((0.0, 0.0_f32), |(sum, most), it| (sum + it, most.max(it)));
        let root = path().last().unwrap_or(target.joint);
        let base = skeleton[root].offset;
        Self { root, base, shortest: (2.0 * greatest - longest).max(0.0), longest }
    }
}

impl OutOfReach {
    /// `None` if the bones reach the target, or come within `tolerance` (in the world) of it.
    pub fn of(inputs: &SolveInputs, target: &ChainTarget, tolerance: f32) -> Option<Self> {
        // Part of the reach by which a moved target is inside of it, where solvers are fast.
        const INSIDE: f32 = 2e-3;
        if inputs.options.root == Root::Free {
            return None;
        }
        let skeleton = &inputs.skeleton;
        let reach = ChainReach::new(skeleton, target);
        let transform = skeleton.transform();
        let scale = transform.matrix3.determinant().abs().cbrt();
        let at = transform.inverse().transform_point3(target.point);
        let (towards, distance) = (at - reach.base, at.distance(reach.base));
        let bounds = [reach.shortest, reach.longest.max(reach.shortest)];
        let nearest = distance.clamp(bounds[0], bounds[1]);
        let inside = nearest + INSIDE * (0.5 * (bounds[0] + bounds[1]) - nearest);
        let direction = towards.try_normalize().unwrap_or(Vec3::X);
        let in_world =
            |distance: f32| transform.transform_point3(reach.base + direction * distance);
        let missing = in_world(nearest).distance(target.point);
        if missing.is_nan() || missing <= tolerance {
            return None;
        }
        let is_far = distance > reach.longest;
        let factor = (is_far && reach.longest > 0.0).then(|| distance / reach.longest);
        let cause = Cause::OutOfReach {
            base: reach.root,
            distance: distance * scale,
            shortest: reach.shortest * scale,
            longest: reach.longest * scale,
            boundary: Boundary::Bones,
        };
        Some(Self { cause, point: in_world(inside), factor, target: *target })
    }

    /// Remedies that could bring the tip to the target.
    pub fn remedies(&self) -> impl Iterator<Item = Remedy> {
        // Longer than needed: solvers are slow where the chain is straight.
        const LONGER: f32 = 1.01;
        let joint = self.target.joint;
        let factor = self.factor.map(|factor| factor * LONGER);
        [
            Some(Remedy::MoveTarget { joint, point: self.point }),
            factor.map(|factor| Remedy::Lengthen { joint, factor }),
            Some(Remedy::SetRoot(Root::Free)),
        ]
        .into_iter()
        .flatten()
    }
}

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
    pub fn new(pose: &Skeleton, target: &ChainTarget) -> Self {
        let direction = target.residual_in(pose).try_normalize().unwrap_or(Vec3::ZERO);
        let columns = jacobian_of_point(pose, target.joint, target.grip_in(pose));
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

    /// Joints between the root and the tip, the most strongly pulled first; those that are not
    /// pulled, as in a straight chain, from the tip to the root.
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
    let moments = |target: &ChainTarget| -> Vec<Vec3> {
        let force = target.residual_in(pose) * target.weight;
        let columns = jacobian_of_point(pose, target.joint, target.grip_in(pose));
        let moment =
            |columns: &[Vec3; 3]| Vec3::from_array(columns.map(|column| column.dot(force)));
        columns.iter().map(moment).collect()
    };
    let own = moments(inputs.target_of(joint)?);
    let agreement = |target: &ChainTarget| -> f32 {
        own.iter().zip(moments(target)).map(|(own, other)| own.dot(other)).sum()
    };
    let others = inputs.targets.iter().filter(|target| target.joint != joint);
    let opposed = others.map(|target| (target.joint, agreement(target)));
    opposed.min_by(|(_, one), (_, other)| one.total_cmp(other)).map(|(joint, _)| joint)
}
