use super::opened::every_skeleton;

/// A scene of Scotty3D, or what looks like one: each of its skeletons is refused in a few words, or is
/// one that can be, and can be saved and read again as it is.
pub fn js3d(data: &[u8]) {
    every_skeleton(data);
}
