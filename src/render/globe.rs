use bytemuck::{Pod, Zeroable};
use glam::{Vec3, Vec4};

use super::Gpu;
use super::pipeline::{PipelineDescriptor, PipelineOutput};
use super::shell::SphereSide;
use super::view::Uniforms;
use crate::scene::{Colour, Globe, Palette, Scene};

pub(super) const SHADER: &str = concat!(
    include_str!("../../shaders/view.wgsl"),
    include_str!("../../shaders/sphere.wgsl"),
    include_str!("../../shaders/globe.wgsl"),
);

/// Number of sides of the globe that are drawn: far and near.
const SIDES: u32 = 2;

#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
struct GlobeData {
    centre: Vec3,
    radius: f32,
    axis: Vec3,
    singular: f32,
    ramp: [Vec4; Palette::GAINS],
    line: Vec4,
    max_gain: f32,
    padding: [f32; 3],
}

const _: () = assert!(size_of::<GlobeData>() == 2 * 16 + Palette::GAINS * 16 + 2 * 16);

/// Draws the far and the near side of the globe of gains.
#[derive(Debug)]
pub(super) struct Globes {
    pipeline: wgpu::RenderPipeline,
    uniforms: Uniforms<GlobeData>,
    shown: bool,
}

impl Globes {
    pub fn new(gpu: &Gpu, view: &wgpu::BindGroupLayout) -> Self {
        let uniforms = Uniforms::new(gpu, "globe");
        let layouts = [view, &uniforms.layout];
        let pipeline = PipelineDescriptor {
            topology: wgpu::PrimitiveTopology::TriangleStrip,
            ..PipelineDescriptor::new("globe", SHADER, &layouts, PipelineOutput::Blended)
        }
        .build(gpu);
        Self { pipeline, uniforms, shown: false }
    }

    /// Sends the changes to the device and returns the number of bytes sent.
    pub fn upload(&mut self, gpu: &Gpu, scene: &Scene) -> u64 {
        let globe = scene.globe.filter(Globe::has_size);
        self.shown = globe.is_some();
        globe.map_or(0, |globe| self.uniforms.upload(gpu, GlobeData::new(&globe, &scene.palette)))
    }

    pub fn triangles(&self) -> u32 {
        if self.shown { 2 * SIDES } else { 0 }
    }

    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>, side: SphereSide) {
        let instance = match side {
            SphereSide::Far => 0,
            SphereSide::Near => 1,
        };
        if self.shown {
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(1, &self.uniforms.group, &[]);
            pass.draw(0..4, instance..instance + 1);
        }
    }
}

impl GlobeData {
    fn new(globe: &Globe, palette: &Palette) -> Self {
        let screen = |colour: Colour| Vec4::from_array(colour.channels());
        let mut singular = globe.singular();
        Self {
            centre: globe.centre,
            radius: globe.radius,
            singular: singular.clone().count() as f32,
            axis: singular.next().unwrap_or(Vec3::Y),
            ramp: palette.gains.map(screen),
            line: screen(palette.guide),
            max_gain: Palette::MAX_GAIN,
            padding: [0.0; 3],
        }
    }
}
