//! The parts of one iteration, in the order in which a method computes them.

mod recorder;

use glam::Vec3;
use nalgebra::{Matrix3, SymmetricEigen, Vector3};

use crate::skeleton::{JointId, RotationAxis, Skeleton};

pub(super) use recorder::{Event, LinkSegment, Recorder, sub_steps};

/// A part of an iteration. Positions and lengths are in the world.
#[derive(Clone, Debug, PartialEq)]
pub struct SubStep {
    /// The computed part.
    pub kind: SubStepKind,
    /// The skeleton in the pose after it.
    pub pose: Skeleton,
    /// Largest distance from a tip to its target in that pose, as far as the method counts it.
    pub error: f32,
    /// The turns that joints miss in that pose, of all targets with an orientation.
    pub turns: Vec<MissedTurn>,
}

/// The turn that a joint misses to the orientation of its target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MissedTurn {
    /// The joint.
    pub joint: JointId,
    /// Its position.
    pub at: Vec3,
    /// The axis of the turn, by the right-hand rule, times its angle in radians.
    pub turn: Vec3,
}

/// A part of an iteration, with its results.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum SubStepKind {
    /// Straight chains, which no method can bend, are bent before the first iteration.
    Bend,
    /// Transpose and damped least squares: the Jacobian and the gradient. The pose is unchanged.
    Gradient(Gradient),
    /// Transpose and damped least squares: the angles are changed.
    Step(StepTaken),
    /// CCD: one joint is turned.
    Turn(Turn),
    /// Free roots are moved.
    MoveRoots,
    /// FABRIK: the pass from the targets to the roots, as segments from joints to points. The pose
    /// is unchanged.
    Backward(Vec<[Vec3; 2]>),
    /// FABRIK: the pass back from the roots, as segments from joints to points.
    Forward(Vec<[Vec3; 2]>),
    /// Relaxation: the length of each bone is restored in turn, from the targets to the roots, by
    /// moving both of its ends, as segments from joints to points. Bones beside it stretch or
    /// shorten. The pose is unchanged.
    Relaxed(Vec<[Vec3; 2]>),
    /// Relaxation: bones of their own length are laid out from the roots towards the points, as
    /// segments from joints to points.
    LaidOut(Vec<[Vec3; 2]>),
    /// FABRIK and relaxation: the passes raised the error and are undone; a sweep of CCD follows.
    Undo,
    /// Two-bone: the upper joint of the limb that ends with this joint is turned, so that the elbow
    /// is at its place.
    PlaceElbow(JointId),
    /// Two-bone: this joint is turned to the target.
    Aim(JointId),
    /// The method starts again from another pose, or the solver returns to the best pose.
    Restart,
}

/// The Jacobian of all tips, and the gradient of f.
#[derive(Clone, Debug, PartialEq)]
pub struct Gradient {
    /// One column for each angle and each tip that it moves, joints from the root on.
    pub columns: Vec<Column>,
    /// One column for each angle and each joint with an orientation that it turns, joints from the
    /// root on.
    pub turn_columns: Vec<TurnColumn>,
    /// The speeds that each tip can have in different directions.
    pub ellipsoids: Vec<Ellipsoid>,
    /// The damping λ of damped least squares.
    pub damping: Option<f32>,
}

/// A column of the Jacobian.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Column {
    /// The joint that turns.
    pub joint: JointId,
    /// The axis of its angle.
    pub axis: RotationAxis,
    /// The joint whose tip moves.
    pub tip: JointId,
    /// Position of the tip.
    pub at: Vec3,
    /// Velocity of the tip, per radian of the angle.
    pub by: Vec3,
}

/// A column of the Jacobian for an orientation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TurnColumn {
    /// The joint that turns.
    pub joint: JointId,
    /// The axis of its angle.
    pub axis: RotationAxis,
    /// The joint with the orientation.
    pub target: JointId,
    /// Position of the joint with the orientation.
    pub at: Vec3,
    /// What the angle takes from the missing turn, per radian: an axis times an angle. For a
    /// rotation it is the axis of the angle itself, of length 1.
    pub by: Vec3,
    /// Angle by which the missing turn becomes shorter, per radian of the angle: the part of `by`
    /// along the missing turn.
    pub gain: f32,
}

/// A change of angles.
#[derive(Clone, Debug, PartialEq)]
pub struct StepTaken {
    /// The changes of all angles, joints from the root on.
    pub changes: Vec<AngleChange>,
    /// The moves of all tips.
    pub tips: Vec<TipMove>,
    /// The turns that the Jacobian predicts to be missing after the step, in the order of
    /// [`SubStep::turns`].
    pub predicted_turns: Vec<Vec3>,
    /// The step length τ of the transpose, in radians per squared length.
    pub length: Option<f32>,
    /// The damping λ of damped least squares.
    pub damping: Option<f32>,
    /// Number of longer or less damped steps that were refused before.
    pub refused: u32,
}

/// The change of an angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AngleChange {
    /// The joint.
    pub joint: JointId,
    /// The axis of its angle.
    pub axis: RotationAxis,
    /// The component of the gradient of f.
    pub gradient: f32,
    /// The change in radians.
    pub by: f32,
    /// True if the angle is at a limit afterwards.
    pub is_at_limit: bool,
}

/// The move of a tip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TipMove {
    /// The joint whose tip moves.
    pub joint: JointId,
    /// The position before.
    pub from: Vec3,
    /// The position that the Jacobian predicts.
    pub predicted: Vec3,
    /// The position after.
    pub to: Vec3,
}

/// The turn of one joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Turn {
    /// The joint.
    pub joint: JointId,
    /// Its position.
    pub base: Vec3,
    /// Unit axis of the turn; zero for no turn.
    pub axis: Vec3,
    /// Angle of the turn in radians, seen against the axis.
    pub angle: f32,
    /// For each tip below the joint its position before, its target, and its position after.
    pub tips: Vec<[Vec3; 3]>,
}

impl SubStepKind {
    /// A short description of the part.
    pub fn title(&self) -> &'static str {
        match self {
            Self::Bend => "Bend the straight chain",
            Self::Gradient(Gradient { damping: None, .. }) => "Compute the Jacobian",
            Self::Gradient(_) => "Compute the Jacobian and its ellipsoid",
            Self::Step(StepTaken { damping: None, .. }) => "Step along the gradient",
            Self::Step(_) => "Take the damped step",
            Self::Turn(_) => "Turn one joint",
            Self::MoveRoots => "Move the roots",
            Self::Backward(_) => "Pass backward, from the target to the root",
            Self::Forward(_) => "Pass forward, from the root to the tip",
            Self::Relaxed(_) => "Restore each bone's length, from the target to the root",
            Self::LaidOut(_) => "Lay the bones out, from the root to the tip",
            Self::Undo => "Undo the passes",
            Self::PlaceElbow(_) => "Place the elbow",
            Self::Aim(_) => "Turn to the target",
            Self::Restart => "Start again from another pose",
        }
    }
}

/// The velocities that a tip has while all angles together turn at one radian per second: the
/// ellipsoid of J·Jᵀ, with the columns of the Jacobian J.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipsoid {
    /// The joint whose tip moves.
    pub tip: JointId,
    /// Position of the tip.
    pub centre: Vec3,
    /// Unit axes, perpendicular to each other, the longest first.
    pub axes: [Vec3; 3],
    /// The singular values σ of J, the lengths of the axes, the greatest first.
    pub values: [f32; 3],
}

impl Ellipsoid {
    /// The ellipsoid of a tip whose velocities, one for each angle, are `columns`.
    pub(super) fn of(tip: JointId, centre: Vec3, columns: impl Iterator<Item = Vec3>) -> Self {
        let mut square = Matrix3::<f64>::zeros();
        for column in columns {
            let by = Vector3::from(column.as_dvec3().to_array());
            square += by * by.transpose();
        }
        let eigen = SymmetricEigen::new(square);
        let mut order = [0, 1, 2];
        order.sort_by(|one, other| eigen.eigenvalues[*other].total_cmp(&eigen.eigenvalues[*one]));
        let axis = |index: usize| {
            let axis = eigen.eigenvectors.column(index);
            Vec3::new(axis[0] as f32, axis[1] as f32, axis[2] as f32)
        };
        let value = |index: usize| eigen.eigenvalues[index].max(0.0).sqrt() as f32;
        Self { tip, centre, axes: order.map(axis), values: order.map(value) }
    }

    /// Fraction of the residual along each axis that a step of damped least squares takes away:
    /// σ² / (σ² + λ²).
    pub fn gains(&self, damping: f32) -> [f32; 3] {
        self.values.map(|value| {
            let (square, damping) = (f64::from(value).powi(2), f64::from(damping).powi(2));
            if square > 0.0 { (square / (square + damping)) as f32 } else { 0.0 }
        })
    }
}
