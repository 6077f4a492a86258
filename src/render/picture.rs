use std::fs;
use std::io::{self, Cursor};
use std::path::Path;
use std::time::{Duration, Instant};

use image::RgbaImage;
use thiserror::Error;

use super::canvas::ReadError;
use super::{Canvas, Gpu, Renderer};
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
}

/// Why a picture is not on the disk.
#[derive(Debug, Error)]
pub enum SaveError {
    #[error(transparent)]
    Read(#[from] ReadError),
    #[error("{path} could not be written: there is no folder {folder}")]
    NoFolder { path: String, folder: String },
    #[error("{path} could not be written: {source}")]
    Write { path: String, source: io::Error },
    #[error("{path} could not be written: {source}")]
    Encode { path: String, source: image::ImageError },
}

impl<'a> Picture<'a> {
    pub fn new(gpu: &'a Gpu, width: u32, height: u32, scale: f32) -> Self {
        Self { gpu, renderer: Renderer::new(gpu), canvas: Canvas::new(gpu, width, height), scale }
    }

    /// # Errors
    ///
    /// If the device fails meanwhile.
    pub fn draw(&mut self, scene: &Scene) -> Result<RgbaImage, ReadError> {
        self.renderer.draw(self.gpu, scene, &self.canvas, self.scale);
        self.canvas.read(self.gpu)
    }

    /// Draws the scene that `scene` makes anew `frames` times, waiting for the device each time.
    ///
    /// # Errors
    ///
    /// If the device fails meanwhile.
    pub fn time(
        &mut self,
        frames: u32,
        mut scene: impl FnMut() -> Scene,
    ) -> Result<Timings, ReadError> {
        let (mut cpu, mut frame) = (Vec::new(), Vec::new());
        for _ in 0..frames {
            let start = Instant::now();
            self.renderer.draw(self.gpu, &scene(), &self.canvas, self.scale);
            cpu.push(start.elapsed());
            self.gpu.device.poll(wgpu::PollType::wait_indefinitely())?;
            frame.push(start.elapsed());
        }
        Ok(Timings { frames, cpu: median(cpu), frame: median(frame) })
    }
}

/// Writes a picture as PNG, whole or not at all: to a new file beside it first. What is no file, such
/// as a pipe or a device, is written to as it is.
///
/// # Errors
///
/// If the folder or the file cannot be written.
pub fn save(image: &RgbaImage, path: &Path) -> Result<(), SaveError> {
    let failed = |source| SaveError::Write { path: path.display().to_string(), source };
    let encode = |out: &mut dyn io::Write| {
        let mut png = Cursor::new(Vec::new());
        image
            .write_to(&mut png, image::ImageFormat::Png)
            .map_err(|source| SaveError::Encode { path: path.display().to_string(), source })?;
        out.write_all(png.get_ref()).map_err(failed)
    };
    match fs::metadata(path) {
        Ok(there) if there.is_dir() => return Err(failed(io::ErrorKind::IsADirectory.into())),
        Ok(there) if !there.is_file() => {
            return encode(&mut fs::OpenOptions::new().write(true).open(path).map_err(failed)?);
        }
        _ => {}
    }
    // Where a link leads, so that it stays a link.
    let path = &fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    if !folder.is_dir() {
        return Err(SaveError::NoFolder {
            path: path.display().to_string(),
            folder: folder.display().to_string(),
        });
    }
    let mut file = temporary_file(folder).map_err(failed)?;
    encode(&mut file)?;
    file.as_file().sync_all().map_err(failed)?;
    file.persist(path).map_err(|error| failed(error.error))?;
    Ok(())
}

/// With the rights that a new file has here, not the private ones of a temporary file.
fn temporary_file(folder: &Path) -> io::Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}

fn median(mut times: Vec<Duration>) -> Duration {
    times.sort_unstable();
    times.get(times.len() / 2).copied().unwrap_or_default()
}
