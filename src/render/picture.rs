use std::io::Cursor;
use std::path::Path;
use std::time::Duration;

use image::RgbaImage;
use thiserror::Error;
use web_time::Instant;

use super::gpu::DeviceError;
use super::readback::ReadError;
use super::{Canvas, CrowdError, Gpu, Renderer};
use crate::io::{self, WriteError};
use crate::rig::CrowdTimes;
use crate::scene::Scene;

/// Draws scenes to images, without a window.
#[derive(Debug)]
pub struct PictureRenderer<'a> {
    gpu: &'a Gpu,
    renderer: Renderer,
    canvas: Canvas,
    scale: f32,
}

/// Median times of frames. The device finishes each frame before the next one starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timings {
    /// Number of frames.
    pub frames: u32,
    /// Time from the start of a frame until all its commands are submitted.
    pub cpu: Duration,
    /// Time from the start of a frame until the device has executed its commands.
    pub frame: Duration,
    /// Time to solve the crowd, a part of `frame`; `None` without a crowd.
    pub solve: Option<Duration>,
}

/// Reasons why a picture is not drawn.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum DrawError {
    /// The picture is larger than the largest texture of the device.
    #[error(
        "picture sides must be at most {longest} on this graphics device, got {width}x{height}"
    )]
    TooLarge {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
        /// Maximum side of a picture on this device, in pixels.
        longest: u32,
    },
    /// The device failed while it drew.
    #[error(transparent)]
    Device(#[from] DeviceError),
    /// The picture could not be copied from the device.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// The wait for the device failed.
    #[error("the graphics device did not finish the picture: {0}")]
    Poll(#[from] wgpu::PollError),
}

/// Reasons why a picture is not saved.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SavePictureError {
    /// The file could not be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// PNG encoding failed.
    #[error("{path} could not be encoded: {source}")]
    Encode {
        /// File that was to be written.
        path: String,
        /// The encoder's error.
        source: image::ImageError,
    },
}

impl<'a> PictureRenderer<'a> {
    /// Creates a renderer for pictures of one size in pixels. `scale` is the number of pixels per
    /// point, the unit for the sizes of lines and letters.
    pub fn new(gpu: &'a Gpu, width: u32, height: u32, scale: f32) -> Self {
        Self { gpu, renderer: Renderer::new(gpu), canvas: Canvas::new(gpu, width, height), scale }
    }

    /// Creates a renderer whose lines and letters are as large as in a window of 1280×800, and
    /// scaled up in larger pictures.
    ///
    /// # Errors
    ///
    /// If the picture is too large for the device, or the device fails.
    pub async fn of_size(gpu: &'a Gpu, width: u32, height: u32) -> Result<Self, DrawError> {
        const WINDOW_HEIGHT: f32 = 800.0;
        let longest = gpu.longest_side();
        if width.max(height) > longest {
            return Err(DrawError::TooLarge { width, height, longest });
        }
        let scale = (width.min(height) as f32 / WINDOW_HEIGHT).max(1.0);
        Ok(gpu.watched(async || Self::new(gpu, width, height, scale)).await?)
    }

    /// Draws a scene and reads the image back.
    ///
    /// # Errors
    ///
    /// If the device fails.
    pub async fn draw(&mut self, scene: &Scene) -> Result<RgbaImage, DrawError> {
        let (gpu, renderer, canvas) = (self.gpu, &mut self.renderer, &self.canvas);
        let drawn = gpu.watched(async || {
            renderer.draw(gpu, scene, canvas, self.scale);
            canvas.read(gpu).await
        });
        Ok(drawn.await??)
    }

    /// Number of arms and solver time of the crowd in the last scene; `None` without a crowd.
    ///
    /// # Errors
    ///
    /// If the crowd could not be drawn.
    pub fn crowd_times(&self) -> Result<Option<CrowdTimes>, CrowdError> {
        self.renderer.crowd_times()
    }

    /// Draws `frames` scenes, waits for the device after each of them, and returns the median
    /// times. `scene` makes the scene of a frame from its number, which starts at 0.
    ///
    /// # Errors
    ///
    /// If the device fails.
    pub async fn time(
        &mut self,
        frames: u32,
        mut scene: impl FnMut(u32) -> Scene,
    ) -> Result<Timings, DrawError> {
        let (mut cpu, mut frame, mut solve) = (Vec::new(), Vec::new(), Vec::new());
        for number in 0..frames {
            let start = Instant::now();
            let scene = scene(number);
            let (gpu, renderer, canvas) = (self.gpu, &mut self.renderer, &self.canvas);
            gpu.watched(async || renderer.draw(gpu, &scene, canvas, self.scale)).await?;
            cpu.push(start.elapsed());
            self.gpu.device.poll(wgpu::PollType::wait_indefinitely())?;
            frame.push(start.elapsed());
            solve.extend(self.renderer.crowd_times().ok().flatten().map(|times| times.solve));
        }
        self.gpu.check()?;
        let solve = (!solve.is_empty()).then(|| median(solve));
        Ok(Timings { frames, cpu: median(cpu), frame: median(frame), solve })
    }
}

/// Writes a picture as PNG, completely or not at all: see [`io::write`].
///
/// # Errors
///
/// If the picture cannot be encoded or the file cannot be written.
pub fn save(image: &RgbaImage, path: &Path) -> Result<(), SavePictureError> {
    let mut png = Cursor::new(Vec::new());
    image
        .write_to(&mut png, image::ImageFormat::Png)
        .map_err(|source| SavePictureError::Encode { path: path.display().to_string(), source })?;
    Ok(io::write(path, png.get_ref())?)
}

fn median(mut times: Vec<Duration>) -> Duration {
    times.sort_unstable();
    times.get(times.len() / 2).copied().unwrap_or_default()
}
