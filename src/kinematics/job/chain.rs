use glam::{Affine3A, DMat3, DQuat, DVec3};

use super::error::{JobError, JobField, check_similarity};

/// The three joints of a job in start joint space, in the unit of this space.
pub(super) struct JointChain {
    /// Position of the start joint, in model space.
    start: DVec3,
    /// M_s: the start joint's axes in model space, as columns. If they have scale 0, this is the
    /// identity: no joint can turn, and start joint space is model space.
    axes: DMat3,
    /// M_s⁻¹.
    axes_inverse: DMat3,
    /// Whether the start joint's axes have a scale other than 0.
    can_turn: bool,
    /// u, the vector from the start joint to the middle joint.
    upper_ss: DVec3,
    /// l, the vector from the middle joint to the end joint.
    lower_ss: DVec3,
    /// M_s⁻¹·M_m: the middle joint's axes, as columns; 0 if no joint can turn.
    middle_ss: DMat3,
    /// Rotation that takes axes of turns from middle joint space to start joint space: that of
    /// `middle_ss`, without its scale and mirror. (A mirrored turn about an axis is the opposite
    /// turn about the mirrored axis.)
    pub middle_turn: DQuat,
    /// Rounding of the joints' positions: about an ulp of their largest model space coordinate,
    /// times the largest factor by which M_s⁻¹ lengthens an axis.
    rounding_ss: f64,
}

/// Vectors along the two bones in start joint space, divided by the chain's length `unit`.
pub(super) struct LimbBones {
    pub upper_ss: DVec3,
    pub lower_ss: DVec3,
    /// The chain's length, in start joint space.
    pub unit: f64,
    /// Whether both bones have lengths above 0 and the middle joint can turn the lower bone.
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
        check_similarity(JobField::Middle, middle_ss)?;
        let largest = [start, middle, end].map(|point| point.abs().max_element());
        let largest = largest.into_iter().fold(0.0, f64::max);
        Ok(Self {
            start,
            axes,
            axes_inverse,
            can_turn,
            upper_ss: axes_inverse * (middle - start),
            lower_ss: axes_inverse * (end - middle),
            middle_ss,
            middle_turn: nearest_turn(middle_ss),
            rounding_ss: largest * f64::from(f32::EPSILON) * longest_axis(axes_inverse),
        })
    }

    /// The chain's length L, in start joint space.
    pub fn length_ss(&self) -> f64 {
        self.upper_ss.length() + self.lower_ss.length()
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
        let unit = self.length_ss();
        let (upper_ss, lower_ss) = (self.upper_ss / unit, self.lower_ss / unit);
        let is_jointed = self.upper_ss != DVec3::ZERO
            && self.lower_ss != DVec3::ZERO
            && self.middle_ss != DMat3::ZERO;
        let can_point = (upper_ss + lower_ss).try_normalize().is_some();
        let rounding = self.rounding_ss / unit;
        let limb = LimbBones { upper_ss, lower_ss, unit, is_jointed, rounding };
        (self.can_turn && (is_jointed || can_point)).then_some(limb)
    }

    /// Position of the hand in start joint space after the turns `start` and `middle` of the
    /// joints, computed by the job's matrices.
    pub fn hand_ss(&self, start: DQuat, middle: DQuat) -> DVec3 {
        let lower_ss = if self.middle_ss == DMat3::ZERO {
            self.lower_ss
        } else {
            self.middle_ss * (middle * (self.middle_ss.inverse() * self.lower_ss))
        };
        start * (self.upper_ss + lower_ss)
    }
}

impl LimbBones {
    /// The bones' lengths d₁ and d₂, in chain lengths.
    pub fn lengths(&self) -> (f64, f64) {
        (self.upper_ss.length(), self.lower_ss.length())
    }

    /// Position of the uncorrected hand relative to the start joint.
    pub fn hand_ss(&self) -> DVec3 {
        self.upper_ss + self.lower_ss
    }
}

/// Inverse of a matrix; `None` for a condition number above a million, where rounding an axis to
/// f32 moves points by some percent.
fn inverse(axes: DMat3) -> Option<DMat3> {
    const WORST_CONDITION: f64 = 1e6;
    if axes.determinant() == 0.0 {
        return None;
    }
    let inverse = axes.inverse();
    let condition = longest_axis(axes) * longest_axis(inverse);
    (condition <= WORST_CONDITION).then_some(inverse)
}

fn longest_axis(axes: DMat3) -> f64 {
    axes.x_axis.length().max(axes.y_axis.length()).max(axes.z_axis.length())
}

/// The rotation nearest to a matrix, without scale and mirror: its polar decomposition by Newton's
/// iteration, which converges quadratically. The identity for the zero matrix.
fn nearest_turn(axes: DMat3) -> DQuat {
    const STEPS: usize = 3;
    if axes == DMat3::ZERO {
        return DQuat::IDENTITY;
    }
    let even = axes * axes.determinant().cbrt().recip();
    let nearest = (0..STEPS).fold(even, |m, _| (m + m.inverse().transpose()) * 0.5);
    DQuat::from_mat3(&nearest).normalize()
}
