use ik_arm::io::OpenOptions;

use super::opened::{opened, turned};

/// A robot in URDF, or what looks like one: it is refused with a short message, or is a valid
/// skeleton of joints that turn about one axis, with a mesh, and survives saving and reading.
pub fn urdf(data: &[u8]) {
    if opened(data, &OpenOptions::default()).is_some() {
        turned(data);
    }
}
