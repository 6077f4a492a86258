use egui::Color32;
use egui_plot::LineStyle;

use super::value_scale::ValueKind;
use crate::document::Channel;

/// The curve of one component of a channel.
pub(super) struct ChannelCurve {
    pub channel: Channel,
    /// Component of the channel's values: 0, 1 or 2.
    pub axis: usize,
    pub kind: ValueKind,
    pub name: String,
    pub colour: Color32,
    pub style: LineStyle,
    /// Times in seconds and displayed values of the samples.
    pub line: Vec<[f64; 2]>,
    /// Times in seconds and displayed values of the keys.
    pub knots: Vec<[f64; 2]>,
}
