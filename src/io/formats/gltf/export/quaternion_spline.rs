//! Rotations by keys of angles as glTF's cubic splines of quaternions.
//!
//! A curve of angles is no cubic of quaternions. Between two keys it is cut into equal pieces,
//! until the cubic through the ends of each, with the slopes of the curve there, is as near to the
//! curve as [`EXACT`].

use core::ops::{Add, Mul};

use glam::{DQuat, DVec3, Vec3};

use crate::kinematics::skeleton::exact_angles;
use crate::kinematics::spline::{Interpolation, Spline, hermite};

/// Largest angle in radians between the spline and the curve.
const EXACT: f64 = 5e-5;
/// Largest number of pieces between two keys.
const MOST_PIECES: usize = 256;

/// The rotation of a node by the angles of its joint: `before` · R(angles) · `after`.
#[derive(Clone, Copy)]
pub struct NodeRotation {
    pub before: DQuat,
    pub after: DQuat,
}

/// A key of a spline of quaternions. Slopes are per second.
#[derive(Clone, Copy)]
pub struct QuaternionKey {
    /// In the document, in seconds.
    pub time: f64,
    pub value: DQuat,
    pub arriving: DQuat,
    pub leaving: DQuat,
}

/// The keys at `times`, in seconds, which include those of `track`, and at times in between. No
/// curve of the track is a step.
pub fn keys(track: &Spline<Vec3>, times: &[f64], node: NodeRotation) -> Vec<QuaternionKey> {
    let mut keys: Vec<QuaternionKey> = Vec::new();
    for pair in times.windows(2) {
        let turn = AngleCurve::new(track, pair[0], pair[1], node);
        let mut value = keys.last().map_or_else(|| turn.rotation(0.0), |key| key.value);
        let pieces = turn.pieces(value);
        for index in 0..pieces {
            let [start, end] = [index, index + 1].map(|it| it as f64 / pieces as f64);
            let leaving = turn.slope(start, end, value);
            match keys.last_mut() {
                Some(last) => last.leaving = leaving,
                None => {
                    keys.push(QuaternionKey { time: turn.start, value, arriving: ZERO, leaving });
                }
            }
            value = turn.near(end, value);
            let arriving = turn.slope(end, start, value);
            keys.push(QuaternionKey { time: turn.time(end), value, arriving, leaving: ZERO });
        }
    }
    keys
}

const ZERO: DQuat = DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0);

/// The curve of angles between two times.
struct AngleCurve {
    node: NodeRotation,
    interpolation: Interpolation,
    start: f64,
    end: f64,
    from: DVec3,
    to: DVec3,
    /// Changes of the angles at the slopes of the ends, in the time from one to the other.
    leaving: DVec3,
    arriving: DVec3,
}

impl AngleCurve {
    fn new(track: &Spline<Vec3>, start: f64, end: f64, node: NodeRotation) -> Self {
        let Some(segment) = track.segment(start) else {
            let value = track.at(start).unwrap_or_default().as_dvec3();
            let (interpolation, still) = (Interpolation::Linear, DVec3::ZERO);
            let (leaving, arriving) = (still, still);
            return Self {
                node,
                interpolation,
                start,
                end,
                from: value,
                to: value,
                leaving,
                arriving,
            };
        };
        let slopes = [segment.from, segment.to].map(|knot| track.slopes(knot.time));
        let [leaving, arriving] =
            [slopes[0].map(|slopes| slopes.leaving), slopes[1].map(|slopes| slopes.arriving)]
                .map(|slope| slope.unwrap_or_default().as_dvec3() * (end - start));
        let [from, to] = [segment.from, segment.to].map(|knot| knot.value.as_dvec3());
        let interpolation = segment.from.interpolation;
        Self { node, interpolation, start, end, from, to, leaving, arriving }
    }

    /// Time at a part of the way, in seconds.
    fn time(&self, part: f64) -> f64 {
        if part < 1.0 { self.start + part * (self.end - self.start) } else { self.end }
    }

    fn angles(&self, part: f64) -> DVec3 {
        match self.interpolation {
            Interpolation::Step => self.from,
            Interpolation::Linear => self.from.lerp(self.to, part),
            Interpolation::Slerp => exact_angles::slerp(self.from, self.to, part),
            Interpolation::Smooth | Interpolation::Auto => {
                cubic([self.from, self.leaving, self.to, self.arriving], part)
            }
        }
    }

    fn rotation(&self, part: f64) -> DQuat {
        let angles = self.angles(part);
        let rotation = DQuat::from_rotation_z(angles.z)
            * DQuat::from_rotation_y(angles.y)
            * DQuat::from_rotation_x(angles.x);
        self.node.before * rotation * self.node.after
    }

    /// The rotation at a part of the way, with the sign that is nearer to `near`.
    fn near(&self, part: f64, near: DQuat) -> DQuat {
        same_side(near, self.rotation(part))
    }

    /// Slope per second at a part of the way, seen from the side of `towards`.
    fn slope(&self, part: f64, towards: f64, here: DQuat) -> DQuat {
        // The difference quotient of second order; its error is of the order of STEP².
        const STEP: f64 = 1e-4;
        let step = (towards - part) * STEP;
        let near = self.near(part + step, here);
        let far = self.near(part + 2.0 * step, near);
        (near * 4.0 - here * 3.0 - far) * (0.5 / (step * (self.end - self.start)))
    }

    fn pieces(&self, first: DQuat) -> usize {
        let mut pieces = 1;
        while pieces < MOST_PIECES && !self.is_exact(pieces, first) {
            pieces *= 2;
        }
        pieces
    }

    /// Returns whether the cubics of this many pieces are as near to the curve as [`EXACT`].
    fn is_exact(&self, pieces: usize, first: DQuat) -> bool {
        const INSIDE: [f64; 7] = [0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875];
        let span = (self.end - self.start) / pieces as f64;
        let mut from = first;
        (0..pieces).all(|index| {
            let [start, end] = [index, index + 1].map(|it| it as f64 / pieces as f64);
            let to = self.near(end, from);
            let ends =
                [from, self.slope(start, end, from) * span, to, self.slope(end, start, to) * span];
            from = to;
            INSIDE.into_iter().all(|inside| {
                let spline = cubic(ends, inside).normalize();
                let exact = self.near(start + inside * (end - start), spline);
                2.0 * (exact - spline).length() < EXACT
            })
        })
    }
}

/// The cubic with these values and slopes at its ends: value, slope, value, slope.
fn cubic<T: Copy + Add<Output = T> + Mul<f64, Output = T>>(
    [from, leaving, to, arriving]: [T; 4],
    s: f64,
) -> T {
    let [of_from, of_leaving, of_to, of_arriving] = hermite(s);
    from * of_from + leaving * of_leaving + to * of_to + arriving * of_arriving
}

/// Returns `rotation` or its negative, which is the same rotation, whichever is nearer to
/// `previous`.
pub fn same_side(previous: DQuat, rotation: DQuat) -> DQuat {
    if previous.dot(rotation) < 0.0 { -rotation } else { rotation }
}
