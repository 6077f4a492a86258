use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Vec2, Vec3, Vec4};

use super::Gpu;
use super::pipeline::{self, BindingKind};
use crate::scene::{Colour, Globe, Scene};

/// Uniforms that all shaders of a scene share: `View` in `view.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
struct ViewData {
    clip_from_world: Mat4,
    eye: Vec3,
    orthographic: f32,
    forward: Vec3,
    focus_distance: f32,
    right: Vec3,
    pixel_scale: f32,
    up: Vec3,
    shadow_strength: f32,
    planes_centre: Vec3,
    planes_radius: f32,
    size: Vec2,
    cell: f32,
    padding: f32,
    sky_top: Vec4,
    sky_bottom: Vec4,
    ground: Vec4,
    grid: Vec4,
    walls: Vec4,
}

const _: () = assert!(size_of::<ViewData>() == 64 + 5 * 16 + 16 + 5 * 16);

/// The uniforms that all shaders of a scene share, on the device.
#[derive(Debug)]
pub(super) struct ViewUniforms(Uniforms<ViewData>);

impl ViewUniforms {
    pub fn new(gpu: &Gpu) -> Self {
        Self(Uniforms::new(gpu, "view"))
    }

    pub fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.0.layout
    }

    pub fn group(&self) -> &wgpu::BindGroup {
        &self.0.group
    }

    /// Sends the uniforms if they have changed, and returns the number of bytes sent. `size` is the
    /// picture's in pixels, `scale` the number of pixels per point.
    pub fn upload(&mut self, gpu: &Gpu, scene: &Scene, size: (u32, u32), scale: f32) -> u64 {
        self.0.upload(gpu, ViewData::new(scene, size, scale))
    }
}

impl ViewData {
    fn new(scene: &Scene, (width, height): (u32, u32), scale: f32) -> Self {
        let (palette, planes) = (&scene.palette, &scene.planes);
        let projection = scene.camera.projection(width as f32 / height as f32);
        let screen = |colour: Colour| Vec4::from_array(colour.channels());
        // Nothing is between the eye and the lower half of a globe, nor in its middle.
        let has_globe = scene.globe.filter(Globe::has_size).is_some();
        let ground = palette.ground.with_opacity(planes.ground_opacity);
        let shown = |colour: Colour, is_shown: bool| {
            screen(if is_shown { colour } else { colour.with_opacity(0.0) })
        };
        Self {
            clip_from_world: projection.clip_from_world,
            eye: projection.eye,
            orthographic: if projection.orthographic { 1.0 } else { 0.0 },
            forward: projection.forward,
            focus_distance: scene.camera.distance,
            right: projection.right,
            pixel_scale: scale,
            up: projection.up,
            shadow_strength: if has_globe { 0.0 } else { palette.shadow },
            planes_centre: planes.centre,
            planes_radius: planes.radius,
            size: Vec2::new(width as f32, height as f32),
            cell: planes.cell,
            padding: 0.0,
            sky_top: screen(palette.sky_top),
            sky_bottom: screen(palette.sky_bottom),
            ground: shown(ground, planes.ground && !has_globe),
            grid: shown(palette.grid, planes.grid_xz && !has_globe),
            walls: screen(palette.wall),
        }
    }
}

/// A uniform buffer in a bind group of its own, sent only when its values change.
#[derive(Debug)]
pub(super) struct Uniforms<T> {
    sent: Option<T>,
    buffer: wgpu::Buffer,
    pub layout: wgpu::BindGroupLayout,
    pub group: wgpu::BindGroup,
}

impl<T: Pod + PartialEq> Uniforms<T> {
    pub fn new(gpu: &Gpu, label: &'static str) -> Self {
        let size = size_of::<T>() as u64;
        let buffer = gpu.buffer(label, size, wgpu::BufferUsages::UNIFORM);
        let stages = wgpu::ShaderStages::VERTEX_FRAGMENT | wgpu::ShaderStages::COMPUTE;
        let layout = pipeline::layout(gpu, label, stages, &[BindingKind::Uniform]);
        let group = pipeline::group(gpu, label, &layout, [buffer.as_entire_binding()]);
        Self { sent: None, buffer, layout, group }
    }

    /// Sends the values to the device if they have changed, and returns the number of bytes sent.
    pub fn upload(&mut self, gpu: &Gpu, values: T) -> u64 {
        if self.sent == Some(values) {
            return 0;
        }
        gpu.queue.write_buffer(&self.buffer, 0, bytemuck::bytes_of(&values));
        self.sent = Some(values);
        size_of::<T>() as u64
    }
}
