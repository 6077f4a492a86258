use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use super::Gpu;
use super::quads::{self, Quads};
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
pub(super) struct Dashes(Quads<Instance>);

impl Dashes {
    pub fn new(gpu: &Gpu, view: &wgpu::BindGroupLayout) -> Self {
        Self(Quads::new(
            gpu,
            &quads::Kind {
                label: "dash",
                shader: SHADER,
                layouts: &[view],
                attributes: &wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x4],
                depth: wgpu::CompareFunction::Greater,
            },
        ))
    }

    pub fn upload(&mut self, gpu: &Gpu, scene: &Scene) {
        self.0.upload(gpu, scene.dashes.iter().map(Instance::new));
    }

    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        self.0.draw(pass);
    }
}

impl Instance {
    fn new(dash: &Dash) -> Self {
        Self { from: dash.from, to: dash.to, colour: dash.colour.channels() }
    }
}
