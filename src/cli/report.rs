use std::error::Error;
use std::fmt::Display;
use std::io::{self, Write as _};
use std::process::ExitCode;

/// Exit code that shells expect of a program ended by Ctrl+C.
pub const INTERRUPTED: u8 = 130;
/// Exit code of clap's usage errors.
pub const USAGE: u8 = 2;

/// Prints an error and returns the exit code of a failure.
pub fn fail(error: &dyn Error) -> ExitCode {
    say(error);
    ExitCode::FAILURE
}

/// Prints a message to standard error.
pub fn say(message: &dyn Display) {
    // Not eprintln!, which panics where standard error cannot be written.
    let _ = writeln!(io::stderr(), "ik-arm: {message}");
}
