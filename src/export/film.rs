use std::io::Write;
use std::path::Path;

use super::format::Numbered;
use super::{ExportError, Options};
use crate::document::{Document, Theme};
use crate::io::{self, Exported, FileBatch, Frames, Playback, Progress};
use crate::render::{Gpu, Picture};
use crate::scene::Scene;
use crate::session::Overlays;

/// One picture.
pub fn still(
    document: &Document,
    options: &Options,
    progress: &Progress,
) -> Result<Exported, ExportError> {
    let time = options.time.unwrap_or(document.timeline.start);
    if !time.is_finite() {
        return Err(ExportError::Time(time));
    }
    let gpu = Gpu::headless()?;
    let mut film = Film::new(document, options, &gpu)?;
    progress.step(0, 1)?;
    let bytes = png(options.size, &film.picture(time)?)?;
    progress.step(1, 1)?;
    Ok(Exported { bytes, notes: Vec::new() })
}

/// A file for each frame, all or none.
pub fn sequence(
    document: &Document,
    path: &Path,
    options: &Options,
    progress: &Progress,
) -> Result<Vec<String>, ExportError> {
    let frames = Frames::of_picture(document, options.fps)?;
    let Some(numbered) = Numbered::new(path) else {
        return Err(ExportError::Ending { path: path.display().to_string() });
    };
    let mut batch = FileBatch::beside(path)?;
    let gpu = Gpu::headless()?;
    let mut film = Film::new(document, options, &gpu)?;
    for frame in 0..frames.count() {
        progress.step(frame, frames.count())?;
        let pixels = film.picture(frames.time(frame))?;
        batch.add(&numbered.name(frame), &png(options.size, &pixels)?)?;
    }
    progress.step(frames.count(), frames.count())?;
    batch.finish()?;
    Ok(Vec::new())
}

/// All frames in one animated PNG that plays for ever.
pub fn animation(
    document: &Document,
    path: &Path,
    options: &Options,
    progress: &Progress,
) -> Result<Vec<String>, ExportError> {
    const FOR_EVER: u32 = 0;
    let frames = Frames::of_picture(document, options.fps)?;
    let count = u32::try_from(frames.count()).map_err(|_| ExportError::Frames(frames.count()))?;
    // Frame rates are at most 1000.
    let rate = u16::try_from(frames.rate()).unwrap_or(u16::MAX);
    let gpu = Gpu::headless()?;
    let mut film = Film::new(document, options, &gpu)?;
    io::write_with(path, |file| {
        let mut encoder = encoder(file, options.size);
        encoder.set_animated(count, FOR_EVER)?;
        encoder.set_frame_delay(1, rate)?;
        let mut writer = encoder.write_header()?;
        for frame in 0..frames.count() {
            progress.step(frame, frames.count())?;
            writer.write_image_data(&film.picture(frames.time(frame))?)?;
        }
        progress.step(frames.count(), frames.count())?;
        Ok::<(), ExportError>(writer.finish()?)
    })?;
    Ok(Vec::new())
}

/// Takes pictures of a document, one after the other.
struct Film<'a> {
    playback: Playback,
    overlays: Overlays,
    picture: Picture<'a>,
    theme: Theme,
}

impl<'a> Film<'a> {
    fn new(document: &Document, options: &Options, gpu: &'a Gpu) -> Result<Self, ExportError> {
        let (width, height) = options.size;
        Ok(Self {
            playback: Playback::new(document),
            overlays: Overlays::new(document, document.timeline.start),
            picture: Picture::of_size(gpu, width, height)?,
            theme: options.theme,
        })
    }

    /// Rows from the top, four bytes for each pixel.
    fn picture(&mut self, time: f64) -> Result<Vec<u8>, ExportError> {
        let document = self.playback.at(time);
        self.overlays = std::mem::take(&mut self.overlays).at(document, time);
        let scene = Scene::new(document, &self.overlays, self.theme);
        Ok(self.picture.draw(&scene)?.into_raw())
    }
}

fn png(size: (u32, u32), pixels: &[u8]) -> Result<Vec<u8>, ExportError> {
    let mut bytes = Vec::new();
    let mut writer = encoder(&mut bytes, size).write_header()?;
    writer.write_image_data(pixels)?;
    writer.finish()?;
    Ok(bytes)
}

fn encoder<W: Write>(output: W, (width, height): (u32, u32)) -> png::Encoder<'static, W> {
    let mut encoder = png::Encoder::new(output, width, height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder
}
