use super::target::{Target, TargetKind};
use super::target_space::TargetSpace;
use crate::chain_ik::Root;
use crate::limb_ik::Limb;
use crate::skeleton::{JointId, Skeleton};

/// The joints that a target turns.
pub(super) struct MovedJoints {
    pub turned: Vec<JointId>,
    /// The upper joint of a limb.
    upper: Option<JointId>,
}

impl MovedJoints {
    /// The joints that `target` turns if it poses a skeleton whose solver has this mode of roots.
    pub fn new(skeleton: &Skeleton, root: Root, target: &Target) -> Self {
        let is_free = root == Root::Free;
        let can_turn = |joint: &JointId| {
            let joint = &skeleton[*joint];
            !joint.locked || (is_free && joint.parent.is_none())
        };
        match target.kind {
            TargetKind::WholeBody => Self {
                turned: skeleton.ancestors(target.joint).filter(can_turn).collect(),
                upper: None,
            },
            TargetKind::Limb(_) => match Limb::ending_at(skeleton, target.joint) {
                Ok(limb) => Self { turned: limb.joints().collect(), upper: Some(limb.upper) },
                Err(_) => Self { turned: Vec::new(), upper: None },
            },
        }
    }

    /// Whether the target moves `joint`: turns it or a joint above it.
    pub fn moves(&self, skeleton: &Skeleton, joint: JointId) -> bool {
        skeleton.ancestors(joint).any(|above| self.turned.contains(&above))
    }

    /// Whether `target`, which moves these joints, must be solved after a target that moves the joints
    /// of `other`: because it is on one of them, or because its limb is attached to one.
    pub fn depends_on(&self, skeleton: &Skeleton, target: &Target, other: &Self) -> bool {
        let base = self.upper.and_then(|upper| skeleton[upper].parent);
        let spaces = target.spaces().filter_map(TargetSpace::joint);
        spaces.chain(base).any(|joint| other.moves(skeleton, joint))
    }
}
