use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use super::instances::Instances;
use super::mesh::{self, Mesh};
use super::{Gpu, pipeline};
use crate::scene::{Scene, Shell};

pub(super) const SHADER: &str = concat!(
    include_str!("../../shaders/view.wgsl"),
    include_str!("../../shaders/shell.wgsl"),
);

/// The rim is where corners would show.
const SEGMENTS: u16 = 128;

#[repr(C)]
#[derive(Clone, Copy, PartialEq, Pod, Zeroable, Debug)]
struct Instance {
    centre: Vec3,
    radius: f32,
    colour: [f32; 4],
}

const _: () = assert!(size_of::<Instance>() == 32);

/// Draws spheres that one can see through, from outside and from inside.
#[derive(Debug)]
pub(super) struct Shells {
    far_sides: wgpu::RenderPipeline,
    near_sides: wgpu::RenderPipeline,
    sphere: Mesh,
    shells: Instances<Instance>,
}

impl Shells {
    pub fn new(gpu: &Gpu, view: &wgpu::BindGroupLayout) -> Self {
        let buffers = [
            wgpu::VertexBufferLayout {
                array_stride: size_of::<Vec3>() as u64,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &wgpu::vertex_attr_array![0 => Float32x3],
            },
            wgpu::VertexBufferLayout {
                array_stride: size_of::<Instance>() as u64,
                step_mode: wgpu::VertexStepMode::Instance,
                attributes: &wgpu::vertex_attr_array![1 => Float32x4, 2 => Float32x4],
            },
        ];
        let pipeline = |label, cull| {
            pipeline::build(
                gpu,
                &pipeline::Kind {
                    label,
                    shader: SHADER,
                    fragment: "fragment",
                    layouts: &[view],
                    buffers: &buffers,
                    topology: wgpu::PrimitiveTopology::TriangleList,
                    cull: Some(cull),
                    depth: wgpu::CompareFunction::Greater,
                    opaque: false,
                },
            )
        };
        let (points, indices) = mesh::sphere(SEGMENTS);
        Self {
            far_sides: pipeline("shell, far side", wgpu::Face::Front),
            near_sides: pipeline("shell, near side", wgpu::Face::Back),
            sphere: Mesh::new(gpu, "shell", &points, &indices),
            shells: Instances::new("shells"),
        }
    }

    /// Shells are laid over each other in order: the inner ones come first.
    pub fn upload(&mut self, gpu: &Gpu, scene: &Scene) {
        self.shells.upload(gpu, scene.shells.iter().map(Instance::new));
    }

    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        if let Some((buffer, count)) = self.shells.get() {
            for sides in [&self.far_sides, &self.near_sides] {
                pass.set_pipeline(sides);
                self.sphere.draw(pass, buffer, count);
            }
        }
    }
}

impl Instance {
    fn new(shell: &Shell) -> Self {
        Self { centre: shell.centre, radius: shell.radius, colour: shell.colour.linear() }
    }
}
