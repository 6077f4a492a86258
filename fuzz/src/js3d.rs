use super::opened::every_skeleton;

/// A scene of Scotty3D, or similar bytes: each skeleton is refused with a short message, or is
/// valid and survives saving and reading with its mesh.
pub fn js3d(data: &[u8]) {
    every_skeleton(data);
}
