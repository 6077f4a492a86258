use core::fmt;

use glam::{DMat3, DVec3};
use thiserror::Error;

use crate::vector::saturate;

/// An invalid [`TwoBoneJob`](super::TwoBoneJob).
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum JobError {
    /// A matrix or a vector is not finite. (Of `end` only the translation counts.)
    #[error("{field} must be finite")]
    NotFinite {
        /// The matrix or vector.
        field: JobField,
    },
    /// The start joint's axes are in one plane or on one line (their condition number is above
    /// 1e6), and are not all 0.
    #[error("{field} must have an inverse, or scale 0; its axes are in one plane")]
    NotInvertible {
        /// The matrix, [`JobField::Start`].
        field: JobField,
    },
    /// In start joint space, the middle joint is scaled unevenly.
    #[error(
        "{field} must have axes of equal length in start joint space, to one in a thousand, got {}, \
         {} and {}",
        .lengths[0], .lengths[1], .lengths[2]
    )]
    UnevenAxes {
        /// The matrix, [`JobField::Middle`].
        field: JobField,
        /// Lengths of the three columns of start⁻¹ · middle.
        lengths: [f32; 3],
    },
    /// In start joint space, the middle joint is sheared.
    #[error(
        "{field} must have perpendicular axes in start joint space (cosine from -0.001 to 0.001), got \
         a cosine of {cosine}"
    )]
    SkewAxes {
        /// The matrix, [`JobField::Middle`].
        field: JobField,
        /// Cosine of the angle between the two columns of start⁻¹ · middle that are farthest from
        /// perpendicular.
        cosine: f32,
    },
    /// A number is outside its range.
    #[error("{field} must be {range}, got {value}")]
    OutOfRange {
        /// The field that holds the number.
        field: JobField,
        /// The refused number.
        value: f32,
        /// The valid range, in words.
        range: &'static str,
    },
}

/// A field of [`TwoBoneJob`](super::TwoBoneJob).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum JobField {
    /// Matrix of the start joint.
    Start,
    /// Matrix of the middle joint.
    Middle,
    /// Matrix of the end joint.
    End,
    /// Target of the end joint.
    Target,
    /// Direction from the line between start joint and target to the middle joint.
    Pole,
    /// Hinge axis of the middle joint.
    Hinge,
    /// Twist angle about the line to the target.
    Twist,
    /// Softness of the limits.
    Softness,
    /// Weight: the fraction of the correction to apply.
    Weight,
}

impl fmt::Display for JobField {
    /// The field's name in lower case.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Start => "start",
            Self::Middle => "middle",
            Self::End => "end",
            Self::Target => "target",
            Self::Pole => "pole",
            Self::Hinge => "hinge",
            Self::Twist => "twist",
            Self::Softness => "softness",
            Self::Weight => "weight",
        })
    }
}

/// Largest difference of lengths, and largest cosine between axes, of a similarity.
const DIFFERENT: f64 = 1e-3;

/// The scale of a matrix. Refuses one that is not a similarity: a rotation with an even scale (or
/// 0), mirrored or not.
pub(super) fn similarity_scale(field: JobField, axes: DMat3) -> Result<f64, JobError> {
    let DMat3 { x_axis: x, y_axis: y, z_axis: z } = axes;
    let squares = DVec3::new(x.length_squared(), y.length_squared(), z.length_squared());
    let cosines = DVec3::new(x.dot(y), y.dot(z), z.dot(x));
    let (longest, shortest) = (squares.max_element(), squares.min_element());
    // Squares differ by up to twice as much as lengths: within these bounds, no root is needed.
    let is_similarity = longest - shortest <= DIFFERENT * longest
        && cosines.abs().max_element() <= 0.5 * DIFFERENT * longest;
    if !is_similarity {
        check_similarity(field, axes)?;
    }
    Ok((squares.element_sum() / 3.0).sqrt())
}

fn check_similarity(field: JobField, axes: DMat3) -> Result<(), JobError> {
    let lengths = [axes.x_axis.length(), axes.y_axis.length(), axes.z_axis.length()];
    let longest = lengths.into_iter().fold(0.0, f64::max);
    let shortest = lengths.into_iter().fold(longest, f64::min);
    if longest - shortest > DIFFERENT * longest {
        let lengths = lengths.map(saturate);
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
