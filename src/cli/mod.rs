//! The command line: one module per subcommand.

mod argument;
mod bake;
mod check;
mod convert;
mod examples;
mod export;
mod gui;
mod open;
mod pose;
mod render;
mod report;
mod skin;
mod solve;
mod time_limit;
mod tour;

use std::fs;
use std::io::{self, ErrorKind, Write as _};
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{CommandFactory as _, Parser, Subcommand};
use clap_complete::Shell;

use bake::BakeArgs;
use check::CheckArgs;
use convert::ConvertArgs;
use examples::ExamplesArgs;
use export::ExportArgs;
use gui::GuiArgs;
use pose::PoseArgs;
use render::RenderArgs;
use report::CommandError;
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
    /// Check a skeleton's motion for jumps, lost targets and sliding feet: one line of JSON
    Check(CheckArgs),
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
    Completions {
        /// The shell
        shell: Shell,
    },
    /// Write pages for man to a folder
    Manual {
        /// Folder for the pages; it is made if it does not exist
        folder: PathBuf,
    },
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
    #[cfg(target_os = "linux")]
    if let None | Some(Command::Render(_) | Command::Export(_) | Command::Gui(_)) = command {
        restart_without_device_select();
    }
    let done = match command {
        Some(Command::Solve(args)) => {
            return solve::run(&args).unwrap_or_else(|error| error.exit());
        }
        Some(Command::Pose(args)) => pose::run(&args),
        Some(Command::Check(args)) => check::run(&args),
        Some(Command::Render(args)) => render::run(&args),
        Some(Command::Export(args)) => export::run(&args),
        Some(Command::Convert(args)) => convert::run(&args),
        Some(Command::Bake(args)) => bake::run(&args),
        Some(Command::Skin(args)) => skin::run(&args),
        Some(Command::Examples(args)) => examples::run(&args),
        Some(Command::Tour) => tour::run(),
        Some(Command::Completions { shell }) => print_completions(shell),
        Some(Command::Manual { folder }) => write_manual(folder),
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

/// Prints a shell's completions of commands and options.
fn print_completions(shell: Shell) -> Result<(), CommandError> {
    let mut command = Cli::command();
    let name = command.get_name().to_owned();
    // Written to memory first: clap_complete panics if its output is closed.
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut command, name, &mut script);
    Ok(io::stdout().lock().write_all(&script)?)
}

/// Writes the pages of the manual, one for the program and one for each command.
fn write_manual(folder: PathBuf) -> Result<(), CommandError> {
    let command = Cli::command().disable_help_subcommand(true);
    fs::create_dir_all(&folder).and_then(|()| clap_mangen::generate_to(command, &folder)).map_err(
        |error| CommandError::System {
            doing: "write the pages to",
            name: folder.display().to_string(),
            error,
        },
    )
}

/// Replaces this process by one without Mesa's Vulkan layer "device select", if the layer would
/// print an error.
///
/// The layer asks the Wayland compositor for its GPU. Without `XDG_RUNTIME_DIR` there is no
/// compositor, and libwayland prints an error each time. The layer is switched off by an
/// environment variable, which must be set before a process starts: changing it later is unsafe.
#[cfg(target_os = "linux")]
fn restart_without_device_select() {
    use std::os::unix::process::CommandExt as _;
    use std::path::Path;
    use std::{env, process};

    const SWITCH: &str = "NODEVICE_SELECT";
    let runtime_folder = env::var_os("XDG_RUNTIME_DIR").unwrap_or_default();
    if Path::new(&runtime_folder).is_absolute() || env::var_os(SWITCH).is_some() {
        return;
    }
    let (Ok(program), mut arguments) = (env::current_exe(), env::args_os()) else { return };
    let name = arguments.next().unwrap_or_default();
    let mut restarted = process::Command::new(program);
    // `exec` returns only if it fails. This process then continues, and the layer prints its
    // errors.
    let error = restarted.arg0(name).args(arguments).env(SWITCH, "1").exec();
    log::debug!("cannot restart: {error}");
}
