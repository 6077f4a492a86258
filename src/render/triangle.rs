use core::ops::Range;

use bytemuck::{Pod, Zeroable};
use egui::epaint::ImageDelta;

use super::Gpu;
use super::instances::InstanceBuffer;
use super::pipeline::{PipelineDescriptor, PipelineOutput};
use super::texture::{PaintTexture, TextureSampler};
use super::view::Uniforms;

pub(super) const SHADER: &str = include_str!("../../shaders/triangle.wgsl");

/// Draws flat triangles with textures over a finished picture, such as those of panels.
#[derive(Debug)]
pub struct TrianglePainter {
    pipeline: wgpu::RenderPipeline,
    corners: InstanceBuffer<Corner>,
    /// Width and height of the picture.
    size: Uniforms<[f32; 4]>,
    sampler: TextureSampler,
}

/// A corner of a triangle.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Corner {
    /// Position in the picture, from its top left corner to the right and down.
    pub at: [f32; 2],
    /// Position in the texture, from (0, 0) at its top left corner to (1, 1).
    pub in_texture: [f32; 2],
    /// Colour in sRGB, multiplied by its opacity. It is multiplied by that of the texture.
    pub colour: [u8; 4],
}

impl TrianglePainter {
    /// Creates the pipeline for passes without depth, with one sample per pixel and a colour
    /// attachment of this format, which must not convert to sRGB.
    pub fn new(gpu: &Gpu, format: wgpu::TextureFormat) -> Self {
        let (size, sampler) =
            (Uniforms::new(gpu, "triangles"), TextureSampler::new(gpu, "triangles"));
        let attributes = wgpu::vertex_attr_array![0 => Float32x2, 1 => Float32x2, 2 => Unorm8x4];
        let layouts = [&size.layout, &sampler.layout];
        let output = PipelineOutput::Premultiplied(format);
        let pipeline = PipelineDescriptor {
            buffers: &[wgpu::VertexBufferLayout {
                array_stride: size_of::<Corner>() as u64,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &attributes,
            }],
            ..PipelineDescriptor::new("triangles", SHADER, &layouts, output)
        }
        .build(gpu);
        Self { pipeline, corners: InstanceBuffer::new("triangles"), size, sampler }
    }

    /// Creates the texture of an image that is its whole, without its pixels.
    pub fn texture(&self, gpu: &Gpu, whole: &ImageDelta) -> PaintTexture {
        PaintTexture::new(gpu, &self.sampler, whole)
    }

    /// Adds a corner to the next upload. Three in a row are a triangle.
    pub fn push(&mut self, corner: Corner) {
        self.corners.push(corner);
    }

    /// Sends the pushed corners, which replace those of the previous upload. `size` is the width
    /// and height of the picture in the unit of the corners.
    pub fn upload(&mut self, gpu: &Gpu, [width, height]: [f32; 2]) {
        self.corners.upload(gpu);
        self.size.upload(gpu, [width, height, 0.0, 0.0]);
    }

    /// Draws the triangles of a range of the uploaded corners. The viewport must be the whole
    /// picture.
    pub fn draw(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        texture: &PaintTexture,
        corners: Range<u32>,
    ) {
        if let Some((buffer, _)) = self.corners.get() {
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, &self.size.group, &[]);
            pass.set_bind_group(1, &texture.group, &[]);
            pass.set_vertex_buffer(0, buffer.slice(..));
            pass.draw(corners, 0..1);
        }
    }
}
