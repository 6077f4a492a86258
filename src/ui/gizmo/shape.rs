//! Geometry and colours that gizmos have in common.

use egui::{Color32, Pos2};

pub(in crate::ui) fn bright(colour: Color32) -> Color32 {
    colour.lerp_to_gamma(Color32::WHITE, 0.35)
}

/// Distance in points from a screen position to a line segment; infinite if an end of the segment
/// is not finite, as behind the eye.
pub(in crate::ui) fn to_segment(at: Pos2, from: Pos2, to: Pos2) -> f32 {
    if !(from.is_finite() && to.is_finite()) {
        return f32::INFINITY;
    }
    let along = to - from;
    let part = if along.length_sq() > 0.0 {
        ((at - from).dot(along) / along.length_sq()).clamp(0.0, 1.0)
    } else {
        0.0
    };
    at.distance(from + along * part)
}
