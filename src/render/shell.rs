use core::ops::Range;

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use super::Gpu;
use super::instances::{QuadDescriptor, Quads};
use super::pipeline::PipelineOutput;
use crate::scene::SphereShell;

pub(super) const SHADER: &str = concat!(
    include_str!("../../shaders/view.wgsl"),
    include_str!("../../shaders/sphere.wgsl"),
    include_str!("../../shaders/shell.wgsl"),
);

/// Side of a sphere, as seen from the eye.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SphereSide {
    Near,
    Far,
}

#[repr(C)]
#[derive(Clone, Copy, PartialEq, Pod, Zeroable, Debug)]
struct ShellInstance {
    centre: Vec3,
    radius: f32,
    colour: [f32; 4],
    side: f32,
}

const _: () = assert!(size_of::<ShellInstance>() == 36);

/// Draws sides of shells in the order in which they were uploaded.
#[derive(Debug)]
pub(super) struct Shells(Quads<ShellInstance>);

impl Shells {
    pub fn new(gpu: &Gpu, view: &wgpu::BindGroupLayout) -> Self {
        Self(Quads::new(
            gpu,
            &QuadDescriptor {
                label: "shell",
                shader: SHADER,
                layouts: &[view],
                attributes: &wgpu::vertex_attr_array![0 => Float32x4, 1 => Float32x4, 2 => Float32],
                output: PipelineOutput::Blended,
            },
        ))
    }

    /// Sends the changes to the device and returns the number of bytes sent.
    pub fn upload<'a>(
        &mut self,
        gpu: &Gpu,
        sides: impl Iterator<Item = (&'a SphereShell, SphereSide)>,
    ) -> u64 {
        self.0.upload(gpu, sides.map(|(shell, side)| ShellInstance::new(shell, side)))
    }

    pub fn triangles(&self) -> u32 {
        self.0.triangles()
    }

    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>, sides: Range<u32>) {
        self.0.draw_range(pass, sides);
    }
}

impl ShellInstance {
    fn new(shell: &SphereShell, side: SphereSide) -> Self {
        let side = match side {
            SphereSide::Near => -1.0,
            SphereSide::Far => 1.0,
        };
        let SphereShell { centre, radius, colour } = *shell;
        Self { centre, radius, colour: colour.channels(), side }
    }
}
