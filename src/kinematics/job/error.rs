use glam::{DMat3, DVec3};
use thiserror::Error;

use super::{SoftReach, TwoBoneJob};

/// A job that cannot be done.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum JobError {
    /// A matrix or a vector has a number that is infinite or not a number (in `end`, its place: its
    /// axes may be anything).
    #[error("{field} is not finite; each of its numbers must be")]
    NotFinite {
        /// The field of [`TwoBoneJob`].
        field: &'static str,
    },
    /// The start joint's axes are in one plane or on one line (to a condition number of 1e6), and are
    /// not all 0.
    #[error("{field} has axes in one plane; its matrix must have an inverse, or scale 0")]
    NotInvertible {
        /// The matrix: `"start"`.
        field: &'static str,
    },
    /// In start joint space, the middle joint is scaled unevenly.
    #[error(
        "{field} has axes of length {}, {} and {} in start joint space; they must be equal to one in \
         a thousand",
        .lengths[0], .lengths[1], .lengths[2]
    )]
    UnevenAxes {
        /// The matrix: `"middle"`.
        field: &'static str,
        /// Of the three columns of start⁻¹ · middle.
        lengths: [f32; 3],
    },
    /// In start joint space, the middle joint is sheared.
    #[error(
        "{field} has axes that are not perpendicular in start joint space: the cosine between two is \
         {cosine}; it must be from -0.001 to 0.001"
    )]
    SkewAxes {
        /// The matrix: `"middle"`.
        field: &'static str,
        /// Of the angle between the two columns of start⁻¹ · middle that are farthest from
        /// perpendicular.
        cosine: f32,
    },
    /// A number is outside its range.
    #[error("{field} is {value}; it must be {range}")]
    OutOfRange {
        /// `"twist"`, `"softness"` or `"weight"`.
        field: &'static str,
        /// What was given.
        value: f32,
        /// What would be right.
        range: &'static str,
    },
}

impl TwoBoneJob {
    /// Refuses numbers that are not finite or out of their range.
    pub(super) fn checked(&self) -> Result<SoftReach, JobError> {
        let are_finite = [
            ("start", self.start.is_finite()),
            ("middle", self.middle.is_finite()),
            ("end", self.end.translation.is_finite()),
            ("target", self.target.is_finite()),
            ("pole", self.pole.is_finite()),
            ("hinge", self.hinge.is_finite()),
        ];
        if let Some((field, _)) = are_finite.into_iter().find(|(_, is_finite)| !is_finite) {
            return Err(JobError::NotFinite { field });
        }
        if !self.twist.is_finite() {
            return Err(out_of_range("twist", self.twist, "a finite number"));
        }
        if !(0.0..=1.0).contains(&self.weight) {
            return Err(out_of_range("weight", self.weight, "from 0 to 1"));
        }
        SoftReach::new(self.softness, 1.0, 0.0)
            .map_err(|error| out_of_range(error.field, error.value, error.range))
    }
}

fn out_of_range(field: &'static str, value: f32, range: &'static str) -> JobError {
    JobError::OutOfRange { field, value, range }
}

/// Refuses axes that are not those of a similarity: a rotation and a scale that is the same along
/// each axis (or 0), mirrored or not.
pub(super) fn check_similarity(field: &'static str, axes: DMat3) -> Result<(), JobError> {
    const DIFFERENT: f64 = 1e-3;
    let lengths = [axes.x_axis.length(), axes.y_axis.length(), axes.z_axis.length()];
    let longest = lengths.into_iter().fold(0.0, f64::max);
    let shortest = lengths.into_iter().fold(longest, f64::min);
    if longest - shortest > DIFFERENT * longest {
        let lengths = lengths.map(|length| length.min(f32::MAX.into()) as f32);
        return Err(JobError::UnevenAxes { field, lengths });
    }
    let [x, y, z] = [axes.x_axis, axes.y_axis, axes.z_axis].map(DVec3::normalize_or_zero);
    let cosines = [x.dot(y), y.dot(z), z.dot(x)];
    let skewest = cosines.into_iter().fold(0.0, |a: f64, b| if b.abs() > a.abs() { b } else { a });
    if skewest.abs() > DIFFERENT {
        return Err(JobError::SkewAxes { field, cosine: skewest as f32 });
    }
    Ok(())
}
