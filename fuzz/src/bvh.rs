use ik_arm::io::OpenOptions;

use super::opened::{opened, turned};

/// A motion in BVH, or what looks like one: it is refused with a short message, or is a valid
/// skeleton with keys, and survives saving and reading.
pub fn bvh(data: &[u8]) {
    if opened(data, &OpenOptions::default()).is_some() {
        turned(data);
    }
}
