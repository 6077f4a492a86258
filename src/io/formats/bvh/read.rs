use glam::{DMat3, DVec3, Vec3};

use super::hierarchy::{self, BvhChannel, BvhNode};
use super::motion::{self, MotionData};
use super::rig::distinct;
use super::text::{Scanner, TextError};
use crate::document::{self, Document, Keys, RigKind, SkeletonRig, Timeline};
use crate::io::bones::{self, JointTree};
use crate::io::error::{OpenError, Remark};
use crate::io::exported::BvhUnit;
use crate::io::opened::{OpenOptions, Opened};
use crate::io::source::Source;
use crate::kinematics::skeleton::exact_angles;
use crate::kinematics::skeleton::{Joint, JointId, Skeleton};

/// Returns whether a text is BVH, judged by its first word.
pub fn is_bvh(text: &str) -> bool {
    Scanner::new(text).word().is("HIERARCHY")
}

/// Reads the skeleton of a file and its motion. The skeleton has the name of its first root. Fails
/// if the options choose another name.
pub fn read(source: &Source, options: &OpenOptions) -> Result<Opened, OpenError> {
    let open_error = |error: TextError| {
        let remark = source.remark_about(error.at, &error.joint, &error.reason);
        OpenError::Content { file: source.name().to_owned(), remark }
    };
    let mut text = Scanner::new(source.text());
    let mut nodes = hierarchy::read(&mut text).map_err(open_error)?;
    let (motion, warning) = motion::read(&mut text, &nodes).map_err(open_error)?;
    let skeletons: Vec<_> = nodes.iter().take(1).map(|root| root.name.clone()).collect();
    let name = options.skeleton.as_deref();
    if let Some(name) = name.filter(|name| !skeletons.iter().any(|other| other == name)) {
        let file = source.name().to_owned();
        return Err(OpenError::NoSkeleton { file, name: name.to_owned(), names: skeletons });
    }
    let mut warnings = rename(source, &mut nodes);
    warnings.extend(warning.map(|it| source.remark_about(it.at, &it.joint, &it.reason)));
    let document = document(&nodes, &motion).map_err(open_error)?;
    Ok(Opened {
        order: document.skeleton().ids().collect(),
        document,
        warnings,
        skeletons,
        animations: Vec::new(),
        animation: None,
    })
}

/// Makes the names of joints unique, and returns warnings about the renamed joints.
fn rename(source: &Source, nodes: &mut [BvhNode]) -> Vec<Remark> {
    /// Maximum number of warnings with a position. Bounds the time, because finding a position
    /// takes a search through the text.
    const MOST: usize = 20;
    let names: Vec<_> = nodes.iter().map(|node| node.name.clone()).collect();
    let mut remarks = Vec::new();
    let mut more = 0;
    for (node, name) in nodes.iter_mut().zip(distinct(&names)) {
        if node.name == name {
            continue;
        }
        if remarks.len() < MOST {
            let reason = format!("joint names must be unique; renamed to {name:?}");
            remarks.push(source.remark_about(node.at, &node.name, &reason));
        } else {
            more += 1;
        }
        node.name = name;
    }
    if let Some(last) = remarks.last().filter(|_| more > 0).cloned() {
        let reason = format!("and {more} more like this");
        remarks.push(Remark { field: String::new(), reason, ..last });
    }
    remarks
}

fn document(nodes: &[BvhNode], motion: &MotionData) -> Result<Document, TextError> {
    let mut keys = Keys::default();
    let mut joints = Vec::with_capacity(nodes.len());
    let mut start = 0;
    for (index, node) in nodes.iter().enumerate() {
        let FirstFrame { offset, rotation } = add_keys(&mut keys, index, node, motion, start);
        let default = Joint::new(&node.name, node.parent.map(JointId::new), Vec3::ZERO);
        joints.push(Joint { offset, rotation, ..default });
        start += node.channels.len();
    }
    let tree = JointTree::new(&joints);
    let moves = |joint| keys.has(document::Channel::Offset(JointId::new(joint)));
    let mut bones = tree.bones(|joint| nodes[joint].end, |_| None);
    tree.free_origins(&mut bones, moves);
    tree.guess_leaves(&mut bones, |joint| nodes[joint].end.is_some());
    bones::give_bones(&mut joints, &bones);
    bones::connect(&mut joints, &bones, moves);
    let at = nodes.first().map_or(0, |root| root.at);
    let skeleton =
        Skeleton::from_joints(joints).map_err(|error| TextError::new(at, "", error.to_string()))?;
    let rig = SkeletonRig::new(skeleton);
    let document = Document {
        rig: RigKind::Skeleton,
        skeleton_rig: rig,
        keys,
        timeline: timeline(motion),
        metres_per_unit: Some(BvhUnit::METRES),
        ..Document::default()
    };
    Ok(Document { camera: document.framing_camera(), ..document })
}

/// The timeline from the first frame to the last, or up to the default end if the motion has a
/// single frame.
fn timeline(motion: &MotionData) -> Timeline {
    let default = Timeline::default();
    let timing = motion.timing;
    let end = timing.time(motion.frames().saturating_sub(1));
    let timeline = Timeline { start: 0.0, end, frame_rate: timing.frame_rate };
    if timeline.is_valid() { timeline } else { Timeline { end: default.end, ..timeline } }
}

/// A joint's offset and angles, in radians, at the first frame.
struct FirstFrame {
    offset: Vec3,
    rotation: Vec3,
}

/// Adds keys for the joint's offset and for its angles if they change over time, and returns their
/// values at the first frame. `start` is the index of the joint's first channel in the motion.
fn add_keys(
    keys: &mut Keys,
    joint: usize,
    node: &BvhNode,
    motion: &MotionData,
    start: usize,
) -> FirstFrame {
    let rows = motion.channels(start, node.channels.len());
    let Some(first) = rows.clone().next() else {
        return FirstFrame { offset: node.offset, rotation: Vec3::ZERO };
    };
    let changes = |is_kind: fn(&BvhChannel) -> bool| {
        let value = |row: &[f32], index: usize| row.get(index).copied();
        let chosen = || (0..node.channels.len()).filter(|index| is_kind(&node.channels[*index]));
        rows.clone().any(|row| chosen().any(|index| value(row, index) != value(first, index)))
    };
    if changes(|channel| matches!(channel, BvhChannel::Position(_))) {
        for (frame, row) in rows.clone().enumerate() {
            let time = motion.timing.time(frame);
            keys.insert(document::Channel::Offset(JointId::new(joint)), time, offset(node, row));
        }
    }
    let mut angles = first_angles(node, first);
    let rotation = angles.as_vec3();
    if changes(|channel| matches!(channel, BvhChannel::Rotation(_))) {
        for (frame, row) in rows.enumerate() {
            angles = exact_angles::nearest(rotation_of(node, row), angles);
            let time = motion.timing.time(frame);
            keys.insert(document::Channel::Rotation(JointId::new(joint)), time, angles.as_vec3());
        }
    }
    FirstFrame { offset: offset(node, first), rotation }
}

/// The joint's offset in a frame. Position channels replace the components of `node.offset`.
fn offset(node: &BvhNode, row: &[f32]) -> Vec3 {
    let mut offset = node.offset;
    for (channel, value) in node.channels.iter().zip(row) {
        if let BvhChannel::Position(axis) = channel {
            offset[*axis] = *value;
        }
    }
    offset
}

/// The joint's rotation in a frame: the product of its rotation channels in their order.
fn rotation_of(node: &BvhNode, row: &[f32]) -> DMat3 {
    let mut product = DMat3::IDENTITY;
    for (channel, value) in node.channels.iter().zip(row) {
        let angle = f64::from(*value).to_radians();
        product *= match channel {
            BvhChannel::Rotation(0) => DMat3::from_rotation_x(angle),
            BvhChannel::Rotation(1) => DMat3::from_rotation_y(angle),
            BvhChannel::Rotation(_) => DMat3::from_rotation_z(angle),
            BvhChannel::Position(_) => DMat3::IDENTITY,
        };
    }
    product
}

/// The joint's angles about x, y and z at the first frame, in radians. If its channels are in the
/// order Z, Y, X, these are the angles in the file.
fn first_angles(node: &BvhNode, row: &[f32]) -> DVec3 {
    /// A hundred turns in degrees. Larger angles are reduced by whole turns, because they would be
    /// too coarse as f32 radians.
    const MANY_TURNS: f32 = 36_000.0;
    let mut angles = DVec3::ZERO;
    let mut order = Vec::new();
    for (channel, value) in node.channels.iter().zip(row) {
        if let BvhChannel::Rotation(axis) = channel {
            angles[*axis] = f64::from(*value % MANY_TURNS).to_radians();
            order.push(*axis);
        }
    }
    let is_zyx = order.is_sorted_by(|a, b| a > b);
    if is_zyx { angles } else { exact_angles::nearest(rotation_of(node, row), DVec3::ZERO) }
}
