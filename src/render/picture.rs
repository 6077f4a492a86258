use std::io::Cursor;
use std::path::Path;
use std::time::{Duration, Instant};

use image::RgbaImage;
use thiserror::Error;

use super::canvas::ReadError;
use super::gpu::DeviceError;
use super::{Canvas, Gpu, Renderer};
use crate::io::{self, WriteError};
use crate::scene::Scene;

/// A scene drawn without a window.
#[derive(Debug)]
pub struct Picture<'a> {
    gpu: &'a Gpu,
    renderer: Renderer,
    canvas: Canvas,
    scale: f32,
}

/// How long frames took, each waited for: medians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timings {
    pub frames: u32,
    /// Until the device had its orders.
    pub cpu: Duration,
    /// Until it had carried them out.
    pub frame: Duration,
    /// What of it was the solving of a crowd, where there was one.
    pub solve: Option<Duration>,
}

/// Why there is no picture.
#[derive(Debug, Error)]
pub enum DrawError {
    #[error("a picture of {width}x{height} is larger than this device draws: {longest} at most")]
    TooLarge { width: u32, height: u32, longest: u32 },
    #[error(transparent)]
    Device(#[from] DeviceError),
    #[error(transparent)]
    Read(#[from] ReadError),
}

/// Why a picture is not on the disk.
#[derive(Debug, Error)]
pub enum SaveError {
    #[error(transparent)]
    Draw(#[from] DrawError),
    #[error(transparent)]
    Write(#[from] WriteError),
    #[error("{path} could not be written: {source}")]
    Encode { path: String, source: image::ImageError },
}

impl<'a> Picture<'a> {
    pub fn new(gpu: &'a Gpu, width: u32, height: u32, scale: f32) -> Self {
        Self { gpu, renderer: Renderer::new(gpu), canvas: Canvas::new(gpu, width, height), scale }
    }

    /// Lines and letters are as large as in a window of 1280×800, in larger pictures larger.
    ///
    /// # Errors
    ///
    /// If the device cannot draw one so large.
    pub fn of_size(gpu: &'a Gpu, width: u32, height: u32) -> Result<Self, DrawError> {
        const WINDOW: f32 = 800.0;
        let longest = gpu.longest_side();
        if width.max(height) > longest {
            return Err(DrawError::TooLarge { width, height, longest });
        }
        let scale = (width.min(height) as f32 / WINDOW).max(1.0);
        Ok(gpu.watched(|| Self::new(gpu, width, height, scale))?)
    }

    /// # Errors
    ///
    /// If the device fails meanwhile.
    pub fn draw(&mut self, scene: &Scene) -> Result<RgbaImage, DrawError> {
        let (gpu, renderer, canvas) = (self.gpu, &mut self.renderer, &self.canvas);
        let image = gpu.watched(|| {
            renderer.draw(gpu, scene, canvas, self.scale);
            canvas.read(gpu)
        })?;
        Ok(image?)
    }

    /// Whether there was a crowd in the scene that was drawn last, and it could be.
    pub fn has_crowd(&self) -> bool {
        self.renderer.crowd_times().is_some()
    }

    /// Draws the scenes that `scene` makes, the first, second and so on of `frames`, waiting for the
    /// device each time.
    ///
    /// # Errors
    ///
    /// If the device fails meanwhile.
    pub fn time(
        &mut self,
        frames: u32,
        mut scene: impl FnMut(u32) -> Scene,
    ) -> Result<Timings, ReadError> {
        let (mut cpu, mut frame, mut solve) = (Vec::new(), Vec::new(), Vec::new());
        for number in 0..frames {
            let start = Instant::now();
            let scene = scene(number);
            self.renderer.draw(self.gpu, &scene, &self.canvas, self.scale);
            cpu.push(start.elapsed());
            self.gpu.device.poll(wgpu::PollType::wait_indefinitely())?;
            frame.push(start.elapsed());
            solve.extend(self.renderer.crowd_times().map(|times| times.solve));
        }
        let solve = (!solve.is_empty()).then(|| median(solve));
        Ok(Timings { frames, cpu: median(cpu), frame: median(frame), solve })
    }
}

/// Writes a picture as PNG, whole or not at all: see [`io::write`].
///
/// # Errors
///
/// If the folder or the file cannot be written.
pub fn save(image: &RgbaImage, path: &Path) -> Result<(), SaveError> {
    let mut png = Cursor::new(Vec::new());
    image
        .write_to(&mut png, image::ImageFormat::Png)
        .map_err(|source| SaveError::Encode { path: path.display().to_string(), source })?;
    Ok(io::write(path, png.get_ref())?)
}

fn median(mut times: Vec<Duration>) -> Duration {
    times.sort_unstable();
    times.get(times.len() / 2).copied().unwrap_or_default()
}
