use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Vec2, Vec3, Vec4};

use super::Gpu;
use super::uniforms::Uniforms;
use crate::scene::{Colour, Scene};

/// What every shader of the scene sees, as `view.wgsl` has it.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
struct Uniform {
    clip_from_world: Mat4,
    eye: Vec3,
    orthographic: f32,
    forward: Vec3,
    focus_distance: f32,
    right: Vec3,
    pixel_scale: f32,
    up: Vec3,
    shadow_strength: f32,
    stage_centre: Vec3,
    stage_radius: f32,
    size: Vec2,
    cell: f32,
    padding: f32,
    shown: Vec4,
    sky_top: Vec4,
    sky_bottom: Vec4,
    ground: Vec4,
    grid: Vec4,
    axes: [Vec4; 3],
}

const _: () = assert!(size_of::<Uniform>() == 64 + 5 * 16 + 16 + 8 * 16);

/// The uniform on the device.
#[derive(Debug)]
pub(super) struct View(Uniforms<Uniform>);

impl View {
    pub fn new(gpu: &Gpu) -> Self {
        Self(Uniforms::new(gpu, "view"))
    }

    pub fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.0.layout
    }

    pub fn group(&self) -> &wgpu::BindGroup {
        &self.0.group
    }

    /// How many bytes were sent. `scale` is how many pixels a point has.
    pub fn upload(&mut self, gpu: &Gpu, scene: &Scene, size: (u32, u32), scale: f32) -> u64 {
        self.0.upload(gpu, Uniform::new(scene, size, scale))
    }
}

impl Uniform {
    /// How much of what is below the ground shows through it.
    const GROUND_OPACITY: f32 = 0.55;

    fn new(scene: &Scene, (width, height): (u32, u32), scale: f32) -> Self {
        let (palette, stage) = (&scene.palette, &scene.stage);
        let projection = scene.camera.projection(width as f32 / height as f32);
        let screen = |colour: Colour| Vec4::from_array(colour.channels());
        let shown = [stage.grid_yz, stage.grid_xz, stage.grid_xy, stage.ground];
        Self {
            clip_from_world: projection.clip_from_world,
            eye: projection.eye,
            orthographic: if projection.orthographic { 1.0 } else { 0.0 },
            forward: projection.forward,
            focus_distance: scene.camera.distance,
            right: projection.right,
            pixel_scale: scale,
            up: projection.up,
            shadow_strength: palette.shadow,
            stage_centre: stage.centre,
            stage_radius: stage.radius,
            size: Vec2::new(width as f32, height as f32),
            cell: stage.cell,
            padding: 0.0,
            shown: Vec4::from_array(shown.map(|shown| if shown { 1.0 } else { 0.0 })),
            sky_top: screen(palette.sky_top),
            sky_bottom: screen(palette.sky_bottom),
            ground: screen(palette.ground.with_opacity(Self::GROUND_OPACITY)),
            grid: screen(palette.grid),
            axes: palette.axes.map(screen),
        }
    }
}
