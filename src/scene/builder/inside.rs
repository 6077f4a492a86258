//! What a solver computes in a part of an iteration, drawn where it acts.

use core::f32::consts::TAU;

use glam::{Quat, Vec3};

use super::arc::{SEGMENTS, add_arc};
use crate::kinematics::chain_ik::{
    Column, Ellipsoid, Gradient, StepTaken, SubStep, SubStepKind, TipTarget, Turn,
};
use crate::kinematics::skeleton::{JointId, Skeleton};
use crate::scene::{Ball, Colour, Label, LabelSide, Line, Scene};
use crate::session::{InsideLayer, InsideView};

/// Radius of thin and thick arrows, as fractions of the skeleton's reach.
const THIN: f32 = 0.004;
const THICK: f32 = 0.009;
/// Radius of the arcs of turned angles and of points, as fractions of the reach.
const ARC: f32 = 0.09;
const POINT: f32 = 0.014;
/// Angle in radians from which a turn is drawn.
const LEAST_TURN: f32 = 2e-3;

/// What is needed to draw a part of an iteration.
pub(super) struct InsideDrawing<'a> {
    pub view: &'a InsideView,
    pub targets: &'a [TipTarget],
    /// Joints whose columns are drawn; all if it has none of the chain's.
    pub selection: &'a [JointId],
    pub reach: f32,
}

impl InsideDrawing<'_> {
    pub fn add(&self, scene: &mut Scene) {
        let part: &SubStep = &self.view.part;
        let shows = |layer| self.view.layers.shows(layer);
        match &part.kind {
            SubStepKind::Gradient(gradient) => {
                if shows(InsideLayer::Columns) {
                    self.add_columns(scene, &gradient.columns, &part.pose);
                }
                if shows(InsideLayer::Ellipsoid) {
                    self.add_ellipsoids(scene, gradient);
                }
            }
            SubStepKind::Step(step) if shows(InsideLayer::Step) => {
                self.add_before(scene);
                self.add_step(scene, step, &part.pose);
            }
            SubStepKind::Turn(turn) if shows(InsideLayer::Rays) => {
                self.add_before(scene);
                self.add_turn(scene, turn);
            }
            SubStepKind::Backward(chain) | SubStepKind::Relaxed(chain)
                if shows(InsideLayer::Passes) =>
            {
                self.add_chain(scene, chain, scene.palette.accent);
            }
            SubStepKind::Forward(chain) | SubStepKind::LaidOut(chain)
                if shows(InsideLayer::Passes) =>
            {
                if let Some(SubStepKind::Backward(points) | SubStepKind::Relaxed(points)) =
                    self.previous()
                {
                    self.add_chain(scene, points, scene.palette.accent);
                }
                self.add_chain(scene, chain, scene.palette.guide);
            }
            SubStepKind::PlaceElbow(lower) | SubStepKind::Aim(lower)
                if shows(InsideLayer::Triangle) =>
            {
                self.add_before(scene);
                self.add_triangle(scene, *lower, &part.pose);
            }
            _ => {}
        }
    }

    fn previous(&self) -> Option<&SubStepKind> {
        self.view.previous.as_ref().map(|previous| &previous.kind)
    }

    /// Adds the pose before the part, as lines.
    fn add_before(&self, scene: &mut Scene) {
        let before = &self.view.before;
        let colour = scene.palette.guide.with_opacity(0.6);
        let bones = before.ids().map(|joint| (before.base(joint), before.tip(joint)));
        let bones = bones.filter(|(base, tip)| base != tip);
        scene.lines.extend(bones.map(|(from, to)| Line { from, to, colour, dashed: false }));
    }

    /// Adds the columns as arrows. Long ones have the names of their joint and axis.
    fn add_columns(&self, scene: &mut Scene, columns: &[Column], skeleton: &Skeleton) {
        // As a fraction of the reach.
        const LONG: f32 = 0.25;
        let is_selected = |column: &&Column| self.selection.contains(&column.joint);
        let any = columns.iter().any(|column| is_selected(&column));
        for column in columns.iter().filter(|column| !any || is_selected(column)) {
            let colour = scene.palette.axes[column.axis as usize];
            self.add_arrow(scene, column.at, column.by, THIN, colour);
            if column.by.length() > LONG * self.reach {
                let at = column.at + column.by;
                let label = Label::new(at, 0.0, LabelSide::Above, scene.palette.text);
                let (name, axis) = (&skeleton[column.joint].name, column.axis);
                scene.add_label(label, format_args!("{name} {axis}"));
            }
        }
    }

    /// Adds the ellipsoid of each tip and, with damping, what the damping leaves of it.
    fn add_ellipsoids(&self, scene: &mut Scene, gradient: &Gradient) {
        let Some(damping) = gradient.damping else { return };
        let (whole, damped) = (scene.palette.guide.with_opacity(0.45), scene.palette.accent);
        for ellipsoid in &gradient.ellipsoids {
            let scale = ellipsoid_scale(ellipsoid, self.reach);
            let gains = ellipsoid.gains(damping);
            let axes: [Vec3; 3] =
                core::array::from_fn(|nth| scale * ellipsoid.values[nth] * ellipsoid.axes[nth]);
            add_ellipses(scene, ellipsoid.centre, axes, whole);
            let damped_axes = core::array::from_fn(|nth| gains[nth] * axes[nth]);
            add_ellipses(scene, ellipsoid.centre, damped_axes, damped);
        }
    }

    fn add_step(&self, scene: &mut Scene, step: &StepTaken, pose: &Skeleton) {
        let accent = scene.palette.accent;
        for tip in &step.tips {
            self.add_arrow(scene, tip.from, tip.to - tip.from, THICK, accent);
            let (from, to) = (tip.from, tip.predicted);
            scene.lines.push(Line { from, to, colour: scene.palette.guide, dashed: true });
        }
        let in_world = pose.pose();
        for change in step.changes.iter().filter(|change| change.by.abs() > LEAST_TURN) {
            let joint = &pose[change.joint];
            let parent = joint.parent.map_or(pose.transform(), |parent| in_world.full(parent));
            let axis = joint.rotation_axis(change.axis as usize);
            let axis = parent.transform_vector3(axis).normalize_or_zero();
            let radius = axis.any_orthonormal_vector() * ARC * self.reach;
            let colour = scene.palette.axes[change.axis as usize];
            let centre = in_world.base(change.joint);
            add_arc(scene, centre, radius, axis, change.by, colour);
        }
    }

    fn add_turn(&self, scene: &mut Scene, turn: &Turn) {
        // Radius of the arc as a fraction of the distance to the tip.
        const PART: f32 = 0.6;
        let (guide, accent) = (scene.palette.guide, scene.palette.accent);
        let base = turn.base;
        scene.guide_balls.push(Ball {
            centre: base,
            radius: 2.0 * POINT * self.reach,
            colour: accent,
        });
        for [from, target, to] in turn.tips.iter().copied() {
            scene.lines.push(Line { from: base, to: from, colour: guide, dashed: true });
            scene.lines.push(Line { from: base, to: target, colour: accent, dashed: false });
            let start = PART * (from - base);
            add_arc(scene, base, start, turn.axis, turn.angle, accent);
            let Some(axis) = turn.axis.try_normalize() else { continue };
            let middle = Quat::from_axis_angle(axis, 0.5 * turn.angle) * start;
            let label = Label::new(base + middle, 0.0, LabelSide::Above, scene.palette.text);
            scene.add_label(label, format_args!("{:.1}°", turn.angle.to_degrees()));
            self.add_point(scene, to, accent);
        }
    }

    fn add_chain(&self, scene: &mut Scene, chain: &[[Vec3; 2]], colour: Colour) {
        for [from, to] in chain.iter().copied() {
            let radius = 0.7 * THICK * self.reach;
            if from != to {
                scene.add_guide_solid(from, to, radius, radius, colour);
            }
            self.add_point(scene, from, colour);
            self.add_point(scene, to, colour);
        }
    }

    /// Adds the triangle of a limb's upper joint, elbow and target, and the circle of all elbows.
    fn add_triangle(&self, scene: &mut Scene, lower: JointId, pose: &Skeleton) {
        let target = self.targets.iter().find(|target| target.joint == lower);
        let (Some(upper), Some(target)) = (pose[lower].parent, target) else { return };
        let (accent, guide) = (scene.palette.accent, scene.palette.guide);
        let [shoulder, elbow] = [upper, lower].map(|joint| pose.base(joint));
        for (from, to) in [(shoulder, elbow), (elbow, target.point), (target.point, shoulder)] {
            scene.lines.push(Line { from, to, colour: accent, dashed: false });
        }
        let axis = (target.point - shoulder).normalize_or_zero();
        let out = (elbow - shoulder).reject_from(axis.try_normalize().unwrap_or(Vec3::X));
        add_arc(scene, elbow - out, out, axis, TAU, guide);
        self.add_point(scene, elbow, accent);
    }

    fn add_point(&self, scene: &mut Scene, centre: Vec3, colour: Colour) {
        scene.guide_balls.push(Ball { centre, radius: POINT * self.reach, colour });
    }

    /// Adds an arrow; one that is too short for its head is a line.
    fn add_arrow(&self, scene: &mut Scene, from: Vec3, by: Vec3, radius: f32, colour: Colour) {
        // Length and radius of the head, as multiples of the shaft's radius.
        const HEAD: (f32, f32) = (6.0, 2.6);
        let radius = radius * self.reach;
        let (length, to) = (by.length(), from + by);
        let head = HEAD.0 * radius;
        if length.is_nan() || length <= head {
            return scene.lines.push(Line { from, to, colour, dashed: false });
        }
        let neck = to - by * (head / length);
        scene.add_guide_solid(from, neck, radius, radius, colour);
        scene.add_guide_solid(neck, to, HEAD.1 * radius, 0.0, colour);
    }
}

/// Factor with which an ellipsoid is drawn, so that its longest axis is a part of the reach.
fn ellipsoid_scale(ellipsoid: &Ellipsoid, reach: f32) -> f32 {
    const PART: f32 = 0.4;
    let longest = ellipsoid.values[0];
    if longest > 0.0 { PART * reach / longest } else { 1.0 }
}

/// Adds the three ellipses in which an ellipsoid meets the planes of its axes.
fn add_ellipses(scene: &mut Scene, centre: Vec3, axes: [Vec3; 3], colour: Colour) {
    for (one, other) in [(0, 1), (1, 2), (2, 0)] {
        let point = |index: u16| {
            let (sin, cos) = (TAU * f32::from(index) / f32::from(SEGMENTS)).sin_cos();
            centre + cos * axes[one] + sin * axes[other]
        };
        let line = |index| Line { from: point(index), to: point(index + 1), colour, dashed: false };
        scene.lines.extend((0..SEGMENTS).map(line));
    }
}
