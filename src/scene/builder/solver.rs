//! A solver at work: its shown iterates, the computations of a part of an iteration, drawn where
//! they act, and an angle that swings.

use core::f32::consts::TAU;

use glam::{Quat, Vec3};

use super::drawn_skeleton::{DrawnSkeleton, GHOST};
use crate::document::{Display, Overlay};
use crate::kinematics::chain_ik::{
    ChainTarget, Column, Ellipsoid, Gradient, StepTaken, SubStep, SubStepKind, Turn, TurnColumn,
};
use crate::kinematics::skeleton::{JointId, Skeleton};
use crate::scene::{Ball, Colour, Label, LabelSide, Line, Scene};
use crate::session::{InsideLayer, InsideView, SolverGhost, WiggleTarget, WiggleView};

/// Radius of thin and thick arrows, as fractions of the skeleton's reach.
const THIN: f32 = 0.004;
const THICK: f32 = 0.009;
/// Radius of the arcs of turned angles and of points, as fractions of the reach.
const ARC: f32 = 0.09;
const POINT: f32 = 0.014;
/// Length of the arrow of a turn by one radian, as a fraction of the reach.
const RADIAN: f32 = 0.12;
/// Angle in radians from which a turn is drawn.
const LEAST_TURN: f32 = 2e-3;

/// A part of an iteration, with all that its drawing depends on.
pub(super) struct InsideDrawing<'a> {
    pub view: &'a InsideView,
    pub targets: &'a [ChainTarget],
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
        if shows(InsideLayer::Turns) {
            self.add_turns(scene, part);
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
            let colour = scene.palette.axes[column.axis.index()];
            self.add_arrow(scene, column.at, column.by, THIN, colour);
            if column.by.length() > LONG * self.reach {
                let at = column.at + column.by;
                let label = Label::new(at, 0.0, LabelSide::Above, scene.palette.text);
                let (name, axis) = (&skeleton[column.joint].name, column.axis);
                scene.add_label(label, format_args!("{name} {axis}"));
            }
        }
    }

    /// Adds the turns that joints miss, as arrows along their axes with arcs of their angles;
    /// before a step, what each angle takes from them per radian, and after it, dashed, what the
    /// Jacobian predicted to be left.
    fn add_turns(&self, scene: &mut Scene, part: &SubStep) {
        let radian = RADIAN * self.reach;
        match &part.kind {
            SubStepKind::Gradient(gradient) => {
                let columns = &gradient.turn_columns;
                let is_selected = |column: &&TurnColumn| self.selection.contains(&column.joint);
                let any = columns.iter().any(|column| is_selected(&column));
                for column in columns.iter().filter(|column| !any || is_selected(column)) {
                    let colour = scene.palette.axes[column.axis.index()];
                    self.add_arrow(scene, column.at, radian * column.by, THIN, colour);
                }
            }
            SubStepKind::Step(step) => {
                let colour = scene.palette.guide;
                for (missed, predicted) in part.turns.iter().zip(&step.predicted_turns) {
                    let to = missed.at + radian * *predicted;
                    scene.lines.push(Line { from: missed.at, to, colour, dashed: true });
                }
            }
            _ => {}
        }
        let accent = scene.palette.accent;
        for missed in part.turns.iter().filter(|missed| missed.turn.length() > LEAST_TURN) {
            let by = radian * missed.turn;
            self.add_arrow(scene, missed.at, by, THICK, accent);
            let (axis, angle) = missed.turn.normalize_and_length();
            let start = RADIAN * self.reach * axis.any_orthonormal_vector();
            scene.add_arc(missed.at, start, axis, angle, accent);
            let middle = missed.at + Quat::from_axis_angle(axis, 0.5 * angle) * start;
            let label = Label::new(middle, 0.0, LabelSide::Above, scene.palette.text);
            scene.add_label(label, format_args!("{:.1}°", angle.to_degrees()));
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
            let axis = joint.rotation_axis(change.axis);
            let axis = parent.transform_vector3(axis).normalize_or_zero();
            let radius = axis.any_orthonormal_vector() * ARC * self.reach;
            let colour = scene.palette.axes[change.axis.index()];
            let centre = in_world.base(change.joint);
            scene.add_arc(centre, radius, axis, change.by, colour);
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
            scene.add_arc(base, start, turn.axis, turn.angle, accent);
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
        scene.add_arc(elbow - out, out, axis, TAU, guide);
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
            let (sin, cos) = (TAU * f32::from(index) / f32::from(Scene::CIRCLE)).sin_cos();
            centre + cos * axes[one] + sin * axes[other]
        };
        let line = |index| Line { from: point(index), to: point(index + 1), colour, dashed: false };
        scene.lines.extend((0..Scene::CIRCLE).map(line));
    }
}

impl DrawnSkeleton<'_> {
    /// Adds the shown iterates of solvers. The ghost of a single solver gets labels: the number of
    /// its iteration, and the distances from its tips to the targets.
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
            if is_single {
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

/// Adds an angle that swings: the bones that it moves, the path of the tip and the line that the
/// Jacobian predicts, and the residual.
pub(super) fn add_wiggle(
    scene: &mut Scene,
    drawn: &DrawnSkeleton<'_>,
    skeleton: &Skeleton,
    wiggle: &WiggleView,
) {
    let (accent, guide) = (scene.palette.accent, scene.palette.guide);
    let swinging = drawn.posed(&wiggle.pose);
    for joint in skeleton.ids().filter(|it| skeleton.is_in_subtree(*it, wiggle.swing.joint)) {
        let (base, tip) = (wiggle.pose.base(joint), wiggle.pose.tip(joint));
        let radius = swinging.radius(joint) * GHOST;
        if base != tip {
            scene.add_guide_solid(base, tip, radius, radius, accent);
        }
    }
    let segments = wiggle.path.windows(2);
    scene.lines.extend(segments.map(|ends| Line {
        from: ends[0],
        to: ends[1],
        colour: accent,
        dashed: false,
    }));
    let [from, to] = wiggle.predicted;
    scene.lines.push(Line { from, to, colour: guide, dashed: true });
    let tip = wiggle.pose.tip(wiggle.swing.tip);
    let radius = 0.014 * drawn.reach;
    scene.guide_balls.push(Ball { centre: tip, radius, colour: accent });
    let label = Label::new(tip, radius, LabelSide::Above, accent);
    if let Some(WiggleTarget { before, now, .. }) = wiggle.target {
        scene.add_label(label, format_args!("{:+.4}", now - before));
    }
}
