//! `ik-arm manual`: pages for `man`, one for the program and one for each command.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use thiserror::Error;

use super::report::fail;

use crate::io::system_reason;

/// Arguments of `ik-arm manual`.
#[derive(clap::Args)]
pub struct ManualArgs {
    /// Folder for the pages; it is made if it does not exist
    folder: PathBuf,
}

#[derive(Debug, Error)]
#[error("cannot write the pages to {}: {}", folder.display(), system_reason(source))]
struct ManualError {
    folder: PathBuf,
    source: io::Error,
}

pub fn run(args: &ManualArgs, command: clap::Command) -> ExitCode {
    match write(&args.folder, command) {
        Ok(()) => ExitCode::SUCCESS,
        Err(source) => fail(&ManualError { folder: args.folder.clone(), source }),
    }
}

fn write(folder: &Path, command: clap::Command) -> io::Result<()> {
    fs::create_dir_all(folder)?;
    clap_mangen::generate_to(command.disable_help_subcommand(true), folder)
}
