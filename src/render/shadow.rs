use bytemuck::{Pod, Zeroable};
use glam::Vec4;

use super::instances::Instances;
use super::{Gpu, pipeline};
use crate::scene::{Scene, Shadow};

pub(super) const SHADER: &str =
    concat!(include_str!("../../shaders/view.wgsl"), include_str!("../../shaders/shadow.wgsl"),);

#[repr(C)]
#[derive(Clone, Copy, PartialEq, Pod, Zeroable, Debug)]
struct Instance {
    base: Vec4,
    tip: Vec4,
}

const _: () = assert!(size_of::<Instance>() == 32);

/// Draws soft shadows on the ground.
#[derive(Debug)]
pub(super) struct Shadows {
    pipeline: wgpu::RenderPipeline,
    shadows: Instances<Instance>,
}

impl Shadows {
    pub fn new(gpu: &Gpu, view: &wgpu::BindGroupLayout) -> Self {
        let pipeline = pipeline::build(
            gpu,
            &pipeline::Kind {
                label: "shadow",
                shader: SHADER,
                fragment: "fragment",
                layouts: &[view],
                buffers: &[wgpu::VertexBufferLayout {
                    array_stride: size_of::<Instance>() as u64,
                    step_mode: wgpu::VertexStepMode::Instance,
                    attributes: &wgpu::vertex_attr_array![0 => Float32x4, 1 => Float32x4],
                }],
                topology: wgpu::PrimitiveTopology::TriangleStrip,
                cull: None,
                depth: wgpu::CompareFunction::Greater,
                opaque: false,
            },
        );
        Self { pipeline, shadows: Instances::new("shadows") }
    }

    pub fn upload(&mut self, gpu: &Gpu, scene: &Scene) {
        self.shadows.upload(gpu, scene.shadows.iter().map(Instance::new));
    }

    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        if let Some((buffer, count)) = self.shadows.get() {
            pass.set_pipeline(&self.pipeline);
            pass.set_vertex_buffer(0, buffer.slice(..));
            pass.draw(0..4, 0..count);
        }
    }
}

impl Instance {
    fn new(shadow: &Shadow) -> Self {
        Self {
            base: shadow.base.extend(shadow.base_radius),
            tip: shadow.tip.extend(shadow.tip_radius),
        }
    }
}
