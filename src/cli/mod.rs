//! The command line: solve, render, gui.

mod render;
mod solve;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

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
    /// Draw the arm to a picture, without a window
    Render(render::Args),
}

/// Runs the program with the process's own arguments.
pub fn run() -> ExitCode {
    match Cli::parse().command {
        Some(Command::Solve(args)) => solve::run(&args),
        Some(Command::Render(args)) => render::run(&args),
        None => ExitCode::SUCCESS,
    }
}
