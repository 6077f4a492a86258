use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};
use std::time::Duration;

use super::Gpu;

/// What is timed on the device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lap {
    Scene,
    Panels,
}

/// Measures how long the device works on frames, where the adapter can: see [`GpuTimer::new`].
///
/// The device writes down when each lap begins and ends; what it wrote is fetched some frames later,
/// when it has done so, and never waited for. A frame that comes while all that is on its way is full
/// is not measured.
#[derive(Debug)]
pub struct GpuTimer {
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    readers: [Reader; 3],
    /// Which laps are run in this frame.
    run: [bool; LAPS],
    nanoseconds_per_tick: f64,
}

const LAPS: usize = 2;
/// Begin and end of a lap.
const STAMPS: u32 = 2;
const STAMP: u64 = wgpu::QUERY_SIZE as u64;
/// Where the stamps of a lap begin in a buffer, from one lap to the next.
const STRIDE: u64 = wgpu::QUERY_RESOLVE_BUFFER_ALIGNMENT;
const SIZE: u64 = STRIDE * LAPS as u64;

/// A frame's stamps on their way.
#[derive(Debug)]
struct Reader {
    buffer: wgpu::Buffer,
    frame: u64,
    run: [bool; LAPS],
    state: Arc<AtomicU8>,
}

const FREE: u8 = 0;
/// In the orders of a frame that is not submitted yet.
const WRITTEN: u8 = 1;
const FETCHING: u8 = 2;
const FETCHED: u8 = 3;
const FAILED: u8 = 4;

impl GpuTimer {
    /// Nothing where the adapter has no clock.
    pub fn new(gpu: &Gpu) -> Option<Self> {
        if !gpu.device.features().contains(wgpu::Features::TIMESTAMP_QUERY) {
            return None;
        }
        let buffer = |label, usage| {
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: SIZE,
                usage,
                mapped_at_creation: false,
            })
        };
        let reader = |_| Reader {
            buffer: buffer(
                "timestamps, read",
                wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            ),
            frame: 0,
            run: [false; LAPS],
            state: Arc::new(AtomicU8::new(FREE)),
        };
        Some(Self {
            queries: gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("timestamps"),
                ty: wgpu::QueryType::Timestamp,
                count: STAMPS * LAPS as u32,
            }),
            resolved: buffer(
                "timestamps",
                wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
            ),
            readers: std::array::from_fn(reader),
            run: [false; LAPS],
            nanoseconds_per_tick: f64::from(gpu.queue.get_timestamp_period()),
        })
    }

    /// Begins a frame: no lap is run yet.
    pub fn start(&mut self) {
        self.run = [false; LAPS];
    }

    /// What a render pass needs to be a lap.
    pub fn lap(&mut self, lap: Lap) -> wgpu::RenderPassTimestampWrites<'_> {
        self.run[lap as usize] = true;
        let first = STAMPS * lap as u32;
        wgpu::RenderPassTimestampWrites {
            query_set: &self.queries,
            beginning_of_pass_write_index: Some(first),
            end_of_pass_write_index: Some(first + 1),
        }
    }

    /// Ends a frame, by orders that come behind those of its laps.
    pub fn stop(&mut self, encoder: &mut wgpu::CommandEncoder, frame: u64) {
        let is_free = |reader: &&mut Reader| reader.state.load(Ordering::Acquire) == FREE;
        let Some(reader) = self.readers.iter_mut().find(is_free) else {
            return;
        };
        for lap in (0..LAPS).filter(|lap| self.run[*lap]) {
            let first = STAMPS * lap as u32;
            let to = STRIDE * lap as u64;
            encoder.resolve_query_set(&self.queries, first..first + STAMPS, &self.resolved, to);
        }
        encoder.copy_buffer_to_buffer(&self.resolved, 0, &reader.buffer, 0, SIZE);
        (reader.frame, reader.run) = (frame, self.run);
        reader.state.store(WRITTEN, Ordering::Release);
    }

    /// Asks for what the orders wrote that have been submitted by now.
    pub fn fetch(&self) {
        for reader in &self.readers {
            if reader.state.load(Ordering::Acquire) != WRITTEN {
                continue;
            }
            reader.state.store(FETCHING, Ordering::Release);
            let state = Arc::clone(&reader.state);
            reader.buffer.slice(..).map_async(wgpu::MapMode::Read, move |fetched| {
                let next = if fetched.is_ok() { FETCHED } else { FAILED };
                state.store(next, Ordering::Release);
            });
        }
    }

    /// A frame and how long the device worked on it, if that is known by now of one that has not been
    /// told; waits for nothing.
    pub fn read(&mut self, gpu: &Gpu) -> Option<(u64, Duration)> {
        // What comes of it is told to the callbacks; a lost device says so elsewhere.
        let _ = gpu.device.poll(wgpu::PollType::Poll);
        let period = self.nanoseconds_per_tick;
        self.readers.iter().find_map(|reader| match reader.state.load(Ordering::Acquire) {
            FETCHED => {
                let ticks = reader.ticks();
                reader.buffer.unmap();
                reader.state.store(FREE, Ordering::Release);
                let seconds = ticks? as f64 * period * 1e-9;
                Some((reader.frame, Duration::try_from_secs_f64(seconds).ok()?))
            }
            FAILED => {
                reader.state.store(FREE, Ordering::Release);
                None
            }
            _ => None,
        })
    }
}

impl Reader {
    /// What all laps took together; nothing from a clock that went back.
    fn ticks(&self) -> Option<u64> {
        let mapped = self.buffer.get_mapped_range(..).ok()?;
        let stamp = |at: u64| {
            let at = at as usize;
            let bytes = mapped.get(at..at + STAMP as usize)?;
            Some(u64::from_le_bytes(bytes.try_into().ok()?))
        };
        (0..LAPS).filter(|lap| self.run[*lap]).try_fold(0, |sum: u64, lap| {
            let begin = STRIDE * lap as u64;
            sum.checked_add(stamp(begin + STAMP)?.checked_sub(stamp(begin)?)?)
        })
    }
}
