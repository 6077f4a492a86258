use std::time::Duration;

use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Vec3, Vec4};

use super::compute::{self, Slot};
use super::{Gpu, Solver, pipeline};
use crate::rig::{Crowd, CrowdArrays, CrowdTimes, SolvedBy};
use crate::scene::{Colour, Scene};

pub(super) const CULL: &str =
    concat!(include_str!("../../shaders/crowd.wgsl"), include_str!("../../shaders/cull.wgsl"));

pub(super) const ARMS: &str = concat!(
    include_str!("../../shaders/view.wgsl"),
    include_str!("../../shaders/planes.wgsl"),
    include_str!("../../shaders/crowd.wgsl"),
    include_str!("../../shaders/arms.wgsl"),
);

/// From the nearest arms to the farthest: sides of a limb, and whether there are joints.
const LEVELS: [(u32, bool); 3] = [(12, true), (5, false), (1, false)];
/// Corners of three balls, as the shader has them.
const JOINTS: u32 = 3 * 10 * 5 * 6;
/// What an indirect draw takes: corners, instances, first corner, first instance.
const ARGUMENTS: usize = 4;

/// Radii of a limb, as parts of the arm's length.
const THICK: f32 = 0.05;
const THIN: f32 = 0.034;

#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
struct Uniform {
    planes: [Vec4; 5],
    upper: Vec4,
    lower: Vec4,
    joint: Vec4,
    eye: Vec3,
    per_depth: f32,
    forward: Vec3,
    per_pixel: f32,
    arms: u32,
    stride: u32,
    thick: f32,
    thin: f32,
}

const _: () = assert!(size_of::<Uniform>() == 8 * 16 + 3 * 16);

#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
struct Level {
    sides: u32,
    first: u32,
}

const _: () = assert!(size_of::<Level>() == 8);

/// Draws a crowd: solved here or on the device, culled there, each arm as finely as it is large.
#[derive(Debug, Default)]
pub(super) struct Crowds {
    /// Made when there is first a crowd; the inner is nothing where the adapter has no compute
    /// shaders.
    renderer: Option<Option<CrowdRenderer>>,
    times: Option<CrowdTimes>,
}

#[derive(Debug)]
struct CrowdRenderer {
    arrays: CrowdArrays,
    solver: Solver,
    cull: wgpu::ComputePipeline,
    cull_layout: wgpu::BindGroupLayout,
    draw: wgpu::RenderPipeline,
    draw_layout: wgpu::BindGroupLayout,
    uniform: wgpu::Buffer,
    arguments: wgpu::Buffer,
    levels: [wgpu::Buffer; LEVELS.len()],
    level_groups: [wgpu::BindGroup; LEVELS.len()],
    room: Room,
    /// What the device has.
    shown: Option<Crowd>,
}

/// What is as large as the solver's room.
#[derive(Debug)]
struct Room {
    shoulders: wgpu::Buffer,
    cull: wgpu::BindGroup,
    draw: wgpu::BindGroup,
}

impl Crowds {
    /// Solves the crowd if it is another than was shown last, and sends what the device does not have
    /// of it. How many bytes were sent.
    pub fn upload(
        &mut self,
        gpu: &Gpu,
        view: &wgpu::BindGroupLayout,
        scene: &Scene,
        size: (u32, u32),
    ) -> u64 {
        let Some(crowd) = scene.crowd.filter(|crowd| crowd.arms > 0) else {
            if let Some(Some(renderer)) = &mut self.renderer {
                renderer.shown = None;
            }
            self.times = None;
            return 0;
        };
        let renderer = self.renderer.get_or_insert_with(|| CrowdRenderer::new(gpu, view));
        let Some(renderer) = renderer else {
            return 0;
        };
        let mut sent = 0;
        if renderer.shown != Some(crowd) {
            sent += renderer.resize(gpu, &crowd);
            let solve = renderer.solve(gpu, &crowd);
            self.times = solve.map(|solve| CrowdTimes { arms: crowd.arms, solve });
            renderer.shown = Some(crowd);
        }
        sent + renderer.look(gpu, &crowd, scene, size)
    }

    pub fn times(&self) -> Option<CrowdTimes> {
        self.times
    }

    fn shown(&self) -> Option<(&CrowdRenderer, Crowd)> {
        let renderer = self.renderer.as_ref()?.as_ref()?;
        Some((renderer, renderer.shown?))
    }

    /// Finds out on the device what is seen of it.
    pub fn cull(&self, encoder: &mut wgpu::CommandEncoder) {
        if let Some((renderer, crowd)) = self.shown() {
            let group = (1, &renderer.room.cull);
            compute::run_for_each(encoder, "cull", &renderer.cull, group, crowd.arms);
        }
    }

    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        let Some((renderer, _)) = self.shown() else {
            return;
        };
        pass.set_pipeline(&renderer.draw);
        pass.set_bind_group(1, &renderer.room.draw, &[]);
        for (level, group) in renderer.level_groups.iter().enumerate() {
            pass.set_bind_group(2, group, &[]);
            let offset = level * ARGUMENTS * size_of::<u32>();
            pass.draw_indirect(&renderer.arguments, offset as u64);
        }
    }
}

impl CrowdRenderer {
    fn new(gpu: &Gpu, view: &wgpu::BindGroupLayout) -> Option<Self> {
        let solver = Solver::new(gpu)?;
        let flags = gpu.adapter.get_downlevel_capabilities().flags;
        let needed =
            wgpu::DownlevelFlags::VERTEX_STORAGE | wgpu::DownlevelFlags::INDIRECT_EXECUTION;
        if !flags.contains(needed) {
            log::warn!("{} draws no crowd: it lacks the shaders for it", gpu.name());
            return None;
        }
        let slots = [Slot::Uniform, Slot::Read, Slot::Read, Slot::Write, Slot::Write];
        let stages = wgpu::ShaderStages::COMPUTE;
        let cull_layout = compute::layout(gpu, "cull", stages, &slots);
        let stages = wgpu::ShaderStages::VERTEX;
        let slots = [Slot::Uniform, Slot::Read, Slot::Read, Slot::Read];
        let draw_layout = compute::layout(gpu, "crowd", stages, &slots);
        let level_layout = compute::layout(gpu, "level", stages, &[Slot::Uniform]);
        let draw = pipeline::build(
            gpu,
            &pipeline::Kind {
                label: "crowd",
                shader: ARMS,
                fragment: "fragment",
                layouts: &[view, &draw_layout, &level_layout],
                buffers: &[],
                topology: wgpu::PrimitiveTopology::TriangleList,
                cull: None,
                depth: wgpu::CompareFunction::Greater,
                opaque: true,
            },
        );
        let uniform_of = |label, size: usize| {
            compute::buffer(gpu, label, size as u64, wgpu::BufferUsages::UNIFORM)
        };
        let uniform = uniform_of("crowd", size_of::<Uniform>());
        let arguments = compute::buffer(
            gpu,
            "crowd, indirect",
            (LEVELS.len() * ARGUMENTS * size_of::<u32>()) as u64,
            wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::INDIRECT,
        );
        let levels = LEVELS.map(|_| uniform_of("level", size_of::<Level>()));
        let level_groups =
            levels.each_ref().map(|level| compute::group(gpu, "level", &level_layout, &[level]));
        let cull = compute::pipeline(gpu, "cull", CULL, &[None, Some(&cull_layout)]);
        let layouts = [&cull_layout, &draw_layout];
        let room = Room::new(gpu, &solver, layouts, [&uniform, &arguments]);
        Some(Self {
            arrays: CrowdArrays::default(),
            solver,
            cull,
            cull_layout,
            draw,
            draw_layout,
            uniform,
            arguments,
            levels,
            level_groups,
            room,
            shown: None,
        })
    }

    /// Has as many arms as the crowd, there and here.
    fn resize(&mut self, gpu: &Gpu, crowd: &Crowd) -> u64 {
        let is_other = self.arrays.resize(crowd);
        let is_larger = self.solver.reserve(gpu, crowd.arms);
        if is_larger {
            let layouts = [&self.cull_layout, &self.draw_layout];
            let buffers = [&self.uniform, &self.arguments];
            self.room = Room::new(gpu, &self.solver, layouts, buffers);
            for (level, buffer) in self.levels.iter().enumerate() {
                let (sides, _) = LEVELS[level];
                let of_level = Level { sides, first: level as u32 * self.solver.stride() };
                gpu.queue.write_buffer(buffer, 0, bytemuck::bytes_of(&of_level));
            }
        }
        if !(is_other || is_larger) {
            return 0;
        }
        let [x, z] = &self.arrays.shoulder;
        let stride = u64::from(self.solver.stride()) * size_of::<f32>() as u64;
        for (offset, numbers) in [(0, x), (stride, z)] {
            gpu.queue.write_buffer(&self.room.shoulders, offset, bytemuck::cast_slice(numbers));
        }
        2 * size_of_val(&x[..]) as u64
    }

    /// How long solving took; nothing where it failed.
    fn solve(&mut self, gpu: &Gpu, crowd: &Crowd) -> Option<Duration> {
        self.arrays.ask(crowd);
        match crowd.solved_by {
            SolvedBy::Gpu => {
                let took = self.solver.solve(gpu, crowd.bones, &self.arrays);
                took.inspect_err(|error| log::error!("the crowd was not solved: {error}")).ok()
            }
            SolvedBy::Cpu => {
                let took = self.arrays.solve(crowd.bones).ok();
                self.solver.take(gpu, &self.arrays);
                took
            }
        }
    }

    /// Sends where it is looked at from, and empties the lists of what is seen.
    fn look(&self, gpu: &Gpu, crowd: &Crowd, scene: &Scene, size: (u32, u32)) -> u64 {
        let uniform = Uniform::new(crowd, self.solver.stride(), scene, size);
        gpu.queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(&uniform));
        let arguments = LEVELS.map(|(sides, has_joints)| {
            [2 * 6 * sides + if has_joints { JOINTS } else { 0 }, 0, 0, 0]
        });
        gpu.queue.write_buffer(&self.arguments, 0, bytemuck::cast_slice(&arguments));
        (size_of::<Uniform>() + size_of_val(&arguments)) as u64
    }
}

impl Room {
    fn new(
        gpu: &Gpu,
        solver: &Solver,
        [cull, draw]: [&wgpu::BindGroupLayout; 2],
        [uniform, arguments]: [&wgpu::Buffer; 2],
    ) -> Self {
        let buffer = |label, kinds: u64| {
            let size = kinds * u64::from(solver.stride()) * size_of::<f32>() as u64;
            compute::buffer(gpu, label, size, wgpu::BufferUsages::STORAGE)
        };
        let shoulders = buffer("shoulders", 2);
        let seen = buffer("seen of a crowd", LEVELS.len() as u64);
        let posed = solver.posed();
        let to_cull = [uniform, &shoulders, posed, &seen, arguments];
        let cull = compute::group(gpu, "cull", cull, &to_cull);
        let draw = compute::group(gpu, "crowd", draw, &[uniform, &shoulders, posed, &seen]);
        Self { cull, draw, shoulders }
    }
}

impl Uniform {
    fn new(crowd: &Crowd, stride: u32, scene: &Scene, (width, height): (u32, u32)) -> Self {
        let projection = scene.camera.projection(width as f32 / height as f32);
        let screen = |colour: Colour| Vec4::from_array(colour.channels());
        let reach = crowd.bones.outer_limit();
        // A picture is two of the vector to its upper edge high, at depth 1.
        let pixel = 2.0 * projection.up.length() / height as f32;
        let (per_depth, per_pixel) =
            if projection.orthographic { (0.0, pixel) } else { (pixel, 0.0) };
        Self {
            planes: planes(projection.clip_from_world),
            upper: screen(scene.palette.upper),
            lower: screen(scene.palette.lower),
            joint: screen(scene.palette.joint),
            eye: projection.eye,
            per_depth,
            forward: projection.forward,
            per_pixel,
            arms: crowd.arms,
            stride,
            thick: THICK * reach,
            thin: THIN * reach,
        }
    }
}

/// The sides of what is seen: left, right, bottom, top and near, with unit normals inwards (G. Gribb,
/// K. Hartmann, *Fast Extraction of Viewing Frustum Planes*, 2001; depth is 1 at the near plane).
fn planes(clip_from_world: Mat4) -> [Vec4; 5] {
    let [x, y, z, w] = [0, 1, 2, 3].map(|row| clip_from_world.row(row));
    [w + x, w - x, w + y, w - y, w - z].map(|plane| {
        let length = plane.truncate().length();
        if length > 0.0 { plane / length } else { plane }
    })
}
