//! The program `ik-arm`: an inverse-kinematics arm on screen and on the command line.

use std::process::ExitCode;

fn main() -> ExitCode {
    ik_arm::cli::run()
}
