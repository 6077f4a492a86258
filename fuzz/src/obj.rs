use ik_arm::io::OpenOptions;

use super::opened::opened;

/// A mesh in OBJ, or what looks like one: it is refused with a short message, or is a valid mesh on a
/// joint, and survives saving and reading.
pub fn obj(data: &[u8]) {
    opened(data, &OpenOptions::default());
}
