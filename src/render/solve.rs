use std::time::{Duration, Instant};

use bytemuck::{Pod, Zeroable};

use super::compute::{self, Slot};
use super::{Gpu, ReadError};
use crate::kinematics::two_bone::TwoBone;
use crate::rig::CrowdArrays;

pub(super) const SHADER: &str = include_str!("../../shaders/solve.wgsl");

/// Cursor x, y, z, cosine, sine.
const ASKED: u64 = 5;
/// Elbow x, y, z, hand x, y, z.
const POSED: u64 = 6;
const NUMBER: u64 = size_of::<f32>() as u64;

/// A device that takes longer hangs.
const PATIENCE: wgpu::PollType =
    wgpu::PollType::Wait { submission_index: None, timeout: Some(Duration::from_secs(10)) };

#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
struct Uniform {
    arms: u32,
    stride: u32,
    upper: f32,
    lower: f32,
}

const _: () = assert!(size_of::<Uniform>() == 16);

/// Solves the arms of a crowd on the device, by the mathematics of
/// [`two_bone`](crate::kinematics::two_bone), or takes what was solved elsewhere: either way their
/// poses are there for what draws them.
#[derive(Debug)]
pub struct Solver {
    pipeline: wgpu::ComputePipeline,
    layout: wgpu::BindGroupLayout,
    uniform: wgpu::Buffer,
    room: Room,
    arms: u32,
}

/// Buffers for so many arms: the stride from one kind of number to the next.
#[derive(Debug)]
struct Room {
    arms: u32,
    asked: wgpu::Buffer,
    posed: wgpu::Buffer,
    group: wgpu::BindGroup,
}

impl Solver {
    /// Nothing where the adapter has no compute shaders.
    pub fn new(gpu: &Gpu) -> Option<Self> {
        let flags = gpu.adapter.get_downlevel_capabilities().flags;
        if !flags.contains(wgpu::DownlevelFlags::COMPUTE_SHADERS) {
            return None;
        }
        let slots = [Slot::Uniform, Slot::Read, Slot::Write];
        let layout = compute::layout(gpu, "solve", wgpu::ShaderStages::COMPUTE, &slots);
        let pipeline = compute::pipeline(gpu, "solve", SHADER, &[Some(&layout)]);
        let size = size_of::<Uniform>() as u64;
        let uniform = compute::buffer(gpu, "solve", size, wgpu::BufferUsages::UNIFORM);
        let room = Room::new(gpu, &layout, &uniform, 1);
        Some(Self { pipeline, layout, uniform, room, arms: 0 })
    }

    /// How many arms there is room for: from one kind of number to the next in its buffers.
    pub fn stride(&self) -> u32 {
        self.room.arms
    }

    /// Elbows' x, y, z and hands' x, y, z, in Root space.
    pub(super) fn posed(&self) -> &wgpu::Buffer {
        &self.room.posed
    }

    /// Has room for at least so many arms. Says whether the buffers are others now.
    pub fn reserve(&mut self, gpu: &Gpu, arms: u32) -> bool {
        let is_small = self.room.arms < arms;
        if is_small {
            self.room = Room::new(gpu, &self.layout, &self.uniform, arms);
        }
        is_small
    }

    /// Sends what is asked of the arms, there being [room](Self::reserve), and has the device solve
    /// them. Says how long that took from the order to its end, the sending left out.
    ///
    /// # Errors
    ///
    /// If the device has not done it after ten seconds.
    ///
    /// # Panics
    ///
    /// As all that waits for a device in `wgpu`, if that is lost meanwhile.
    pub fn solve(
        &mut self,
        gpu: &Gpu,
        bones: TwoBone,
        arrays: &CrowdArrays,
    ) -> Result<Duration, wgpu::PollError> {
        let CrowdArrays { cursor: [x, y, z], cos, sin, .. } = arrays;
        self.arms = arrays.len() as u32;
        for (kind, numbers) in [x, y, z, cos, sin].into_iter().enumerate() {
            self.room.write(gpu, &self.room.asked, kind, numbers);
        }
        let uniform = Uniform {
            arms: self.arms,
            stride: self.room.arms,
            upper: bones.upper(),
            lower: bones.lower(),
        };
        gpu.queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(&uniform));
        gpu.queue.submit([]);
        gpu.device.poll(PATIENCE)?;

        let descriptor = wgpu::CommandEncoderDescriptor { label: Some("solve") };
        let mut encoder = gpu.device.create_command_encoder(&descriptor);
        let group = (0, &self.room.group);
        compute::run_for_each(&mut encoder, "solve", &self.pipeline, group, self.arms);
        let orders = encoder.finish();
        let start = Instant::now();
        gpu.queue.submit([orders]);
        gpu.device.poll(PATIENCE)?;
        Ok(start.elapsed())
    }

    /// Sends poses that were solved elsewhere, there being [room](Self::reserve).
    pub fn take(&mut self, gpu: &Gpu, arrays: &CrowdArrays) {
        self.arms = arrays.len() as u32;
        for (kind, numbers) in arrays.elbow.iter().chain(&arrays.hand).enumerate() {
            self.room.write(gpu, &self.room.posed, kind, numbers);
        }
    }

    /// Waits for the device and reads elbows and hands back.
    ///
    /// # Errors
    ///
    /// If the device fails meanwhile.
    pub fn read(&self, gpu: &Gpu) -> Result<[[Vec<f32>; 3]; 2], ReadError> {
        let size = POSED * u64::from(self.room.arms) * NUMBER;
        let usage = wgpu::BufferUsages::MAP_READ;
        let copy = compute::buffer(gpu, "poses, read", size, usage);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(&self.room.posed, 0, &copy, 0, size);
        gpu.queue.submit([encoder.finish()]);
        let mapped = super::canvas::fetch(gpu, &copy)?;
        let numbers: &[f32] = bytemuck::cast_slice(&mapped);
        let of = |kind: usize| {
            let first = kind * self.room.arms as usize;
            numbers[first..first + self.arms as usize].to_vec()
        };
        Ok([[of(0), of(1), of(2)], [of(3), of(4), of(5)]])
    }
}

impl Room {
    fn new(gpu: &Gpu, layout: &wgpu::BindGroupLayout, uniform: &wgpu::Buffer, arms: u32) -> Self {
        let buffer = |label, kinds: u64| {
            let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC;
            compute::buffer(gpu, label, kinds * u64::from(arms) * NUMBER, usage)
        };
        let (asked, posed) = (buffer("asked of a crowd", ASKED), buffer("poses", POSED));
        let group = compute::group(gpu, "solve", layout, &[uniform, &asked, &posed]);
        Self { arms, asked, posed, group }
    }

    fn write(&self, gpu: &Gpu, buffer: &wgpu::Buffer, kind: usize, numbers: &[f32]) {
        let offset = kind as u64 * u64::from(self.arms) * NUMBER;
        gpu.queue.write_buffer(buffer, offset, bytemuck::cast_slice(numbers));
    }
}
