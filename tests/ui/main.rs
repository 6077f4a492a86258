//! Panels and viewport, operated as by a user: the tests press widgets by their names, the
//! mouse drags the hand on screen, and the session is checked.
#![cfg(feature = "app")]

mod accessibility;
mod arm_handles;
mod arm_pin;
mod arm_posing;
mod bake;
mod balance;
mod bench;
#[path = "../common/mod.rs"]
mod common;
mod controls;
mod crowd;
mod dialogs;
mod example_pictures;
mod export;
mod figure_pops;
mod figures;
mod first_click;
mod gallery;
mod glossary;
mod grabbing;
mod graph_editor;
mod habits;
mod hand;
mod hand_keys;
mod history;
mod inside;
mod limits;
mod looks;
mod numbers;
mod own_mesh;
mod panel;
mod pops;
mod reach_curve;
mod safe_hands;
mod skeleton_keys;
mod skeleton_panel;
mod skeleton_view;
mod skin;
mod sliders;
mod snake;
mod start;
mod statistics;
mod targets;
mod timeline;
mod timeline_keys;
mod timeline_looks;
mod touch;
mod tour;
mod view;
mod view_keys;
mod why;
mod wiggle;
