use core::ops::Range;

use bytemuck::Pod;

use super::Gpu;
use super::pipeline::{PipelineDescriptor, PipelineOutput};

/// A list of instances on the device. It is refilled for every picture, and only the range that
/// differs from the previous picture is sent.
#[derive(Debug)]
pub(super) struct InstanceBuffer<T> {
    label: &'static str,
    list: RefilledList<T>,
    buffer: Option<wgpu::Buffer>,
}

/// A list that is refilled in place and keeps track of the items that change.
#[derive(Debug)]
struct RefilledList<T> {
    items: Vec<T>,
    /// Number of items pushed since the last [`finish`](Self::finish).
    filled: usize,
    /// Range from the first to the last item that a push has changed.
    changed: Range<usize>,
}

impl<T: Pod + PartialEq> InstanceBuffer<T> {
    pub fn new(label: &'static str) -> Self {
        let list = RefilledList { items: Vec::new(), filled: 0, changed: 0..0 };
        Self { label, list, buffer: None }
    }

    /// Adds an instance to the next upload.
    pub fn push(&mut self, instance: T) {
        self.list.push(instance);
    }

    /// Sends the changes since the previous upload and returns the number of bytes sent. The list
    /// then consists of the instances pushed since that upload.
    pub fn upload(&mut self, gpu: &Gpu) -> u64 {
        let mut changed = self.list.finish();
        let items = &self.list.items;
        let needed = size_of_val(&items[..]) as u64;
        if self.buffer.as_ref().is_none_or(|buffer| buffer.size() < needed) && needed > 0 {
            changed = 0..items.len();
            let (size, usage) = (needed.next_power_of_two(), wgpu::BufferUsages::VERTEX);
            self.buffer = Some(gpu.buffer(self.label, size, usage));
        }
        let bytes: &[u8] = bytemuck::cast_slice(&items[changed.clone()]);
        if let (Some(buffer), false) = (&self.buffer, bytes.is_empty()) {
            gpu.queue.write_buffer(buffer, (changed.start * size_of::<T>()) as u64, bytes);
        }
        bytes.len() as u64
    }

    /// Pushes all instances, uploads them, and returns the number of bytes sent.
    pub fn upload_all(&mut self, gpu: &Gpu, instances: impl Iterator<Item = T>) -> u64 {
        instances.for_each(|instance| self.push(instance));
        self.upload(gpu)
    }

    /// The buffer and the number of instances in it; `None` without instances.
    pub fn get(&self) -> Option<(&wgpu::Buffer, u32)> {
        let count = self.count();
        self.buffer.as_ref().filter(|_| count > 0).map(|buffer| (buffer, count))
    }

    pub fn count(&self) -> u32 {
        self.list.items.len() as u32
    }
}

impl<T: PartialEq> RefilledList<T> {
    fn push(&mut self, item: T) {
        let index = self.filled;
        self.filled += 1;
        match self.items.get_mut(index) {
            Some(old) if *old == item => return,
            Some(old) => *old = item,
            None => self.items.push(item),
        }
        let start = if self.changed.is_empty() { index } else { self.changed.start };
        self.changed = start..self.filled;
    }

    /// Ends a refill: drops the old items after the pushed ones and returns the range of changed
    /// items.
    fn finish(&mut self) -> Range<usize> {
        self.items.truncate(self.filled);
        self.filled = 0;
        core::mem::take(&mut self.changed)
    }
}

/// Pipeline settings of one kind of quad.
pub(super) struct QuadDescriptor<'a> {
    pub label: &'static str,
    pub shader: &'static str,
    pub layouts: &'a [&'a wgpu::BindGroupLayout],
    pub attributes: &'a [wgpu::VertexAttribute],
    pub output: PipelineOutput,
}

/// Draws one quad per instance, blended over the picture; the shader computes the corners.
#[derive(Debug)]
pub(super) struct Quads<T> {
    pipeline: wgpu::RenderPipeline,
    instances: InstanceBuffer<T>,
}

impl<T: Pod + PartialEq> Quads<T> {
    pub fn new(gpu: &Gpu, descriptor: &QuadDescriptor<'_>) -> Self {
        let QuadDescriptor { label, shader, layouts, attributes, output } = *descriptor;
        let pipeline = PipelineDescriptor {
            buffers: &[wgpu::VertexBufferLayout {
                array_stride: size_of::<T>() as u64,
                step_mode: wgpu::VertexStepMode::Instance,
                attributes,
            }],
            topology: wgpu::PrimitiveTopology::TriangleStrip,
            ..PipelineDescriptor::new(label, shader, layouts, output)
        }
        .build(gpu);
        Self { pipeline, instances: InstanceBuffer::new(label) }
    }

    /// Sends the changes to the device and returns the number of bytes sent.
    pub fn upload(&mut self, gpu: &Gpu, instances: impl Iterator<Item = T>) -> u64 {
        self.instances.upload_all(gpu, instances)
    }

    pub fn triangles(&self) -> u32 {
        2 * self.instances.count()
    }

    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        self.draw_range(pass, 0..self.instances.count());
    }

    /// Draws a range of the instances. Indices beyond the last instance are ignored.
    pub fn draw_range(&self, pass: &mut wgpu::RenderPass<'_>, range: Range<u32>) {
        let Some((buffer, count)) = self.instances.get() else {
            return;
        };
        let range = range.start..range.end.min(count);
        if !range.is_empty() {
            pass.set_pipeline(&self.pipeline);
            pass.set_vertex_buffer(0, buffer.slice(..));
            pass.draw(0..4, range);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_refilled_list_reports_the_range_that_changed() {
        let cases: [(&[u8], &[u8], Range<usize>); 8] = [
            (&[], &[], 0..0),
            (&[], &[1, 2], 0..2),
            (&[1, 2], &[1, 2], 0..0),
            (&[1, 2, 3], &[1, 2], 0..0),
            (&[1, 2], &[1, 2, 3], 2..3),
            (&[1, 2, 3, 4], &[1, 5, 3, 4], 1..2),
            (&[1, 2, 3, 4], &[5, 2, 6, 4], 0..3),
            (&[1, 2, 3], &[], 0..0),
        ];
        for (old, new, expected) in cases {
            let mut list = RefilledList { items: old.to_vec(), filled: 0, changed: 0..0 };
            for round in [expected, 0..0] {
                new.iter().for_each(|item| list.push(*item));
                assert_eq!(list.finish(), round, "{old:?} to {new:?}");
                assert_eq!(list.items, new);
            }
        }
    }
}
