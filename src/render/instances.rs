use core::ops::Range;

use bytemuck::Pod;

use super::Gpu;

/// A list of instances on the device, of which what changes is sent again, and nothing else.
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

    /// How many bytes were sent.
    pub fn upload(&mut self, gpu: &Gpu, instances: impl Iterator<Item = T>) -> u64 {
        let mut changed = replace(&mut self.sent, instances);
        let size = size_of::<T>();
        let needed = (self.sent.len() * size) as u64;
        if self.buffer.as_ref().is_none_or(|buffer| buffer.size() < needed) && needed > 0 {
            changed = 0..self.sent.len();
            self.buffer = Some(gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(self.label),
                size: needed.next_power_of_two(),
                usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            }));
        }
        let bytes: &[u8] = bytemuck::cast_slice(&self.sent[changed.clone()]);
        if let (Some(buffer), false) = (&self.buffer, bytes.is_empty()) {
            gpu.queue.write_buffer(buffer, (changed.start * size) as u64, bytes);
        }
        bytes.len() as u64
    }

    /// The buffer and how many there are in it, unless there are none.
    pub fn get(&self) -> Option<(&wgpu::Buffer, u32)> {
        let count = self.count();
        self.buffer.as_ref().filter(|_| count > 0).map(|buffer| (buffer, count))
    }

    pub fn count(&self) -> u32 {
        self.sent.len() as u32
    }
}

/// Makes a list another one, and tells from where to where the two differ: from the first place that
/// is not as it was to behind the last, as far as the new one goes.
fn replace<T: PartialEq>(old: &mut Vec<T>, new: impl Iterator<Item = T>) -> Range<usize> {
    let mut changed: Option<Range<usize>> = None;
    let mut count = 0;
    for (index, instance) in new.enumerate() {
        count = index + 1;
        match old.get_mut(index) {
            Some(same) if *same == instance => continue,
            Some(other) => *other = instance,
            None => old.push(instance),
        }
        changed = Some(changed.map_or(index, |changed| changed.start)..count);
    }
    old.truncate(count);
    changed.unwrap_or(0..0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_list_becomes_the_new_one_and_tells_where_it_was_another() {
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
            let mut list = old.to_vec();
            assert_eq!(replace(&mut list, new.iter().copied()), expected, "{old:?} to {new:?}");
            assert_eq!(list, new);
        }
    }
}
