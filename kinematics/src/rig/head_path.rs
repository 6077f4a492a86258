use core::iter::once;

use glam::Vec3;

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

/// Number of points between a knot and the next: so many that a body of this length covers at least
/// 256, but at most 64.
fn steps(knots: &[Knot<Vec3>], index: usize, length: f32) -> usize {
    const ON_BODY: f32 = 256.0;
    const MOST: f32 = 64.0;
    // The tangents at the ends depend on the neighbours.
    let around = &knots[index.saturating_sub(1)..(index + 3).min(knots.len())];
    let distance: f32 = around.windows(2).map(|pair| pair[0].value.distance(pair[1].value)).sum();
    let steps = (ON_BODY * distance / length).ceil();
    // Also for NaN, of a body without length.
    if steps < MOST { steps.max(1.0) as usize } else { MOST as usize }
}
