use bytemuck::{Pod, Zeroable};
use glam::{Affine3A, Vec3, Vec4};

use super::Gpu;
use super::pipeline::{self, BindingKind};
use super::readback::{ReadError, fetch};
use crate::kinematics::skeleton::JointId;
use crate::kinematics::skin::{JointDeform, SkinPose, SkinnedMesh, Skinning};

pub(super) const SHADER: &str = include_str!("../../shaders/skin_deform.wgsl");

/// Moves vertices of skins on the device; on a device without compute shaders, on the CPU.
#[derive(Debug)]
pub struct SkinDeformer {
    /// `None` without compute shaders.
    pipeline: Option<wgpu::ComputePipeline>,
    layout: wgpu::BindGroupLayout,
}

/// The vertices of a mesh on the device, as they were attached.
#[derive(Debug)]
pub(super) struct SkinVertices {
    buffer: wgpu::Buffer,
    count: u32,
    /// Number of joints in each set of inverse bind transforms.
    joints: u32,
    /// Number of joints in all sets.
    all_joints: u32,
}

/// A mesh and how it is to be moved.
#[derive(Clone, Copy)]
pub(super) struct Deformation<'a> {
    pub mesh: &'a SkinnedMesh,
    pub pose: &'a SkinPose,
    pub skinning: Skinning,
    /// The joint whose weights are passed on; `None` for none.
    pub weights_of: Option<JointId>,
}

/// The vertices of a mesh in a pose on the device.
#[derive(Debug)]
pub(super) struct DeformedSkin {
    uniform: wgpu::Buffer,
    joints: wgpu::Buffer,
    /// Vertices with position and normal in the world.
    pub vertices: wgpu::Buffer,
    group: wgpu::BindGroup,
    /// The uniforms of the pose that the vertices are in; `None` before the first.
    data: Option<SkinData>,
    /// The joints of that pose.
    sent: Vec<JointData>,
}

#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
struct SkinData {
    to_world: [Vec4; 3],
    vertices: u32,
    skinning: u32,
    weights_of: i32,
    joints: u32,
}

#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
struct JointData {
    matrix: [Vec4; 3],
    turn: [Vec4; 3],
    turn_twice: [Vec4; 3],
    scale: [Vec4; 3],
    real: Vec4,
    dual: Vec4,
    along: Vec4,
    roll: Vec4,
}

#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
struct VertexData {
    position: Vec3,
    joints_low: u32,
    normal: Vec3,
    joints_high: u32,
    weights: [f32; 4],
}

/// A vertex in the world; the weight of the chosen joint is the position's w.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(super) struct DeformedVertex {
    position: Vec4,
    normal: Vec4,
}

const _: () = assert!(size_of::<SkinData>() == 64);
const _: () = assert!(size_of::<JointData>() == 256);
const _: () = assert!(size_of::<VertexData>() == 48);
const _: () = assert!(size_of::<DeformedVertex>() == 32);

impl SkinDeformer {
    /// Creates the pipeline.
    pub fn new(gpu: &Gpu) -> Self {
        let kinds =
            [BindingKind::Uniform, BindingKind::Read, BindingKind::Read, BindingKind::Write];
        let layout = pipeline::layout(gpu, "skin", wgpu::ShaderStages::COMPUTE, &kinds);
        let flags = gpu.adapter.get_downlevel_capabilities().flags;
        let pipeline = flags
            .contains(wgpu::DownlevelFlags::COMPUTE_SHADERS)
            .then(|| pipeline::compute(gpu, "skin", SHADER, &[Some(&layout)]));
        Self { pipeline, layout }
    }

    /// Positions and normals in the world of a posed mesh, moved by the device and read back.
    ///
    /// # Errors
    ///
    /// If the device fails.
    pub async fn deform(
        &self,
        gpu: &Gpu,
        mesh: &SkinnedMesh,
        pose: &SkinPose,
        skinning: Skinning,
    ) -> Result<(Vec<Vec3>, Vec<Vec3>), ReadError> {
        let vertices = SkinVertices::new(gpu, mesh);
        let mut deformed = self.skin(gpu, &vertices);
        let deformation = Deformation { mesh, pose, skinning, weights_of: None };
        self.update(gpu, &vertices, &mut deformed, deformation);
        let size = u64::from(vertices.count) * size_of::<DeformedVertex>() as u64;
        let usage = wgpu::BufferUsages::MAP_READ;
        let copy = gpu.buffer("skin read", size.max(4), usage);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(&deformed.vertices, 0, &copy, 0, size);
        gpu.queue.submit([encoder.finish()]);
        let mapped = fetch(gpu, &copy).await?;
        let all: Vec<DeformedVertex> = bytemuck::pod_collect_to_vec(&mapped[..size as usize]);
        Ok(all.iter().map(|vertex| (vertex.position.truncate(), vertex.normal.truncate())).unzip())
    }

    /// Buffers for a pose of a mesh.
    pub(super) fn skin(&self, gpu: &Gpu, mesh: &SkinVertices) -> DeformedSkin {
        let storage = wgpu::BufferUsages::STORAGE;
        let uniform_size = size_of::<SkinData>() as u64;
        let uniform = gpu.buffer("skin", uniform_size, wgpu::BufferUsages::UNIFORM);
        let size = u64::from(mesh.all_joints.max(1)) * size_of::<JointData>() as u64;
        let joints = gpu.buffer("skin joints", size, storage);
        let size = u64::from(mesh.count.max(1)) * size_of::<DeformedVertex>() as u64;
        let usage = storage | wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_SRC;
        let vertices = gpu.buffer("skin vertices", size, usage);
        let buffers = [&uniform, &joints, &mesh.buffer, &vertices];
        let resources = buffers.map(wgpu::Buffer::as_entire_binding);
        let group = pipeline::group(gpu, "skin", &self.layout, resources);
        DeformedSkin { uniform, joints, vertices, group, data: None, sent: Vec::new() }
    }

    /// Moves the vertices if the pose is another one than before, and returns the number of bytes
    /// sent.
    pub(super) fn update(
        &self,
        gpu: &Gpu,
        vertices: &SkinVertices,
        deformed: &mut DeformedSkin,
        deformation: Deformation<'_>,
    ) -> u64 {
        let Deformation { pose, skinning, weights_of, .. } = deformation;
        let data = SkinData {
            to_world: rows(pose.to_world()),
            vertices: vertices.count,
            skinning: Skinning::ALL.iter().position(|it| *it == skinning).unwrap_or(0) as u32,
            weights_of: weights_of.map_or(-1, |joint| joint.index() as i32),
            joints: vertices.joints.max(1),
        };
        let followed = pose.joints().iter().take(vertices.all_joints as usize);
        let is_same = deformed.data == Some(data)
            && followed.clone().map(JointData::new).eq(deformed.sent.iter().copied());
        if is_same {
            return 0;
        }
        deformed.data = Some(data);
        deformed.sent.clear();
        deformed.sent.extend(followed.map(JointData::new));
        match &self.pipeline {
            Some(pipeline) => {
                let bytes: &[u8] = bytemuck::cast_slice(&deformed.sent);
                gpu.queue.write_buffer(&deformed.uniform, 0, bytemuck::bytes_of(&data));
                gpu.queue.write_buffer(&deformed.joints, 0, bytes);
                let mut encoder = gpu.device.create_command_encoder(&Default::default());
                let groups = [&deformed.group];
                pipeline::run_for_each(&mut encoder, "skin", pipeline, &groups, vertices.count);
                gpu.queue.submit([encoder.finish()]);
                (bytes.len() + size_of::<SkinData>()) as u64
            }
            None => {
                let vertices = on_cpu(deformation);
                let bytes: &[u8] = bytemuck::cast_slice(&vertices);
                gpu.queue.write_buffer(&deformed.vertices, 0, bytes);
                bytes.len() as u64
            }
        }
    }
}

fn on_cpu(deformation: Deformation<'_>) -> Vec<DeformedVertex> {
    let Deformation { mesh, pose, skinning, weights_of } = deformation;
    let (mut positions, mut normals) = (Vec::new(), Vec::new());
    mesh.write_posed(pose, skinning, &mut positions, &mut normals);
    let weights = mesh.weights().iter().map(|weights| weights_of.map_or(0.0, |it| weights.of(it)));
    let vertices = positions.into_iter().zip(normals).zip(weights);
    vertices
        .map(|((position, normal), weight)| DeformedVertex {
            position: position.extend(weight),
            normal: normal.extend(0.0),
        })
        .collect()
}

impl SkinVertices {
    pub fn new(gpu: &Gpu, mesh: &SkinnedMesh) -> Self {
        let triangles = mesh.mesh();
        let vertices = triangles.positions.iter().zip(&triangles.normals).zip(mesh.weights());
        let vertices: Vec<VertexData> = vertices
            .zip(mesh.first_joints())
            .map(|(((position, normal), weights), first)| {
                let [a, b, c, d] = weights.joints().map(|joint| first as u32 + u32::from(joint));
                VertexData {
                    position: *position,
                    joints_low: a | b << 16,
                    normal: *normal,
                    joints_high: c | d << 16,
                    weights: weights.weights(),
                }
            })
            .collect();
        let buffer = gpu.filled_buffer("skin mesh", &vertices, wgpu::BufferUsages::STORAGE);
        let joints = mesh.inverse_binds().len() as u32;
        let all_joints = joints * mesh.bind_sets().len() as u32;
        Self { buffer, count: vertices.len() as u32, joints, all_joints }
    }
}

impl JointData {
    fn new(joint: &JointDeform) -> Self {
        Self {
            matrix: rows(joint.matrix),
            turn: rows(joint.turn),
            turn_twice: rows(joint.turn_twice),
            scale: rows(Affine3A { matrix3: joint.scale, ..Affine3A::IDENTITY }),
            real: joint.real,
            dual: joint.dual,
            along: joint.along,
            roll: Vec4::new(joint.roll, 0.0, 0.0, 0.0),
        }
    }
}

fn rows(transform: Affine3A) -> [Vec4; 3] {
    let Affine3A { matrix3, translation } = transform;
    let columns = matrix3.transpose();
    [
        columns.x_axis.extend(translation.x),
        columns.y_axis.extend(translation.y),
        columns.z_axis.extend(translation.z),
    ]
}
