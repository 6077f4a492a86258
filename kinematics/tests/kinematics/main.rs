//! The library of kinematics against independent twins: f64, finite differences, matrix products.

mod balance;
mod balance_target;
mod binding;
mod chain_ik;
mod chain_ik_gradient;
#[path = "../common/mod.rs"]
mod common;
mod cones;
mod diagnose;
mod evaluate;
mod figure_limbs;
mod fk;
mod humanoid;
mod ik;
mod limb_frames;
mod limb_ik;
mod null_space_drag;
mod orientation;
mod places;
mod pop;
mod reach_region;
mod skeleton;
mod skin_from_bones;
mod skinning;
mod soft_reach;
mod solver_inside;
mod spline;
mod stiffness;
mod swing;
mod target_match;
mod track;
mod twist;
mod two_bone;
mod two_bone_accuracy;
mod two_bone_job;
