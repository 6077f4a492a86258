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

    fn with_names(&self, say: impl FnOnce(Names<'_>) -> String) -> String {
        let joint = |joint: JointId| {
            self.skeleton.joint(joint).map_or_else(String::new, |it| it.name.clone())
        };
        let tip = |of: JointId| {
            let target = self.target(of).map(|index| self.end_of(&self.targets[index]));
            joint(target.unwrap_or(of))
        };
        say(Names { joint: &joint, tip: &tip })
    }
}
