use bytemuck::{Pod, Zeroable};
use glam::Vec4;

use super::Gpu;
use super::instances::{QuadDescriptor, Quads};
use super::pipeline::PipelineOutput;
use crate::scene::{Scene, Shadow};

pub(super) const SHADER: &str =
    concat!(include_str!("../../shaders/view.wgsl"), include_str!("../../shaders/shadow.wgsl"),);

#[repr(C)]
#[derive(Clone, Copy, PartialEq, Pod, Zeroable, Debug)]
struct ShadowInstance {
    base: Vec4,
    tip: Vec4,
}

const _: () = assert!(size_of::<ShadowInstance>() == 32);

/// Draws soft shadows on the ground.
#[derive(Debug)]
pub(super) struct Shadows(Quads<ShadowInstance>);

impl Shadows {
    pub fn new(gpu: &Gpu, view: &wgpu::BindGroupLayout) -> Self {
        Self(Quads::new(
            gpu,
            &QuadDescriptor {
                label: "shadow",
                shader: SHADER,
                layouts: &[view],
                attributes: &wgpu::vertex_attr_array![0 => Float32x4, 1 => Float32x4],
                output: PipelineOutput::Blended,
            },
        ))
    }

    /// Sends the changes to the device and returns the number of bytes sent.
    pub fn upload(&mut self, gpu: &Gpu, scene: &Scene) -> u64 {
        self.0.upload(gpu, scene.shadows.iter().map(ShadowInstance::new))
    }

    pub fn triangles(&self) -> u32 {
        self.0.triangles()
    }

    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        self.0.draw(pass);
    }
}

impl ShadowInstance {
    fn new(shadow: &Shadow) -> Self {
        Self {
            base: shadow.base.extend(shadow.base_radius),
            tip: shadow.tip.extend(shadow.tip_radius),
        }
    }
}
