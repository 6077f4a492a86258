//! The real program in a real window: a mouse drags a slider and the hand, and the screen follows.
//!
//! Needs a display without a window manager, `xdotool` and ImageMagick's `import`; the script that
//! runs all tests makes one: `scripts/test.sh`. By hand, within such a display:
//! `cargo test --test window -- --ignored`.
#![cfg(all(feature = "app", target_os = "linux"))]

mod drag;
mod keyboard;
mod loss;
mod places;
mod recovery;
mod screen;
mod typing;
