use glam::Vec3;

use crate::scene::Scene;

/// Adds rods along the world's axes, half as long as the rig's reach. Arrowheads belong to handles.
pub(super) fn add(scene: &mut Scene, reach: f32) {
    let length = 0.5 * reach;
    let radius = 0.009 * length;
    for (axis, colour) in Vec3::AXES.into_iter().zip(scene.palette.axes) {
        scene.add_solid(Vec3::ZERO, axis * length, radius, radius, colour);
    }
}
