use image::RgbaImage;

use super::Gpu;
use super::readback::{ReadError, fetch};

/// Render target: an image, and multisampled colour and depth buffers.
///
/// The scene may be drawn at a smaller size and enlarged, which takes less time, or at a larger one
/// and reduced, which smooths edges: see [`Self::set_resolution_scale`].
#[derive(Debug)]
pub struct Canvas {
    width: u32,
    height: u32,
    image: wgpu::Texture,
    pub(super) colour: wgpu::TextureView,
    /// Buffers of the image's size.
    full: SampleBuffers,
    /// Buffers for pictures of another size, kept for the next time; `None` before the first.
    scaled: Option<ScaledPicture>,
    resolution_scale: f32,
}

/// Multisampled buffers for one size of pictures.
#[derive(Debug)]
pub(super) struct SampleBuffers {
    pub colour: wgpu::TextureView,
    pub depth: wgpu::TextureView,
}

/// A picture that is drawn smaller or larger than the image, and then scaled to its size.
#[derive(Debug)]
struct ScaledPicture {
    size: (u32, u32),
    colour: wgpu::TextureView,
    samples: SampleBuffers,
}

impl Canvas {
    /// Pixel format of the image. It is not an sRGB format, since the shaders encode sRGB
    /// themselves.
    pub const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
    pub(super) const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
    pub(super) const SAMPLES: u32 = 4;
    /// The largest ratio of the size at which the scene is drawn to the size of the image: each
    /// pixel is the mean of four, each with four samples.
    pub const FINEST: f32 = 2.0;

    /// Creates a canvas of a size in pixels. Both sides are clamped to the range from 1 to
    /// [`Gpu::longest_side`].
    pub fn new(gpu: &Gpu, width: u32, height: u32) -> Self {
        let side = |length: u32| length.clamp(1, gpu.longest_side());
        let (width, height) = (side(width), side(height));
        let image = texture(gpu, "canvas image", Self::FORMAT, 1, (width, height));
        let colour = image.create_view(&Default::default());
        let full = SampleBuffers::new(gpu, (width, height));
        Self { width, height, image, colour, full, scaled: None, resolution_scale: 1.0 }
    }

    /// Sets the ratio of the size at which the scene is drawn to the size of the image, from 1 / 8
    /// to [`Self::FINEST`]. Neither side becomes longer than [`Gpu::longest_side`]. The picture is
    /// scaled to the size of the image, and labels are drawn over it.
    pub fn set_resolution_scale(&mut self, gpu: &Gpu, resolution_scale: f32) {
        const LEAST: f32 = 0.125;
        let longest = self.width.max(self.height);
        let most = (gpu.longest_side() as f32 / longest as f32).min(Self::FINEST);
        self.resolution_scale = resolution_scale.clamp(LEAST, most);
        let size = self.drawn_size();
        let has_size = self.scaled.as_ref().is_some_and(|scaled| scaled.size == size);
        if self.resolution_scale != 1.0 && !has_size {
            self.scaled = Some(ScaledPicture::new(gpu, size));
        }
    }

    /// Ratio of the size at which the scene is drawn to the size of the image.
    pub fn resolution_scale(&self) -> f32 {
        self.resolution_scale
    }

    /// Width and height in pixels at which the scene is drawn.
    pub(super) fn drawn_size(&self) -> (u32, u32) {
        let side = |length: u32| ((length as f32 * self.resolution_scale).round() as u32).max(1);
        (side(self.width), side(self.height))
    }

    /// The buffers in which the scene is drawn.
    pub(super) fn samples(&self) -> &SampleBuffers {
        self.scaled().map_or(&self.full, |scaled| &scaled.samples)
    }

    /// View of the picture in the size in which the scene is drawn, for shaders that sample it.
    pub fn drawn(&self) -> &wgpu::TextureView {
        self.scaled().map_or(&self.colour, |scaled| &scaled.colour)
    }

    fn scaled(&self) -> Option<&ScaledPicture> {
        self.scaled.as_ref().filter(|_| self.resolution_scale != 1.0)
    }

    /// Width and height in pixels.
    pub fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// Ratio of width to height.
    pub fn aspect(&self) -> f32 {
        self.width as f32 / self.height as f32
    }

    /// Waits for the device and reads the picture back.
    ///
    /// # Errors
    ///
    /// If the device fails.
    pub async fn read(&self, gpu: &Gpu) -> Result<RgbaImage, ReadError> {
        const PIXEL: u32 = 4;
        let row = self.width * PIXEL;
        let padded_row = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let size = u64::from(padded_row) * u64::from(self.height);
        let buffer = gpu.buffer("canvas read", size, wgpu::BufferUsages::MAP_READ);
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

        let mapped = fetch(gpu, &buffer).await?;
        let pixels = mapped
            .chunks_exact(padded_row as usize)
            .flat_map(|padded| &padded[..row as usize])
            .copied()
            .collect();
        RgbaImage::from_raw(self.width, self.height, pixels).ok_or(ReadError::Size)
    }
}

impl SampleBuffers {
    fn new(gpu: &Gpu, size: (u32, u32)) -> Self {
        let buffer = |label, format| {
            texture(gpu, label, format, Canvas::SAMPLES, size).create_view(&Default::default())
        };
        Self {
            colour: buffer("canvas samples", Canvas::FORMAT),
            depth: buffer("canvas depth", Canvas::DEPTH),
        }
    }
}

impl ScaledPicture {
    fn new(gpu: &Gpu, size: (u32, u32)) -> Self {
        let colour = texture(gpu, "scaled picture", Canvas::FORMAT, 1, size);
        let samples = SampleBuffers::new(gpu, size);
        Self { size, colour: colour.create_view(&Default::default()), samples }
    }
}

fn texture(
    gpu: &Gpu,
    label: &str,
    format: wgpu::TextureFormat,
    sample_count: u32,
    (width, height): (u32, u32),
) -> wgpu::Texture {
    use wgpu::TextureUsages;
    let read = TextureUsages::COPY_SRC | TextureUsages::TEXTURE_BINDING;
    let usage = if sample_count == 1 { read } else { TextureUsages::empty() };
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: TextureUsages::RENDER_ATTACHMENT | usage,
        view_formats: &[],
    })
}
