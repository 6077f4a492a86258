//! Targets of chains: they turn a number of joints from their own joint upwards, after the body, such
//! as a look-at target neck and head.

use super::skeleton_rig::SkeletonRig;
use super::target::Target;
use crate::chain_ik::{Root, SolverOptions};
use crate::skeleton::{Joint, JointId, Skeleton};

impl SkeletonRig {
    /// Targets of chains and limbs, in the order in which they are solved. Chains that have joints in
    /// common are one group, which is solved when its last member is due.
    pub(super) fn solved_together(&self, order: Vec<usize>) -> Vec<Vec<usize>> {
        let is_chain = |index: &usize| self.targets[*index].kind.is_chain();
        if !order.iter().any(is_chain) {
            return order.into_iter().map(|index| vec![index]).collect();
        }
        let groups = self.groups_of_chains(order.iter().copied().filter(is_chain));
        let together = |index: usize| match groups.iter().find(|group| group.contains(&index)) {
            Some(group) => (group.last() == Some(&index)).then(|| group.clone()),
            None => Some(vec![index]),
        };
        order.into_iter().filter_map(together).collect()
    }

    /// The targets of chains that are solved together with one, itself among them.
    pub(super) fn chains_with(&self, index: usize) -> Vec<usize> {
        let is_chain = |index: &usize| {
            let target = &self.targets[*index];
            target.kind.is_chain() && self.is_solved_for(target)
        };
        let groups = self.groups_of_chains((0..self.targets.len()).filter(is_chain));
        groups.into_iter().find(|group| group.contains(&index)).unwrap_or_default()
    }

    /// Targets of chains in groups that have no joint in common.
    fn groups_of_chains(&self, chains: impl Iterator<Item = usize>) -> Vec<Vec<usize>> {
        let mut groups: Vec<Vec<usize>> = Vec::new();
        for index in chains {
            let turned = self.moved_by(&self.targets[index]).turned;
            let shares = |group: &Vec<usize>| {
                self.turned_together(group).iter().any(|joint| turned.contains(joint))
            };
            let (mut shared, apart): (Vec<_>, Vec<_>) = groups.into_iter().partition(shares);
            shared.push(vec![index]);
            groups = apart;
            groups.push(shared.concat());
        }
        groups
    }

    /// The joints that targets of chains turn.
    pub(super) fn turned_together(&self, together: &[usize]) -> Vec<JointId> {
        together.iter().flat_map(|index| self.moved_by(&self.targets[*index]).turned).collect()
    }

    /// Length in the world from the base of the uppermost joint that a target turns, or from the root
    /// for a target of the whole body, to the tip of the target's joint.
    pub(super) fn length_of_chain(&self, target: &Target) -> f32 {
        let whole = self.length_to(target.joint);
        let above = target.top_of_chain(&self.skeleton).and_then(|top| {
            let Joint { parent, offset, .. } = self.skeleton[top];
            let to_parent =
                self.length_to(parent?) - self.scale() * self.skeleton[parent?].axis.length();
            Some(to_parent + self.scale() * offset.length())
        });
        whole - above.unwrap_or(0.0)
    }

    /// Options of the solver for chains: their roots do not move.
    pub(super) fn chain_options(&self) -> SolverOptions {
        let root = match self.solver.root {
            Root::Free => Root::Turns,
            root => root,
        };
        SolverOptions { root, ..self.solver }
    }
}

/// A pose in which only these joints can be turned.
pub(super) fn with_others_locked(pose: &Skeleton, turned: &[JointId]) -> Skeleton {
    let mut locked = pose.clone();
    for joint in pose.ids().filter(|joint| !turned.contains(joint)) {
        locked.write_local(joint, |joint| joint.locked = true);
    }
    locked
}
