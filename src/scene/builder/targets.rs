use core::f32::consts::TAU;

use glam::Vec3;

use super::drawn_skeleton::DrawnSkeleton;
use crate::document::{ShownLength, Target, TwistReferenceKind};
use crate::kinematics::skeleton::{JointId, Skeleton};
use crate::rig::TargetReport;
use crate::scene::{Ball, Colour, Label, LabelSide, Line, Scene};

/// Maximum radius of a target's ball: as a fraction of the skeleton's reach, and as a multiple of
/// the radius of the bone that it moves, so that the ball hides no bones of a long chain.
const TARGET_RADIUS: (f32, f32) = (0.014, 1.6);
/// Opacity of the line from a limb's base to its target at full influence.
const POINTER_OPACITY: f32 = 0.45;
/// Duration in seconds and number of segments of a target's trail.
const TRAIL: (f64, usize) = (1.2, 48);

impl DrawnSkeleton<'_> {
    /// Adds a target as a ball; for a limb that it poses, the axis from the limb's base and the
    /// pole.
    pub fn add_target(&self, scene: &mut Scene, target: &Target, report: &TargetReport) {
        let at = report.position;
        let radius = self.target_radius(target.joint);
        let guide = scene.palette.guide;
        let colour = if target.enabled { guide } else { guide.with_opacity(0.35) };
        scene.guide_balls.push(Ball { centre: at, radius, colour });
        if !target.enabled {
            return;
        }
        if let Some(upper) = self.upper_of(target).filter(|_| target.is_posing()) {
            let colour = guide.with_opacity(POINTER_OPACITY * target.influence);
            scene.lines.push(Line { from: self.pose.base(upper), to: at, colour, dashed: false });
            self.add_pole(scene, target, report, radius);
        }
    }

    fn target_radius(&self, joint: JointId) -> f32 {
        let (of_reach, of_bone) = TARGET_RADIUS;
        (of_reach * self.reach).min(of_bone * self.radius(joint))
    }

    /// Adds a line from a joint's tip to its target, labelled with their distance, unless the tip
    /// reaches the target.
    ///
    /// The label is clear of the target's handles if it has any.
    pub fn add_gap(
        &self,
        scene: &mut Scene,
        joint: JointId,
        at: Vec3,
        colour: Colour,
        has_handles: bool,
    ) {
        let (tip, radius) = (self.pose.tip(joint), self.target_radius(joint));
        let gap = tip.distance(at);
        if gap > 1.5 * radius {
            scene.lines.push(Line { from: tip, to: at, colour, dashed: true });
            let label = Label::new(at, radius, LabelSide::Above, colour);
            let label = if has_handles { label.clear_of_handles() } else { label };
            let shown = ShownLength { length: gap, decimals: residual_decimals(self.reach) };
            scene.add_label(label, format_args!("{shown}"));
        }
    }

    /// Adds the circle of all places where the elbow of a limb could be with the tip where it is,
    /// and a spoke to the elbow; nothing for another target, or for a straight limb.
    pub fn add_elbow_circle(&self, scene: &mut Scene, target: &Target) {
        // Radius as a fraction of the reach from which the circle is drawn.
        const LEAST: f32 = 1e-4;
        let Some(upper) = self.upper_of(target).filter(|_| target.is_posing()) else { return };
        let [base, elbow] = [upper, target.joint].map(|joint| self.pose.base(joint));
        let Some(axis) = (self.pose.tip(target.joint) - base).try_normalize() else { return };
        let out = (elbow - base).reject_from_normalized(axis);
        if out.length() > LEAST * self.reach {
            let centre = elbow - out;
            scene.add_arc(centre, out, axis, TAU, scene.palette.guide);
            let colour = scene.palette.accent;
            scene.lines.push(Line { from: centre, to: elbow, colour, dashed: false });
        }
    }

    /// The upper joint of a limb's target.
    fn upper_of(&self, target: &Target) -> Option<JointId> {
        target.limb()?;
        let above = |joint: &JointId| self.joints[joint.index()].parent;
        let ancestors = std::iter::successors(above(&target.joint), above);
        ancestors.into_iter().find(|joint| !self.joints[joint.index()].locked)
    }

    /// Adds the pole as a ball, with a line from the elbow.
    fn add_pole(&self, scene: &mut Scene, target: &Target, report: &TargetReport, radius: f32) {
        let Some(pole) = report.pole else { return };
        let colour = scene.palette.twist_reference(TwistReferenceKind::Pole);
        scene.guide_balls.push(Ball { centre: pole, radius, colour });
        let from = self.pose.base(target.joint);
        scene.lines.push(Line { from, to: pole, colour: colour.with_opacity(0.6), dashed: true });
        let label = Label::new(pole, radius, LabelSide::Above, colour);
        scene.add_label(label, format_args!("Pole"));
    }
}

/// Number of decimals of a labelled distance, for a skeleton of this reach.
fn residual_decimals(reach: f32) -> usize {
    (2.0 - reach.log10().floor()).clamp(0.0, 6.0) as usize
}

/// Adds the recent path of a moving target in its present space, fading out with age.
pub(super) fn add_trail(scene: &mut Scene, target: &Target, pose: &Skeleton, time: f64) {
    let to_world = target.space.to_world(pose);
    let (seconds, steps) = TRAIL;
    let seconds = seconds.min(f64::from(target.motion.period));
    let at = |step: usize| -> Vec3 {
        to_world.transform_point3(target.at(time - seconds * step as f64 / steps as f64))
    };
    let colour = scene.palette.accent;
    for step in 0..steps {
        let colour = colour.with_opacity(0.9 * (1.0 - step as f32 / steps as f32));
        scene.lines.push(Line { from: at(step), to: at(step + 1), colour, dashed: false });
    }
}
