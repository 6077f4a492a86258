use core::ops::Range;

use bytemuck::Pod;

use super::instances::Instances;
use super::{Gpu, pipeline};

/// What makes one kind of quad differ from another.
pub(super) struct Kind<'a> {
    pub label: &'static str,
    pub shader: &'static str,
    pub layouts: &'a [&'a wgpu::BindGroupLayout],
    pub attributes: &'a [wgpu::VertexAttribute],
    pub depth: wgpu::CompareFunction,
}

/// Four-cornered things laid over the picture, one an instance; the shader places the corners.
#[derive(Debug)]
pub(super) struct Quads<T> {
    pipeline: wgpu::RenderPipeline,
    instances: Instances<T>,
}

impl<T: Pod + PartialEq> Quads<T> {
    pub fn new(gpu: &Gpu, kind: &Kind<'_>) -> Self {
        let pipeline = pipeline::build(
            gpu,
            &pipeline::Kind {
                label: kind.label,
                shader: kind.shader,
                fragment: "fragment",
                layouts: kind.layouts,
                buffers: &[wgpu::VertexBufferLayout {
                    array_stride: size_of::<T>() as u64,
                    step_mode: wgpu::VertexStepMode::Instance,
                    attributes: kind.attributes,
                }],
                topology: wgpu::PrimitiveTopology::TriangleStrip,
                cull: None,
                depth: kind.depth,
                opaque: false,
            },
        );
        Self { pipeline, instances: Instances::new(kind.label) }
    }

    /// How many bytes were sent.
    pub fn upload(&mut self, gpu: &Gpu, instances: impl Iterator<Item = T>) -> u64 {
        self.instances.upload(gpu, instances)
    }

    pub fn triangles(&self) -> u32 {
        2 * self.instances.count()
    }

    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        self.draw_some(pass, 0..self.instances.count());
    }

    /// Draws those of a part of the list, as far as there are any.
    pub fn draw_some(&self, pass: &mut wgpu::RenderPass<'_>, part: Range<u32>) {
        let Some((buffer, count)) = self.instances.get() else {
            return;
        };
        let part = part.start..part.end.min(count);
        if !part.is_empty() {
            pass.set_pipeline(&self.pipeline);
            pass.set_vertex_buffer(0, buffer.slice(..));
            pass.draw(0..4, part);
        }
    }
}
