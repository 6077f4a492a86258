use std::time::Duration;

use bytemuck::{Pod, Zeroable};
use web_time::Instant;

use super::Gpu;
use super::pipeline::{self, BindingKind};
use super::readback::{ReadError, fetch};
use crate::kinematics::two_bone::TwoBone;
use crate::rig::{Crowd, CrowdArrays, Processor};

pub(super) const SHADER: &str = include_str!("../../shaders/crowd_solver.wgsl");

/// Number of arrays of a crowd's targets: Cursor x, y and z, cosine and sine of the twist.
const TARGET_ARRAYS: u64 = 5;
/// Number of arrays of a crowd's poses: elbow x, y and z, hand x, y and z.
const POSE_ARRAYS: u64 = 6;
const FLOAT: u64 = size_of::<f32>() as u64;

/// Maximum wait for the device. A device that takes longer is considered to have hung.
const TIMEOUT: wgpu::PollType =
    wgpu::PollType::Wait { submission_index: None, timeout: Some(Duration::from_secs(10)) };

#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
struct CrowdSolverData {
    arms: u32,
    stride: u32,
    upper: f32,
    lower: f32,
}

const _: () = assert!(size_of::<CrowdSolverData>() == 16);

/// Solves the arms of a crowd on the device, with the formulas of
/// [`two_bone`](crate::kinematics::two_bone), or uploads poses that were solved on the CPU. In both
/// cases the poses are then in the buffer from which the crowd is drawn.
#[derive(Debug)]
pub struct CrowdSolver {
    pipeline: wgpu::ComputePipeline,
    layout: wgpu::BindGroupLayout,
    uniform: wgpu::Buffer,
    buffers: CrowdSolverBuffers,
    arms: u32,
}

/// Buffers with room for `stride` arms; each array starts `stride` floats after the previous one.
#[derive(Debug)]
struct CrowdSolverBuffers {
    stride: u32,
    targets: wgpu::Buffer,
    poses: wgpu::Buffer,
    group: wgpu::BindGroup,
}

impl CrowdSolver {
    /// Creates a solver with room for one arm; `None` if the adapter has no compute shaders.
    pub fn new(gpu: &Gpu) -> Option<Self> {
        let flags = gpu.adapter.get_downlevel_capabilities().flags;
        if !flags.contains(wgpu::DownlevelFlags::COMPUTE_SHADERS) {
            return None;
        }
        let kinds = [BindingKind::Uniform, BindingKind::Read, BindingKind::Write];
        let layout = pipeline::layout(gpu, "crowd solver", wgpu::ShaderStages::COMPUTE, &kinds);
        let pipeline = pipeline::compute(gpu, "crowd solver", SHADER, &[Some(&layout)]);
        let size = size_of::<CrowdSolverData>() as u64;
        let uniform = gpu.buffer("crowd solver", size, wgpu::BufferUsages::UNIFORM);
        let buffers = CrowdSolverBuffers::new(gpu, &layout, &uniform, 1);
        Some(Self { pipeline, layout, uniform, buffers, arms: 0 })
    }

    /// Number of bytes that a crowd sends to the device: targets if the device solves it, else
    /// poses.
    pub(super) fn bytes(crowd: &Crowd) -> u64 {
        let arrays = match crowd.processor {
            Processor::Gpu => TARGET_ARRAYS,
            Processor::Cpu => POSE_ARRAYS,
        };
        arrays * u64::from(crowd.arms) * FLOAT
    }

    /// Capacity of the buffers in arms; also the distance in floats between the starts of two
    /// arrays in a buffer.
    pub fn stride(&self) -> u32 {
        self.buffers.stride
    }

    /// Buffer of the poses in Root space: arrays of x, y and z of the elbows, then of the hands.
    pub(super) fn poses(&self) -> &wgpu::Buffer {
        &self.buffers.poses
    }

    /// Makes room for at least `arms` arms. Room grows in powers of two, so that a growing crowd
    /// seldom replaces the buffers; returns whether this call did.
    pub fn reserve(&mut self, gpu: &Gpu, arms: u32) -> bool {
        let is_small = self.buffers.stride < arms;
        if is_small {
            self.resize(gpu, arms.next_power_of_two());
        }
        is_small
    }

    /// Frees the memory of the arms.
    pub fn release(&mut self, gpu: &Gpu) {
        self.resize(gpu, 1);
    }

    fn resize(&mut self, gpu: &Gpu, stride: u32) {
        self.buffers = CrowdSolverBuffers::new(gpu, &self.layout, &self.uniform, stride);
        self.arms = 0;
    }

    /// Uploads the targets, solves the arms on the device, and returns the time from submission to
    /// completion, without the upload. The buffers must have room for all arms: see
    /// [`reserve`](Self::reserve).
    ///
    /// # Errors
    ///
    /// If the device does not finish within ten seconds.
    ///
    /// # Panics
    ///
    /// If the device is lost, as in every `wgpu` function that waits for the device.
    pub fn solve(
        &mut self,
        gpu: &Gpu,
        bones: TwoBone,
        arrays: &CrowdArrays,
    ) -> Result<Duration, wgpu::PollError> {
        let CrowdArrays { cursor: [x, y, z], cos, sin, .. } = arrays;
        self.arms = arrays.len() as u32;
        for (index, array) in [x, y, z, cos, sin].into_iter().enumerate() {
            self.buffers.write(gpu, &self.buffers.targets, index, array);
        }
        let data = CrowdSolverData {
            arms: self.arms,
            stride: self.buffers.stride,
            upper: bones.upper(),
            lower: bones.lower(),
        };
        gpu.queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(&data));
        gpu.queue.submit([]);
        gpu.device.poll(TIMEOUT)?;

        let descriptor = wgpu::CommandEncoderDescriptor { label: Some("crowd solver") };
        let mut encoder = gpu.device.create_command_encoder(&descriptor);
        let groups = [&self.buffers.group];
        pipeline::run_for_each(&mut encoder, "crowd solver", &self.pipeline, &groups, self.arms);
        let commands = encoder.finish();
        let start = Instant::now();
        gpu.queue.submit([commands]);
        gpu.device.poll(TIMEOUT)?;
        Ok(start.elapsed())
    }

    /// Uploads poses that were solved on the CPU. The buffers must have room for all arms: see
    /// [`reserve`](Self::reserve).
    pub fn upload_poses(&mut self, gpu: &Gpu, arrays: &CrowdArrays) {
        self.arms = arrays.len() as u32;
        for (index, array) in arrays.elbow.iter().chain(&arrays.hand).enumerate() {
            self.buffers.write(gpu, &self.buffers.poses, index, array);
        }
    }

    /// Waits for the device and reads back the elbows and hands in Root space: for each an array of
    /// x, of y and of z.
    ///
    /// # Errors
    ///
    /// If the device fails.
    pub async fn read(&self, gpu: &Gpu) -> Result<[[Vec<f32>; 3]; 2], ReadError> {
        let size = POSE_ARRAYS * u64::from(self.buffers.stride) * FLOAT;
        let usage = wgpu::BufferUsages::MAP_READ;
        let copy = gpu.buffer("crowd poses, read back", size, usage);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(&self.buffers.poses, 0, &copy, 0, size);
        gpu.queue.submit([encoder.finish()]);
        let mapped = fetch(gpu, &copy).await?;
        let floats: &[f32] = bytemuck::cast_slice(&mapped);
        let array = |index: usize| {
            let first = index * self.buffers.stride as usize;
            floats[first..first + self.arms as usize].to_vec()
        };
        Ok([[array(0), array(1), array(2)], [array(3), array(4), array(5)]])
    }
}

impl CrowdSolverBuffers {
    fn new(gpu: &Gpu, layout: &wgpu::BindGroupLayout, uniform: &wgpu::Buffer, stride: u32) -> Self {
        let buffer = |label, arrays: u64| {
            let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC;
            gpu.buffer(label, arrays * u64::from(stride) * FLOAT, usage)
        };
        let targets = buffer("crowd targets", TARGET_ARRAYS);
        let poses = buffer("crowd poses", POSE_ARRAYS);
        let resources = [uniform, &targets, &poses].map(wgpu::Buffer::as_entire_binding);
        let group = pipeline::group(gpu, "crowd solver", layout, resources);
        Self { stride, targets, poses, group }
    }

    fn write(&self, gpu: &Gpu, buffer: &wgpu::Buffer, index: usize, array: &[f32]) {
        let offset = index as u64 * u64::from(self.stride) * FLOAT;
        gpu.queue.write_buffer(buffer, offset, bytemuck::cast_slice(array));
    }
}
