use core::ops::Range;

use bytemuck::Pod;

use super::instance_buffer::InstanceBuffer;
use super::pipeline::Output;
use super::{Gpu, pipeline};

/// Pipeline settings of one kind of quad.
pub(super) struct QuadDescriptor<'a> {
    pub label: &'static str,
    pub shader: &'static str,
    pub layouts: &'a [&'a wgpu::BindGroupLayout],
    pub attributes: &'a [wgpu::VertexAttribute],
    pub depth: wgpu::CompareFunction,
    pub output: Output,
}

/// Draws one quad per instance, blended over the picture; the shader computes the corners.
#[derive(Debug)]
pub(super) struct Quads<T> {
    pipeline: wgpu::RenderPipeline,
    instances: InstanceBuffer<T>,
}

impl<T: Pod + PartialEq> Quads<T> {
    pub fn new(gpu: &Gpu, descriptor: &QuadDescriptor<'_>) -> Self {
        let pipeline = pipeline::build(
            gpu,
            &pipeline::PipelineDescriptor {
                label: descriptor.label,
                shader: descriptor.shader,
                fragment: "fragment",
                constants: &[],
                layouts: descriptor.layouts,
                buffers: &[wgpu::VertexBufferLayout {
                    array_stride: size_of::<T>() as u64,
                    step_mode: wgpu::VertexStepMode::Instance,
                    attributes: descriptor.attributes,
                }],
                topology: wgpu::PrimitiveTopology::TriangleStrip,
                cull: None,
                depth: descriptor.depth,
                output: descriptor.output,
            },
        );
        Self { pipeline, instances: InstanceBuffer::new(descriptor.label) }
    }

    /// Sends the changes to the device and returns the number of bytes sent.
    pub fn upload(&mut self, gpu: &Gpu, instances: impl Iterator<Item = T>) -> u64 {
        self.instances.upload_all(gpu, instances)
    }

    pub fn triangles(&self) -> u32 {
        2 * self.instances.count()
    }

    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        self.draw_range(pass, 0..self.instances.count());
    }

    /// Draws a range of the instances. Indices beyond the last instance are ignored.
    pub fn draw_range(&self, pass: &mut wgpu::RenderPass<'_>, range: Range<u32>) {
        let Some((buffer, count)) = self.instances.get() else {
            return;
        };
        let range = range.start..range.end.min(count);
        if !range.is_empty() {
            pass.set_pipeline(&self.pipeline);
            pass.set_vertex_buffer(0, buffer.slice(..));
            pass.draw(0..4, range);
        }
    }
}
