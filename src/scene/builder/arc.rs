use core::f32::consts::TAU;

use glam::{Quat, Vec3};

use crate::scene::{Colour, Line, Scene};

/// Number of lines of a whole circle.
pub(super) const SEGMENTS: u16 = 64;

/// Adds an arc that begins at `centre + start` and goes round `axis`.
pub(super) fn add_arc(
    scene: &mut Scene,
    centre: Vec3,
    start: Vec3,
    axis: Vec3,
    angle: f32,
    colour: Colour,
) {
    let Some(axis) = axis.try_normalize() else { return };
    let count = (f32::from(SEGMENTS) * angle.abs() / TAU).ceil().clamp(1.0, 256.0) as u16;
    let point = |index: u16| {
        centre + Quat::from_axis_angle(axis, angle * f32::from(index) / f32::from(count)) * start
    };
    let line = |index| Line { from: point(index), to: point(index + 1), colour, dashed: false };
    scene.lines.extend((0..count).map(line));
}
