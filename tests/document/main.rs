//! Documents and sessions: what is evaluated, edited, played and drawn as plain lists.

mod arm_figures;
mod bake;
mod balance;
mod body_follows;
mod bones;
mod chains;
#[path = "../common/mod.rs"]
mod common;
mod dissolve;
mod drawn;
mod edits;
mod elbow_circle;
mod examples;
mod framing;
mod gallery;
mod grab;
mod inspection;
mod keys;
mod leg_pops;
mod posing;
mod reach_regions;
mod session;
mod session_edges;
mod session_pops;
mod snake;
mod snake_head;
mod soak;
mod solver_runs;
mod straight_legs;
mod tadpoles;
mod target_spaces;
mod tour;
mod track;
mod up_axis;
