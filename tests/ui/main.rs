//! The panels and the viewport as a person uses them: widgets are pressed by their names, the
//! hand is dragged where it is seen, and the session is checked.
#![cfg(feature = "app")]

mod accessibility;
mod arm_posing;
mod bench;
mod crowd;
mod dialogs;
mod export;
mod first_click;
mod gallery;
mod hand;
mod hand_keys;
mod history;
mod looks;
mod numbers;
mod panel;
mod pops;
mod reach_curve;
mod safe_hands;
mod skeleton_keys;
mod skeleton_panel;
mod skeleton_view;
mod sliders;
mod statistics;
mod timeline;
mod timeline_keys;
mod timeline_looks;
mod view;
mod view_keys;
