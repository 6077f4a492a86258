//! Inverse and forward kinematics of arms and skeletons, as pure functions of numbers.
//!
//! ```
//! use glam::Vec3;
//! use ik_arm_kinematics::two_bone::TwoBone;
//!
//! let arm = TwoBone::new(200.0, 300.0)?;
//! let pose = arm.solve(Vec3::new(250.0, 120.0, 60.0), 30_f32.to_radians());
//! println!("elbow at {}, hand at {}", pose.elbow, pose.hand);
//! # Ok::<(), ik_arm_kinematics::two_bone::LengthError>(())
//! ```
//!
//! [`job::TwoBoneJob`] turns the joints of a limb in somebody else's skeleton.
//! [Iterative solvers](chain_ik) move skeletons of any shape to any number of targets.
//!
//! # Architecture
//!
//! Each module uses only modules of its own row and of the rows above. Imports between files form
//! no circle. A test of the repository checks both.
//!
//! | modules | contents |
//! | --- | --- |
//! | [`angle`], [`follow`], [`spline`], `shared`, `vector` | angles, rotations, curves, points along a path |
//! | [`two_bone`] | the closed form of two bones |
//! | [`batch`], [`soft_reach`], [`twist`] | many arms at once; a hand that slows down before the arm is straight; twist references |
//! | [`fk`], [`ik`], [`job`], [`pop`] | the arm by its joint angles and by its hand; correcting a limb of another program's skeleton; why an elbow jumped |
//! | [`skeleton`] | trees of joints, their forward kinematics, their limits and their balance |
//! | [`humanoid`], [`limb_ik`], [`skin`] | which joints are a person's arms, legs and head; limbs of skeletons in closed form; skins and how they follow the joints |
//! | [`chain_ik`], [`diagnosis`] | iterative solvers, seen from inside; why a target is not reached and what would help |
//! | [`rig`] | what is posed: the arm as Root → Limb → Socket, a skeleton with its targets, balance and skin, crowds of arms; steps of motions and their pops; reach regions |
//!
//! # Conventions
//!
//! - Right-handed axes: +x right, +y up, +z towards the viewer.
//! - Angles are radians.
//! - A target out of reach gives a result, not an error. Errors name the field and the rule.
//!
//! # Features
//!
//! `parallel` solves batches on all cores (rayon). `serde` implements `Serialize` and `Deserialize`
//! for skeletons, targets, options of solvers and their reports.

pub mod angle;
pub mod batch;
pub mod chain_ik;
pub mod diagnosis;
pub mod fk;
pub mod follow;
pub mod humanoid;
pub mod ik;
pub mod job;
pub mod limb_ik;
pub mod pop;
pub mod rig;
mod shared;
pub mod skeleton;
pub mod skin;
pub mod soft_reach;
pub mod spline;
pub mod twist;
pub mod two_bone;
mod vector;

pub use shared::Shared;

pub(crate) use vector::{normalize, rotation_between};

/// Compiles the code in README.md.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
