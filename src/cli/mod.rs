//! The command line: one module per subcommand.

mod argument;
mod bake;
mod convert;
mod examples;
mod export;
mod gui;
mod open;
mod open_args;
mod packaging;
mod pose;
mod progress_bar;
mod quiet;
mod render;
mod report;
mod skin;
mod solve;
mod time_limit;
mod tour;
mod view_name;

use std::io::{self, ErrorKind, Write as _};
use std::process::ExitCode;

use clap::{CommandFactory as _, Parser, Subcommand};

use bake::BakeArgs;
use convert::ConvertArgs;
use examples::ExamplesArgs;
use export::ExportArgs;
use gui::GuiArgs;
use packaging::{CompletionsArgs, ManualArgs};
use pose::PoseArgs;
use render::RenderArgs;
use skin::SkinArgs;
use solve::SolveArgs;

/// Pose arms and skeletons by inverse kinematics (IK) and see how it works.
///
/// Opens the window if no command is given.
#[derive(Parser)]
#[command(name = "ik-arm", version, args_conflicts_with_subcommands = true)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    window: GuiArgs,
}

#[derive(Subcommand)]
enum Command {
    /// Solve arm poses: one JSON object per line in, one per line out
    Solve(SolveArgs),
    /// Print the pose of a file's skeleton as JSON: by its targets, by FK or by a solver
    Pose(PoseArgs),
    /// Draw the arm, a file or a crowd to a PNG, without a window
    Render(RenderArgs),
    #[command(about = export::about())]
    Export(ExportArgs),
    #[command(about = convert::about())]
    Convert(ConvertArgs),
    /// Replace a skeleton's targets by keys: a document in, a document out
    Bake(BakeArgs),
    /// Give a file's skeleton a smooth skin around its bones: a document out
    Skin(SkinArgs),
    /// List the built-in example scenes, or print one
    Examples(ExamplesArgs),
    /// Print the text of the tour that the window gives
    Tour,
    /// Print the completions of commands and options for a shell
    Completions(CompletionsArgs),
    /// Write pages for man to a folder
    Manual(ManualArgs),
    /// Open the window (also without a command)
    Gui(GuiArgs),
}

/// Runs the program with the arguments of its process.
pub fn run() -> ExitCode {
    // rfd logs an error where the system has no file dialog; the program's own dialog asks instead.
    let filter = env_logger::Env::default().default_filter_or("error,rfd=off");
    env_logger::Builder::from_env(filter).init();
    let Cli { command, window } = match Cli::try_parse() {
        Ok(parsed) => parsed,
        Err(message) => return print_message(&message),
    };
    if let None | Some(Command::Render(_) | Command::Export(_) | Command::Gui(_)) = command {
        quiet::restart_without_device_select();
    }
    let done = match command {
        Some(Command::Solve(args)) => return solve::run(&args),
        Some(Command::Export(args)) => return export::run(&args),
        Some(Command::Convert(args)) => return convert::run(&args),
        Some(Command::Pose(args)) => pose::run(&args),
        Some(Command::Render(args)) => render::run(&args),
        Some(Command::Bake(args)) => bake::run(&args),
        Some(Command::Skin(args)) => skin::run(&args),
        Some(Command::Examples(args)) => examples::run(&args),
        Some(Command::Tour) => tour::run(),
        Some(Command::Completions(args)) => packaging::print_completions(&args, Cli::command()),
        Some(Command::Manual(args)) => packaging::write_manual(&args, Cli::command()),
        Some(Command::Gui(args)) => gui::run(&args),
        None => gui::run(&window),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => error.exit(),
    }
}

/// Prints the help, the version or a usage error, and returns the exit code.
fn print_message(message: &clap::Error) -> ExitCode {
    let printed = message.print().and_then(|()| io::stdout().flush());
    match printed {
        Err(error) if error.kind() != ErrorKind::BrokenPipe && !message.use_stderr() => {
            report::say(&format_args!("cannot write to standard output: {error}"));
            ExitCode::FAILURE
        }
        _ => ExitCode::from(u8::try_from(message.exit_code()).unwrap_or(report::USAGE)),
    }
}
