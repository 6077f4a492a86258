use std::sync::Arc;

use glam::Affine3A;

use crate::document::{SkeletonRig, Target};
use crate::io::Progress;
use crate::kinematics::Shared;
use crate::kinematics::skeleton::{JointId, Skeleton};
use crate::kinematics::skin::{SkinPose, SkinnedMesh, VertexWeights};
use crate::rig::{AttachedMesh, ReachRegion, ReachSearch};
use crate::session::outcome::{Consequence, Outcome};

/// The reach region of the selected joint's target. It is computed in the background while the
/// overlay is shown.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReachRegions {
    /// The last job that ended, with what it found.
    found: Option<(ReachJob, Option<ShownRegion>)>,
    running: Option<ReachJob>,
}

/// A search for the reach region of a target.
#[derive(Clone, Debug)]
pub struct ReachJob {
    /// The rig with the values that its channels have at the time.
    rig: Shared<SkeletonRig>,
    /// Index of the target.
    index: usize,
    /// In seconds.
    time: f64,
    progress: Arc<Progress>,
}

/// A reach region as a mesh in the world.
#[derive(Clone, Debug, PartialEq)]
pub struct ShownRegion {
    /// The surface.
    pub mesh: Shared<AttachedMesh>,
    /// The pose of its only joint, which rests.
    pub pose: Shared<SkinPose>,
}

/// Starts and ends searches for reach regions.
#[derive(Clone, Debug, PartialEq)]
pub enum ReachAction {
    /// A search has started; it replaces the one that runs.
    Started(ReachJob),
    /// A search has ended; without a region if it was cancelled or found none.
    Ended(ReachJob, Option<Box<ShownRegion>>),
}

impl ReachJob {
    /// A search for the region of the target with an index of a rig, at a time in seconds; the rig
    /// must have the target.
    #[must_use]
    pub fn new(rig: &SkeletonRig, index: usize, time: f64) -> Self {
        Self { rig: Shared::from(rig.clone()), index, time, progress: Arc::default() }
    }

    /// Searches and returns the action that ends the search.
    #[must_use]
    pub async fn run(self) -> ReachAction {
        /// Parts of the work after which the search can be cancelled.
        const PARTS: usize = 1000;
        let Some(mut search) = ReachSearch::new(&self.rig, self.index, self.time) else {
            return ReachAction::Ended(self, None);
        };
        while search.advance() {
            let done = (search.progress() * PARTS as f32) as usize;
            if self.progress.step(done, PARTS).await.is_err() {
                return ReachAction::Ended(self, None);
            }
        }
        let region = search.finish().and_then(|region| ShownRegion::new(&region));
        ReachAction::Ended(self, region.map(Box::new))
    }

    /// True if the job has the region of this target. The region does not depend on where the
    /// target is.
    fn is_of(&self, rig: &SkeletonRig, index: usize, time: f64) -> bool {
        let anywhere = |target: &Target| {
            let anywhere = target.with_home(Default::default());
            Target { influence: 1.0, enabled: true, ..anywhere }
        };
        let is_same = |(at, (one, other)): (usize, (&Target, &Target))| match at == index {
            true => anywhere(one) == anywhere(other),
            false => one == other,
        };
        let own = &self.rig;
        index == self.index
            && own.skeleton == rig.skeleton
            && own.targets.len() == rig.targets.len()
            && own.targets.iter().zip(&rig.targets).enumerate().all(is_same)
            && own.solver.root == rig.solver.root
            && own.body_follows == rig.body_follows
            && own.balance == rig.balance
            && own.follow_paths == rig.follow_paths
            && (self.time == time || !rig.is_moving())
    }
}

impl PartialEq for ReachJob {
    fn eq(&self, other: &Self) -> bool {
        self.is_of(&other.rig, other.index, other.time)
    }
}

impl ShownRegion {
    /// The mesh of a region; `None` if it cannot be drawn.
    pub fn new(region: &ReachRegion) -> Option<Self> {
        let skeleton = Skeleton::with_root("region");
        let surface = region.surface().clone();
        let weights = vec![VertexWeights::rigid(JointId::new(0)); surface.positions.len()];
        let mesh = SkinnedMesh::new(surface, weights, vec![Affine3A::IDENTITY]).ok()?;
        let pose = Shared::from(mesh.pose(&skeleton));
        let mesh = Shared::from(AttachedMesh::new(mesh, Vec::new(), &skeleton));
        Some(Self { mesh, pose })
    }
}

impl ReachRegions {
    /// The region of a target of a rig at a time in seconds; `None` if it is not known or if there is
    /// none.
    pub(super) fn found(&self, rig: &SkeletonRig, index: usize, time: f64) -> Option<&ShownRegion> {
        let (job, region) = self.found.as_ref()?;
        region.as_ref().filter(|_| job.is_of(rig, index, time))
    }

    /// True while the region of a target is searched for.
    pub(super) fn is_running(&self, rig: &SkeletonRig, index: usize, time: f64) -> bool {
        self.running.as_ref().is_some_and(|job| job.is_of(rig, index, time))
    }

    /// True if a search for the region of a target has ended.
    pub(super) fn is_known(&self, rig: &SkeletonRig, index: usize, time: f64) -> bool {
        self.found.as_ref().is_some_and(|(job, _)| job.is_of(rig, index, time))
    }

    pub(super) fn apply(&mut self, action: ReachAction) -> Outcome {
        match action {
            ReachAction::Started(job) => {
                if let Some(running) = self.running.replace(job) {
                    running.progress.cancel();
                }
            }
            ReachAction::Ended(job, region) => {
                if self.running.as_ref() == Some(&job) {
                    self.running = None;
                    self.found = Some((job, region.map(|region| *region)));
                }
                return Consequence::Refresh.into();
            }
        }
        Outcome::default()
    }
}
