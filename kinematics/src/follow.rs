//! Path following: the joints of a chain follow the path of its head, as a snake's do.
//!
//! With bones of fixed length, joint k+1 is the first point at the distance of one bone on the way
//! back along the path from joint k:
//! |P(s_{k+1}) − P(s_k)| = d_k, s_{k+1} < s_k.

use glam::Vec3;

/// Positions of the joints for the head at parameter `head` of `path`: one more than `lengths`.
///
/// `path` must be continuous and defined before `head` for the length of the chain. `stride` is a
/// parameter step over which the path is nearly straight and crosses the sphere of one bone about a
/// joint at most once. The search for a joint ends after 10,000 strides, that for the whole chain
/// after 1,000,000: on a path that stays within one bone of a joint, the next joint is where the
/// search ends.
pub fn along(
    path: impl Fn(f64) -> Vec3,
    head: f64,
    stride: f64,
    lengths: impl IntoIterator<Item = f32>,
) -> Vec<Vec3> {
    let first = path(head);
    core::iter::once(first).chain(behind(path, head, stride, lengths)).collect()
}

/// Positions of the joints behind the first point of a line of straight segments, one for each of
/// `lengths`. The line leads away from the head; beyond its end, the joints go straight on. Takes
/// as many points of the line as the joints need.
pub fn along_line(
    line: impl IntoIterator<Item = Vec3>,
    lengths: impl IntoIterator<Item = f32>,
) -> impl Iterator<Item = Vec3> {
    let mut line = line.into_iter();
    // The last joint, and the segment of the line on which the next one is searched.
    let mut joint = line.next().unwrap_or_default();
    let mut from = joint;
    let mut to = line.next();
    let mut direction = Vec3::ZERO;
    lengths.into_iter().map(move |length| {
        while let Some(end) = to {
            direction = (end - from).try_normalize().unwrap_or(direction);
            if end.distance(joint) > length {
                break;
            }
            from = end;
            to = line.next();
        }
        from += direction * leaves_sphere(from - joint, direction, length);
        joint = from;
        joint
    })
}

/// Distance along a unit `direction`, from a point in a sphere around the origin to its surface.
fn leaves_sphere(point: Vec3, direction: Vec3, radius: f32) -> f32 {
    let along = point.dot(direction);
    let squared = along * along - point.length_squared() + radius * radius;
    squared.max(0.0).sqrt() - along
}

/// [`along`] as an iterator, without the head.
pub(crate) fn behind(
    path: impl Fn(f64) -> Vec3,
    head: f64,
    stride: f64,
    lengths: impl IntoIterator<Item = f32>,
) -> impl Iterator<Item = Vec3> {
    const MOST_STRIDES: usize = 1_000_000;
    let mut left = MOST_STRIDES;
    let mut at = head;
    lengths.into_iter().map(move |length| {
        let from = path(at);
        at = first_before(|s| path(s).distance(from) - length, at, stride, &mut left);
        path(at)
    })
}

/// Steps back from `start` by `stride` until `excess` is positive, then bisects the last step;
/// returns the path's parameter there. Each step is counted off `left`, the number of steps still
/// allowed; without a positive `excess`, the result is where the steps end.
fn first_before(excess: impl Fn(f64) -> f32, start: f64, stride: f64, left: &mut usize) -> f64 {
    const MOST_STRIDES: usize = 10_000;
    const HALVINGS: usize = 40;
    let mut near = start;
    let mut far = start;
    for _ in 0..MOST_STRIDES.min(*left) {
        if excess(far) > 0.0 {
            break;
        }
        near = far;
        far -= stride;
        *left -= 1;
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (near + far);
        if excess(middle) > 0.0 {
            far = middle;
        } else {
            near = middle;
        }
    }
    near
}
