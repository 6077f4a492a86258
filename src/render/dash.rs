use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use super::instances::Instances;
use super::{Gpu, pipeline};
use crate::scene::{Dash, Scene};

pub(super) const SHADER: &str =
    concat!(include_str!("../../shaders/view.wgsl"), include_str!("../../shaders/dash.wgsl"),);

#[repr(C)]
#[derive(Clone, Copy, PartialEq, Pod, Zeroable, Debug)]
struct Instance {
    from: Vec3,
    to: Vec3,
    colour: [f32; 4],
}

const _: () = assert!(size_of::<Instance>() == 40);

/// Draws dashed lines.
#[derive(Debug)]
pub(super) struct Dashes {
    pipeline: wgpu::RenderPipeline,
    dashes: Instances<Instance>,
}

impl Dashes {
    pub fn new(gpu: &Gpu, view: &wgpu::BindGroupLayout) -> Self {
        let attributes = wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x4];
        let pipeline = pipeline::build(
            gpu,
            &pipeline::Kind {
                label: "dash",
                shader: SHADER,
                fragment: "fragment",
                layouts: &[view],
                buffers: &[wgpu::VertexBufferLayout {
                    array_stride: size_of::<Instance>() as u64,
                    step_mode: wgpu::VertexStepMode::Instance,
                    attributes: &attributes,
                }],
                topology: wgpu::PrimitiveTopology::TriangleStrip,
                cull: None,
                depth: wgpu::CompareFunction::Greater,
                opaque: false,
            },
        );
        Self { pipeline, dashes: Instances::new("dashes") }
    }

    pub fn upload(&mut self, gpu: &Gpu, scene: &Scene) {
        self.dashes.upload(gpu, scene.dashes.iter().map(Instance::new));
    }

    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        if let Some((buffer, count)) = self.dashes.get() {
            pass.set_pipeline(&self.pipeline);
            pass.set_vertex_buffer(0, buffer.slice(..));
            pass.draw(0..4, 0..count);
        }
    }
}

impl Instance {
    fn new(dash: &Dash) -> Self {
        Self { from: dash.from, to: dash.to, colour: dash.colour.channels() }
    }
}
