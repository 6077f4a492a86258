//! The order in which see-through parts of skins are drawn: the farthest first.

use core::ops::Range;
use std::collections::BTreeMap;

use glam::{Vec3, Vec4};

use crate::kinematics::skin::{SkinPose, SkinnedMesh};

/// The mean of the corners of a part of a skin, in every pose: for each joint of each set of inverse
/// bind transforms the sum of its weights times (position, 1), over the number of corners.
#[derive(Debug)]
pub(super) struct PartCentre(Vec<(usize, Vec4)>);

impl PartCentre {
    /// The centre of the corners of triangles with these indices.
    pub fn new(mesh: &SkinnedMesh, corners: Range<u32>) -> Self {
        let first_joints: Vec<usize> = mesh.first_joints().collect();
        let corners = corners.start as usize..corners.end as usize;
        let corners = mesh.mesh().triangles.as_flattened().get(corners).unwrap_or_default();
        let mut of_joints: BTreeMap<usize, Vec4> = BTreeMap::new();
        for corner in corners.iter().map(|corner| *corner as usize) {
            let position = mesh.mesh().positions[corner].extend(1.0);
            for (joint, weight) in mesh.weights()[corner].iter() {
                let joint = first_joints[corner] + joint.index();
                *of_joints.entry(joint).or_default() += position * weight / corners.len() as f32;
            }
        }
        Self(of_joints.into_iter().collect())
    }

    /// The centre in the world, with joints that are blended linearly.
    pub fn posed(&self, pose: &SkinPose) -> Vec3 {
        let of_joint = |(joint, weighted): &(usize, Vec4)| {
            let moved = pose.joints().get(*joint).map(|joint| {
                let by = joint.matrix;
                by.matrix3 * weighted.truncate() + Vec3::from(by.translation) * weighted.w
            });
            moved.unwrap_or_default()
        };
        pose.to_world().transform_point3(self.0.iter().map(of_joint).sum())
    }
}
