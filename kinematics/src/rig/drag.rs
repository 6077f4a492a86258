use glam::Vec3;

use super::balance_target::Footing;
use super::evaluate::EvaluatedSkeleton;
use super::skeleton_rig::SkeletonRig;
use super::target::{Target, TargetKind};
use crate::chain_ik::{ChainTarget, DragReport, NullSpaceDrag, Root, SolveError};
use crate::skeleton::{Joint, JointId, RotationAxis, Skeleton};

/// Drags of points of bodies.
impl SkeletonRig {
    /// A drag of a point of a joint from a pose that this rig has at a time in seconds. All that
    /// targets hold stays: whole-body targets of full influence, where they are reached or as far
    /// from it as they are, so those of chains, and with [`SkeletonRig::body_follows`] the hands
    /// and feet of limb targets. The limbs themselves do not turn; solve them again for the dragged
    /// pose. Where limbs could not follow, because of the limits of their joints, the point stays
    /// nearer to where it was.
    ///
    /// # Errors
    ///
    /// See [`SolveError`].
    pub fn drag(
        &self,
        evaluated: &EvaluatedSkeleton,
        time: f64,
        dragged: ChainTarget,
    ) -> Result<(NullSpaceDrag, DragReport), SolveError> {
        const HALVINGS: u32 = 6;
        let whole = self.dragged_to(evaluated, time, dragged)?;
        if !self.loses_limbs(evaluated, time, &whole.0) {
            return Ok(whole);
        }
        let from = dragged.effector_in(&evaluated.solved);
        let to = |part: f32| ChainTarget { point: from.lerp(dragged.point, part), ..dragged };
        let (mut least, mut most) = (0.0, 1.0);
        let mut farthest = self.dragged_to(evaluated, time, to(least))?;
        for _ in 0..HALVINGS {
            let middle = 0.5 * (least + most);
            let drag = self.dragged_to(evaluated, time, to(middle))?;
            if self.loses_limbs(evaluated, time, &drag.0) {
                most = middle;
            } else {
                (least, farthest) = (middle, drag);
            }
        }
        let mut posed = Skeleton::clone(&evaluated.solved);
        farthest.0.write(&mut posed);
        farthest.1.distance = dragged.effector_in(&posed).distance(dragged.point);
        Ok(farthest)
    }

    /// True if limbs miss their targets by more than before after a drag.
    fn loses_limbs(&self, evaluated: &EvaluatedSkeleton, time: f64, drag: &NullSpaceDrag) -> bool {
        let mut posed = Skeleton::clone(&evaluated.solved);
        drag.write(&mut posed);
        let posed = self.with_limbs(posed, time);
        let mut limbs = self.targets.iter().zip(&evaluated.targets);
        limbs.any(|(target, before)| {
            let is_held =
                self.is_solved_for(target) && target.influence >= 1.0 && self.pulls_body(target);
            let error = posed.tip(target.joint).distance(target.in_world(&posed, time));
            is_held && error > before.error + self.tolerance()
        })
    }

    /// A drag to a place, whatever becomes of limbs.
    fn dragged_to(
        &self,
        evaluated: &EvaluatedSkeleton,
        time: f64,
        dragged: ChainTarget,
    ) -> Result<(NullSpaceDrag, DragReport), SolveError> {
        let mut pose = Skeleton::clone(&evaluated.solved);
        for joint in self.limb_joints_of_targets() {
            pose.write_local(joint, |joint| joint.locked = true);
        }
        let footing = self.footing(&evaluated.solved);
        let mut held = self.held_targets(evaluated, time);
        let is_root = pose.joint(dragged.joint).is_some_and(|joint| joint.parent.is_none());
        let balance = self.held_balance(evaluated, &footing);
        // A body that nothing holds would be carried away.
        let is_held = self.holds_body() || balance.is_some();
        let root = match self.solver.root {
            Root::Free if !is_held && !is_root => Root::Turns,
            root => root,
        };
        held.extend(balance);
        let mut drag = NullSpaceDrag::with_limbs(&pose, &held, &footing.limbs, dragged, root)?;
        let report = drag.run();
        Ok((drag, report))
    }

    /// True if a drag of a point of a joint can turn the joint or one above it, or move the root.
    pub fn can_drag(&self, joint: JointId) -> bool {
        let turns = |joint: &Joint| {
            let is_movable = RotationAxis::ALL.into_iter().any(|axis| !joint.limits.is_fixed(axis));
            match (joint.parent, self.solver.root) {
                (None, Root::Locked) => false,
                (None, Root::Free) => true,
                _ => !joint.locked && is_movable,
            }
        };
        let of_limbs: Vec<JointId> = self.limb_joints_of_targets().collect();
        let mut above = self.skeleton.ancestors(joint);
        above.any(|joint| !of_limbs.contains(&joint) && turns(&self.skeleton[joint]))
    }

    /// True if targets of full influence hold the body: whole-body targets, or limb targets that it
    /// follows.
    pub fn holds_body(&self) -> bool {
        let mut full = self.full_targets();
        full.any(|it| it.kind == TargetKind::WholeBody || self.pulls_body(it))
    }

    /// True if a target of full influence turns a joint of the whole body or of a chain.
    pub fn is_turned_by_body_target(&self, joint: JointId) -> bool {
        let mut targets = self.full_targets().filter(|it| it.limb().is_none());
        targets.any(|target| self.moved_by(target).turned.contains(&joint))
    }

    fn full_targets(&self) -> impl Iterator<Item = &Target> {
        self.targets.iter().filter(|it| self.is_solved_for(it) && it.influence >= 1.0)
    }

    /// The joints that limb targets of full influence turn.
    fn limb_joints_of_targets(&self) -> impl Iterator<Item = JointId> {
        let limbs = self.full_targets().filter(|target| target.limb().is_some());
        limbs.flat_map(|target| self.moved_by(target).turned)
    }

    /// The place above which a balance of full influence holds the centre of mass: that which it asks
    /// for, or where the centre is if it is not there.
    fn held_balance(
        &self,
        evaluated: &EvaluatedSkeleton,
        footing: &Footing,
    ) -> Option<ChainTarget> {
        let balance = self.body_target_of_balance(footing).filter(|it| it.influence >= 1.0)?;
        let report = evaluated.balance.as_ref()?;
        let place = match report.error() > self.tolerance() {
            true => Vec3::new(report.centre.x, 0.0, report.centre.y),
            false => balance.tip.point,
        };
        Some(ChainTarget { point: place, ..balance.tip })
    }

    /// The places and orientations that targets of full influence hold in a pose.
    fn held_targets(&self, evaluated: &EvaluatedSkeleton, time: f64) -> Vec<ChainTarget> {
        let EvaluatedSkeleton { fk, solved, targets, .. } = evaluated;
        let full = |target: &Target| self.is_solved_for(target) && target.influence >= 1.0;
        let mut held = Vec::new();
        for (target, report) in self.targets.iter().zip(targets).filter(|(it, _)| full(it)) {
            if target.limb().is_none() {
                let mut of_target = self.tip_target(target, fk, time);
                if report.error > self.tolerance() {
                    of_target.point = solved.tip(target.joint);
                }
                if report.misses_rotation() {
                    of_target.orientation = None;
                }
                if of_target.weight > 0.0 || of_target.orientation.is_some() {
                    held.push(of_target);
                }
            } else if let Some(mut base) = self.base_target(target, fk, time) {
                // A base from which the limb does not reach its target goes no farther away.
                let at = base.effector_in(solved);
                let scale = solved.transform().matrix3.determinant().abs().cbrt();
                let [least, most] = base.distances;
                let present = at.distance(base.point) / scale;
                base.distances = [least.min(present), most.max(present)];
                held.push(base);
            }
        }
        held
    }
}
