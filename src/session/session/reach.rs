use super::Session;
use crate::document::Overlay;
use crate::session::reach_regions::{ReachJob, ShownRegion};

/// The reach region of the selected target.
impl Session {
    /// The reach region of the selected joint's target. `None` if the overlay is hidden, while the
    /// region is not known, and for a target that is reached everywhere or nowhere.
    pub fn reach_region(&self) -> Option<&ShownRegion> {
        let index = self.target_with_region()?;
        self.reach_regions.found(&self.shown().rig, index, self.playback().time())
    }

    /// True while the reach region of the selected target is searched for.
    pub fn is_finding_reach_region(&self) -> bool {
        let (rig, time) = (&self.shown().rig, self.playback().time());
        let index = self.target_with_region();
        index.is_some_and(|index| self.reach_regions.is_running(rig, index, time))
    }

    /// The search for a reach region that should run now, on a thread of its own: see
    /// [`ReachAction`](crate::session::ReachAction). `None` if the region is known or not shown, and
    /// during drags and playback.
    pub fn next_reach_region(&self) -> Option<ReachJob> {
        let index = self.target_with_region()?;
        if self.history().is_editing() || self.playback().is_playing() {
            return None;
        }
        let (rig, time) = (&self.shown().rig, self.playback().time());
        let regions = &self.reach_regions;
        let is_found = regions.is_known(rig, index, time) || regions.is_running(rig, index, time);
        (!is_found).then(|| ReachJob::new(rig, index, time))
    }

    /// Index of the selected joint's target if its region is shown.
    fn target_with_region(&self) -> Option<usize> {
        let rig = &self.shown().rig;
        let selected = || {
            let joint = self.selection().active()?;
            rig.target_of_end(joint).or_else(|| rig.limb_target_of(joint))
        };
        let index = match rig.sole_limb() {
            Some(target) => rig.target(target.joint),
            None => selected(),
        };
        let is_shown = self.shown().display.shows(Overlay::ReachRegion);
        index.filter(|index| is_shown && !rig.targets[*index].has_free_place())
    }
}
