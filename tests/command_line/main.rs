//! The commands of `ik-arm`, run as processes.
#![cfg(feature = "app")]

mod bake;
mod check;
#[path = "../common/mod.rs"]
mod common;
mod convert;
mod examples;
mod export;
mod limits;
mod pose;
mod render;
mod shell;
mod skin;
mod solve;
mod tour;

use std::process::{Command, Output};

/// The program.
fn program() -> Command {
    Command::new(env!("CARGO_BIN_EXE_ik-arm"))
}

fn run(arguments: &[&str]) -> Output {
    program().args(arguments).output().expect("the program runs")
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}
