use glam::{DMat3, DQuat, DVec3};

use super::TwoBoneJob;

/// The three joints, relative to the start joint, in model space.
pub(super) struct Chain {
    /// Where the start joint is.
    pub start: DVec3,
    /// From start to middle.
    upper: DVec3,
    /// From middle to end.
    lower: DVec3,
    start_axes: DMat3,
    middle_axes: DMat3,
    /// From middle joint space to start joint space, scales and mirrors left out: what an axis is
    /// turned by. (A turn about an axis is one about the axis's mirror image the other way round.)
    pub middle_turn: DQuat,
    /// An ulp of the joints' largest coordinate, or a little more.
    pub rounding: f64,
}

/// The two bones in start joint space, in units of the chain's length.
pub(super) struct Limb {
    pub upper_ss: DVec3,
    pub lower_ss: DVec3,
    /// What 1 is in start joint space.
    pub unit: f64,
    /// Whether both are bones, and the middle joint can turn the lower one.
    pub is_jointed: bool,
    /// What the coordinates' rounding makes of each bone.
    pub rounding: f64,
}

impl Chain {
    pub fn new(job: &TwoBoneJob) -> Self {
        let joints = [job.start, job.middle, job.end];
        let [start, middle, end] = joints.map(|joint| joint.translation.as_dvec3());
        let [start_axes, middle_axes, _] = joints.map(|joint| joint.matrix3.as_dmat3());
        let largest = [start, middle, end].map(|point| point.abs().max_element());
        Self {
            start,
            upper: middle - start,
            lower: end - middle,
            start_axes,
            middle_axes,
            middle_turn: turn_between(start_axes, middle_axes),
            rounding: largest.into_iter().fold(0.0, f64::max) * f64::from(f32::EPSILON),
        }
    }

    /// L.
    pub fn length(&self) -> f64 {
        self.upper.length() + self.lower.length()
    }

    /// A vector of model space; nothing where the start joint has scale 0.
    pub fn vector_ss(&self, vector: DVec3) -> Option<DVec3> {
        (self.start_axes != DMat3::ZERO).then(|| self.start_axes.inverse() * vector)
    }

    /// Nothing where there is nothing to turn, or nothing that could turn it.
    pub fn limb_ss(&self) -> Option<Limb> {
        let (upper, lower) = (self.vector_ss(self.upper)?, self.vector_ss(self.lower)?);
        let unit = upper.length() + lower.length();
        let (upper_ss, lower_ss) = (upper / unit, lower / unit);
        let is_jointed =
            upper != DVec3::ZERO && lower != DVec3::ZERO && self.middle_axes != DMat3::ZERO;
        let can_turn = (upper_ss + lower_ss).try_normalize().is_some();
        let rounding = self.rounding / self.length();
        (is_jointed || can_turn).then_some(Limb { upper_ss, lower_ss, unit, is_jointed, rounding })
    }

    /// From the start joint to the hand after both joints are turned, in model space.
    pub fn hand(&self, start: DQuat, middle: DQuat) -> DVec3 {
        let lower = turned(self.middle_axes, middle, self.lower);
        turned(self.start_axes, start, self.upper + lower)
    }
}

impl Limb {
    /// d₁ and d₂.
    pub fn lengths(&self) -> (f64, f64) {
        (self.upper_ss.length(), self.lower_ss.length())
    }

    /// From the start joint, before anything is turned.
    pub fn hand_ss(&self) -> DVec3 {
        self.upper_ss + self.lower_ss
    }
}

/// A vector that hangs on a joint, after the joint is turned in its own space.
fn turned(axes: DMat3, turn: DQuat, vector: DVec3) -> DVec3 {
    if axes == DMat3::ZERO { vector } else { axes * (turn * (axes.inverse() * vector)) }
}

/// The rotation that is nearest to what is between two joints, without scale and mirror: the polar
/// decomposition by Newton's iteration, each step of which squares what is uneven or skew.
fn turn_between(start_axes: DMat3, middle_axes: DMat3) -> DQuat {
    const STEPS: usize = 3;
    if start_axes == DMat3::ZERO || middle_axes == DMat3::ZERO {
        return DQuat::IDENTITY;
    }
    let between = start_axes.inverse() * middle_axes;
    let even = between * between.determinant().cbrt().recip();
    let nearest = (0..STEPS).fold(even, |m, _| (m + m.inverse().transpose()) * 0.5);
    DQuat::from_mat3(&nearest).normalize()
}
