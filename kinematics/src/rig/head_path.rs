use core::iter::{empty, once};

use glam::Vec3;

use super::target::Target;
use crate::spline::{Knot, Spline};

/// The path that a head with keys has travelled until a time, as points in skeleton space, the newest
/// first: where the head is; the spline through its keys, from the time back to the first key; and the
/// body behind the first key, given by the vectors from joint to joint.
///
/// The head is beside the spline if an edit without a key has moved it.
pub(super) fn points<'a>(
    head: Vec3,
    keys: &'a Spline<Vec3>,
    time: f64,
    body: &'a [Vec3],
) -> impl Iterator<Item = Vec3> + 'a {
    let first = keys.knots().first().map_or(head, |knot| knot.value);
    let length = body.iter().map(|bone| bone.length()).sum();
    once(head).chain(on_spline(keys, time, length)).chain(behind(first, body))
}

/// The path that a target has travelled until a time, as points in the target's space, the newest first:
/// where the target is; the way back that its motion and the keys of its home give; and the body behind
/// that, given by the vectors from joint to joint.
///
/// The target is beside the path if an edit without a key has moved it.
pub(super) fn of_target<'a>(
    target: &'a Target,
    keys: Option<&'a Spline<Vec3>>,
    time: f64,
    body: Vec<Vec3>,
) -> impl Iterator<Item = Vec3> + 'a {
    let past = move |time: f64| {
        let home = keys.and_then(|keys| keys.at(time)).unwrap_or(target.home);
        home + target.motion.offset(time)
    };
    let length = body.iter().map(|bone| bone.length()).sum();
    let first = keys.and_then(|keys| keys.knots().first());
    let (way, start): (Box<dyn Iterator<Item = Vec3> + 'a>, Vec3) = match (keys, first) {
        _ if target.is_moving() => {
            // Steps of one revolution, steps a second for keys, and the number of steps.
            let step = (f64::from(target.motion.period) / 256.0).min(1.0 / 120.0);
            let steps = 4096;
            let start = past(time - step * f64::from(steps));
            (Box::new(steps_back(past, time, (steps, step), length)), start)
        }
        (Some(keys), Some(first)) => (Box::new(on_spline(keys, time, length)), first.value),
        _ => (Box::new(empty()), target.at(time)),
    };
    let body: Vec<Vec3> = behind(start, &body).collect();
    once(target.at(time)).chain(way).chain(body)
}

/// Points of a path from a time back, for a number of steps of some seconds.
fn steps_back(
    past: impl Fn(f64) -> Vec3,
    time: f64,
    (steps, step): (u32, f64),
    length: f32,
) -> impl Iterator<Item = Vec3> {
    let back = move |steps: f64| past(time - steps * step);
    let mut last = back(0.0);
    (0..steps).flat_map(move |index| {
        let next = back(f64::from(index + 1));
        let parts = parts(last.distance(next), length);
        let part = |part: usize| back(f64::from(index) + part as f64 / parts as f64);
        last = next;
        (1..=parts).map(part).collect::<Vec<_>>()
    })
}

/// Number of parts of a piece of a path: so many that a body of this length covers at least 256, but at
/// most 64.
fn parts(distance: f32, length: f32) -> usize {
    const ON_BODY: f32 = 256.0;
    const MOST: f32 = 64.0;
    let parts = (ON_BODY * distance / length).ceil();
    // Also for NaN, of a body without length.
    if parts < MOST { parts.max(1.0) as usize } else { MOST as usize }
}

/// The start of a body and its points, for the vectors from joint to joint.
pub(super) fn behind(start: Vec3, body: &[Vec3]) -> impl Iterator<Item = Vec3> + '_ {
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
