use super::session::Session;
use crate::document::RigKind;
use crate::kinematics::diagnosis::{Diagnosis, Remedy};
use crate::kinematics::skeleton::JointId;
use crate::rig::SkeletonRig;
use crate::words::{self, significant};

/// Why targets are not reached.
impl Session {
    /// The causes for which the target of the selected joint is not reached, the most likely first;
    /// without such a target, those of the posing target that is farthest from its tip. Empty if all
    /// are reached, while something is dragged or plays, and for other rigs than skeletons.
    pub fn why(&self) -> &[Diagnosis] {
        let index = self.examined_target();
        index.map_or(&[], |index| self.why_target(index))
    }

    /// [`Session::why`] without finding it out: empty if it was not called since the last change.
    pub fn known_why(&self) -> &[Diagnosis] {
        if !self.evaluated.knows_why() {
            return &[];
        }
        self.examined_target().map_or(&[], |index| self.known_why_target(index))
    }

    /// The causes for which the target with this index in
    /// [`SkeletonRig::targets`](crate::rig::SkeletonRig::targets) is not reached.
    pub fn why_target(&self, index: usize) -> &[Diagnosis] {
        let rig = self.skeleton_rig();
        if !self.can_examine() || index >= rig.targets.len() {
            return &[];
        }
        let targets = rig.targets.len();
        self.evaluated.why(index, targets, || rig.diagnose_targets(&[index], self.time()))
    }

    /// [`Session::why_target`] without finding it out.
    pub fn known_why_target(&self, index: usize) -> &[Diagnosis] {
        if self.can_examine() { self.evaluated.known_why(index) } else { &[] }
    }

    fn can_examine(&self) -> bool {
        let is_moving = self.is_editing() || self.is_playing();
        let is_on_path = self.skeleton_rig().is_on_path(self.time());
        self.rig() == RigKind::Skeleton && !is_moving && !is_on_path
    }

    /// The selected joint's target if it is not reached, or else the posing one farthest from its
    /// tip; if all tips are at their targets, the one whose hand misses most of its rotation.
    fn examined_target(&self) -> Option<usize> {
        let rig = self.skeleton_rig();
        let is_missed = |index: &usize| {
            let report = self.evaluated_skeleton().targets.get(*index);
            report.is_some_and(|report| !rig.is_reached(report))
        };
        let selected = self.selected().and_then(|joint| rig.target_of_end(joint));
        let selected = selected.filter(|index| rig.targets[*index].enabled).filter(is_missed);
        let errors = rig.targets.iter().zip(&self.evaluated_skeleton().targets).enumerate();
        let posing = errors.filter(|(_, (target, _))| rig.is_solved_for(target));
        let missed = posing.filter(|(_, (_, report))| !rig.is_reached(report));
        let most = missed.max_by(|(_, (_, one)), (_, (_, other))| {
            let [one, other] = [one, other].map(|report| {
                let distance = if report.error > rig.tolerance() { report.error } else { 0.0 };
                (distance, report.rotation_error.unwrap_or_default())
            });
            one.0.total_cmp(&other.0).then(one.1.total_cmp(&other.1))
        });
        selected.or(most.map(|(index, _)| index))
    }

    /// Applies a remedy for a target that is not reached, and says what it did.
    pub(super) fn apply_remedy(&mut self, target: JointId, remedy: &Remedy) {
        let time = self.time();
        let edited =
            self.edit_document(|document| document.skeleton_rig.apply_remedy(remedy, time));
        if edited.is_none() {
            return;
        }
        let rig = self.skeleton_rig();
        let done = words::remedy_done(rig, remedy);
        let result = match rig.target(target).filter(|index| rig.targets[*index].enabled) {
            Some(index) => self.describe_result(rig, index),
            None => String::new(),
        };
        self.say(format!("{done}{result}"));
    }

    fn describe_result(&self, rig: &SkeletonRig, index: usize) -> String {
        let Some(report) = self.evaluated_skeleton().targets.get(index) else {
            return String::new();
        };
        let name = &rig.skeleton[rig.end_of(&rig.targets[index])].name;
        let missing = significant(report.rotation_error.unwrap_or_default().to_degrees());
        if rig.is_reached(report) {
            format!(": {name} is at its target now")
        } else if report.error > rig.tolerance() {
            format!(": {name} is {} from its target now", significant(report.error))
        } else {
            format!(": {name} is {missing}° short of its target's rotation now")
        }
    }
}
