use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Vec3, Vec4};
use thiserror::Error;

use super::crowd_lod::{CrowdLod, CrowdLodData, DrawArguments};
use super::pipeline::{self, BindingKind, PipelineDescriptor, PipelineOutput};
use super::readback::Readback;
use super::{Canvas, CrowdSolver, Gpu};
use crate::rig::{Crowd, CrowdArrays, CrowdTimes, Processor};
use crate::scene::{Colour, Scene};

pub(super) const CULL: &str = concat!(
    include_str!("../../shaders/view.wgsl"),
    include_str!("../../shaders/crowd.wgsl"),
    include_str!("../../shaders/crowd_cull.wgsl")
);

const ARGUMENT_BYTES: u64 = size_of_val(&CrowdLod::NO_DRAWS) as u64;

/// Radius of a limb at its base, as a fraction of the arm's length.
const BASE_RADIUS: f32 = 0.05;

#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
struct CrowdData {
    planes: [Vec4; 5],
    upper: Vec4,
    lower: Vec4,
    joint: Vec4,
    lods: [CrowdLodData; CrowdLod::COUNT],
    eye: Vec3,
    pixel_per_depth: f32,
    forward: Vec3,
    pixel: f32,
    arms: u32,
    stride: u32,
    base_radius: f32,
    resolution_scale: f32,
}

const _: () = assert!(size_of::<CrowdData>() == 8 * 16 + 5 * 16 + 3 * 16);

/// Draws a crowd: solves it on the CPU or the device, culls it on the device, and draws each arm
/// with a level of detail that depends on its size on screen.
#[derive(Debug, Default)]
pub(super) struct Crowds {
    /// Created when the first crowd is drawn.
    renderer: Option<Result<CrowdRenderer, CrowdError>>,
    times: Option<Result<CrowdTimes, CrowdError>>,
}

#[derive(Debug)]
struct CrowdRenderer {
    arrays: CrowdArrays,
    solver: CrowdSolver,
    cull: wgpu::ComputePipeline,
    cull_layout: wgpu::BindGroupLayout,
    draw: [wgpu::RenderPipeline; CrowdLod::COUNT],
    draw_layout: wgpu::BindGroupLayout,
    uniform: wgpu::Buffer,
    arguments: wgpu::Buffer,
    drawn: Readback,
    /// Number of triangles of the arms in view, as last read back.
    triangles: u32,
    buffers: CrowdBuffers,
    /// Crowd whose poses are on the device; `None` if there is none.
    uploaded: Option<Crowd>,
}

/// Buffers whose arrays have the solver's stride, and the bind groups of these buffers.
#[derive(Debug)]
struct CrowdBuffers {
    shoulders: wgpu::Buffer,
    cull: wgpu::BindGroup,
    draw: wgpu::BindGroup,
}

impl Crowds {
    /// Solves the scene's crowd if it has changed, uploads the changes for a picture on the canvas,
    /// and returns the number of bytes sent.
    pub fn upload(
        &mut self,
        gpu: &Gpu,
        view: &wgpu::BindGroupLayout,
        scene: &Scene,
        canvas: &Canvas,
    ) -> u64 {
        let Some(crowd) = scene.crowd.filter(|crowd| crowd.arms > 0) else {
            if let Some(Ok(renderer)) = &mut self.renderer {
                renderer.release(gpu);
            }
            self.times = None;
            return 0;
        };
        let renderer = match self.renderer.get_or_insert_with(|| CrowdRenderer::new(gpu, view)) {
            Ok(renderer) => renderer,
            Err(error) => {
                self.times = Some(Err(error.clone()));
                return 0;
            }
        };
        let mut sent = 0;
        if renderer.uploaded != Some(crowd) {
            sent += renderer.resize(gpu, &crowd) + CrowdSolver::bytes(&crowd);
            self.times = Some(renderer.solve(gpu, &crowd));
            renderer.uploaded = Some(crowd);
        }
        sent + renderer.set_view(gpu, &crowd, scene, canvas)
    }

    /// Number of arms and solver time of the last scene's crowd; `None` without a crowd.
    pub fn times(&self) -> Result<Option<CrowdTimes>, CrowdError> {
        self.times.clone().transpose()
    }

    /// Number of triangles of the arms in view in an earlier frame. Lines and points count none.
    pub fn triangles(&self) -> u32 {
        self.uploaded().map_or(0, |(renderer, _)| renderer.triangles)
    }

    /// Reads the number of triangles of an earlier frame back, if it has arrived.
    pub fn read_triangles(&mut self) {
        if let Some(Ok(renderer)) = &mut self.renderer {
            renderer.drawn.fetch();
            let triangles = renderer.drawn.read(|bytes| Some(CrowdLod::triangles(bytes)));
            renderer.triangles = triangles.unwrap_or(renderer.triangles);
        }
    }

    /// True if the number of triangles of an earlier frame has not arrived yet.
    pub fn awaits_triangles(&self) -> bool {
        self.uploaded().is_some_and(|(renderer, _)| !renderer.drawn.is_free())
    }

    fn uploaded(&self) -> Option<(&CrowdRenderer, Crowd)> {
        let renderer = self.renderer.as_ref()?.as_ref().ok()?;
        Some((renderer, renderer.uploaded?))
    }

    /// Encodes the culling, which writes the arguments of the indirect draws.
    pub fn cull(&self, encoder: &mut wgpu::CommandEncoder, view: &wgpu::BindGroup) {
        if let Some((renderer, crowd)) = self.uploaded() {
            let groups = [view, &renderer.buffers.cull];
            pipeline::run_for_each(encoder, "crowd culling", &renderer.cull, &groups, crowd.arms);
            if renderer.drawn.is_free() {
                renderer.drawn.copy(encoder, &renderer.arguments);
            }
        }
    }

    /// Draws the arms that are near.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        self.draw_lods(pass, |lod| !lod.is_far());
    }

    /// Draws the arms that are far, whose colours have been mixed with that of the floor.
    pub fn draw_far(&self, pass: &mut wgpu::RenderPass<'_>) {
        self.draw_lods(pass, CrowdLod::is_far);
    }

    fn draw_lods(&self, pass: &mut wgpu::RenderPass<'_>, is_drawn: impl Fn(&CrowdLod) -> bool) {
        let Some((renderer, _)) = self.uploaded() else {
            return;
        };
        pass.set_bind_group(1, &renderer.buffers.draw, &[]);
        let lods = CrowdLod::ALL.iter().zip(&renderer.draw).enumerate();
        for (index, (_, pipeline)) in lods.filter(|(_, (lod, _))| is_drawn(lod)) {
            pass.set_pipeline(pipeline);
            let offset = index * size_of::<DrawArguments>();
            pass.draw_indirect(&renderer.arguments, offset as u64);
        }
    }
}

impl CrowdRenderer {
    fn new(gpu: &Gpu, view: &wgpu::BindGroupLayout) -> Result<Self, CrowdError> {
        let unsupported = || CrowdError::Unsupported(gpu.name());
        let solver = CrowdSolver::new(gpu).ok_or_else(unsupported)?;
        let flags = gpu.adapter.get_downlevel_capabilities().flags;
        let needed =
            wgpu::DownlevelFlags::VERTEX_STORAGE | wgpu::DownlevelFlags::INDIRECT_EXECUTION;
        if !flags.contains(needed) {
            return Err(unsupported());
        }
        let kinds = [
            BindingKind::Uniform,
            BindingKind::Read,
            BindingKind::Read,
            BindingKind::Write,
            BindingKind::Write,
        ];
        let stages = wgpu::ShaderStages::COMPUTE;
        let cull_layout = pipeline::layout(gpu, "crowd culling", stages, &kinds);
        let stages = wgpu::ShaderStages::VERTEX;
        let kinds = [BindingKind::Uniform, BindingKind::Read, BindingKind::Read, BindingKind::Read];
        let draw_layout = pipeline::layout(gpu, "crowd", stages, &kinds);
        let layouts = [view, &draw_layout];
        let draw = std::array::from_fn(|index| {
            let lod = CrowdLod::ALL[index];
            PipelineDescriptor {
                constants: &[("LOD", index as f64)],
                topology: lod.topology,
                ..PipelineDescriptor::new("crowd", lod.shader, &layouts, PipelineOutput::Opaque)
            }
            .build(gpu)
        });
        let size = size_of::<CrowdData>() as u64;
        let uniform = gpu.buffer("crowd", size, wgpu::BufferUsages::UNIFORM);
        let arguments = gpu.buffer(
            "crowd, indirect",
            ARGUMENT_BYTES,
            wgpu::BufferUsages::STORAGE
                | wgpu::BufferUsages::INDIRECT
                | wgpu::BufferUsages::COPY_SRC,
        );
        let cull = pipeline::compute(gpu, "crowd culling", CULL, &[Some(view), Some(&cull_layout)]);
        let layouts = [&cull_layout, &draw_layout];
        let buffers = CrowdBuffers::new(gpu, &solver, layouts, [&uniform, &arguments]);
        Ok(Self {
            arrays: CrowdArrays::default(),
            solver,
            cull,
            cull_layout,
            draw,
            draw_layout,
            uniform,
            arguments,
            drawn: Readback::new(gpu, "crowd, read back", ARGUMENT_BYTES),
            triangles: 0,
            buffers,
            uploaded: None,
        })
    }

    /// Resizes the arrays and buffers to the crowd's number of arms, and uploads the positions of
    /// the shoulders if they have changed. Returns the number of bytes sent.
    fn resize(&mut self, gpu: &Gpu, crowd: &Crowd) -> u64 {
        let has_changed = self.arrays.resize(crowd);
        let is_larger = self.solver.reserve(gpu, crowd.arms);
        if is_larger {
            self.replace_buffers(gpu);
        }
        if !(has_changed || is_larger) {
            return 0;
        }
        let [x, z] = &self.arrays.shoulder;
        let stride = u64::from(self.solver.stride()) * size_of::<f32>() as u64;
        for (offset, array) in [(0, x), (stride, z)] {
            gpu.queue.write_buffer(&self.buffers.shoulders, offset, bytemuck::cast_slice(array));
        }
        2 * size_of_val(&x[..]) as u64
    }

    fn replace_buffers(&mut self, gpu: &Gpu) {
        let layouts = [&self.cull_layout, &self.draw_layout];
        let buffers = [&self.uniform, &self.arguments];
        self.buffers = CrowdBuffers::new(gpu, &self.solver, layouts, buffers);
    }

    /// Frees the memory of a crowd that is no longer shown.
    fn release(&mut self, gpu: &Gpu) {
        if self.uploaded.take().is_some() {
            self.arrays = CrowdArrays::default();
            self.solver.release(gpu);
            self.replace_buffers(gpu);
            self.triangles = 0;
        }
    }

    fn solve(&mut self, gpu: &Gpu, crowd: &Crowd) -> Result<CrowdTimes, CrowdError> {
        self.arrays.set_targets(crowd);
        let solve = match crowd.processor {
            Processor::Gpu => self
                .solver
                .solve(gpu, crowd.bones, &self.arrays)
                .map_err(|error| CrowdError::Device(error.to_string()))?,
            Processor::Cpu => {
                // All arrays have the same length, so `solve` returns no error.
                let time = self.arrays.solve(crowd.bones).unwrap_or_default();
                self.solver.upload_poses(gpu, &self.arrays);
                time
            }
        };
        Ok(CrowdTimes { arms: crowd.arms, solve })
    }

    /// Uploads the camera, resets the arguments of the indirect draws, and returns the number of
    /// bytes sent.
    fn set_view(&self, gpu: &Gpu, crowd: &Crowd, scene: &Scene, canvas: &Canvas) -> u64 {
        let data = CrowdData::new(crowd, self.solver.stride(), scene, canvas);
        gpu.queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(&data));
        gpu.queue.write_buffer(&self.arguments, 0, bytemuck::cast_slice(&CrowdLod::NO_DRAWS));
        size_of::<CrowdData>() as u64 + ARGUMENT_BYTES
    }
}

impl CrowdBuffers {
    fn new(
        gpu: &Gpu,
        solver: &CrowdSolver,
        layouts: [&wgpu::BindGroupLayout; 2],
        [uniform, arguments]: [&wgpu::Buffer; 2],
    ) -> Self {
        let buffer = |label, arrays: u64| {
            let size = arrays * u64::from(solver.stride()) * size_of::<f32>() as u64;
            gpu.buffer(label, size, wgpu::BufferUsages::STORAGE)
        };
        let shoulders = buffer("crowd shoulders", 2);
        let visible = buffer("crowd, visible arms", CrowdLod::words().into());
        let poses = solver.poses();
        let to_cull = [uniform, &shoulders, poses, &visible, arguments];
        let to_draw = [uniform, &shoulders, poses, &visible];
        let cull = to_cull.map(wgpu::Buffer::as_entire_binding);
        let draw = to_draw.map(wgpu::Buffer::as_entire_binding);
        let cull = pipeline::group(gpu, "crowd culling", layouts[0], cull);
        let draw = pipeline::group(gpu, "crowd", layouts[1], draw);
        Self { cull, draw, shoulders }
    }
}

impl CrowdData {
    fn new(crowd: &Crowd, stride: u32, scene: &Scene, canvas: &Canvas) -> Self {
        let (width, height) = canvas.drawn_size();
        let projection = scene.camera.projection(width as f32 / height as f32);
        let screen = |colour: Colour| Vec4::from_array(colour.channels());
        let reach = crowd.bones.outer_limit();
        // `up` is half the height of the picture, at depth 1 in perspective.
        let pixel = 2.0 * projection.up.length() / height as f32;
        let (pixel_per_depth, pixel) =
            if projection.orthographic { (0.0, pixel) } else { (pixel, 0.0) };
        Self {
            planes: frustum_planes(projection.clip_from_world),
            upper: screen(scene.palette.upper),
            lower: screen(scene.palette.lower),
            joint: screen(scene.palette.joint),
            lods: CrowdLod::data(stride),
            eye: projection.eye,
            pixel_per_depth,
            forward: projection.forward,
            pixel,
            arms: crowd.arms,
            stride,
            base_radius: BASE_RADIUS * reach,
            resolution_scale: canvas.resolution_scale(),
        }
    }
}

/// Left, right, bottom, top and near planes of the view frustum, with unit normals pointing inwards
/// (G. Gribb, K. Hartmann, *Fast Extraction of Viewing Frustum Planes*, 2001), for reversed depth,
/// which is 1 at the near plane.
fn frustum_planes(clip_from_world: Mat4) -> [Vec4; 5] {
    let [x, y, z, w] = [0, 1, 2, 3].map(|row| clip_from_world.row(row));
    [w + x, w - x, w + y, w - y, w - z].map(|plane| {
        let length = plane.truncate().length();
        if length > 0.0 { plane / length } else { plane }
    })
}

/// Reasons why a crowd is not drawn.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum CrowdError {
    /// The adapter, named here, lacks a feature that crowds require.
    #[error(
        "the graphics adapter {0} cannot draw crowds: it lacks compute shaders, storage buffers in \
         vertex shaders or indirect drawing"
    )]
    Unsupported(String),
    /// The device failed or hung while it solved the crowd.
    #[error("the graphics device did not solve the crowd: {0}")]
    Device(String),
}
