//! x
#[cfg(feature = "app")]
pub mod app;
#[cfg(feature = "app")]
pub mod cli;
#[cfg(feature = "document")]
pub mod document;
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
