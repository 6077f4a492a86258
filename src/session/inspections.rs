use std::sync::Arc;

use crate::document::{Document, Inspection, Track};
use crate::io::Progress;
use crate::kinematics::Shared;
use crate::session::history::editing::Editing;
use crate::session::outcome::{Consequence, Outcome};

/// Inspections of the skeleton's motion: pops, lost targets and slides. Each runs in the background.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Inspections {
    /// The findings of the latest inspection, with the revision of the document.
    found: Option<(u64, Shared<Inspection>)>,
    running: Option<InspectionJob>,
}

/// An inspection of a revision of the document.
#[derive(Clone, Debug)]
pub struct InspectionJob {
    revision: u64,
    track: Track,
    progress: Arc<Progress>,
}

/// Starts and ends inspections. From the first one on, the session shows provisional poses of
/// motions that take long to compute, until an inspection has computed them.
#[derive(Clone, Debug, PartialEq)]
pub enum InspectAction {
    /// An inspection has started; it replaces the one that runs.
    Started(InspectionJob),
    /// An inspection has ended; without a result if it was cancelled.
    Ended(InspectionJob, Option<Box<Inspection>>),
}

impl InspectionJob {
    /// An inspection of the present document.
    #[must_use]
    pub fn new(editing: &Editing) -> Self {
        let (revision, track) = (editing.revision(), editing.track().clone());
        Self { revision, track, progress: Arc::default() }
    }

    /// Inspects the motion and returns the action that ends the inspection.
    #[must_use]
    pub async fn run(self) -> InspectAction {
        let frames = self.track.document().timeline;
        let total = frames.frames();
        let go_on = async |done| self.progress.step(done, total).await.is_ok();
        let mut found = Inspection::new(&self.track, frames, false, go_on).await;
        if let Some(found) = &mut found {
            found.find_better_posture(&self.track, frames, go_on).await;
        }
        InspectAction::Ended(self, found.map(Box::new))
    }
}

impl PartialEq for InspectionJob {
    /// Compares revisions, of which the results are a function.
    fn eq(&self, other: &Self) -> bool {
        self.revision == other.revision
    }
}

impl Inspections {
    /// The findings in the motion of the present document; `None` while that is not known, or if
    /// nothing moves.
    pub(super) fn found(&self, editing: &Editing) -> Option<&Inspection> {
        let (revision, found) = self.found.as_ref()?;
        (*revision == editing.revision()).then_some(found)
    }

    /// The inspection that should run now; `None` if there is nothing new to inspect, or while an
    /// edit goes on.
    pub(super) fn next(&self, editing: &Editing) -> Option<InspectionJob> {
        let revision = editing.revision();
        let is_known = self.found.as_ref().is_some_and(|(known, _)| *known == revision);
        let is_running = self.running.as_ref().is_some_and(|job| job.revision == revision);
        let can_start = !is_known && !is_running && !editing.is_editing();
        (can_start && is_worth(editing.document())).then(|| InspectionJob::new(editing))
    }

    pub(super) fn apply(&mut self, action: InspectAction) -> Outcome {
        match action {
            InspectAction::Started(job) => {
                if let Some(running) = self.running.replace(job) {
                    running.progress.cancel();
                }
            }
            InspectAction::Ended(job, found) => {
                if self.running.as_ref() == Some(&job) {
                    self.running = None;
                }
                if let Some(found) = found {
                    self.found = Some((job.revision, Shared::from(*found)));
                }
                // The inspection has computed the states of the motion that the session shares.
                return Consequence::Refresh.into();
            }
        }
        Outcome::default()
    }
}

/// True if targets move the rig of a document.
fn is_worth(document: &Document) -> bool {
    document.is_posed_over_time()
}
