//! A 3D inverse-kinematics arm to pose, look into and understand.
//!
//! The crate is the program `ik-arm`. Its solvers are a library of their own,
//! [`ik_arm_kinematics`], which other programs use without this crate.
//!
//! # Architecture
//!
//! Each module uses only modules above it in this table. Imports between the files of a module form
//! no circle (`tests/architecture.rs`).
//!
//! | module | contents | feature |
//! | --- | --- | --- |
//! | `kinematics` | [`ik_arm_kinematics`], re-exported: arms, skeletons and their solvers; its floors are listed there | |
//! | [`words`] | diagnoses and their remedies as sentences | |
//! | [`document`] | saved state: the rig, keys, timeline, camera, display; motions, their inspections and bakes | |
//! | [`io`] | files: reads documents, Scotty3D's skeletons, glTF and BVH; writes documents, glTF, BVH, CSV and OBJ; reads and writes lines of `ik-arm solve`, and links | |
//! | [`session`] | the open document and state that is not saved; actions, undo and redo; the tour | |
//! | [`scene`] | what to draw, as plain lists | |
//! | `render` | draws a scene with wgpu into a window, a PNG or a test image | `app` |
//! | `export` | files for other programs: motion, tables, meshes, pictures | `app` |
//! | `ui` | egui panels that read a session and push actions | `app` |
//! | `app` | window, surface and frame loop (winit), on a computer or in a page of a browser | `app` |
//! | `cli` | commands: solve, pose, check, render, export, bake, skin, examples, tour, gui | `app` |
//!
//! # One frame
//!
//! 1. Panels and viewport read the [session](session::Session) and push
//!    [actions](session::Action).
//! 2. [`apply`](session::Session::apply) checks each action, edits the document and solves again.
//! 3. If there was an action, the panels run once more, so that no panel shows the state from
//!    before the action.
//! 4. The [scene](scene::Scene) is refilled from the pose and drawn if it changed; then the
//!    panels are drawn.
//!
//! Nothing is drawn while nothing changes. A figure's motion is a [track](document::Track): each
//! step continues from the one before, so that a pose late in a long motion takes a while after an
//! edit. The view then shows a provisional pose, while a thread [inspects](session::InspectionJob)
//! the motion and computes its states on the way.
//!
//! # Conventions
//!
//! - Right-handed axes: +x right, +y up, +z towards the viewer.
//! - Angles are radians in code, degrees on screen and on the command line.
//! - Where code uses two spaces, the name of a point says which space the point is in.
//! - A target out of reach gives a result, not an error. Errors name the file, the field and the
//!   rule.
//! - A pose is a function of document and time, and a [`Track`](document::Track) is the only way
//!   to it: it gives a [`Posed`](document::Posed), which solves the rig once. All state that
//!   determines the pose is in the document, except unkeyed edits of keyed channels, which last
//!   until the time changes.
//! - Playback writes nothing to the document, except keys while heads follow the mouse.

#![cfg_attr(docsrs, feature(doc_cfg))]

#[cfg(feature = "app")]
pub mod app;
#[cfg(all(feature = "app", not(target_arch = "wasm32")))]
pub mod cli;
pub mod document;
#[cfg(feature = "app")]
pub mod export;
pub mod io;
#[cfg(feature = "app")]
pub mod render;
pub mod scene;
pub mod session;
#[cfg(feature = "app")]
pub mod ui;
pub mod words;

pub use ik_arm_kinematics as kinematics;
pub use ik_arm_kinematics::rig;

/// Compiles the code in README.md.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
