use super::opened::opened;

/// A motion in BVH, or what looks like one: it is refused in a few words, or is a skeleton that can
/// be, with keys, and can be saved and read again as it is.
pub fn bvh(data: &[u8]) {
    opened(data, None);
}
