//! Inverse and forward kinematics as pure functions of numbers.

pub mod angle;
pub mod batch;
pub mod chain_ik;
pub mod diagnosis;
pub mod euler;
pub mod fk;
pub mod follow;
pub mod ik;
pub mod job;
pub mod limb_ik;
mod normalize;
pub mod pop;
mod rotation_between;
mod saturate;
mod shared;
pub mod skeleton;
pub mod skin;
pub mod soft_reach;
pub mod spline;
pub mod swing;
pub mod twist;
pub mod two_bone;

pub use shared::Shared;

pub(crate) use normalize::normalize;
pub(crate) use rotation_between::rotation_between;
#[cfg(feature = "app")]
pub(crate) use saturate::saturate_vector;
