use glam::Vec3;

use super::file::GltfFile;
use super::joint_tracks::JointTracks;
use super::node_poser::JointPlacement;
use super::skins::SkinJoints;
use crate::document::{Channel, Document, RigKind, SkeletonRig, Timeline};
use crate::io::gltf::names::UniqueNames;
use crate::kinematics::skeleton::{Joint, JointId, Skeleton, SkeletonError};
use crate::kinematics::spline::Spline;

/// Returns all joints of a skin in the bind pose, with offsets and frames in world axes. The axes
/// of their bones are zero until [`build`] sets them.
pub fn joints(file: &GltfFile, joints: &SkinJoints, bind_pose: &[JointPlacement]) -> Vec<Joint> {
    let mut names = UniqueNames::default();
    let joint = |(index, node): (usize, &usize)| {
        let name = file.nodes.0.get(*node).and_then(|node| node.name.as_deref());
        let name = name.filter(|name| !name.trim().is_empty());
        let name = names.free(name.unwrap_or(&format!("joint_{index}")));
        let parent = joints.parents[index];
        let origin = parent.map_or(glam::DVec3::ZERO, |parent| bind_pose[parent].base);
        Joint {
            offset: (bind_pose[index].base - origin).as_vec3(),
            frame: bind_pose[index].frame.as_mat3(),
            ..Joint::new(&name, parent.map(JointId::new), Vec3::ZERO)
        }
    };
    joints.nodes.iter().enumerate().map(joint).collect()
}

/// An imported skeleton with its motion.
pub struct ImportedRig {
    /// A document with the joints in the pose of the first frame, and keys for the joints that
    /// move.
    pub document: Document,
    /// For every joint of the skin, its index in the skeleton; `None` if the joint is only the tip
    /// of its parent's bone.
    pub kept: Vec<Option<usize>>,
}

pub fn build(
    mut joints: Vec<Joint>,
    motions: &[JointTracks],
    timeline: Option<Timeline>,
) -> Result<ImportedRig, SkeletonError> {
    let bind_offsets: Vec<Vec3> = joints.iter().map(|joint| joint.offset).collect();
    let size = bind_offsets.iter().map(|offset| offset.length()).fold(0.0, f32::max);
    let first = |track: &Spline<Vec3>| track.knots().first().map(|knot| knot.value);
    for (joint, motion) in joints.iter_mut().zip(motions) {
        joint.offset = first(&motion.offset).unwrap_or(joint.offset);
        joint.rotation = first(&motion.rotation).unwrap_or(joint.rotation);
    }
    let moves: Vec<bool> = joints
        .iter()
        .enumerate()
        .map(|(index, _)| motions.get(index).is_some_and(|motion| motion.moves(size)))
        .collect();
    let are_tips = tips(&joints, &moves);
    give_bones(&mut joints, &bind_offsets, &are_tips);
    let mut kept = Vec::with_capacity(joints.len());
    let mut next = 0;
    for is_tip in &are_tips {
        kept.push((!is_tip).then_some(next));
        next += usize::from(!is_tip);
    }
    let mut document = Document { rig: RigKind::Skeleton, ..Document::default() };
    if let Some(timeline) = timeline {
        document.timeline = timeline;
        add_keys(&mut document, motions, &moves, &kept);
    }
    let mut kept_joints = Vec::with_capacity(next);
    for (mut joint, is_tip) in joints.into_iter().zip(are_tips) {
        joint.parent = joint.parent.and_then(|parent| kept[parent.index()].map(JointId::new));
        kept_joints.extend((!is_tip).then_some(joint));
    }
    document.skeleton_rig = SkeletonRig::new(Skeleton::from_joints(kept_joints)?);
    Ok(ImportedRig { document, kept })
}

/// For each joint, whether it is only the tip of its parent's bone. A tip has the name of its
/// parent with `_tip` at the end, no children and a constant offset.
fn tips(joints: &[Joint], moves: &[bool]) -> Vec<bool> {
    let mut are_leaves = vec![true; joints.len()];
    for parent in joints.iter().filter_map(|joint| joint.parent) {
        are_leaves[parent.index()] = false;
    }
    let is_tip = |(index, joint): (usize, &Joint)| {
        let parent = joint.parent.map(|parent| joints[parent.index()].name.as_str());
        let is_named = parent.is_some() && joint.name.strip_suffix("_tip") == parent;
        is_named && are_leaves[index] && !moves[index]
    };
    joints.iter().enumerate().map(is_tip).collect()
}

/// Sets the axis of each joint's bone. The axis goes from the joint to its tip, otherwise to the
/// child along the joint's y axis, otherwise to the mean of the children.
fn give_bones(joints: &mut [Joint], bind_offsets: &[Vec3], are_tips: &[bool]) {
    const ALONG: f32 = 0.999;
    let mut children: Vec<Vec<usize>> = vec![Vec::new(); joints.len()];
    for (index, joint) in joints.iter().enumerate() {
        if let Some(parent) = joint.parent {
            children[parent.index()].push(index);
        }
    }
    for (index, children) in children.into_iter().enumerate() {
        let y = joints[index].frame.y_axis;
        let is_along = |child: &&usize| bind_offsets[**child].normalize_or_zero().dot(y) > ALONG;
        let tip = children.iter().find(|child| are_tips[**child]);
        let axis = match tip.or_else(|| children.iter().find(is_along)) {
            Some(child) if are_tips[*child] => joints[*child].offset,
            Some(child) => bind_offsets[*child],
            None => middle(children.iter().map(|child| bind_offsets[*child])),
        };
        let joint = &mut joints[index];
        joint.radius = Joint::new("", None, axis).radius;
        joint.axis = axis;
    }
}

/// The mean of those offsets that are not zero; zero if there are none.
fn middle(offsets: impl Iterator<Item = Vec3>) -> Vec3 {
    let offsets: Vec<Vec3> = offsets.filter(|offset| *offset != Vec3::ZERO).collect();
    let weight = 1.0 / offsets.len().max(1) as f32;
    offsets.into_iter().map(|offset| offset * weight).sum()
}

fn add_keys(
    document: &mut Document,
    motions: &[JointTracks],
    moves: &[bool],
    kept: &[Option<usize>],
) {
    for ((motion, moves), joint) in motions.iter().zip(moves).zip(kept) {
        let Some(joint) = joint.map(JointId::new) else { continue };
        if motion.turns() {
            document.keys.set_track(Channel::Rotation(joint), motion.rotation.clone());
        }
        if *moves {
            document.keys.set_track(Channel::Offset(joint), motion.offset.clone());
        }
    }
}
