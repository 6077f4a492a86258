use glam::Vec3;

use crate::scene::Scene;

/// Adds arrows along the world's axes, half as long as the rig's reach.
pub(super) fn add(scene: &mut Scene, reach: f32) {
    let length = 0.5 * reach;
    let (shaft, head, head_length) = (length * 0.009, length * 0.034, length * 0.12);
    for (axis, colour) in Vec3::AXES.into_iter().zip(scene.palette.axes) {
        let neck = axis * (length - head_length);
        scene.add_solid(Vec3::ZERO, neck, shaft, shaft, colour);
        scene.add_solid(neck, axis * length, head, 0.0, colour);
    }
}
