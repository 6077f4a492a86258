//! `ik-arm completions` and `ik-arm manual`: files that an installation gives to a shell and to `man`.

use std::fs;
use std::io::{self, Write as _};
use std::path::PathBuf;

use clap::Command;
use clap_complete::Shell;

use super::report::CommandError;

/// Arguments of `ik-arm completions`.
#[derive(clap::Args)]
pub struct CompletionsArgs {
    /// The shell
    shell: Shell,
}

/// Arguments of `ik-arm manual`.
#[derive(clap::Args)]
pub struct ManualArgs {
    /// Folder for the pages; it is made if it does not exist
    folder: PathBuf,
}

/// Prints a shell's completions of commands and options.
pub fn print_completions(args: &CompletionsArgs, mut command: Command) -> Result<(), CommandError> {
    let name = command.get_name().to_owned();
    // Written to memory first: clap_complete panics if its output is closed.
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut command, name, &mut script);
    Ok(io::stdout().lock().write_all(&script)?)
}

/// Writes the pages, one for the program and one for each command.
pub fn write_manual(args: &ManualArgs, command: Command) -> Result<(), CommandError> {
    let ManualArgs { folder } = args;
    fs::create_dir_all(folder)
        .and_then(|()| clap_mangen::generate_to(command.disable_help_subcommand(true), folder))
        .map_err(|error| CommandError::Manual { folder: folder.clone(), error })
}
