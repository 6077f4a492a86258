use super::opened::every_skeleton;

/// A `.gltf` or `.glb` file, or similar bytes: each skin is refused with a short message, or
/// is a valid skeleton that survives saving and reading with its mesh.
pub fn gltf(data: &[u8]) {
    every_skeleton(data);
}
