use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use super::Gpu;
use super::instances::{QuadDescriptor, Quads};
use super::pipeline::PipelineOutput;
use crate::scene::{Line, Scene};

pub(super) const SHADER: &str =
    concat!(include_str!("../../shaders/view.wgsl"), include_str!("../../shaders/line.wgsl"),);

#[repr(C)]
#[derive(Clone, Copy, PartialEq, Pod, Zeroable, Debug)]
struct LineInstance {
    from: Vec3,
    to: Vec3,
    colour: [f32; 4],
    dashed: f32,
}

const _: () = assert!(size_of::<LineInstance>() == 44);

/// Draws lines.
#[derive(Debug)]
pub(super) struct Lines(Quads<LineInstance>);

impl Lines {
    pub fn new(gpu: &Gpu, view: &wgpu::BindGroupLayout) -> Self {
        Self(Quads::new(
            gpu,
            &QuadDescriptor {
                label: "line",
                shader: SHADER,
                layouts: &[view],
                attributes: &wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x4, 3 => Float32],
                output: PipelineOutput::Blended,
            },
        ))
    }

    /// Sends the changes to the device and returns the number of bytes sent.
    pub fn upload(&mut self, gpu: &Gpu, scene: &Scene) -> u64 {
        self.0.upload(gpu, scene.lines.iter().map(LineInstance::new))
    }

    pub fn triangles(&self) -> u32 {
        self.0.triangles()
    }

    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        self.0.draw(pass);
    }
}

impl LineInstance {
    fn new(line: &Line) -> Self {
        let dashed = if line.dashed { 1.0 } else { 0.0 };
        Self { from: line.from, to: line.to, colour: line.colour.channels(), dashed }
    }
}
