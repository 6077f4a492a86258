//! Draws a [`Scene`](crate::scene::Scene) with wgpu. The window, PNG files and the test images are
//! drawn by the same code.
//!
//! A [`Renderer`] holds the pipelines and is created once per device; a [`Canvas`] is its render
//! target. Each kind of part that is drawn has one file here and one shader of the same name.

mod atlas;
mod backdrop;
mod canvas;
mod compute;
mod crowd;
mod crowd_error;
mod crowd_lod;
mod crowd_solver;
mod font;
mod font_face;
mod globe;
mod glyph_sheet;
mod gpu;
mod gpu_timer;
mod ignored_letters;
mod instance_buffer;
mod label;
mod label_places;
mod line;
mod mesh;
mod picture;
mod pipeline;
mod quads;
mod readback;
mod renderer;
mod shaders;
mod shadow;
mod shell;
mod skin;
mod skin_deformer;
mod skin_material;
mod solid;
mod solid_mesh;
mod sphere_order;
mod spheres;
mod system_fonts;
mod texture_painter;
mod texture_sampler;
mod triangle_painter;
mod uniforms;
mod view;

pub use canvas::{Canvas, ReadError};
pub use crowd_error::CrowdError;
pub use crowd_solver::CrowdSolver;
pub use gpu::{DeviceError, Gpu, GpuError};
pub use gpu_timer::{GpuTimer, TimedPass};
pub use picture::{DrawError, PictureRenderer, SavePictureError, Timings, save};
pub use renderer::{Counts, Renderer};
pub use shaders::shaders;
pub use skin_deformer::SkinDeformer;
pub use system_fonts::SystemFace;
pub use texture_painter::TexturePainter;
pub use triangle_painter::{Corner, TrianglePainter};
