use std::process::ExitCode;

fn main() -> ExitCode {
    ik_arm::cli::run()
}
