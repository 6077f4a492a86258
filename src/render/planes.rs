use super::Gpu;
use super::pipeline::{PipelineDescriptor, PipelineOutput};
use crate::scene::Planes;

pub(super) const SHADER: &str =
    concat!(include_str!("../../shaders/view.wgsl"), include_str!("../../shaders/planes.wgsl"));

/// Draws the floor and the grids over everything opaque.
#[derive(Debug)]
pub(super) struct PlanePainter {
    pipeline: wgpu::RenderPipeline,
    /// Which planes are shown, in the order of their indices in the shader: the walls x = 0 and
    /// z = 0, and the floor, which is drawn last.
    shown: [bool; 3],
}

impl PlanePainter {
    pub fn new(gpu: &Gpu, view: &wgpu::BindGroupLayout) -> Self {
        let pipeline = PipelineDescriptor {
            topology: wgpu::PrimitiveTopology::TriangleStrip,
            ..PipelineDescriptor::new("planes", SHADER, &[view], PipelineOutput::Blended)
        }
        .build(gpu);
        Self { pipeline, shown: [false; 3] }
    }

    pub fn show(&mut self, planes: &Planes) {
        self.shown = [planes.grid_yz, planes.grid_xy, planes.grid_xz || planes.ground];
    }

    pub fn triangles(&self) -> u32 {
        2 * self.shown().count() as u32
    }

    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_pipeline(&self.pipeline);
        for plane in self.shown() {
            pass.draw(0..4, plane..plane + 1);
        }
    }

    fn shown(&self) -> impl Iterator<Item = u32> {
        (0..).zip(self.shown).filter_map(|(plane, is_shown)| is_shown.then_some(plane))
    }
}
