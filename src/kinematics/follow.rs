//! Follow the leader: the joints of a chain on the path that its head has gone.
//!
//! A snake that is led by its head has every joint where the head was before. With bones of fixed
//! length a joint k+1 is the last point of the path, going back from joint k, that is one bone
//! away: |P(s_{k+1}) − P(s_k)| = d_k, s_{k+1} < s_k.

use glam::Vec3;

/// Where the joints are when the head is at parameter `head` of `path`: one point more than there
/// are `lengths`.
///
/// `path` must be continuous and defined before `head` as far as the chain reaches back; `stride` is
/// a difference of parameters over which it is nearly straight and does not leave a joint's reach
/// twice. On a path that never goes one bone away the joint stays some thousand strides back, and
/// after a million strides of the whole chain what is left of it stays where it is.
pub fn along(
    path: impl Fn(f64) -> Vec3,
    head: f64,
    stride: f64,
    lengths: impl IntoIterator<Item = f32>,
) -> Vec<Vec3> {
    let first = path(head);
    core::iter::once(first).chain(behind(path, head, stride, lengths)).collect()
}

/// The same one after the other, without the head.
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
