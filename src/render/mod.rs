//! Draws a [`Scene`](crate::scene::Scene) with wgpu. The window, PNG files and the test images are
//! drawn by the same code.
//!
//! A [`Renderer`] holds the pipelines and is created once per device; a [`Canvas`] is its render
//! target. Each kind of part that is drawn has one file here and one shader of the same name.

mod backdrop;
mod canvas;
mod crowd;
mod crowd_lod;
mod crowd_solver;
mod globe;
mod gpu;
mod gpu_timer;
mod instances;
mod label;
mod label_places;
mod line;
mod mesh;
mod picture;
mod pipeline;
mod planes;
mod readback;
mod renderer;
mod shadow;
mod shell;
mod skin;
mod skin_deform;
mod skin_material;
mod skin_order;
mod solid;
mod spheres;
#[cfg_attr(target_arch = "wasm32", path = "page_fonts.rs")]
mod system_fonts;
mod texture;
mod triangle;
mod view;

pub use canvas::Canvas;
pub use crowd::CrowdError;
pub use crowd_solver::CrowdSolver;
pub use gpu::{DeviceError, Gpu, GpuError};
pub use gpu_timer::{GpuTimer, TimedPass};
pub use picture::{DrawError, PictureRenderer, SavePictureError, Timings, save};
pub use readback::ReadError;
pub use renderer::{Counts, Renderer};
pub use skin_deform::SkinDeformer;
pub use system_fonts::system_fonts;
pub use texture::{PaintTexture, TexturePainter};
pub use triangle::{Corner, TrianglePainter};

/// Names and WGSL sources of all complete shaders.
pub fn shaders() -> [(&'static str, &'static str); 16] {
    [
        ("backdrop", backdrop::SHADER),
        ("crowd_arms", crowd_lod::ARMS),
        ("crowd_cull", crowd::CULL),
        ("crowd_far", crowd_lod::FAR),
        ("crowd_solver", crowd_solver::SHADER),
        ("globe", globe::SHADER),
        ("label", label::SHADER),
        ("line", line::SHADER),
        ("planes", planes::SHADER),
        ("shadow", shadow::SHADER),
        ("shell", shell::SHADER),
        ("skin", skin::SHADER),
        ("skin_deform", skin_deform::SHADER),
        ("solid", solid::SHADER),
        ("texture", texture::SHADER),
        ("triangle", triangle::SHADER),
    ]
}
