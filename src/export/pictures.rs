//! Exports of pictures: one, one file per frame, or all frames in one animated picture.

use std::io::Write;
use std::num::NonZero;
use std::panic::resume_unwind;
use std::path::Path;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};

use super::format::{ExportError, NumberedName};
use crate::document::{Document, Theme, Track};
use crate::io::{self, ExportFrames, ExportOptions, Exported, FileBatch, Progress};
use crate::render::{Gpu, PictureRenderer};
use crate::scene::SceneBuilder;
use crate::session::Overlays;

/// Draws one picture and encodes it as PNG.
pub async fn still(
    document: &Document,
    options: &ExportOptions,
    progress: &Progress,
) -> Result<Exported, ExportError> {
    let time = options.time.unwrap_or(document.timeline.start);
    if !time.is_finite() {
        return Err(ExportError::Time(time));
    }
    let gpu = Gpu::headless().await?;
    let mut renderer = FrameRenderer::new(document, options, &gpu).await?;
    progress.step(0, 1).await?;
    let bytes = png(options.size, &renderer.pixels(time).await?)?;
    progress.step(1, 1).await?;
    Ok(Exported { bytes, notes: Vec::new() })
}

/// Writes one picture file per frame, either all files or none.
pub async fn sequence(
    document: &Document,
    path: &Path,
    name: &NumberedName,
    options: &ExportOptions,
    progress: &Progress,
) -> Result<Vec<String>, ExportError> {
    let frames = ExportFrames::of_picture(document, options.fps)?;
    let batch = FileBatch::beside(path)?;
    let gpu = Gpu::headless().await?;
    let mut renderer = FrameRenderer::new(document, options, &gpu).await?;
    let batch = Arc::new(batch);
    let write = {
        let (batch, name, size) = (Arc::clone(&batch), name.clone(), options.size);
        move |(number, pixels): Frame| {
            Ok(batch.add(&name.with_number(number), &png(size, &pixels)?)?)
        }
    };
    let writers = FrameWriters::new(write);
    for frame in 0..frames.count() {
        progress.step(frame, frames.count()).await?;
        if !writers.add((frame, renderer.pixels(frames.time(frame)).await?))? {
            break;
        }
    }
    writers.finish()?;
    progress.step(frames.count(), frames.count()).await?;
    // The writers have ended, and with them their shares of the batch.
    if let Some(batch) = Arc::into_inner(batch) {
        batch.finish()?;
    }
    Ok(Vec::new())
}

/// Writes all frames to one animated PNG that loops for ever.
pub async fn animation(
    document: &Document,
    path: &Path,
    options: &ExportOptions,
    progress: &Progress,
) -> Result<Vec<String>, ExportError> {
    const LOOP_FOR_EVER: u32 = 0;
    let frames = ExportFrames::of_picture(document, options.fps)?;
    let count = u32::try_from(frames.count()).map_err(|_| ExportError::Frames(frames.count()))?;
    let gpu = Gpu::headless().await?;
    let mut renderer = FrameRenderer::new(document, options, &gpu).await?;
    let mut file = io::NewFile::at(path)?;
    let mut encoder = encoder(&mut file, options.size);
    encoder.set_animated(count, LOOP_FOR_EVER)?;
    let (seconds, frames_in_them) = frame_delay(frames.rate());
    encoder.set_frame_delay(seconds, frames_in_them)?;
    let mut writer = encoder.write_header()?;
    for frame in 0..frames.count() {
        progress.step(frame, frames.count()).await?;
        writer.write_image_data(&renderer.pixels(frames.time(frame)).await?)?;
    }
    progress.step(frames.count(), frames.count()).await?;
    writer.finish()?;
    Ok(file.finish().map(|()| Vec::new())?)
}

/// Draws a document at successive times.
struct FrameRenderer<'a> {
    track: Track,
    overlays: Overlays,
    builder: SceneBuilder,
    picture: PictureRenderer<'a>,
    theme: Theme,
}

impl<'a> FrameRenderer<'a> {
    async fn new(
        document: &Document,
        options: &ExportOptions,
        gpu: &'a Gpu,
    ) -> Result<Self, ExportError> {
        let (width, height) = options.size;
        let track = Track::new(document);
        Ok(Self {
            overlays: Overlays::new(&track, &track.at(document.timeline.start)),
            track,
            builder: SceneBuilder::default(),
            picture: PictureRenderer::of_size(gpu, width, height).await?,
            theme: options.theme,
        })
    }

    /// Draws the document at `time`, in seconds. Returns the RGBA pixels in rows from the top.
    async fn pixels(&mut self, time: f64) -> Result<Vec<u8>, ExportError> {
        let posed = self.track.at(time);
        self.overlays.follow(&self.track, &posed);
        let scene = self.builder.build(&posed, &self.overlays, self.theme);
        Ok(self.picture.draw(&scene).await?.into_raw())
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

/// The time of a frame as a fraction, numerator and denominator, in seconds: the most exact one
/// that an animated PNG can have.
fn frame_delay(rate: f64) -> (u16, u16) {
    let fraction = |seconds: u16| {
        let frames = (f64::from(seconds) * rate).round().clamp(1.0, f64::from(u16::MAX));
        (seconds, frames as u16)
    };
    let error = |(seconds, frames): (u16, u16)| {
        (f64::from(seconds) / f64::from(frames) - rate.recip()).abs()
    };
    let most = (f64::from(u16::MAX) / rate).clamp(1.0, f64::from(u16::MAX)) as u16;
    let better = |best, next| if error(next) < error(best) { next } else { best };
    (1..=most).map(fraction).reduce(better).unwrap_or((1, 30))
}

/// The pixels of a frame, with its number.
type Frame = (usize, Vec<u8>);

/// Encodes and writes a frame.
type WriteFrame = dyn Fn(Frame) -> Result<(), ExportError> + Send + Sync;

/// Threads that encode and write frames while the next ones are drawn, one on each core. They have
/// ended when this is dropped.
struct FrameWriters {
    write: Arc<WriteFrame>,
    /// `None` once there are no more.
    frames: Option<SyncSender<Frame>>,
    /// None in a browser, where each frame is written before the next one is drawn.
    writers: Vec<JoinHandle<Result<(), ExportError>>>,
}

impl FrameWriters {
    /// Starts the threads. Each calls `write` with the next frame until there are no more, or until
    /// it fails.
    fn new(write: impl Fn(Frame) -> Result<(), ExportError> + Send + Sync + 'static) -> Self {
        let write: Arc<WriteFrame> = Arc::new(write);
        let cores = thread::available_parallelism().map_or(1, NonZero::get);
        // As many frames wait as are written, so that memory stays small.
        let (frames, receiver) = sync_channel(cores);
        let waiting = Arc::new(Mutex::new(Some(receiver)));
        let start = |_| {
            let (waiting, write) = (Arc::clone(&waiting), Arc::clone(&write));
            let work = move || {
                while let Some(frame) = next(&waiting) {
                    // After an error nobody receives any more, so that drawing stops, too.
                    write(frame).inspect_err(|_| drop(lock(&waiting).take()))?;
                }
                Ok(())
            };
            thread::Builder::new().spawn(work).ok()
        };
        let writers = (0..cores).map_while(start).collect();
        Self { write, frames: Some(frames), writers }
    }

    /// Hands a frame over; waits while too many wait. Returns whether it will be written: not if
    /// another one has failed.
    ///
    /// # Errors
    ///
    /// The error of writing it, without threads.
    fn add(&self, frame: Frame) -> Result<bool, ExportError> {
        match &self.frames {
            Some(frames) if !self.writers.is_empty() => Ok(frames.send(frame).is_ok()),
            _ => (self.write)(frame).map(|()| true),
        }
    }

    /// Waits until all frames are written.
    ///
    /// # Errors
    ///
    /// The first error of a thread.
    fn finish(mut self) -> Result<(), ExportError> {
        let ends = self.join();
        let ends = ends.into_iter().map(|end| end.unwrap_or_else(|panic| resume_unwind(panic)));
        ends.collect()
    }

    /// Lets the threads end, and waits for all of them, also after an error.
    fn join(&mut self) -> Vec<thread::Result<Result<(), ExportError>>> {
        self.frames = None;
        self.writers.drain(..).map(JoinHandle::join).collect()
    }
}

impl Drop for FrameWriters {
    fn drop(&mut self) {
        self.join();
    }
}

/// Frames that wait; `None` after an error.
type Waiting = Mutex<Option<Receiver<Frame>>>;

fn lock(waiting: &Waiting) -> MutexGuard<'_, Option<Receiver<Frame>>> {
    waiting.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The next frame; `None` if there are no more.
fn next(waiting: &Waiting) -> Option<Frame> {
    lock(waiting).as_ref()?.recv().ok()
}

#[cfg(test)]
mod tests {
    use super::frame_delay;

    #[test]
    fn frames_last_as_long_as_the_frame_rate_says() {
        assert_eq!(frame_delay(30.0), (1, 30));
        assert_eq!(frame_delay(30e3 / 1001.0), (1001, 30_000));
        assert_eq!(frame_delay(0.01), (100, 1));
        for rate in [23.976, 29.97, 33.33, 119.88, 0.37, 999.9] {
            let (seconds, frames) = frame_delay(rate);
            let is = f64::from(frames) / f64::from(seconds);
            assert!((is / rate - 1.0).abs() < 1e-5, "{rate}: {is}");
        }
    }
}
