//! A 3D inverse-kinematics arm to pose, look into and understand.
//!
//! The crate is the program `ik-arm` and, without its default features, solvers that depend
//! on `glam`, `nalgebra`, `multiversion` and `thiserror` alone:
//!
//! ```
//! use glam::Vec3;
//! use ik_arm::kinematics::two_bone::TwoBone;
//!
//! let arm = TwoBone::new(200.0, 300.0)?;
//! let pose = arm.solve(Vec3::new(250.0, 120.0, 60.0), 30_f32.to_radians());
//! println!("elbow at {}, hand {:?}", pose.elbow, pose.reach);
//! # Ok::<(), ik_arm::kinematics::two_bone::LengthError>(())
//! ```
//!
//! Trees of joints have [solvers](kinematics::chain_ik) that bring any number of tips to their targets.
//!
//! # The house
//!
//! A module uses only what stands above it.
//!
//! | module | what it is | feature |
//! | --- | --- | --- |
//! | [`kinematics`] | pure numbers: two bones, one or a batch, their swivel and reach, IK and FK of the arm, a two-bone job for other programs' skeletons, skeletons, solvers, following a path, splines | |
//! | [`rig`] | the arm as a hierarchy: Root → Limb → Socket, limbs and guides; crowds of arms | |
//! | `document` | what is saved: arm, skeleton with targets, keys in time, camera, what is shown | `document` |
//! | `io` | files: documents, Scotty3D's skeletons, glTF and BVH in; documents, glTF, BVH, tables out; lines of `ik-arm solve` | `document` |
//! | `session` | the document and what is not saved; `Action` and `apply`; undo | `document` |
//! | `scene` | what to draw: plain lists | `document` |
//! | `render` | wgpu: draws a scene into a window, a PNG or a test image | `render` |
//! | `export` | files for other programs: motions, tables, pictures | `render` |
//! | `ui` | egui panels: read a session, push actions | `app` |
//! | `app` | winit: window, surface, frame loop | `app` |
//! | `cli` | solve, pose, render, export, examples, gui | `app` |
//!
//! # One frame
//!
//! The panels and the viewport read the [session](session::Session) and push
//! [actions](session::Action); [`apply`](session::Session::apply) checks each, edits the document
//! and solves the arm again; if there was any, the panels run once more, so that none shows the
//! state before; the [scene](scene::Scene) is made from the document and drawn if it is not the one
//! on screen already; then the panels. Nothing is drawn while nothing changes.
//!
//! # Conventions
//!
//! Right-handed, +x right, +y up, +z towards the viewer. Angles are radians in code, degrees on
//! screen and on the command line. A point's name carries its space where two spaces meet. A cursor
//! out of reach is a value, not an error; errors name the file, field or value and what would be
//! right. All state that shapes the pose is in the document: pose = f(document, time). A solver's
//! iteration is an action that edits angles, like any other. Keyed channels have the values of their
//! keys; one that is edited without a new key is shown as it is edited until the time changes, which
//! is the only state of a pose that is not saved. Playing writes nothing, and never carries the elbow
//! along: a transported spin has keys that are measured from the map.

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
