use super::skeleton_rig::SkeletonRig;
use crate::diagnosis::{Diagnosis, Names, Remedy};
use crate::skeleton::JointId;

/// Diagnoses in words, with the names of the joints. A limb's target is named after its hand.
impl SkeletonRig {
    /// [`Diagnosis::sentence`] with the names of the rig.
    pub fn sentence(&self, found: &Diagnosis) -> String {
        self.with_names(|names| found.sentence(names))
    }

    /// [`Remedy::sentence`] with the names of the rig.
    pub fn remedy_sentence(&self, remedy: &Remedy) -> String {
        self.with_names(|names| remedy.sentence(names))
    }

    /// [`Remedy::done`] with the names of the rig.
    pub fn remedy_done(&self, remedy: &Remedy) -> String {
        self.with_names(|names| remedy.done(names))
    }

    /// The joint by which [`Self::sentence`] calls what does not reach its target; `None` if the rig has
    /// no such target.
    pub fn named_tip(&self, found: &Diagnosis) -> Option<JointId> {
        self.named(found.target)
    }

    fn with_names(&self, say: impl FnOnce(Names<'_>) -> String) -> String {
        let joint = |joint: JointId| {
            self.skeleton.joint(joint).map_or_else(String::new, |it| it.name.clone())
        };
        let tip = |of: JointId| joint(self.named(of).unwrap_or(of));
        say(Names { joint: &joint, tip: &tip })
    }

    /// The joint by which sentences call what the target of a joint moves: a limb's hand, or the joint.
    fn named(&self, target: JointId) -> Option<JointId> {
        self.target(target).map(|index| self.end_of(&self.targets[index]))
    }
}
