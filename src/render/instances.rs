use bytemuck::Pod;

use super::Gpu;

/// A list of instances on the device, sent again only when it changes.
#[derive(Debug)]
pub(super) struct Instances<T> {
    label: &'static str,
    sent: Vec<T>,
    buffer: Option<wgpu::Buffer>,
}

impl<T: Pod + PartialEq> Instances<T> {
    pub fn new(label: &'static str) -> Self {
        Self { label, sent: Vec::new(), buffer: None }
    }

    pub fn upload(&mut self, gpu: &Gpu, instances: impl Iterator<Item = T> + Clone) {
        if instances.clone().eq(self.sent.iter().copied()) {
            return;
        }
        self.sent.clear();
        self.sent.extend(instances);
        let bytes: &[u8] = bytemuck::cast_slice(&self.sent);
        let room = self.buffer.as_ref().map_or(0, wgpu::Buffer::size);
        if room < bytes.len() as u64 {
            self.buffer = Some(gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(self.label),
                size: (bytes.len() as u64).next_power_of_two(),
                usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            }));
        }
        if let (Some(buffer), false) = (&self.buffer, bytes.is_empty()) {
            gpu.queue.write_buffer(buffer, 0, bytes);
        }
    }

    /// The buffer and how many there are in it, unless there are none.
    pub fn get(&self) -> Option<(&wgpu::Buffer, u32)> {
        let count = self.sent.len() as u32;
        self.buffer.as_ref().filter(|_| count > 0).map(|buffer| (buffer, count))
    }
}
