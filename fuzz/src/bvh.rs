use ik_arm::io::OpenOptions;

use super::opened::opened;

/// A motion in BVH, or what looks like one: it is refused with a short message, or is a valid
/// skeleton with keys, and survives saving and reading.
pub fn bvh(data: &[u8]) {
    opened(data, &OpenOptions::default());
}
