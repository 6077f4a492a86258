//! The commands of `ik-arm`, run as processes.
#![cfg(feature = "app")]

mod bake;
#[path = "../common/mod.rs"]
mod common;
mod convert;
mod examples;
mod export;
mod pose;
mod render;
mod shell;
mod skin;
mod solve;
mod tour;
