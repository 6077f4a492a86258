use super::opened::every_skeleton;

/// A `.gltf` or `.glb` file, or what looks like one: each of its skins is refused in a few words, or
/// is a skeleton that can be, and can be saved and read again as it is.
pub fn gltf(data: &[u8]) {
    every_skeleton(data);
}
