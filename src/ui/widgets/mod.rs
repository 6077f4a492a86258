//! Widgets of which the panels consist. They depend on no panel.

mod buttons;
mod choices;
mod number;
pub(in crate::ui) mod plot;
mod section;
mod slider;
pub(in crate::ui) mod text;

pub(in crate::ui) use buttons::{Icon, IconButton, KeyButton, button, diamond, primary_button};
pub(in crate::ui) use choices::{Choice, Segment, Tab, check_boxes, segments, tabs};
pub(in crate::ui) use number::{DragNumber, NumberField, frame_rate};
pub(in crate::ui) use plot::colour_bar;
pub(in crate::ui) use section::{
    at_right, fold_opened_sections, folded_section, named_section, open_section, pair, section,
    section_with, term_pair,
};
pub(in crate::ui) use slider::Slider;
pub(in crate::ui) use slider::{
    AXES, PointSliders, angle_slider, euler_sliders, soft_reach_sliders,
};
pub(in crate::ui) use text::error_label;
