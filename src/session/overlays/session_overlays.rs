use glam::Vec3;

use super::onion_skins::write_onion_skins;
use super::overlays::{InsideView, Overlays, SolverGhost, twist_reference_poses};
use super::trail::{has_trail, sample_trail};
use crate::session::session::Session;
use crate::session::solver::run::SolverRun;

/// Overlays of the viewport.
impl Session {
    /// State that the viewport shows beside the document: selection, drags, trails, solver ghosts.
    pub fn overlays(&self) -> Overlays {
        let mut overlays = Overlays::default();
        self.write_overlays(&mut overlays);
        overlays
    }

    /// Writes [`Session::overlays`] into `overlays` and reuses its memory. Allocates nothing,
    /// except for onion skins, which copy a document with keys.
    pub fn write_overlays(&self, overlays: &mut Overlays) {
        overlays.crowd = self.crowd();
        overlays.selection.clear();
        overlays.selection.extend_from_slice(self.selection().joints());
        overlays.hovered = self.selection().hovered_part();
        overlays.figure = self.selection().figure();
        overlays.concerned.clear();
        if let (Some(found), true) = (self.why(false).first(), self.solvers().is_idle()) {
            // The sentence calls a limb's target by its hand.
            overlays.concerned.extend(self.skeleton_rig().end_of_target(found.target));
            overlays.concerned.extend_from_slice(&found.joints);
        }
        overlays.inside = inside_view(self);
        overlays.wiggle = self.view().wiggle_view(self.posed());
        let transported = Some(self.evaluated().transport_path().transported());
        overlays.twist_references = twist_reference_poses(self.posed(), transported);
        overlays.trail.clear();
        overlays.trail.extend_from_slice(trail(self));
        write_ghosts(self.solvers().runs(), &mut overlays.ghosts);
        write_onion_skins(self.history().track(), self.posed(), &mut overlays.onion_skins);
    }
}

/// The part of the shown iteration that is looked at.
fn inside_view(session: &Session) -> Option<InsideView> {
    let run = session.solvers().run()?;
    let shown = run.shown_part()?;
    let part = run.parts().get(shown)?.clone();
    let previous = shown.checked_sub(1).and_then(|before| run.parts().get(before)).cloned();
    let (before, layers) = (run.before_part().clone(), session.view().inside_layers());
    Some(InsideView { part, previous, before, layers })
}

/// World positions of the hand or the active joint's tip in all frames; empty if the motion trail
/// is hidden.
fn trail(session: &Session) -> &[Vec3] {
    if has_trail(session.document(), session.shown()) {
        let joint = session.selection().active();
        session.evaluated().trail(|| sample_trail(session.history().track(), joint))
    } else {
        &[]
    }
}

fn write_ghosts<'a>(runs: impl Iterator<Item = &'a SolverRun>, ghosts: &mut Vec<SolverGhost>) {
    let mut count = 0;
    for run in runs {
        if count == ghosts.len() {
            ghosts.push(SolverGhost::default());
        }
        let ghost = &mut ghosts[count];
        (ghost.method, ghost.iteration) = (run.method(), run.shown().iteration);
        ghost.part = run.shown_part().map(|part| [part + 1, run.parts().len()]);
        ghost.targets.clear();
        ghost.targets.extend_from_slice(run.targets());
        run.skeleton().write_pose(&mut ghost.pose);
        count += 1;
    }
    ghosts.truncate(count);
}
