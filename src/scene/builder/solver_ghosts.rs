use super::drawn_skeleton::{DrawnSkeleton, GHOST};
use crate::document::{Display, Overlay};
use crate::scene::{Ball, Colour, Label, LabelSide, Scene};
use crate::session::SolverGhost;

impl DrawnSkeleton<'_> {
    /// Adds the shown iterates of solvers. The ghost of a single solver gets labels: the number of its
    /// iteration, and the distances from its tips to the targets.
    pub fn add_solver_ghosts(&self, scene: &mut Scene, ghosts: &[SolverGhost], display: Display) {
        for ghost in ghosts {
            let colour = scene.palette.method(ghost.method);
            let drawn = self.posed(&ghost.pose);
            drawn.add_ghost(scene, colour);
            // Labels of all ghosts of a race would hide each other.
            let is_single = ghosts.len() == 1;
            if is_single && display.shows(Overlay::Cursor) {
                for target in &ghost.targets {
                    drawn.add_gap(scene, target.joint, target.point, colour, false);
                }
            }
            if is_single && display.shows(Overlay::Labels) {
                drawn.add_iteration(scene, ghost, colour);
            }
        }
    }

    /// Adds thin bones that also show faintly through the skeleton's own.
    fn add_ghost(&self, scene: &mut Scene, colour: Colour) {
        for joint in self.pose.ids() {
            let (base, tip) = (self.pose.base(joint), self.pose.tip(joint));
            let radius = self.radius(joint) * GHOST;
            if base != tip {
                scene.add_guide_solid(base, tip, radius, radius, colour);
            }
            scene.guide_balls.push(Ball { centre: tip, radius, colour });
        }
    }

    /// Adds the number of an iteration and of its part as a label above the highest tip.
    fn add_iteration(&self, scene: &mut Scene, ghost: &SolverGhost, colour: Colour) {
        let tips = self.pose.ids().map(|joint| (joint, self.pose.tip(joint)));
        if let Some((joint, at)) = tips.max_by(|(_, a), (_, b)| a.y.total_cmp(&b.y)) {
            let label = Label::new(at, self.radius(joint), LabelSide::Above, colour);
            let iteration = ghost.iteration;
            match ghost.part {
                Some([part, of]) => scene
                    .add_label(label, format_args!("Iteration {iteration}, part {part} of {of}")),
                None => scene.add_label(label, format_args!("Iteration {iteration}")),
            }
        }
    }
}
