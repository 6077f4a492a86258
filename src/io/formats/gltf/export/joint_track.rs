use std::rc::Rc;

use ::gltf::json::animation::Interpolation as Curve;
use glam::{DQuat, DVec3, Vec3};

use super::nodes::RigidTransform;
use crate::document::Timeline;
use crate::kinematics::spline::Knot;

/// Times of the file for times of the document.
#[derive(Clone, Copy)]
pub struct ClipTimes {
    start: f64,
    /// Time of the first frame in the file.
    first: f64,
}

impl ClipTimes {
    /// The first frame is at its time in the document, unless that is below 0, which glTF does not
    /// allow, or so late that single precision cannot tell the frames apart. Then it is at 0.
    pub fn new(timeline: Timeline) -> Self {
        let rounding = timeline.end * f64::from(f32::EPSILON);
        let is_exact = timeline.start >= 0.0 && rounding < 0.1 / timeline.frame_rate;
        Self { start: timeline.start, first: if is_exact { timeline.start } else { 0.0 } }
    }

    /// Time of the file in seconds for one of the document.
    pub fn of(self, time: f64) -> f64 {
        (self.first + (time - self.start)).max(0.0)
    }
}

/// The values of one node over time.
pub struct JointTrack<const N: usize> {
    pub node: usize,
    /// Times of the keys in the file, in seconds.
    pub times: Rc<Vec<f32>>,
    pub curve: Curve,
    /// One value for each key; for cubic splines the arriving slope, the value and the leaving
    /// slope.
    pub values: Vec<[f32; N]>,
    /// The keys whose curve a cubic spline is, as the file has them in `extras`; none for other
    /// curves.
    pub keys: Vec<Knot<Vec3>>,
}

/// Changes below this count as rounding errors: in radians for a rotation, relative to the distance
/// from the parent for a translation.
const LEAST: f64 = 1e-6;

impl JointTrack<4> {
    /// Returns whether the rotation ever leaves the bind pose.
    pub fn turns(&self, bind_pose: &RigidTransform) -> bool {
        let turns = |value: &[f32; 4]| {
            let rotation = DQuat::from_array(value.map(f64::from));
            let difference = same_side(bind_pose.rotation, rotation) - bind_pose.rotation;
            2.0 * difference.length() > LEAST
        };
        if self.curve == Curve::CubicSpline {
            // Between two keys, a spline without slopes stays on the shortest way.
            let slope = |slope: &[f32; 4]| slope.iter().any(|it| f64::from(it.abs()) > LEAST);
            return self
                .values
                .chunks(3)
                .any(|key| slope(&key[0]) || turns(&key[1]) || slope(&key[2]));
        }
        self.values.iter().any(turns)
    }
}

impl JointTrack<3> {
    /// Returns whether the node ever leaves the bind pose.
    pub fn moves(&self, bind_pose: &RigidTransform) -> bool {
        if self.curve == Curve::CubicSpline {
            return true;
        }
        self.values.iter().any(|value| {
            let translation = DVec3::from_array(value.map(f64::from));
            let size = translation.length().max(bind_pose.translation.length());
            translation.distance(bind_pose.translation) > LEAST * size
        })
    }
}

/// Returns `rotation` or its negative, which is the same rotation, whichever is nearer to
/// `previous`.
pub fn same_side(previous: DQuat, rotation: DQuat) -> DQuat {
    if previous.dot(rotation) < 0.0 { -rotation } else { rotation }
}
