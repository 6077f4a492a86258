//! Widgets of which the panels consist. They depend on no panel.

mod angle_slider;
mod button;
mod colour_bar;
mod error_label;
mod field;
pub(in crate::ui) mod format;
mod frame_rate;
mod icon_button;
mod key_button;
mod number;
pub(in crate::ui) mod plot;
mod point;
mod section;
mod segments;
mod slider;
mod soft_reach_sliders;
pub(in crate::ui) mod symbol;
mod tabs;

pub(in crate::ui) use angle_slider::{angle_slider, euler_sliders};
pub(in crate::ui) use button::{button, primary_button};
pub(in crate::ui) use colour_bar::colour_bar;
pub(in crate::ui) use error_label::error_label;
pub(in crate::ui) use field::NumberField;
pub(in crate::ui) use frame_rate::frame_rate;
pub(in crate::ui) use icon_button::{Icon, IconButton, diamond};
pub(in crate::ui) use key_button::KeyButton;
pub(in crate::ui) use number::DragNumber;
pub(in crate::ui) use point::{AXES, PointSliders};
pub(in crate::ui) use section::{
    at_right, fold_opened_sections, folded_section, named_section, open_section, pair, section,
    section_with, term_pair,
};
pub(in crate::ui) use segments::{Segment, segments};
pub(in crate::ui) use slider::Slider;
pub(in crate::ui) use soft_reach_sliders::soft_reach_sliders;
pub(in crate::ui) use tabs::{Tab, tabs};
