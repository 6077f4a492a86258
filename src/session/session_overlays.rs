use glam::Vec3;

use super::comparison::Comparison;
use super::onion_skins::write_onion_skins;
use super::overlays::{Overlays, SolverGhost};
use super::session::Session;
use super::trail::{has_trail, walk};
use crate::document::Document;

impl Overlays {
    /// What a picture of a document at a time shows beside it, as the document's display has it:
    /// nothing is selected.
    pub fn new(document: &Document, time: f64) -> Self {
        let shown = document.evaluate(time);
        let has_trail = has_trail(document, &shown);
        let mut overlays = Self {
            time,
            trail: if has_trail { walk(document, None) } else { Vec::new() },
            ..Self::default()
        };
        write_onion_skins(document, &shown, time, &mut overlays.onion_skins);
        overlays
    }

    /// The same at another time, at which the document is.
    #[must_use]
    pub fn at(mut self, document: &Document, time: f64) -> Self {
        self.time = time;
        write_onion_skins(document, document, time, &mut self.onion_skins);
        self
    }
}

impl Session {
    /// What a picture shows beside the document.
    pub fn overlays(&self) -> Overlays {
        let mut overlays = Overlays::default();
        self.write_overlays(&mut overlays);
        overlays
    }

    /// [`Session::overlays`] in the memory that another staging has: none is taken anew, except that
    /// onion skins take a copy of a document with keys.
    pub fn write_overlays(&self, overlays: &mut Overlays) {
        overlays.time = self.time();
        overlays.crowd = self.crowd();
        overlays.selection.clear();
        overlays.selection.extend_from_slice(self.selection());
        overlays.hovered = self.hovered();
        overlays.transported = Some(self.transport_path().transported());
        overlays.trail.clear();
        overlays.trail.extend_from_slice(self.trail());
        write_ghosts(self.comparison(), &mut overlays.ghosts);
        write_onion_skins(self.document(), self.shown(), self.time(), &mut overlays.onion_skins);
    }

    /// The hand or the tip of the active joint at every frame.
    fn trail(&self) -> &[Vec3] {
        if has_trail(self.document(), self.shown()) {
            self.evaluated.trail(|| walk(self.document(), self.selected()))
        } else {
            &[]
        }
    }
}

fn write_ghosts(comparison: Option<&Comparison>, ghosts: &mut Vec<SolverGhost>) {
    let solvers = comparison.into_iter().flat_map(Comparison::solvers);
    let mut count = 0;
    for solver in solvers.filter(|solver| solver.report().is_ok()) {
        let method = solver.method;
        match ghosts.get_mut(count) {
            Some(ghost) => {
                ghost.method = method;
                solver.skeleton.write_pose(&mut ghost.pose);
            }
            None => ghosts.push(SolverGhost { method, pose: solver.skeleton.pose() }),
        }
        count += 1;
    }
    ghosts.truncate(count);
}
