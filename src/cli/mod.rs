//! The command line: solve, pose, render, export, examples, gui.

mod argument;
mod examples;
mod export;
mod open;
mod pose;
mod quiet;
mod render;
mod solve;

use std::io::{self, Write as _};
use std::path::PathBuf;
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
    /// Pose a file's skeleton at a time, solved or as it stands, and print it as JSON
    Pose(pose::Args),
    /// Draw the arm or a file to a picture, without a window
    Render(render::Args),
    /// Write a file's motion or pictures for other programs: .glb, .bvh, .csv, .png, .apng
    Export(export::Args),
    /// List the scenes that come with the program, or print one
    Examples(examples::Args),
    /// Open the window (also without a command)
    Gui(GuiArgs),
}

/// Runs the program with the process's own arguments.
pub fn run() -> ExitCode {
    // rfd logs an error where the system has no file dialog; ours asks instead.
    let filter = env_logger::Env::default().default_filter_or("error,rfd=off");
    env_logger::Builder::from_env(filter).init();
    let command = Cli::parse().command;
    if let None | Some(Command::Render(_) | Command::Export(_) | Command::Gui(_)) = command {
        quiet::restart_without_device_select();
    }
    match command {
        Some(Command::Solve(args)) => solve::run(&args),
        Some(Command::Pose(args)) => pose::run(&args),
        Some(Command::Render(args)) => render::run(&args),
        Some(Command::Export(args)) => export::run(&args),
        Some(Command::Examples(args)) => examples::run(&args),
        Some(Command::Gui(args)) => gui(&args),
        None => gui(&GuiArgs::default()),
    }
}

#[derive(clap::Args, Default)]
struct GuiArgs {
    /// Document of ik-arm, .js3d scene of Scotty3D, .bvh, .glb or .gltf, to open in it
    #[arg(value_name = "FILE")]
    file: Option<PathBuf>,
    /// Which of a scene's skeletons
    #[arg(long, value_name = "NAME", requires = "file")]
    skeleton: Option<String>,
}

fn gui(args: &GuiArgs) -> ExitCode {
    let mut document = None;
    if let Some(path) = &args.file {
        match open::open(path, args.skeleton.as_deref()) {
            // A file of another program is opened, not saved over.
            Ok(opened) => {
                let file = opened.skeletons.is_empty().then(|| path.clone());
                document = Some((opened.document, file));
            }
            Err(error) => return fail(&error),
        }
    }
    match app::run(document) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => fail(&error),
    }
}

fn fail(error: &dyn std::error::Error) -> ExitCode {
    say(error);
    ExitCode::FAILURE
}

fn say(what: &dyn std::fmt::Display) {
    // Not eprintln!, which panics where stderr cannot be written.
    let _ = writeln!(io::stderr(), "ik-arm: {what}");
}
