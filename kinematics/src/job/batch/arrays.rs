use core::ops::Range;

use glam::{Affine3A, Vec3};
use thiserror::Error;

use super::kernel::{BLOCK, FastPathJobs, Results, outcome};
use crate::batch::{Points, QuaternionsMut};
use crate::job::{JobError, TwoBoneCorrection, TwoBoneJob};
use crate::two_bone::Reach;

/// Transforms of joints to model space, one joint for each limb.
#[derive(Clone, Copy, Debug)]
pub struct Joints<'a> {
    /// First columns of the matrices.
    pub x_axis: Points<'a>,
    /// Second columns.
    pub y_axis: Points<'a>,
    /// Third columns.
    pub z_axis: Points<'a>,
    /// Positions.
    pub translation: Points<'a>,
}

/// Jobs for many limbs: the fields of [`TwoBoneJob`] as arrays with one number for each limb.
#[derive(Clone, Copy, Debug)]
pub struct JobInputs<'a> {
    /// Transforms of the start joints to model space.
    pub start: Joints<'a>,
    /// Transforms of the middle joints to model space.
    pub middle: Joints<'a>,
    /// Positions of the end joints in model space.
    pub end: Points<'a>,
    /// Targets of the end joints in model space.
    pub target: Points<'a>,
    /// Directions of the poles in model space; (0, 0, 0) for a limb without one.
    pub pole: Option<Points<'a>>,
    /// Hinge axes in the space of the middle joints; (0, 0, 0) for a limb without one.
    pub hinge: Option<Points<'a>>,
    /// Angles in radians; 0 if not given.
    pub twist: Option<&'a [f32]>,
    /// Weights from 0 to 1; 1 if not given.
    pub weight: Option<&'a [f32]>,
    /// Softness of the limits of all limbs.
    pub softness: f32,
}

impl<'a> Joints<'a> {
    pub(super) fn columns(self) -> [Points<'a>; 4] {
        [self.x_axis, self.y_axis, self.z_axis, self.translation]
    }

    fn part(self, limbs: &Range<usize>) -> Self {
        let [x_axis, y_axis, z_axis, translation] = self.columns().map(|of| part(of, limbs));
        Self { x_axis, y_axis, z_axis, translation }
    }

    fn at(self, limb: usize) -> Affine3A {
        let [x, y, z, translation] = self.columns().map(|of| at(of, limb));
        Affine3A::from_cols(x.into(), y.into(), z.into(), translation.into())
    }
}

impl JobInputs<'_> {
    /// Number of limbs.
    pub fn len(&self) -> usize {
        self.target.x.len()
    }

    /// True if there is no limb.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The job of one limb.
    ///
    /// # Panics
    ///
    /// If there is no such limb.
    pub fn job(&self, limb: usize) -> TwoBoneJob {
        TwoBoneJob {
            start: self.start.at(limb),
            middle: self.middle.at(limb),
            end: Affine3A::from_translation(at(self.end, limb)),
            target: at(self.target, limb),
            pole: self.pole.map(|pole| at(pole, limb)),
            hinge: self.hinge.map(|hinge| at(hinge, limb)),
            twist: self.twist.map_or(0.0, |twist| twist[limb]),
            softness: self.softness,
            weight: self.weight.map_or(1.0, |weight| weight[limb]),
        }
    }

    /// The jobs of a range of the limbs.
    pub(super) fn part(&self, limbs: Range<usize>) -> Self {
        Self {
            start: self.start.part(&limbs),
            middle: self.middle.part(&limbs),
            end: part(self.end, &limbs),
            target: part(self.target, &limbs),
            pole: self.pole.map(|pole| part(pole, &limbs)),
            hinge: self.hinge.map(|hinge| part(hinge, &limbs)),
            twist: self.twist.map(|twist| &twist[limbs.clone()]),
            weight: self.weight.map(|weight| &weight[limbs.clone()]),
            softness: self.softness,
        }
    }

    /// Copies the jobs of at most a block of limbs, without their weights and softness.
    pub(super) fn copy_to(&self, jobs: &mut FastPathJobs) {
        for (joints, to) in [(self.start, &mut jobs.start), (self.middle, &mut jobs.middle)] {
            for (column, to) in joints.columns().into_iter().zip(to) {
                copy(column, to);
            }
        }
        copy(self.end, &mut jobs.end);
        copy(self.target, &mut jobs.target);
        for (axes, to) in [(self.pole, &mut jobs.pole), (self.hinge, &mut jobs.hinge)] {
            if let Some(axes) = axes {
                copy(axes, to);
            }
        }
        let [sin, cos] = &mut jobs.twist;
        for (twist, (sin, cos)) in self.twist.into_iter().flatten().zip(sin.iter_mut().zip(cos)) {
            (*sin, *cos) = f64::from(*twist).sin_cos();
        }
    }

    pub(super) fn check(&self) -> Result<(), LenError> {
        let joints = [
            (["start.x_axis.x", "start.x_axis.y", "start.x_axis.z"], self.start.x_axis),
            (["start.y_axis.x", "start.y_axis.y", "start.y_axis.z"], self.start.y_axis),
            (["start.z_axis.x", "start.z_axis.y", "start.z_axis.z"], self.start.z_axis),
            (
                ["start.translation.x", "start.translation.y", "start.translation.z"],
                self.start.translation,
            ),
            (["middle.x_axis.x", "middle.x_axis.y", "middle.x_axis.z"], self.middle.x_axis),
            (["middle.y_axis.x", "middle.y_axis.y", "middle.y_axis.z"], self.middle.y_axis),
            (["middle.z_axis.x", "middle.z_axis.y", "middle.z_axis.z"], self.middle.z_axis),
            (
                ["middle.translation.x", "middle.translation.y", "middle.translation.z"],
                self.middle.translation,
            ),
            (["end.x", "end.y", "end.z"], self.end),
            (["target.x", "target.y", "target.z"], self.target),
        ];
        let options = [
            (["pole.x", "pole.y", "pole.z"], self.pole),
            (["hinge.x", "hinge.y", "hinge.z"], self.hinge),
        ];
        let options = options.into_iter().filter_map(|(names, of)| Some((names, of?)));
        for (names, Points { x, y, z }) in joints.into_iter().chain(options) {
            for (array, of) in names.into_iter().zip([x, y, z]) {
                check(array, of.len(), self.len())?;
            }
        }
        for (array, of) in [("twist", self.twist), ("weight", self.weight)] {
            check(array, of.map_or(self.len(), <[f32]>::len), self.len())?;
        }
        Ok(())
    }
}

fn copy(Points { x, y, z }: Points<'_>, to: &mut [[f32; BLOCK]; 3]) {
    for (from, to) in [x, y, z].into_iter().zip(to) {
        to[..from.len()].copy_from_slice(from);
    }
}

fn part<'a>(Points { x, y, z }: Points<'a>, limbs: &Range<usize>) -> Points<'a> {
    Points { x: &x[limbs.clone()], y: &y[limbs.clone()], z: &z[limbs.clone()] }
}

fn at(Points { x, y, z }: Points<'_>, limb: usize) -> Vec3 {
    Vec3::new(x[limb], y[limb], z[limb])
}

/// Arrays to which the fields of a [`TwoBoneCorrection`] are written, one number for each limb.
#[derive(Debug)]
pub struct JobOutputs<'a> {
    /// Δ₁ of each limb.
    pub start_correction: QuaternionsMut<'a>,
    /// Δ₂ of each limb.
    pub middle_correction: QuaternionsMut<'a>,
    /// Distance from each corrected hand to its target in model space.
    pub hand_error: &'a mut [f32],
    /// Reach of each limb, or why its job is refused. A refused limb gets no correction (identity
    /// rotations) and a hand error of NaN.
    pub reach: &'a mut [Result<Reach, JobError>],
}

impl JobOutputs<'_> {
    pub(super) fn check(&self, limbs: usize) -> Result<(), LenError> {
        let QuaternionsMut { x, y, z, w } = &self.start_correction;
        check("start_correction.x", x.len(), limbs)?;
        check("start_correction.y", y.len(), limbs)?;
        check("start_correction.z", z.len(), limbs)?;
        check("start_correction.w", w.len(), limbs)?;
        let QuaternionsMut { x, y, z, w } = &self.middle_correction;
        check("middle_correction.x", x.len(), limbs)?;
        check("middle_correction.y", y.len(), limbs)?;
        check("middle_correction.z", z.len(), limbs)?;
        check("middle_correction.w", w.len(), limbs)?;
        check("hand_error", self.hand_error.len(), limbs)?;
        check("reach", self.reach.len(), limbs)
    }

    /// Copies the results of the first `limbs` limbs of a block to the limbs after `first`.
    pub(super) fn copy_from(&mut self, results: &Results, first: usize, limbs: usize) {
        let to = first..first + limbs;
        for (values, QuaternionsMut { x, y, z, w }) in [
            (&results.start_correction, &mut self.start_correction),
            (&results.middle_correction, &mut self.middle_correction),
        ] {
            for (values, array) in values.iter().zip([x, y, z, w]) {
                array[to.clone()].copy_from_slice(&values[..limbs]);
            }
        }
        self.hand_error[to.clone()].copy_from_slice(&results.hand_error[..limbs]);
        for (reach, outcome) in self.reach[to].iter_mut().zip(results.outcome) {
            *reach = Ok(if outcome == outcome::REACHED {
                Reach::Reached
            } else if outcome == outcome::TOO_CLOSE {
                Reach::TooClose
            } else {
                Reach::TooFar
            });
        }
    }

    pub(super) fn set(&mut self, limb: usize, result: Result<TwoBoneCorrection, JobError>) {
        let (start, middle, hand_error) = match result {
            Ok(of) => (of.start_correction, of.middle_correction, of.hand_error),
            Err(_) => (Default::default(), Default::default(), f32::NAN),
        };
        for (turn, QuaternionsMut { x, y, z, w }) in
            [(start, &mut self.start_correction), (middle, &mut self.middle_correction)]
        {
            [x[limb], y[limb], z[limb], w[limb]] = turn.to_array();
        }
        self.hand_error[limb] = hand_error;
        self.reach[limb] = result.map(|of| of.reach);
    }

    /// The outputs of the first `middle` limbs, and of the others.
    #[cfg(feature = "parallel")]
    pub(super) fn split_at(self, middle: usize) -> (Self, Self) {
        let (start, second_start) = self.start_correction.split_at(middle);
        let (turn, second_turn) = self.middle_correction.split_at(middle);
        let (hand_error, second_hand_error) = self.hand_error.split_at_mut(middle);
        let (reach, second_reach) = self.reach.split_at_mut(middle);
        let first = Self { start_correction: start, middle_correction: turn, hand_error, reach };
        let second = Self {
            start_correction: second_start,
            middle_correction: second_turn,
            hand_error: second_hand_error,
            reach: second_reach,
        };
        (first, second)
    }
}

/// Arrays of a batch that differ in length.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("{array} has {len} numbers; target.x has {limbs}, and there must be as many")]
pub struct LenError {
    /// Path of the array in [`JobInputs`](super::JobInputs) or [`JobOutputs`](super::JobOutputs),
    /// such as `start.x_axis.y`.
    pub array: &'static str,
    /// Length of the array.
    pub len: usize,
    /// Number of limbs, the length of `target.x`.
    pub limbs: usize,
}

pub(super) fn check(array: &'static str, len: usize, limbs: usize) -> Result<(), LenError> {
    if len == limbs { Ok(()) } else { Err(LenError { array, len, limbs }) }
}
