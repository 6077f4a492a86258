use std::collections::{HashMap, HashSet};

use glam::{DVec3, Mat3, Vec3};

use super::joint_tracks::{JointPlacement, JointTracks};
use super::nodes::{NodeTree, SkinJoints};
use crate::document::{Channel, Document, SkeletonRig, Timeline};
use crate::io::bones::{self, JointBone, JointTree};
use crate::io::formats::gltf::UniqueNames;
use crate::io::formats::gltf::file::{GltfFile, GltfNode};
use crate::kinematics::skeleton::{Joint, JointId, Skeleton, SkeletonError};
use crate::kinematics::spline::Spline;

/// Returns all joints of a skin in the bind pose, with offsets and frames in world axes. The axes
/// of their bones are zero until [`build`] sets them.
pub fn joints(
    file: &GltfFile<'_>,
    joints: &SkinJoints,
    bind_pose: &[JointPlacement],
) -> Vec<Joint> {
    let mut names = UniqueNames::default();
    let humanoid: HashMap<usize, &str> = file.extensions.humanoid().into_iter().collect();
    let joint = |(index, node): (usize, &usize)| {
        let name = file.nodes.0.get(*node).and_then(|node| node.name.as_deref());
        let name = name.filter(|name| !name.trim().is_empty());
        let name = names.free(name.unwrap_or(&format!("joint_{index}")));
        let parent = joints.parents[index];
        let origin = parent.map_or(DVec3::ZERO, |parent| bind_pose[parent].base);
        Joint {
            offset: (bind_pose[index].base - origin).as_vec3(),
            frame: bind_pose[index].frame.as_mat3(),
            human_bone: humanoid
                .get(node)
                .filter(|name| !name.is_empty())
                .map(|it| (*it).to_owned()),
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

/// Where bones end that lead to no joint.
pub struct BoneEnds {
    /// For each joint the end of its bone relative to it, in its axes.
    pub of: Vec<Option<Vec3>>,
    /// True if leaves without an end have no bone, rather than one that the file does not tell.
    pub are_complete: bool,
}

impl BoneEnds {
    /// The ends of leaves, and of joints whose end is straighter ahead than any child: a node below
    /// that is no joint and has nothing to draw, as many programs write for the tips of fingers and
    /// heads. Files of this program are complete.
    pub fn new(
        file: &GltfFile<'_>,
        nodes: &NodeTree,
        joints: &SkinJoints,
        bind_pose: &[JointPlacement],
    ) -> Self {
        let worlds = nodes.worlds();
        let is_joint: HashSet<usize> = joints.nodes.iter().copied().collect();
        let is_empty = |node: &usize| {
            let GltfNode { mesh, camera, skin, .. } = &file.nodes.0[*node];
            let draws = mesh.is_some() || camera.is_some() || skin.is_some();
            !draws && !is_joint.contains(node) && nodes.children[*node].is_empty()
        };
        let from_base = |joint: usize, to: DVec3| (to - bind_pose[joint].base).as_vec3();
        let longest_end = |joint: usize| {
            let empty = nodes.children[joints.nodes[joint]].iter().copied().filter(is_empty);
            let ends = empty.map(|node| from_base(joint, worlds[node].translation));
            let longer = |a: &Vec3, b: &Vec3| a.length().total_cmp(&b.length());
            ends.filter(|end| end.is_finite() && *end != Vec3::ZERO).max_by(longer)
        };
        // A head has eyes below it, but its bone goes on to its end.
        let is_straighter = |joint: usize, end: &Vec3| {
            let children = (0..joints.nodes.len()).filter(|it| joints.parents[*it] == Some(joint));
            let Some(parent) = joints.parents[joint] else { return children.count() == 0 };
            let arriving = from_base(parent, bind_pose[joint].base).normalize_or_zero();
            let bend = |leaving: Vec3| leaving.normalize_or_zero().dot(arriving);
            let mut leaving = children.map(|child| from_base(joint, bind_pose[child].base));
            leaving.all(|leaving| bend(leaving) < bend(*end))
        };
        let end = |joint| longest_end(joint).filter(|end| is_straighter(joint, end));
        Self {
            of: (0..joints.nodes.len()).map(end).collect(),
            are_complete: file.asset.0.is_of_this_program(),
        }
    }
}

pub fn build(
    mut joints: Vec<Joint>,
    motions: &[JointTracks],
    timeline: Option<Timeline>,
    ends: &BoneEnds,
) -> Result<ImportedRig, SkeletonError> {
    let bind_offsets: Vec<Vec3> = joints.iter().map(|joint| joint.offset).collect();
    let size = bind_offsets.iter().map(|offset| offset.length()).fold(0.0, f32::max);
    let first = |track: &Spline<Vec3>| track.knots().first().map(|knot| knot.value);
    for (joint, motion) in joints.iter_mut().zip(motions) {
        joint.offset = first(&motion.offset).unwrap_or(joint.offset);
        joint.rotation = first(&motion.rotation).unwrap_or(joint.rotation);
        joint.skin.scale = first(&motion.skin.scale).unwrap_or(joint.skin.scale);
        joint.skin.shear = first(&motion.skin.shear).unwrap_or(joint.skin.shear);
    }
    let moves: Vec<bool> = joints
        .iter()
        .enumerate()
        .map(|(index, _)| motions.get(index).is_some_and(|motion| motion.moves(size)))
        .collect();
    let stretches =
        |joint: usize| motions.get(joint).is_some_and(|it| it.stretches() != [false; 2]);
    let are_tips = tips(&joints, |joint| moves[joint] || stretches(joint));
    let bones = bones(&joints, &are_tips, &moves, ends);
    bones::give_bones(&mut joints, &bones);
    bones::connect(&mut joints, &bones, |joint| moves[joint]);
    for (joint, motion) in joints.iter_mut().zip(motions) {
        joint.frame *= motion.frame.unwrap_or(Mat3::IDENTITY);
    }
    let mut kept = Vec::with_capacity(joints.len());
    let mut next = 0;
    for is_tip in &are_tips {
        kept.push((!is_tip).then_some(next));
        next += usize::from(!is_tip);
    }
    let mut document = Document::new(SkeletonRig::default());
    if let Some(timeline) = timeline {
        document.timeline = timeline;
        add_keys(&mut document, motions, &moves, &kept);
    }
    let mut kept_joints = Vec::with_capacity(next);
    for (mut joint, is_tip) in joints.into_iter().zip(are_tips) {
        joint.parent = joint.parent.and_then(|parent| kept[parent.index()].map(JointId::new));
        kept_joints.extend((!is_tip).then_some(joint));
    }
    document.rig = SkeletonRig::new(Skeleton::from_joints(kept_joints)?);
    Ok(ImportedRig { document, kept })
}

/// For each joint, whether it is only the tip of its parent's bone. A tip has the name of its
/// parent with `_tip` at the end and no children, and does not change.
fn tips(joints: &[Joint], changes: impl Fn(usize) -> bool) -> Vec<bool> {
    let mut are_leaves = vec![true; joints.len()];
    for parent in joints.iter().filter_map(|joint| joint.parent) {
        are_leaves[parent.index()] = false;
    }
    let is_tip = |(index, joint): (usize, &Joint)| {
        let parent = joint.parent.map(|parent| joints[parent.index()].name.as_str());
        let is_named = parent.is_some() && joint.name.strip_suffix("_tip") == parent;
        is_named && are_leaves[index] && !changes(index)
    };
    joints.iter().enumerate().map(is_tip).collect()
}

/// The bone of each joint: to its tip, to one of the `ends`, to the child along the joint's y axis
/// (as Blender has its bones), or to the child that continues the chain.
fn bones(joints: &[Joint], are_tips: &[bool], moves: &[bool], ends: &BoneEnds) -> Vec<JointBone> {
    /// Cosine of the greatest angle between the y axis and a bone along it.
    const ALONG: f64 = 0.999;
    let tree = JointTree::new(joints);
    let tip = |joint: usize| tree.children(joint).iter().copied().find(|child| are_tips[*child]);
    let end = |joint: usize| tip(joint).map(|tip| joints[tip].offset).or(ends.of[joint]);
    let along_y = |joint: usize| {
        let y = joints[joint].frame.y_axis.as_dvec3();
        let is_along =
            |child: &usize| joints[*child].offset.as_dvec3().normalize_or_zero().dot(y) > ALONG;
        tree.children(joint).iter().copied().find(is_along)
    };
    let mut bones = tree.bones(end, along_y);
    if ends.are_complete {
        return bones;
    }
    tree.free_origins(&mut bones, |joint| moves[joint]);
    tree.guess_leaves(&mut bones, |joint| are_tips[joint] || end(joint).is_some());
    bones
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
        let [scales, shears] = motion.stretches();
        if scales {
            document.keys.set_track(Channel::SkinScale(joint), motion.skin.scale.clone());
        }
        if shears {
            document.keys.set_track(Channel::SkinShear(joint), motion.skin.shear.clone());
        }
    }
}
