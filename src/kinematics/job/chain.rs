use glam::{Affine3A, DMat3, DQuat, DVec3};

use super::error::{JobError, JobField, check_similarity};

/// The three joints in start joint space, in its own unit.
pub(super) struct JointChain {
    /// The start joint, in model space.
    start: DVec3,
    /// M_s: the start joint's axes in model space. Where they have scale 0, no joint can turn, and start
    /// joint space is model space.
    axes: DMat3,
    /// M_s⁻¹.
    axes_inverse: DMat3,
    can_turn: bool,
    /// u, from start to middle.
    upper_ss: DVec3,
    /// l, from middle to end.
    lower_ss: DVec3,
    /// M_s⁻¹·M_m: the middle joint's axes; 0 where no joint can turn.
    middle_ss: DMat3,
    /// Rotation from middle joint space to start joint space without scale and mirror, for axes. (A
    /// rotation about an axis is the opposite rotation about the axis's mirror image.)
    pub middle_turn: DQuat,
    /// About an ulp of the joints' largest model space coordinate, along the axis that magnifies it
    /// most.
    rounding_ss: f64,
}

/// The two bones in start joint space, in units of the chain's length.
pub(super) struct LimbBones {
    pub upper_ss: DVec3,
    pub lower_ss: DVec3,
    /// The chain's length in start joint space.
    pub unit: f64,
    /// Whether both bones have a length and the middle joint can turn the lower one.
    pub is_jointed: bool,
    /// Displacement of a joint by the rounding of its coordinates.
    pub rounding: f64,
}

impl JointChain {
    /// Refuses a start joint whose matrix has no inverse (scale 0 is accepted), and a middle joint
    /// whose axes are uneven or skew in start joint space.
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

    /// L.
    pub fn length_ss(&self) -> f64 {
        self.upper_ss.length() + self.lower_ss.length()
    }

    /// A model space point.
    pub fn point_ss(&self, point: DVec3) -> DVec3 {
        self.vector_ss(point - self.start)
    }

    /// A model space vector.
    pub fn vector_ss(&self, vector: DVec3) -> DVec3 {
        self.axes_inverse * vector
    }

    /// A vector's length in model space.
    pub fn length_in_model(&self, vector_ss: DVec3) -> f64 {
        (self.axes * vector_ss).length()
    }

    /// The bones; `None` where there is nothing to turn, or no joint can turn.
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

    /// The hand after both joints are turned, by the given matrices.
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
    /// d₁ and d₂.
    pub fn lengths(&self) -> (f64, f64) {
        (self.upper_ss.length(), self.lower_ss.length())
    }

    /// The uncorrected hand, from the start joint.
    pub fn hand_ss(&self) -> DVec3 {
        self.upper_ss + self.lower_ss
    }
}

/// The inverse; `None` for a condition number above a million, where rounding an axis to f32 moves
/// points by some percent.
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

/// The nearest rotation to axes, without scale and mirror: the polar decomposition by Newton's
/// iteration, which converges quadratically.
fn nearest_turn(axes: DMat3) -> DQuat {
    const STEPS: usize = 3;
    if axes == DMat3::ZERO {
        return DQuat::IDENTITY;
    }
    let even = axes * axes.determinant().cbrt().recip();
    let nearest = (0..STEPS).fold(even, |m, _| (m + m.inverse().transpose()) * 0.5);
    DQuat::from_mat3(&nearest).normalize()
}
