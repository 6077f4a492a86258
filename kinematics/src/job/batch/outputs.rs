use super::inputs::{LenError, check};
use super::kernel::{Results, outcome};
use crate::batch::QuaternionsMut;
use crate::job::{JobError, TwoBoneCorrection};
use crate::two_bone::Reach;

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
}
