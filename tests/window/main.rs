//! The real program in a real window: a mouse drags a slider and the hand, and the screen follows.
//!
//! Needs a display without a window manager, `xdotool` and ImageMagick's `import`.
//! `scripts/test.sh` starts such a display; within one, `cargo test --test window -- --ignored`
//! runs the tests.
#![cfg(all(feature = "app", target_os = "linux"))]

mod display;
mod drag;
mod keyboard;
mod loss;
mod pictures;
mod places;
mod recovery;
mod screen;
mod typing;
mod why;

use places::Places;
use screen::Program;
use tempfile::TempDir;

/// The program in a window, with a folder for its settings and the places of its widgets.
fn open() -> (TempDir, Places, Program) {
    open_to_debug("")
}

/// The same with `IK_ARM_DEBUG` set to `debug`.
fn open_to_debug(debug: &str) -> (TempDir, Places, Program) {
    let folder = tempfile::tempdir().expect("a folder");
    let program = Program::open_to_debug(folder.path(), debug);
    (folder, Places::new(), program)
}
