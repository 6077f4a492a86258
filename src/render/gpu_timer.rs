use std::time::Duration;

use super::Gpu;
use super::readback::Readback;

/// A render pass that is timed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TimedPass {
    /// The 3D scene.
    Scene,
    /// The panels.
    Panels,
}

/// Measures the device's time for each frame with timestamp queries.
///
/// The device writes timestamps at the start and end of each pass. They are read back some frames
/// later, without waiting. While all readbacks are in use, frames are not measured.
#[derive(Debug)]
pub struct GpuTimer {
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    readbacks: [TimestampReadback; 3],
    /// For each pass, true if it is part of the current frame.
    passes: [bool; PASSES],
    nanoseconds_per_tick: f64,
}

const PASSES: usize = 2;
/// Timestamps per pass: start and end.
const STAMPS: u32 = 2;
const STAMP: u64 = wgpu::QUERY_SIZE as u64;
/// Distance in bytes between the timestamps of two passes in a buffer.
const STRIDE: u64 = wgpu::QUERY_RESOLVE_BUFFER_ALIGNMENT;
const SIZE: u64 = STRIDE * PASSES as u64;

/// The timestamps of a frame, until they are read.
#[derive(Debug)]
struct TimestampReadback {
    stamps: Readback,
    frame: u64,
    passes: [bool; PASSES],
}

impl GpuTimer {
    /// Creates the timer; `None` if the adapter has no timestamp queries.
    pub fn new(gpu: &Gpu) -> Option<Self> {
        if !gpu.device.features().contains(wgpu::Features::TIMESTAMP_QUERY) {
            return None;
        }
        let readback = |_| TimestampReadback {
            stamps: Readback::new(gpu, "timestamps, read back", SIZE),
            frame: 0,
            passes: [false; PASSES],
        };
        Some(Self {
            queries: gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("timestamps"),
                ty: wgpu::QueryType::Timestamp,
                count: STAMPS * PASSES as u32,
            }),
            resolved: gpu.buffer(
                "timestamps",
                SIZE,
                wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
            ),
            readbacks: std::array::from_fn(readback),
            passes: [false; PASSES],
            nanoseconds_per_tick: f64::from(gpu.queue.get_timestamp_period()),
        })
    }

    /// Starts a frame.
    pub fn start(&mut self) {
        self.passes = [false; PASSES];
    }

    /// Timestamp writes for a pass of the current frame.
    pub fn pass(&mut self, pass: TimedPass) -> wgpu::RenderPassTimestampWrites<'_> {
        self.passes[pass as usize] = true;
        let first = STAMPS * pass as u32;
        wgpu::RenderPassTimestampWrites {
            query_set: &self.queries,
            beginning_of_pass_write_index: Some(first),
            end_of_pass_write_index: Some(first + 1),
        }
    }

    /// Ends the frame with this number. The encoder must be submitted after the frame's passes.
    pub fn stop(&mut self, encoder: &mut wgpu::CommandEncoder, frame: u64) {
        let mut readbacks = self.readbacks.iter_mut();
        let Some(readback) = readbacks.find(|readback| readback.stamps.is_free()) else {
            return;
        };
        for pass in (0..PASSES).filter(|pass| self.passes[*pass]) {
            let first = STAMPS * pass as u32;
            let to = STRIDE * pass as u64;
            encoder.resolve_query_set(&self.queries, first..first + STAMPS, &self.resolved, to);
        }
        readback.stamps.copy(encoder, &self.resolved);
        (readback.frame, readback.passes) = (frame, self.passes);
    }

    /// Starts reading back the timestamps of ended frames, whose commands must have been submitted.
    pub fn fetch(&self) {
        for readback in &self.readbacks {
            readback.stamps.fetch();
        }
    }

    /// Number of a measured frame and the device's time for its passes; `None` if no result is
    /// available yet. Returns each frame once and never waits.
    pub fn read(&mut self, gpu: &Gpu) -> Option<(u64, Duration)> {
        // Callbacks report finished readbacks and a lost device, so the result can be ignored.
        let _ = gpu.device.poll(wgpu::PollType::Poll);
        let period = self.nanoseconds_per_tick;
        self.readbacks.iter().find_map(|readback| {
            let ticks = readback.stamps.read(|stamps| ticks(stamps, readback.passes))?;
            let time = Duration::try_from_secs_f64(ticks as f64 * period * 1e-9).ok()?;
            Some((readback.frame, time))
        })
    }
}

/// Sum of the passes' durations in ticks; `None` if timestamps are missing or the clock went
/// backwards.
fn ticks(stamps: &[u8], passes: [bool; PASSES]) -> Option<u64> {
    let stamp = |at: u64| {
        let at = at as usize;
        let bytes = stamps.get(at..at + STAMP as usize)?;
        Some(u64::from_le_bytes(bytes.try_into().ok()?))
    };
    (0..PASSES).filter(|pass| passes[*pass]).try_fold(0, |sum: u64, pass| {
        let begin = STRIDE * pass as u64;
        sum.checked_add(stamp(begin + STAMP)?.checked_sub(stamp(begin)?)?)
    })
}
