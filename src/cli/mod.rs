//! The command line: solve, render, gui.

mod render;
mod solve;

use std::io::{self, Write as _};
use std::process::ExitCode;

use clap::{Parser, Subcommand};

use crate::app;

/// A 3D inverse-kinematics arm to pose, look into and understand.
///
/// Without a command it opens the window.
#[derive(Parser)]
#[command(name = "ik-arm", version)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Subcommand)]
enum Command {
    /// Solve poses, one JSON object per line in, one per line out
    Solve(solve::Args),
    /// Open the window (also without a command)
    Gui,
    /// Draw the arm to a picture, without a window
    Render(render::Args),
}

/// Runs the program with the process's own arguments.
pub fn run() -> ExitCode {
    env_logger::Builder::from_env(env_logger::Env::default().default_filter_or("error")).init();
    match Cli::parse().command {
        Some(Command::Solve(args)) => solve::run(&args),
        Some(Command::Render(args)) => render::run(&args),
        Some(Command::Gui) | None => gui(),
    }
}

fn gui() -> ExitCode {
    match app::run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => fail(&error),
    }
}

fn fail(error: &dyn std::error::Error) -> ExitCode {
    // Not eprintln!, which panics where stderr cannot be written.
    let _ = writeln!(io::stderr(), "ik-arm: {error}");
    ExitCode::FAILURE
}
