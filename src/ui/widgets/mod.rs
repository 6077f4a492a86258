//! Widgets of which the panels consist. They depend on no panel.

mod buttons;
mod choices;
mod number;
pub(in crate::ui) mod plot;
mod section;
mod slider;
pub(in crate::ui) mod text;

pub(in crate::ui) use buttons::{
    Icon, IconButton, KeyButton, button, diamond, fold_mark, primary_button, wide_button,
};
pub(in crate::ui) use choices::{
    Choice, check_box, check_boxes, explained, menu_item, name, overlay_check_box, segment,
    segments, tabs,
};
pub(in crate::ui) use number::{DragNumber, NumberField, frame_rate};
pub(in crate::ui) use plot::colour_bar;
pub(in crate::ui) use section::{
    at_right, fold_opened_sections, folded_section, named_folded_section, named_section,
    named_section_with, open_section, pair, section, section_with, term_pair, value, whole_rows,
};
pub(in crate::ui) use slider::{
    AXES, PointSliders, Slider, angle_slider, euler_sliders, requested_steps, requested_values,
    set_range, soft_reach_sliders, with_axis,
};
pub(in crate::ui) use text::error_label;
