use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};

use futures_channel::oneshot;
use thiserror::Error;

use super::Gpu;

const FREE: u8 = 0;
/// The commands that write the buffer are encoded, but may not be submitted yet.
const WRITTEN: u8 = 1;
const FETCHING: u8 = 2;
const FETCHED: u8 = 3;
const FAILED: u8 = 4;

/// Reads a buffer of the device back without waiting: commands copy it to a second buffer, which is
/// read some frames later.
#[derive(Debug)]
pub(super) struct Readback {
    buffer: wgpu::Buffer,
    state: Arc<AtomicU8>,
}

impl Readback {
    /// Makes room for `size` bytes.
    pub fn new(gpu: &Gpu, label: &str, size: u64) -> Self {
        let buffer = gpu.buffer(label, size, wgpu::BufferUsages::MAP_READ);
        Self { buffer, state: Arc::new(AtomicU8::new(FREE)) }
    }

    /// True if no copy is under way.
    pub fn is_free(&self) -> bool {
        self.state() == FREE
    }

    /// Encodes a copy of the first bytes of `from`. Must be free.
    pub fn copy(&self, encoder: &mut wgpu::CommandEncoder, from: &wgpu::Buffer) {
        encoder.copy_buffer_to_buffer(from, 0, &self.buffer, 0, self.buffer.size());
        self.set(WRITTEN);
    }

    /// Starts reading an encoded copy, whose commands must have been submitted.
    pub fn fetch(&self) {
        if self.state() != WRITTEN {
            return;
        }
        self.set(FETCHING);
        let state = Arc::clone(&self.state);
        self.buffer.slice(..).map_async(wgpu::MapMode::Read, move |fetched| {
            let next = if fetched.is_ok() { FETCHED } else { FAILED };
            state.store(next, Ordering::Release);
        });
    }

    /// Result of `read` for the bytes; `None` if they have not arrived yet, cannot be read, or
    /// were read before. The device must be polled for them to arrive.
    pub fn read<T>(&self, read: impl FnOnce(&[u8]) -> Option<T>) -> Option<T> {
        let state = self.state();
        let value = if state == FETCHED {
            let value = self.buffer.get_mapped_range(..).ok().and_then(|mapped| read(&mapped));
            self.buffer.unmap();
            value
        } else {
            None
        };
        if matches!(state, FETCHED | FAILED) {
            self.set(FREE);
        }
        value
    }

    fn state(&self) -> u8 {
        self.state.load(Ordering::Acquire)
    }

    fn set(&self, state: u8) {
        self.state.store(state, Ordering::Release);
    }
}

/// Waits until the device has executed all commands, then maps a buffer and returns its contents.
pub(super) async fn fetch(gpu: &Gpu, buffer: &wgpu::Buffer) -> Result<wgpu::BufferView, ReadError> {
    let (sender, receiver) = oneshot::channel();
    buffer.slice(..).map_async(wgpu::MapMode::Read, move |result| {
        // Sending fails only if the poll below has failed, which drops the receiver.
        let _ = sender.send(result);
    });
    // In a browser, this returns at once, and the buffer is mapped later.
    gpu.device.poll(wgpu::PollType::wait_indefinitely())?;
    receiver.await.unwrap_or(Err(wgpu::BufferAsyncError))?;
    Ok(buffer.get_mapped_range(..)?)
}

/// Reasons why a buffer could not be read back from the device.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The wait for the device failed.
    #[error("the graphics device did not finish: {0}")]
    Poll(#[from] wgpu::PollError),
    /// The buffer could not be mapped.
    #[error("cannot read from the graphics device: {0}")]
    Map(#[from] wgpu::BufferAsyncError),
    /// The mapped range is invalid.
    #[error("cannot read from the graphics device: {0}")]
    Range(#[from] wgpu::MapRangeError),
    /// The data that was read does not have the size of the picture.
    #[error("the graphics device returned a picture of the wrong size")]
    Size,
}
