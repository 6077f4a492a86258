use glam::Vec3;

use super::solve_inputs::SolveInputs;
use crate::chain_ik::{Root, TipTarget};
use crate::diagnosis::{Boundary, Cause, Remedy};
use crate::skeleton::{JointId, Skeleton};

/// Distances that the tip of a chain can have from the base of its root, whatever the joints turn, in
/// skeleton space.
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
    target: TipTarget,
}

impl ChainReach {
    fn new(skeleton: &Skeleton, target: &TipTarget) -> Self {
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
    pub fn of(inputs: &SolveInputs, target: &TipTarget, tolerance: f32) -> Option<Self> {
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

    /// What could bring the tip to the target.
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
