use image::RgbaImage;
use thiserror::Error;

use super::Gpu;

/// Render target: an image, and multisampled colour and depth buffers.
#[derive(Debug)]
pub struct Canvas {
    width: u32,
    height: u32,
    image: wgpu::Texture,
    pub(super) colour: wgpu::TextureView,
    pub(super) samples: wgpu::TextureView,
    pub(super) depth: wgpu::TextureView,
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

impl Canvas {
    /// Pixel format of the image. It is not an sRGB format, since the shaders encode sRGB
    /// themselves.
    pub const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
    pub(super) const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
    pub(super) const SAMPLES: u32 = 4;

    /// Creates a canvas of a size in pixels. Both sides are clamped to the range from 1 to
    /// [`Gpu::longest_side`].
    pub fn new(gpu: &Gpu, width: u32, height: u32) -> Self {
        let side = |length: u32| length.clamp(1, gpu.longest_side());
        let (width, height) = (side(width), side(height));
        let texture = |label, format, sample_count, usage| {
            gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage,
                view_formats: &[],
            })
        };
        let drawn = wgpu::TextureUsages::RENDER_ATTACHMENT;
        let shown = drawn | wgpu::TextureUsages::COPY_SRC | wgpu::TextureUsages::TEXTURE_BINDING;
        let image = texture("canvas image", Self::FORMAT, 1, shown);
        let samples = texture("canvas samples", Self::FORMAT, Self::SAMPLES, drawn);
        let depth = texture("canvas depth", Self::DEPTH, Self::SAMPLES, drawn);
        let view = |texture: &wgpu::Texture| texture.create_view(&Default::default());
        Self {
            width,
            height,
            colour: view(&image),
            samples: view(&samples),
            depth: view(&depth),
            image,
        }
    }

    /// Width and height in pixels.
    pub fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// Ratio of width to height.
    pub fn aspect(&self) -> f32 {
        self.width as f32 / self.height as f32
    }

    /// View of the image, for shaders that sample it.
    pub fn view(&self) -> &wgpu::TextureView {
        &self.colour
    }

    /// Waits for the device and reads the picture back.
    ///
    /// # Errors
    ///
    /// If the device fails.
    pub fn read(&self, gpu: &Gpu) -> Result<RgbaImage, ReadError> {
        const PIXEL: u32 = 4;
        let row = self.width * PIXEL;
        let padded_row = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("canvas read"),
            size: u64::from(padded_row) * u64::from(self.height),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        encoder.copy_texture_to_buffer(
            self.image.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &buffer,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(padded_row),
                    rows_per_image: None,
                },
            },
            self.image.size(),
        );
        gpu.queue.submit([encoder.finish()]);

        let mapped = fetch(gpu, &buffer)?;
        let pixels = mapped
            .chunks_exact(padded_row as usize)
            .flat_map(|padded| &padded[..row as usize])
            .copied()
            .collect();
        RgbaImage::from_raw(self.width, self.height, pixels).ok_or(ReadError::Size)
    }
}

/// Waits until the device has executed all commands, then maps a buffer and returns its contents.
pub(super) fn fetch(gpu: &Gpu, buffer: &wgpu::Buffer) -> Result<wgpu::BufferView, ReadError> {
    let (sender, receiver) = std::sync::mpsc::channel();
    buffer.slice(..).map_async(wgpu::MapMode::Read, move |result| {
        // Sending fails only if the poll below has failed, which drops the receiver.
        let _ = sender.send(result);
    });
    gpu.device.poll(wgpu::PollType::wait_indefinitely())?;
    receiver.recv().unwrap_or(Err(wgpu::BufferAsyncError))?;
    Ok(buffer.get_mapped_range(..)?)
}
