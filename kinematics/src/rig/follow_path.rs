use core::f64::consts::TAU;
use core::iter::{empty, once};

use glam::{Affine3A, Vec3};

use super::target::Target;
use crate::skeleton::{JointId, Skeleton};
use crate::spline::{Knot, Spline};

/// A path that a chain of joints follows, as a snake follows its head. The chain is a root, called
/// the head, that root's first child, and so on.
///
/// If limits keep a joint's tip off the path, the next joint starts at that tip and turns back
/// towards the path. Locked joints follow, too.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FollowPath {
    /// The head: a joint without a parent.
    pub root: JointId,
    /// The cause of the head's motion.
    pub kind: PathKind,
}

/// The cause of the motion of a head whose chain follows a path.
///
/// Behind the path that a key or a target gives, the joints' own angles give the line of the body.
/// A joint keeps its roll as far as the least rotation from its own direction to the path does;
/// where the path turns back in space, the roll can turn quickly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PathKind {
    /// The head moves around a ring.
    Ring(WavyRing),
    /// The keys of the head move it, and the chain follows the path that the head has travelled
    /// since its first key. Until then, or without keys, the joints keep their own angles.
    Head,
    /// The enabled target of the head moves it, and the chain follows the path that the target has
    /// travelled. That target moves nothing else, whatever its influence. Without such a target the
    /// joints keep their own angles.
    Target,
}

impl PathKind {
    /// True if the path has finite lengths and a period above 0.
    pub fn is_valid(&self) -> bool {
        match self {
            Self::Ring(WavyRing { radius, amplitude, waves: _, period }) => {
                let are_finite = [radius, amplitude, period].into_iter().all(|it| it.is_finite());
                are_finite && *period > 0.0
            }
            Self::Head | Self::Target => true,
        }
    }
}

/// A closed path: a circle around the origin of skeleton space, at the height of the head, with
/// waves on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WavyRing {
    /// Radius of the circle, in skeleton space.
    pub radius: f32,
    /// Amplitude of the waves, in skeleton space.
    pub amplitude: f32,
    /// Number of waves on the circle.
    pub waves: u32,
    /// Duration of one revolution in seconds.
    pub period: f32,
}

impl WavyRing {
    /// Point of the ring in skeleton space, at height 0, after `turns` revolutions around the
    /// circle.
    pub fn point(&self, turns: f64) -> Vec3 {
        let turn = turns.rem_euclid(1.0) * TAU;
        let wave = f64::from(self.amplitude) * (turn * f64::from(self.waves)).sin();
        let radius = f64::from(self.radius) + wave;
        Vec3::new((radius * turn.cos()) as f32, 0.0, (-radius * turn.sin()) as f32)
    }

    /// Number of revolutions around the circle up to a time in seconds.
    pub fn turns_at(&self, time: f64) -> f64 {
        time / f64::from(self.period)
    }

    /// Number of revolutions over which the ring is nearly straight.
    pub(super) fn stride(&self) -> f64 {
        const STRIDES_PER_WAVE: f64 = 64.0;
        1.0 / (STRIDES_PER_WAVE * f64::from(self.waves.max(1)))
    }

    /// Ends of two perpendicular diameters of the circle that encloses the ring, at height 0, in
    /// the world.
    pub fn corners(&self, skeleton: &Skeleton) -> [Vec3; 4] {
        let far = self.radius.abs() + self.amplitude.abs();
        [Vec3::X, Vec3::NEG_X, Vec3::Z, Vec3::NEG_Z]
            .map(|side| skeleton.transform().transform_point3(side * far))
    }

    /// Points of the ring in the world, from `from` to `to` revolutions. `transform` maps skeleton
    /// space to the world; `height` is the ring's height in skeleton space.
    pub fn trail(
        &self,
        transform: Affine3A,
        height: f32,
        from: f64,
        to: f64,
    ) -> impl Iterator<Item = Vec3> {
        const POINTS: usize = 256;
        let at = move |fraction: f64| from + (to - from) * fraction;
        (0..=POINTS)
            .map(move |index| self.point(at(index as f64 / POINTS as f64)) + Vec3::Y * height)
            .map(move |point| transform.transform_point3(point))
    }
}

/// The path that a head with keys has travelled until a time, as points in skeleton space, the
/// newest first: where the head is; the spline through its keys, from the time back to the first
/// key; and the body behind the first key, given by the vectors from joint to joint.
///
/// The head is beside the spline if an edit without a key has moved it.
pub(super) fn travelled_by_head<'a>(
    head: Vec3,
    keys: &'a Spline<Vec3>,
    time: f64,
    body: &'a [Vec3],
) -> impl Iterator<Item = Vec3> + 'a {
    let first = keys.knots().first().map_or(head, |knot| knot.value);
    let length = body.iter().map(|bone| bone.length()).sum();
    once(head).chain(on_spline(keys, time, length)).chain(body_behind(first, body))
}

/// The path that a target has travelled until a time, as points in the target's space, the newest
/// first: where the target is; the way back that its motion and the keys of its home give; and the
/// body behind that, given by the vectors from joint to joint.
///
/// The target is beside the path if an edit without a key has moved it.
pub(super) fn travelled_by_target<'a>(
    target: &'a Target,
    keys: Option<&'a Spline<Vec3>>,
    time: f64,
    body: Vec<Vec3>,
) -> impl Iterator<Item = Vec3> + 'a {
    let past = move |time: f64| {
        let home = keys.and_then(|keys| keys.at(time)).unwrap_or(target.present_home());
        home + target.motion.offset(time)
    };
    let length = body.iter().map(|bone| bone.length()).sum();
    let first = keys.and_then(|keys| keys.knots().first());
    let (way, start): (Box<dyn Iterator<Item = Vec3> + 'a>, Vec3) = match (keys, first) {
        _ if target.is_moving() => {
            // 256 steps of a revolution, but at least 120 a second, for keys.
            let step = (f64::from(target.motion.period) / 256.0).min(1.0 / 120.0);
            let start = past(time - step * f64::from(MOST_STEPS));
            (Box::new(steps_back(past, time, step, length)), start)
        }
        (Some(keys), Some(first)) => (Box::new(on_spline(keys, time, length)), first.value),
        _ => (Box::new(empty()), target.at(time)),
    };
    let body: Vec<Vec3> = body_behind(start, &body).collect();
    once(target.at(time)).chain(way).chain(body)
}

/// Number of steps back in time along the path of a moving target.
const MOST_STEPS: u32 = 4096;

/// Points of a path from a time back in steps of `step` seconds, for a body of this length.
fn steps_back(
    past: impl Fn(f64) -> Vec3,
    time: f64,
    step: f64,
    length: f32,
) -> impl Iterator<Item = Vec3> {
    let back = move |steps: f64| past(time - steps * step);
    let mut last = back(0.0);
    (0..MOST_STEPS).flat_map(move |index| {
        let next = back(f64::from(index + 1));
        let parts = parts(last.distance(next), length);
        let part = |part: usize| back(f64::from(index) + part as f64 / parts as f64);
        last = next;
        (1..=parts).map(part).collect::<Vec<_>>()
    })
}

/// Number of parts of a piece of a path: so many that a body of this length covers at least 256,
/// but at most 64.
fn parts(distance: f32, length: f32) -> usize {
    const ON_BODY: f32 = 256.0;
    const MOST: f32 = 64.0;
    let parts = (ON_BODY * distance / length).ceil();
    // Also for NaN, of a body without length.
    if parts < MOST { parts.max(1.0) as usize } else { MOST as usize }
}

/// The start of a body and its points, for the vectors from joint to joint.
pub(super) fn body_behind(start: Vec3, body: &[Vec3]) -> impl Iterator<Item = Vec3> + '_ {
    let points = body.iter().scan(start, |point, bone| {
        *point += bone;
        Some(*point)
    });
    once(start).chain(points)
}

/// Points of a spline from a time back to its first knot, close together for a body of this length.
fn on_spline(keys: &Spline<Vec3>, time: f64, length: f32) -> impl Iterator<Item = Vec3> + '_ {
    let knots = keys.knots();
    let until = knots.partition_point(|knot| knot.time <= time);
    (0..until).rev().flat_map(move |index| {
        let from = knots[index].time;
        let to = knots.get(index + 1).map_or(from, |next| next.time.min(time));
        let steps = steps(knots, index, length);
        let point = move |step: usize| {
            let back = step as f64 / steps as f64;
            keys.at(to * (1.0 - back) + from * back)
        };
        (0..steps).filter_map(point)
    })
}

/// Number of points between a knot and the next.
fn steps(knots: &[Knot<Vec3>], index: usize, length: f32) -> usize {
    // The tangents at the ends depend on the neighbours.
    let around = &knots[index.saturating_sub(1)..(index + 3).min(knots.len())];
    let distance: f32 = around.windows(2).map(|pair| pair[0].value.distance(pair[1].value)).sum();
    parts(distance, length)
}
