//! Draws a [`Scene`](crate::scene::Scene) with wgpu: the same code for the window, a PNG and the
//! test images.
//!
//! A [`Renderer`] holds the pipelines and is made once for a device; a [`Canvas`] is what it draws
//! on. Each thing drawn has one file here and one shader of the same name.

mod atlas;
mod backdrop;
mod canvas;
mod compute;
mod crowd;
mod font;
mod globe;
mod gpu;
mod gpu_timer;
mod instances;
mod label;
mod line;
mod mesh;
mod order;
mod picture;
mod pipeline;
mod quads;
mod renderer;
mod shadow;
mod shell;
mod solid;
mod solve;
mod spheres;
mod system_fonts;
mod uniforms;
mod view;

pub use canvas::{Canvas, ReadError};
pub use gpu::{DeviceError, Gpu, GpuError};
pub use gpu_timer::{GpuTimer, Lap};
pub use picture::{DrawError, Picture, SaveError, Timings, save};
pub use renderer::{Counts, Renderer};
pub use solve::Solver;
pub use system_fonts::SystemFace;

/// Every shader with the name of its file, whole as it is compiled.
pub fn shaders() -> [(&'static str, &'static str); 10] {
    [
        ("arms", crowd::ARMS),
        ("backdrop", backdrop::SHADER),
        ("cull", crowd::CULL),
        ("globe", globe::SHADER),
        ("line", line::SHADER),
        ("label", label::SHADER),
        ("shadow", shadow::SHADER),
        ("shell", shell::SHADER),
        ("solid", solid::SHADER),
        ("solve", solve::SHADER),
    ]
}
