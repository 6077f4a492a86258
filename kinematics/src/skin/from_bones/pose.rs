//! The pose in which a surface is made. In the bind poses of some files, bones overlap: the arms lie
//! along the neck, for example. A surface around these would merge them.

use glam::{Affine3A, Mat3, Mat3A, Vec3};

use super::body::{Blob, SkinShape};
use super::sweep::BlobSphere;
use crate::skeleton::{Joint, JointId, JointLimits, Skeleton, SkeletonPose};
use crate::skin::{SkinError, SkinnedMesh};

/// A skeleton whose bind pose is a pose of another one.
pub struct PosedBones {
    pub skeleton: Skeleton,
    pub shape: SkinShape,
    /// For each joint its rotation in that pose, in skeleton space.
    rotations: Vec<Mat3A>,
}

impl PosedBones {
    /// The skeleton in the pose of a shape.
    pub fn new(skeleton: &Skeleton, shape: &SkinShape) -> Self {
        let mut posed = skeleton.clone();
        posed.ids().for_each(|joint| posed.write_local(joint, |joint| joint.rotation = Vec3::ZERO));
        for (joint, rotation) in &shape.pose {
            posed.write_local(*joint, |joint| joint.rotation = *rotation);
        }
        let pose = posed.pose_in_skeleton();
        let rotations: Vec<Mat3A> = posed.ids().map(|joint| pose.full(joint).matrix3).collect();
        for (joint, own) in skeleton.iter() {
            let above = own.parent.map_or(Mat3A::IDENTITY, |parent| rotations[parent.index()]);
            let turn = rotations[joint.index()];
            posed.write_local(joint, |joint| {
                *joint = Joint {
                    offset: above * own.offset,
                    axis: turn * own.axis,
                    rotation: Vec3::ZERO,
                    frame: Mat3::IDENTITY,
                    limits: JointLimits::NONE,
                    ..own.clone()
                };
            });
        }
        let turned = |blob: &Blob| {
            let turn = rotations.get(blob.joint.index()).copied().unwrap_or(Mat3A::IDENTITY);
            let turned = |it: &BlobSphere| BlobSphere { centre: turn * it.centre, ..*it };
            Blob { spheres: blob.spheres.iter().map(turned).collect(), ..*blob }
        };
        let blobs = shape.blobs.iter().map(turned).collect();
        let shape = SkinShape { blobs, pose: Vec::new(), ..shape.clone() };
        Self { skeleton: posed, shape, rotations }
    }

    /// A mesh around the posed bones, attached to the joints in that pose.
    pub fn attached(&self, mesh: SkinnedMesh) -> Result<SkinnedMesh, SkinError> {
        let binds = mesh.inverse_binds().iter().zip(&self.rotations);
        let binds = binds.map(|(bind, turn)| Affine3A::from_mat3(turn.transpose().into()) * *bind);
        let binds = binds.collect();
        SkinnedMesh::new(mesh.mesh().clone(), mesh.weights().to_vec(), binds)
    }
}

impl SkinShape {
    /// The shape whose surface is made in the pose that a skeleton has, if fewer of its bones
    /// overlap in it than in the bind pose.
    #[must_use]
    pub fn with_bones_apart(self, skeleton: &Skeleton) -> Self {
        Self { pose: pose_apart(skeleton), ..self }
    }
}

/// The rotations of the joints in the pose that a skeleton has, if fewer bones overlap in it than
/// in the bind pose; otherwise none.
fn pose_apart(skeleton: &Skeleton) -> Vec<(JointId, Vec3)> {
    /// Maximum number of joints of which all pairs are compared; larger skeletons keep the bind pose.
    const MOST_JOINTS: usize = 2_000;
    let turned = skeleton.iter().filter(|(_, joint)| joint.rotation != Vec3::ZERO);
    let pose: Vec<(JointId, Vec3)> = turned.map(|(id, joint)| (id, joint.rotation)).collect();
    if pose.is_empty() || skeleton.joints().len() > MOST_JOINTS {
        return Vec::new();
    }
    let in_bind_pose = overlapping_pairs(skeleton, &skeleton.bind_pose_in_skeleton());
    let is_better = in_bind_pose > 0
        && overlapping_pairs(skeleton, &skeleton.pose_in_skeleton()) < in_bind_pose;
    if is_better { pose } else { Vec::new() }
}

/// Number of pairs of bones that overlap, except for neighbours. Siblings count if their
/// outer halves do, since many begin at the same point.
fn overlapping_pairs(skeleton: &Skeleton, pose: &SkeletonPose) -> usize {
    /// Distance of two bones that overlap, relative to the sum of their radii.
    const INSIDE: f32 = 0.5;
    let has_bone = |(_, joint): &(JointId, &Joint)| joint.axis != Vec3::ZERO && joint.radius > 0.0;
    let bones: Vec<(JointId, &Joint)> = skeleton.iter().filter(has_bone).collect();
    let ends = |joint: JointId, from: f32| {
        let (base, tip) = (pose.base(joint), pose.tip(joint));
        [base.lerp(tip, from), tip]
    };
    let are_neighbours = |(one, first): (JointId, &Joint), (other, second): (JointId, &Joint)| {
        first.parent == Some(other) || second.parent == Some(one)
    };
    let mut count = 0;
    for (index, one) in bones.iter().enumerate() {
        let inside = bones[index + 1..].iter().filter(|other| {
            let reach = INSIDE * (one.1.radius + other.1.radius);
            let from = if one.1.parent == other.1.parent { 0.5 } else { 0.0 };
            !are_neighbours(*one, **other)
                && distance(ends(one.0, from), ends(other.0, from)) < reach
        });
        count += inside.count();
    }
    count
}

/// The distance of two segments. Source: C. Ericson, *Real-Time Collision Detection*, 5.1.9.
fn distance([a, b]: [Vec3; 2], [c, d]: [Vec3; 2]) -> f32 {
    let (u, v, w) = (b - a, d - c, a - c);
    let (uu, vv, uv) = (u.length_squared(), v.length_squared(), u.dot(v));
    let (uw, vw) = (u.dot(w), v.dot(w));
    let part = |value: f32| if value.is_finite() { value.clamp(0.0, 1.0) } else { 0.0 };
    let along_first = part((uv * vw - uw * vv) / (uu * vv - uv * uv));
    let along_second = part((uv * along_first + vw) / vv);
    let along_first = part((uv * along_second - uw) / uu);
    (a + u * along_first).distance(c + v * along_second)
}
