//! A 3D inverse-kinematics arm to pose, look into and understand.
//!
//! The crate is the program `ik-arm`. Without its default features it is a library of solvers that
//! depends only on `glam`, `nalgebra`, `multiversion` and `thiserror`:
//!
//! ```
//! use glam::Vec3;
//! use ik_arm::kinematics::two_bone::TwoBone;
//!
//! let arm = TwoBone::new(200.0, 300.0)?;
//! let pose = arm.solve(Vec3::new(250.0, 120.0, 60.0), 30_f32.to_radians());
//! println!("elbow at {}, hand at {}", pose.elbow, pose.hand);
//! # Ok::<(), ik_arm::kinematics::two_bone::LengthError>(())
//! ```
//!
//! [Iterative solvers](kinematics::chain_ik) move skeletons of any shape to any number of targets.
//!
//! # Architecture
//!
//! Each module uses only modules above it in this table. Imports between the files of a module form
//! no circle (`tests/architecture.rs`).
//!
//! | module | contents | feature |
//! | --- | --- | --- |
//! | [`kinematics`] | mathematics: two-bone arms, one or a batch; twist references; soft limits; IK and FK of the arm; a two-bone job for other programs' skeletons, one or a batch; skeletons; chain solvers, seen from inside; why a target is not reached; path following; splines; skins | |
//! | [`rig`] | the arm as a hierarchy Root → Limb → Socket with limbs and guides; a skeleton with its targets and its skin; crowds of arms | |
//! | `document` | saved state: both rigs, keys, timeline, camera, display; bakes | `document` |
//! | `io` | files: reads documents, Scotty3D's skeletons, glTF and BVH; writes documents, glTF, BVH, CSV and OBJ; reads and writes lines of `ik-arm solve` | `document` |
//! | `session` | the open document and state that is not saved; actions, undo and redo; the tour | `document` |
//! | `scene` | what to draw, as plain lists | `document` |
//! | `render` | draws a scene with wgpu into a window, a PNG or a test image | `render` |
//! | `export` | files for other programs: motion, tables, meshes, pictures | `render` |
//! | `ui` | egui panels that read a session and push actions | `app` |
//! | `app` | window, surface and frame loop (winit) | `app` |
//! | `cli` | commands: solve, pose, render, export, bake, skin, examples, tour, gui | `app` |
//!
//! # One frame
//!
//! 1. Panels and viewport read the [session](session::Session) and push
//!    [actions](session::Action).
//! 2. [`apply`](session::Session::apply) checks each action, edits the document and solves again.
//! 3. If there was an action, the panels run once more, so that no panel shows the state from
//!    before the action.
//! 4. The [scene](scene::Scene) is refilled from the document and drawn if it changed; then the
//!    panels are drawn.
//!
//! Nothing is drawn while nothing changes.
//!
//! # Conventions
//!
//! - Right-handed axes: +x right, +y up, +z towards the viewer.
//! - Angles are radians in code, degrees on screen and on the command line.
//! - Where code uses two spaces, the name of a point says which space the point is in.
//! - A target out of reach gives a result, not an error. Errors name the file, the field and the
//!   rule.
//! - A pose is a function of document and time. All state that determines the pose is in the
//!   document, except unkeyed edits of keyed channels, which last until the time changes.
//! - Playback writes nothing to the document. Keys of a transported twist are measured from the
//!   stereographic map, so that a pose does not depend on the poses before it.

#![cfg_attr(docsrs, feature(doc_cfg))]

#[cfg(feature = "app")]
pub mod app;
#[cfg(feature = "app")]
pub mod cli;
#[cfg(feature = "document")]
pub mod document;
#[cfg(feature = "render")]
pub mod export;
#[cfg(feature = "document")]
pub mod io;
pub mod kinematics;
#[cfg(feature = "render")]
pub mod render;
pub mod rig;
#[cfg(feature = "document")]
pub mod scene;
#[cfg(feature = "document")]
pub mod session;
#[cfg(feature = "app")]
pub mod ui;

/// Compiles the code in README.md.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
