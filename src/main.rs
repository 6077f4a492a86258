//! The program `ik-arm`: an inverse-kinematics arm on screen and on the command line.

#[cfg(not(target_arch = "wasm32"))]
fn main() -> std::process::ExitCode {
    ik_arm::cli::run()
}

#[cfg(target_arch = "wasm32")]
fn main() {
    if let Err(error) = ik_arm::app::run() {
        panic!("{error}");
    }
}
