//! Validation of every shader without a GPU.
#![cfg(feature = "render")]

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
