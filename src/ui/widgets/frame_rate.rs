//! The number of frames per second.

use egui::DragValue;

use crate::document::Timeline;

/// A field for a number of frames per second, which need not be whole.
pub(in crate::ui) fn frame_rate(rate: &mut f64) -> DragValue<'_> {
    let range = Timeline::MIN_FRAME_RATE..=Timeline::MAX_FRAME_RATE;
    DragValue::new(rate).speed(0.25).max_decimals(3).range(range)
}
