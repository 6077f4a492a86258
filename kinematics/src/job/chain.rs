use glam::{Affine3A, DMat3, DQuat, DVec3};

use super::error::{JobError, JobField, similarity_scale};
use super::fast_path::cofactors;

/// The three joints of a job in start joint space, in the unit of this space.
pub(super) struct JointChain {
    /// Position of the start joint, in model space.
    start: DVec3,
    /// M_s: the start joint's axes in model space, as columns. If they have scale 0, this is the
    /// identity: no joint can turn, and start joint space is model space.
    axes: DMat3,
    /// M_s⁻¹.
    axes_inverse: DMat3,
    /// True if the start joint's axes have a scale other than 0.
    can_turn: bool,
    /// u, the vector from the start joint to the middle joint.
    upper_ss: DVec3,
    /// l, the vector from the middle joint to the end joint.
    lower_ss: DVec3,
    /// Lengths of u and l.
    lengths_ss: [f64; 2],
    /// M_s⁻¹·M_m: the middle joint's axes, as columns; 0 if no joint can turn.
    middle_ss: DMat3,
    /// Its inverse; 0 for a middle joint of scale 0.
    middle_inverse: DMat3,
    /// Scale of the middle joint in start joint space, negative for one that mirrors.
    middle_scale: f64,
    /// Rounding of the joints' positions: about an ulp of their largest model space coordinate,
    /// times the largest factor by which M_s⁻¹ lengthens an axis.
    rounding_ss: f64,
}

/// The two bones in start joint space. Lengths are in units of the chain's length.
pub(super) struct LimbBones {
    /// û, the direction from the start joint to the middle joint; NaN for a bone of length 0.
    pub upper_ss: DVec3,
    /// The direction from the middle joint to the end joint; NaN for a bone of length 0.
    pub lower_ss: DVec3,
    /// d₁.
    pub upper: f64,
    /// d₂.
    pub lower: f64,
    /// Direction from the start joint to the uncorrected hand, of any length.
    pub hand_ss: DVec3,
    /// 1 / L, with the chain's length L in start joint space.
    pub inv_length: f64,
    /// True if both bones have lengths above 0 and the middle joint can turn the lower bone.
    pub is_jointed: bool,
    /// Displacement of a joint by the rounding of its coordinates, in chain lengths.
    pub rounding: f64,
}

impl JointChain {
    /// The chain of the start, middle and end joint, given in model space. Refuses a start joint
    /// whose matrix has no inverse (scale 0 is accepted), and a middle joint whose axes are uneven
    /// or skew in start joint space.
    pub fn new(joints: [Affine3A; 3]) -> Result<Self, JobError> {
        let [start_axes, middle_axes, _] = joints.map(|joint| joint.matrix3.as_dmat3());
        let [start, middle, end] = joints.map(|joint| joint.translation.as_dvec3());
        let can_turn = start_axes != DMat3::ZERO;
        let axes = if can_turn { start_axes } else { DMat3::IDENTITY };
        let axes_inverse =
            inverse(axes).ok_or(JobError::NotInvertible { field: JobField::Start })?;
        let middle_axes = if can_turn { middle_axes } else { DMat3::ZERO };
        let middle_ss = axes_inverse * middle_axes;
        let middle_scale = similarity_scale(JobField::Middle, middle_ss)?;
        let middle_inverse = adjugate_inverse(middle_ss).unwrap_or(DMat3::ZERO);
        let largest = start.abs().max(middle.abs()).max(end.abs()).max_element();
        let upper_ss = axes_inverse * (middle - start);
        let lower_ss = axes_inverse * (end - middle);
        Ok(Self {
            start,
            axes,
            axes_inverse,
            can_turn,
            upper_ss,
            lower_ss,
            lengths_ss: [upper_ss.length(), lower_ss.length()],
            middle_ss,
            middle_inverse,
            middle_scale: middle_scale.copysign(middle_inverse.determinant()),
            rounding_ss: largest
                * f64::from(f32::EPSILON)
                * longest_axis_squared(axes_inverse).sqrt(),
        })
    }

    /// The chain's length L, in start joint space.
    pub fn length_ss(&self) -> f64 {
        self.lengths_ss[0] + self.lengths_ss[1]
    }

    /// Converts a point from model space to start joint space.
    pub fn point_ss(&self, point: DVec3) -> DVec3 {
        self.vector_ss(point - self.start)
    }

    /// Converts a vector from model space to start joint space.
    pub fn vector_ss(&self, vector: DVec3) -> DVec3 {
        self.axes_inverse * vector
    }

    /// Length in model space of a vector in start joint space.
    pub fn length_in_model(&self, vector_ss: DVec3) -> f64 {
        (self.axes * vector_ss).length()
    }

    /// The two bones; `None` if the start joint cannot turn, or if the chain neither bends nor
    /// points in a direction.
    pub fn limb(&self) -> Option<LimbBones> {
        let [upper, lower] = self.lengths_ss;
        let inv_length = (upper + lower).recip();
        let inv_product = (upper * lower).recip();
        let is_jointed = upper > 0.0 && lower > 0.0 && self.middle_ss != DMat3::ZERO;
        let hand_ss = self.upper_ss + self.lower_ss;
        let limb = LimbBones {
            upper_ss: self.upper_ss * (lower * inv_product),
            lower_ss: self.lower_ss * (upper * inv_product),
            upper: upper * inv_length,
            lower: lower * inv_length,
            hand_ss,
            inv_length,
            is_jointed,
            rounding: self.rounding_ss * inv_length,
        };
        (self.can_turn && (is_jointed || hand_ss != DVec3::ZERO)).then_some(limb)
    }

    /// The direction in start joint space of an axis of turns in middle joint space. (A mirrored
    /// turn about an axis is the opposite turn about the mirrored axis.)
    pub fn axis_ss(&self, axis: DVec3) -> DVec3 {
        self.middle_ss * axis * 1.0_f64.copysign(self.middle_scale)
    }

    /// Converts the axis of a turn from start joint space to middle joint space, without changing
    /// its length.
    ///
    /// The rotation Q nearest to M = M_s⁻¹·M_m is the polar decomposition of M; for a similarity up
    /// to rounding, one step of Newton's iteration is exact: Q = (M/s + (M/s)⁻ᵀ) / 2.
    pub fn axis_in_middle(&self, axis_ss: DVec3) -> DVec3 {
        if self.middle_scale == 0.0 || axis_ss == DVec3::ZERO {
            return axis_ss;
        }
        let by_transpose = self.middle_ss.transpose_mul_vec3(axis_ss) / self.middle_scale;
        let by_inverse = self.middle_inverse * axis_ss * self.middle_scale;
        let axis = by_transpose + by_inverse;
        axis * (axis_ss.length_squared() / axis.length_squared()).sqrt()
    }

    /// Position of the hand in start joint space after the turns `start` and `middle` of the
    /// joints, computed by the job's matrices.
    pub fn hand_ss(&self, start: DQuat, middle: DQuat) -> DVec3 {
        let lower_ss = if self.middle_scale == 0.0 {
            self.lower_ss
        } else {
            self.middle_ss * (middle * (self.middle_inverse * self.lower_ss))
        };
        start * (self.upper_ss + lower_ss)
    }
}

/// Inverse of a matrix; `None` for a condition number above a million, where rounding an axis to
/// f32 moves points by some percent.
fn inverse(axes: DMat3) -> Option<DMat3> {
    const WORST_CONDITION: f64 = 1e6;
    let inverse = adjugate_inverse(axes)?;
    let condition_squared = longest_axis_squared(axes) * longest_axis_squared(inverse);
    (condition_squared <= WORST_CONDITION * WORST_CONDITION).then_some(inverse)
}

/// Inverse by cross products; `None` without one.
fn adjugate_inverse(axes: DMat3) -> Option<DMat3> {
    let cofactors = cofactors(axes);
    let determinant = axes.x_axis.dot(cofactors.x_axis);
    (determinant != 0.0).then(|| (cofactors * determinant.recip()).transpose())
}

fn longest_axis_squared(axes: DMat3) -> f64 {
    let DMat3 { x_axis, y_axis, z_axis } = axes;
    x_axis.length_squared().max(y_axis.length_squared()).max(z_axis.length_squared())
}
