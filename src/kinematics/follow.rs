//! Path following: joints of a chain on the path of its head.
//!
//! Every joint of a snake is where its head was before. With bones of fixed length, joint k+1 is the
//! first point at a distance of one bone when the path is followed back from joint k:
//! |P(s_{k+1}) − P(s_k)| = d_k, s_{k+1} < s_k.

use glam::Vec3;

/// Positions of the joints for the head at parameter `head` of `path`: one more than `lengths`.
///
/// `path` must be continuous and defined before `head` as far as the chain reaches back. `stride` is
/// a parameter step over which the path is nearly straight and leaves a bone's reach at most once. A
/// joint is at most 10,000 strides behind the one before it, and the whole chain 1,000,000: on a path
/// that never goes one bone away, joints stop there.
pub fn along(
    path: impl Fn(f64) -> Vec3,
    head: f64,
    stride: f64,
    lengths: impl IntoIterator<Item = f32>,
) -> Vec<Vec3> {
    let first = path(head);
    core::iter::once(first).chain(behind(path, head, stride, lengths)).collect()
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
        at = back_by(|s| path(s).distance(from) - length, at, stride, &mut left);
        path(at)
    })
}

/// The parameter before `start` at which `beyond` becomes positive, by at most so many strides.
fn back_by(beyond: impl Fn(f64) -> f32, start: f64, stride: f64, left: &mut usize) -> f64 {
    const MOST_STRIDES: usize = 10_000;
    const HALVINGS: usize = 40;
    let mut near = start;
    let mut far = start;
    for _ in 0..MOST_STRIDES.min(*left) {
        if beyond(far) > 0.0 {
            break;
        }
        near = far;
        far -= stride;
        *left -= 1;
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (near + far);
        if beyond(middle) > 0.0 {
            far = middle;
        } else {
            near = middle;
        }
    }
    near
}
