//! Validation of every shader without a GPU, and of their colour functions on the device.

use ik_arm::render::Gpu;
use pollster::block_on;
use wgpu::naga::front::wgsl;
use wgpu::naga::valid::{Capabilities, ValidationFlags, Validator};

#[test]
fn every_shader_is_valid() {
    for (name, source) in ik_arm::render::shaders() {
        let module = wgsl::parse_str(source)
            .unwrap_or_else(|error| panic!("{name}: {}", error.emit_to_string(source)));
        Validator::new(ValidationFlags::all(), Capabilities::empty())
            .validate(&module)
            .unwrap_or_else(|error| panic!("{name}: {}", error.emit_to_string(source)));
        let entries: Vec<_> = module.entry_points.iter().map(|entry| entry.name.as_str()).collect();
        let draws = entries.contains(&"vertex") && entries.contains(&"fragment");
        assert!(draws || entries == ["compute"], "{name}: {entries:?}");
    }
}

#[test]
fn every_shader_file_is_part_of_a_shader() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/shaders");
    for file in std::fs::read_dir(folder).expect("shaders") {
        let path = file.expect("a file").path();
        let source = std::fs::read_to_string(&path).expect("text");
        let used = ik_arm::render::shaders().iter().any(|(_, whole)| whole.contains(&source));
        assert!(used, "{} is not used", path.display());
    }
}

/// Evaluates the functions `decoded` and `encoded` of the shaders on the device.
fn on_device(gpu: &Gpu, function: &str, values: &[f32]) -> Vec<f32> {
    let view = include_str!("../../shaders/view.wgsl");
    let source = format!(
        "{view}
        @group(1) @binding(0) var<storage, read_write> values: array<f32>;
        @compute @workgroup_size(1)
        fn compute(@builtin(global_invocation_id) id: vec3u) {{
            values[id.x] = {function}(vec3f(values[id.x])).x;
        }}"
    );
    let device = &gpu.device;
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(source.into()),
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: None,
        module: &module,
        entry_point: Some("compute"),
        compilation_options: Default::default(),
        cache: None,
    });
    let bytes: &[u8] = bytemuck::cast_slice(values);
    let buffer = |usage| {
        let size = bytes.len() as u64;
        device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size,
            usage: usage | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        })
    };
    let storage = buffer(wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC);
    let read = buffer(wgpu::BufferUsages::MAP_READ);
    gpu.queue.write_buffer(&storage, 0, bytes);
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(1),
        entries: &[wgpu::BindGroupEntry { binding: 0, resource: storage.as_entire_binding() }],
    });
    let mut encoder = device.create_command_encoder(&Default::default());
    let mut pass = encoder.begin_compute_pass(&Default::default());
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(1, &group, &[]);
    pass.dispatch_workgroups(values.len() as u32, 1, 1);
    drop(pass);
    encoder.copy_buffer_to_buffer(&storage, 0, &read, 0, read.size());
    gpu.queue.submit([encoder.finish()]);
    read.slice(..).map_async(wgpu::MapMode::Read, |read| read.expect("mapped"));
    device.poll(wgpu::PollType::wait_indefinitely()).expect("computed");
    bytemuck::cast_slice(&read.get_mapped_range(..).expect("mapped")).to_vec()
}

#[test]
fn colours_are_decoded_and_encoded_as_srgb() {
    let gpu = block_on(Gpu::headless()).expect("a device");
    let colours: Vec<f32> = (0..=2_000).map(|step| step as f32 / 2_000.0).collect();
    let lights: Vec<f32> = colours.iter().map(|colour| 1.4 * colour * colour).collect();
    let decode = |c: f64| if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) };
    let encode =
        |c: f64| if c <= 0.003_130_8 { c * 12.92 } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 };
    let within = |function, values: &[f32], exact: &dyn Fn(f64) -> f64, bound: f64| {
        for (value, on_device) in values.iter().zip(on_device(&gpu, function, values)) {
            let off = f64::from(on_device) - exact(f64::from(*value));
            assert!(off.abs() < bound, "{function} of {value} is off by {off}");
        }
    };
    within("decoded", &colours, &decode, 3e-5);
    within("encoded", &lights, &encode, 6e-5);
}
