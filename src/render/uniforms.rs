use bytemuck::Pod;

use super::Gpu;

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
        let label = Some(label);
        let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label,
            size: size_of::<T>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let layout = gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label,
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::VERTEX_FRAGMENT | wgpu::ShaderStages::COMPUTE,
                ty: wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Uniform,
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
                count: None,
            }],
        });
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label,
            layout: &layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: buffer.as_entire_binding() }],
        });
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
