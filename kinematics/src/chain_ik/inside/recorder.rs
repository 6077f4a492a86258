use glam::{Affine3A, DVec3, Quat, Vec3, Vec3A};

use super::{
    AngleChange, Column, Ellipsoid, Gradient, MissedTurn, StepTaken, SubStep, SubStepKind, TipMove,
    Turn, TurnColumn,
};
use crate::chain_ik::configuration::{Configuration, Coordinates};
use crate::chain_ik::orientation::MissingTurn;
use crate::chain_ik::problem::{EndEffector, Problem};
use crate::skeleton::{RotationAxis, Skeleton};
use crate::vector::{saturate, saturate_vector};

/// Keeps what a method computes in an iteration, in the problem's units; nothing if it is off.
pub(in crate::chain_ik) struct Recorder(Option<Vec<Record>>);

/// A part of an iteration with the configuration after it.
pub(in crate::chain_ik) struct Record {
    pub event: Event,
    pub config: Configuration,
}

/// A part of an iteration.
pub(in crate::chain_ik) enum Event {
    /// Straight chains were bent before the first iteration.
    Bend,
    /// The gradient was computed; with damped least squares, for this λ.
    Gradient { descent: Coordinates, damping: Option<f32> },
    /// The angles were changed by `factor` times `by`, within the limits, after `tries` longer or
    /// less damped steps that were refused.
    Step { by: Coordinates, factor: f32, tries: u32, damping: Option<f32> },
    /// One link was rotated; `pairs` are the tips below it before, and their targets.
    Turn { link: usize, rotation: Quat, pairs: Vec<[Vec3A; 2]> },
    /// The roots were moved.
    MoveRoots,
    /// Points were moved from the targets towards the roots.
    Backward(Vec<LinkSegment>),
    /// Points were moved back from the roots.
    Forward(Vec<LinkSegment>),
    /// The length of each bone was restored in turn, from the targets to the roots.
    Relaxed(Vec<LinkSegment>),
    /// Bones were laid out from the roots towards the points.
    LaidOut(Vec<LinkSegment>),
    /// The passes were undone, because they raised the cost.
    Undo,
    /// The elbow of the limb that ends with this link was placed.
    PlaceElbow(usize),
    /// The link was turned to the target.
    Aim(usize),
    /// The method starts again from another pose, or the solver ends with the best pose.
    Restart,
}

/// A link from its joint to one of its points.
#[derive(Clone, Copy)]
pub(in crate::chain_ik) struct LinkSegment {
    pub link: usize,
    pub ends: [Vec3A; 2],
}

impl Recorder {
    pub fn off() -> Self {
        Self(None)
    }

    pub fn on() -> Self {
        Self(Some(Vec::new()))
    }

    pub fn is_on(&self) -> bool {
        self.0.is_some()
    }

    /// Keeps a part of the iteration that ended with `config`.
    pub fn record(&mut self, config: &Configuration, event: impl FnOnce() -> Event) {
        if let Some(records) = &mut self.0 {
            push(records, Record { event: event(), config: config.clone() });
        }
    }

    /// Keeps a change to `config`, unless that is the configuration after the last part.
    pub fn record_change(&mut self, config: &Configuration, event: Event) {
        if let Some(records) = &mut self.0
            && records.last().is_none_or(|last| !last.config.is_same(config))
        {
            push(records, Record { event, config: config.clone() });
        }
    }

    pub fn into_records(self) -> Vec<Record> {
        self.0.unwrap_or_default()
    }
}

/// Appends a record. Where a method has a part for each of very many links, the last record takes
/// the place of the one before it: otherwise memory would grow with the square of the number of
/// links.
fn push(records: &mut Vec<Record>, record: Record) {
    /// Maximum number of links in all records.
    const MOST: usize = 1 << 18;
    if records.len() > 1 && (records.len() + 1) * record.config.bases.len() > MOST {
        records.pop();
    }
    records.push(record);
}

/// The sub-steps of an iteration. `pose` gives the skeleton in a configuration.
pub(in crate::chain_ik) fn sub_steps(
    records: Vec<Record>,
    problem: &Problem,
    transform: Affine3A,
    pose: impl Fn(&Configuration) -> Skeleton,
) -> Vec<SubStep> {
    let world = World { problem, transform };
    let mut before: Option<Before> = None;
    let mut steps = Vec::with_capacity(records.len());
    for Record { event, config } in records {
        let kind = world.kind(&event, &config, before.as_ref());
        if let Event::Gradient { descent, .. } = event {
            before = Some(Before { config: config.clone(), descent });
        }
        let (pose, error) = (pose(&config), saturate(config.error(problem)));
        steps.push(SubStep { kind, pose, error, turns: world.missed_turns(&config) });
    }
    steps
}

/// The configuration before a step, and the negative gradient there.
struct Before {
    config: Configuration,
    descent: Coordinates,
}

/// Conversion from the problem's units to the world.
struct World<'a> {
    problem: &'a Problem,
    transform: Affine3A,
}

impl World<'_> {
    fn kind(&self, event: &Event, config: &Configuration, before: Option<&Before>) -> SubStepKind {
        let joint = |link: usize| self.problem.links[link].joint;
        match event {
            Event::Bend => SubStepKind::Bend,
            Event::Gradient { damping, .. } => {
                SubStepKind::Gradient(self.gradient(config, *damping))
            }
            Event::Step { by, factor, tries, damping } => match before {
                Some(before) => {
                    let length = damping.is_none().then(|| self.step_length(*factor));
                    let damping = damping.map(|damping| self.length(damping));
                    let predicted = self.predicted(before, by, *factor);
                    SubStepKind::Step(StepTaken {
                        changes: self.changes(before, config),
                        tips: self.tip_moves(&before.config, &predicted, config),
                        predicted_turns: self.predicted_turns(before, by, *factor),
                        length,
                        damping,
                        refused: *tries,
                    })
                }
                None => SubStepKind::Restart,
            },
            Event::Turn { link, rotation, pairs } => {
                SubStepKind::Turn(self.turn(config, *link, *rotation, pairs))
            }
            Event::MoveRoots => SubStepKind::MoveRoots,
            Event::Backward(chain) => SubStepKind::Backward(self.chain(chain)),
            Event::Forward(chain) => SubStepKind::Forward(self.chain(chain)),
            Event::Relaxed(chain) => SubStepKind::Relaxed(self.chain(chain)),
            Event::LaidOut(chain) => SubStepKind::LaidOut(self.chain(chain)),
            Event::Undo => SubStepKind::Undo,
            Event::PlaceElbow(link) => SubStepKind::PlaceElbow(joint(*link)),
            Event::Aim(link) => SubStepKind::Aim(joint(*link)),
            Event::Restart => SubStepKind::Restart,
        }
    }

    fn gradient(&self, config: &Configuration, damping: Option<f32>) -> Gradient {
        let columns = self.columns(config);
        let tips = self.problem.effectors.iter().zip(&config.tips);
        let ellipsoids = tips.map(|(effector, tip)| {
            let own = columns.iter().filter(|column| column.tip == effector.joint);
            let centre = self.point(effector.tree, *tip);
            Ellipsoid::of(effector.joint, centre, own.map(|column| column.by))
        });
        let ellipsoids = ellipsoids.collect();
        let turn_columns = self.turn_columns(config);
        let damping = damping.map(|damping| self.length(damping));
        Gradient { columns, turn_columns, ellipsoids, damping }
    }

    fn columns(&self, config: &Configuration) -> Vec<Column> {
        let mut columns = Vec::new();
        for (index, link) in self.problem.links.iter().enumerate() {
            for effector in self.problem.below(link) {
                let tip = config.tips[*effector];
                let arm = tip - config.pivot(self.problem, index, *effector);
                let effector = &self.problem.effectors[*effector];
                for axis in RotationAxis::ALL {
                    columns.push(Column {
                        joint: link.joint,
                        axis,
                        tip: effector.joint,
                        at: self.point(effector.tree, tip),
                        by: self.vector(config.axes[index].col(axis.index()).cross(arm)),
                    });
                }
            }
        }
        columns
    }

    fn turn_columns(&self, config: &Configuration) -> Vec<TurnColumn> {
        let mut columns = Vec::new();
        for (index, link) in self.problem.links.iter().enumerate() {
            for (effector, missing) in self.missing_turns(config) {
                if !self.problem.below(link).contains(&effector) {
                    continue;
                }
                let effector = &self.problem.effectors[effector];
                let way = missing.turn.normalize_or_zero();
                for axis in RotationAxis::ALL {
                    let about = config.axes[index].col(axis.index());
                    let by = missing.column(about, config.bases[index]);
                    columns.push(TurnColumn {
                        joint: link.joint,
                        axis,
                        target: effector.joint,
                        at: self.base(config, effector),
                        by: self.turn_vector(by),
                        gain: by.dot(way),
                    });
                }
            }
        }
        columns
    }

    /// The turns that joints miss, with the indices of their end effectors.
    fn missing_turns<'a>(
        &'a self,
        config: &'a Configuration,
    ) -> impl Iterator<Item = (usize, MissingTurn)> + 'a {
        let effectors = self.problem.effectors.iter().enumerate();
        effectors.filter_map(|(index, it)| Some((index, config.missing_turn(it)?)))
    }

    fn missed_turns(&self, config: &Configuration) -> Vec<MissedTurn> {
        let missed = self.missing_turns(config).map(|(effector, missing)| {
            let effector = &self.problem.effectors[effector];
            let (at, turn) = (self.base(config, effector), self.turn_vector(missing.turn));
            MissedTurn { joint: effector.joint, at, turn }
        });
        missed.collect()
    }

    /// Position of an end effector's joint.
    fn base(&self, config: &Configuration, effector: &EndEffector) -> Vec3 {
        self.point(effector.tree, config.joint_of(effector))
    }

    /// The turns that the Jacobian predicts to be missing after a step, before limits.
    fn predicted_turns(&self, before: &Before, by: &Coordinates, factor: f32) -> Vec<Vec3> {
        let config = &before.config;
        let left = |(index, missing): (usize, MissingTurn)| {
            let effector = &self.problem.effectors[index];
            let mut left = missing.turn;
            for (at, link) in self.problem.links.iter().enumerate() {
                if self.problem.below(link).contains(&index) {
                    let turn = config.axes[at] * Vec3A::from(by.angles[at] * factor);
                    left -= missing.column(turn, config.bases[at]);
                }
            }
            if self.problem.free_roots {
                let lever = factor * self.problem.shift_unit.powi(2);
                left -= missing.taken(Vec3A::ZERO, lever * by.shifts[effector.tree]);
            }
            left
        };
        self.missing_turns(config).map(left).map(|left| self.turn_vector(left)).collect()
    }

    /// The tips that the Jacobian predicts for a step, before limits.
    fn predicted(&self, before: &Before, by: &Coordinates, factor: f32) -> Vec<Vec3A> {
        let config = &before.config;
        let mut tips = config.tips.clone();
        for (index, link) in self.problem.links.iter().enumerate() {
            let turn = config.axes[index] * Vec3A::from(by.angles[index] * factor);
            for effector in self.problem.below(link) {
                tips[*effector] += turn
                    .cross(config.tips[*effector] - config.pivot(self.problem, index, *effector));
            }
        }
        if self.problem.free_roots {
            let lever = factor * self.problem.shift_unit.powi(2);
            let effectors = self.problem.effectors.iter().enumerate();
            for ((index, effector), tip) in effectors.zip(&mut tips) {
                *tip += lever * self.problem.part_of_shift(index) * by.shifts[effector.tree];
            }
        }
        tips
    }

    fn changes(&self, before: &Before, after: &Configuration) -> Vec<AngleChange> {
        let links = self.problem.links.iter().enumerate();
        let changes = links.flat_map(|(index, link)| {
            RotationAxis::ALL.into_iter().map(move |axis| {
                let nth = axis.index();
                let is_at_limit = link.limits.is_at_end(after.angles[index], axis);
                let gradient = -before.descent.angles[index][nth];
                let by = after.angles[index][nth] - before.config.angles[index][nth];
                let gradient = (f64::from(gradient) * self.scale().powi(2)) as f32;
                AngleChange { joint: link.joint, axis, gradient, by, is_at_limit }
            })
        });
        changes.collect()
    }

    fn tip_moves(
        &self,
        before: &Configuration,
        predicted: &[Vec3A],
        after: &Configuration,
    ) -> Vec<TipMove> {
        let effectors = self.problem.effectors.iter().enumerate();
        let moves = effectors.map(|(index, effector)| TipMove {
            joint: effector.joint,
            from: self.point(effector.tree, before.tips[index]),
            predicted: self.point(effector.tree, predicted[index]),
            to: self.point(effector.tree, after.tips[index]),
        });
        moves.collect()
    }

    fn turn(
        &self,
        config: &Configuration,
        index: usize,
        rotation: Quat,
        pairs: &[[Vec3A; 2]],
    ) -> Turn {
        let link = &self.problem.links[index];
        let base = config.bases[index];
        let (axis, angle) = rotation.to_axis_angle();
        let axis = if angle == 0.0 { Vec3::ZERO } else { axis };
        let (axis, angle) = if angle > core::f32::consts::PI {
            (-axis, core::f32::consts::TAU - angle)
        } else {
            (axis, angle)
        };
        let tips = pairs.iter().map(|[tip, target]| {
            let after = base + rotation * (*tip - base);
            [*tip, *target, after].map(|point| self.point(link.tree, point))
        });
        Turn {
            joint: link.joint,
            base: self.point(link.tree, base),
            axis: self.turn_vector(axis.into()),
            angle,
            tips: tips.collect(),
        }
    }

    fn chain(&self, segments: &[LinkSegment]) -> Vec<[Vec3; 2]> {
        let segment = |segment: &LinkSegment| {
            let tree = self.problem.links[segment.link].tree;
            segment.ends.map(|end| self.point(tree, end))
        };
        segments.iter().map(segment).collect()
    }

    /// A point of a tree in the world.
    fn point(&self, tree: usize, point: Vec3A) -> Vec3 {
        let in_skeleton = self.problem.trees[tree].origin + point.as_dvec3() / self.problem.unit();
        saturate_vector(self.transform.as_daffine3().transform_point3(in_skeleton))
    }

    /// A rotation vector, which keeps its length. An axis changes its sign in a mirror.
    fn turn_vector(&self, turn: Vec3A) -> Vec3 {
        let side = self.transform.matrix3.determinant().signum();
        side * turn.length() * self.vector(turn).normalize_or_zero()
    }

    fn vector(&self, vector: Vec3A) -> Vec3 {
        let in_skeleton: DVec3 = vector.as_dvec3() / self.problem.unit();
        saturate_vector(self.transform.as_daffine3().transform_vector3(in_skeleton))
    }

    fn length(&self, length: f32) -> f32 {
        saturate(f64::from(length) * self.scale())
    }

    /// A step length τ, which has the unit of 1/length².
    fn step_length(&self, step: f32) -> f32 {
        saturate(f64::from(step) / self.scale().powi(2))
    }

    /// Factor from the problem's units to the world's, by the transform's mean scale.
    fn scale(&self) -> f64 {
        1.0 / self.problem.length_from_world(1.0)
    }
}
