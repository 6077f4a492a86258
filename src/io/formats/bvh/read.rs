use glam::{DMat3, DVec3, Vec3};

use super::hierarchy::{self, BvhChannel, BvhNode, Scanner, TextError, Token};
use super::rig::distinct;
use crate::document::{self, Document, Keys, SkeletonRig, Timeline};
use crate::io::bones::{self, JointTree};
use crate::io::error::{OpenError, Remark};
use crate::io::exported::BvhUnit;
use crate::io::frame_rate;
use crate::io::opened::{OpenOptions, Opened};
use crate::io::source::Source;
use crate::kinematics::skeleton::{Joint, JointId, Skeleton, exact_angles};
use crate::kinematics::spline::{Interpolation, Knot, Spline};

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
    let (motion, warning) = read_motion(&mut text, &nodes).map_err(open_error)?;
    let skeletons: Vec<_> = nodes.iter().take(1).map(|root| root.name.clone()).collect();
    let name = options.skeleton.as_deref();
    if let Some(name) = name.filter(|name| !skeletons.iter().any(|other| other == name)) {
        let file = source.name().to_owned();
        return Err(OpenError::NoSkeleton { file, name: name.to_owned(), names: skeletons });
    }
    let mut warnings = rename(source, &mut nodes);
    warnings.extend(warning.map(|it| source.remark_about(it.at, &it.joint, &it.reason)));
    if motion.keep_offsets(&mut nodes) {
        let reason = "the positions of joints are 0 in all frames: the joints keep their OFFSETs";
        warnings.push(Remark::new(reason.to_owned()));
    }
    let document = document(&nodes, &motion).map_err(open_error)?;
    Ok(Opened {
        order: document.skeleton().ids().collect(),
        document,
        warnings,
        skeletons,
        skeleton: Some(0),
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
        keys,
        timeline: timeline(motion),
        metres_per_unit: Some(BvhUnit::METRES),
        ..Document::new(rig)
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
        let knot = |(frame, row)| {
            angles = exact_angles::nearest(rotation_of(node, row), angles);
            let time = motion.timing.time(frame);
            // Near gimbal lock, angles swing out and back within a frame; the joint does not.
            Knot { interpolation: Interpolation::Slerp, ..Knot::new(time, angles.as_vec3()) }
        };
        let track: Spline<Vec3> = rows.enumerate().map(knot).collect();
        keys.set_track(document::Channel::Rotation(JointId::new(joint)), track);
    }
    FirstFrame { offset: offset(node, first), rotation }
}

/// The joint's offset in a frame. Position channels replace the components of `node.offset`, unless
/// the joint keeps it.
fn offset(node: &BvhNode, row: &[f32]) -> Vec3 {
    let mut offset = node.offset;
    for (channel, value) in node.channels.iter().zip(row) {
        match channel {
            BvhChannel::Position(axis) if !node.keeps_offset => offset[*axis] = *value,
            _ => {}
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

/// The values of all channels in each frame.
pub struct MotionData {
    frames: usize,
    /// Number of channels of all joints together.
    width: usize,
    values: Vec<f32>,
    pub timing: FrameTiming,
}

/// The times of the frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameTiming {
    /// Frames per second, as far as a timeline can have them.
    pub frame_rate: f64,
    /// Time from one frame to the next in seconds; `None` if it is 1 / `frame_rate`.
    step: Option<f64>,
}

/// Reads the text after the word MOTION. Text after the last frame is ignored, with a warning.
fn read_motion(
    text: &mut Scanner<'_>,
    nodes: &[BvhNode],
) -> Result<(MotionData, Option<TextError>), TextError> {
    let count = labelled(text, &["Frames"])?;
    let frames = count.whole("")?;
    let timing = FrameTiming::read(labelled(text, &["Frame", "Time"])?, frames)?;
    let channels: Vec<(&BvhNode, BvhChannel)> =
        nodes.iter().flat_map(|node| node.channels.iter().map(move |it| (node, *it))).collect();
    let width = channels.len();
    // The header can claim more frames than the file has. A number takes at least two bytes, a
    // digit and a space, so the rest of the text limits how many there can be.
    let max_values = text.remaining().div_ceil(2);
    let mut values = Vec::with_capacity(frames.saturating_mul(width).min(max_values));
    for frame in 0..if width == 0 { 0 } else { frames } {
        let Some(line) = text.line() else {
            let reason =
                format!("Frames must be {frame}, the number of lines that follow, got {frames}");
            return Err(TextError::new(count.at, "", reason));
        };
        read_frame(line, frame, &channels, &mut values)?;
    }
    let warning = text.line().map(|line| {
        TextError::new(
            line.at,
            "",
            format!("ignored: text after the {frames} frames of the header"),
        )
    });
    Ok((MotionData { frames, width, values, timing }, warning))
}

fn labelled<'a>(text: &mut Scanner<'a>, label: &[&str]) -> Result<Token<'a>, TextError> {
    if text.label(label) {
        return Ok(text.word());
    }
    let word = text.word();
    let reason = format!("{}, expected {}:", word.found(), label.join(" "));
    Err(TextError::new(word.at, "", reason))
}

fn read_frame(
    line: Token<'_>,
    frame: usize,
    channels: &[(&BvhNode, BvhChannel)],
    values: &mut Vec<f32>,
) -> Result<(), TextError> {
    let width = channels.len();
    let mut words = line.words();
    for (index, (node, channel)) in channels.iter().enumerate() {
        let Some(word) = words.next() else {
            let reason = format!(
                "frame {frame} must have {width} numbers, got {index} before {}",
                channel.name()
            );
            return Err(TextError::new(line.end(), &node.name, reason));
        };
        let value = word.number(&node.name).map_err(|error| {
            let reason = format!("{} of frame {frame}: {}", channel.name(), error.reason);
            TextError { reason, ..error }
        })?;
        values.push(value);
    }
    match words.next() {
        None => Ok(()),
        Some(word) => {
            let count = width + 1 + words.count();
            let reason = format!("frame {frame} must have {width} numbers, got {count}");
            Err(TextError::new(word.at, "", reason))
        }
    }
}

impl MotionData {
    pub fn frames(&self) -> usize {
        self.frames
    }

    /// Lets joints keep their offsets if the positions of all joints but the root are 0 in all frames
    /// and some of these joints have another offset, as MakeHuman writes files: the joints would all
    /// be at one point. Returns whether they do. A root moves by its positions unless they are 0, too.
    fn keep_offsets(&self, nodes: &mut [BvhNode]) -> bool {
        let mut start = 0;
        let mut placed: Vec<(usize, bool)> = Vec::new();
        for (index, node) in nodes.iter().enumerate() {
            let is_position = |channel: &BvhChannel| matches!(channel, BvhChannel::Position(_));
            if node.channels.iter().any(is_position) {
                let is_still = |row: &[f32]| {
                    let mut values = node.channels.iter().zip(row);
                    values.all(|(channel, value)| !is_position(channel) || *value == 0.0)
                };
                placed.push((index, self.channels(start, node.channels.len()).all(is_still)));
            }
            start += node.channels.len();
        }
        let inner = || placed.iter().filter(|(index, _)| nodes[*index].parent.is_some());
        let are_lost = self.frames > 0
            && inner().all(|(_, is_zero)| *is_zero)
            && inner().any(|(index, _)| nodes[*index].offset != Vec3::ZERO);
        for (index, is_zero) in placed {
            nodes[index].keeps_offset = are_lost && is_zero;
        }
        are_lost
    }

    /// For each frame, the values of the `width` channels that begin with channel `start`.
    pub fn channels(&self, start: usize, width: usize) -> impl Iterator<Item = &[f32]> + Clone {
        let rows = self.values.chunks_exact(self.width.max(1));
        rows.map(move |row| row.get(start..start + width).unwrap_or_default())
    }
}

impl FrameTiming {
    fn read(word: Token<'_>, frames: usize) -> Result<Self, TextError> {
        let step: f64 =
            word.text.parse().ok().filter(|step: &f64| step.is_finite()).ok_or_else(|| {
                TextError::new(word.at, "", format!("{}, expected a time in seconds", word.found()))
            })?;
        if step <= 0.0 {
            let reason = format!("Frame Time must be above 0 s, got {step}");
            return Err(TextError::new(word.at, "", reason));
        }
        let timing = Self::new(step, last_digit(word.text));
        let end = timing.time(frames.saturating_sub(1));
        if end > Timeline::MAX_TIME {
            let max_time = Timeline::MAX_TIME;
            let reason =
                format!("motion must last at most {max_time} s, got {frames} frames of {step} s");
            return Err(TextError::new(word.at, "", reason));
        }
        Ok(timing)
    }

    /// `unit` is the value of the last digit of `step`.
    fn new(step: f64, unit: f64) -> Self {
        let rate = frame_rate::of_frame_time(step, unit);
        let frame_rate = rate.clamp(Timeline::MIN_FRAME_RATE, Timeline::MAX_FRAME_RATE);
        Self { frame_rate, step: (frame_rate != rate).then_some(step) }
    }

    /// Time of a frame, in seconds.
    pub fn time(&self, frame: usize) -> f64 {
        match self.step {
            None => frame as f64 / self.frame_rate,
            Some(step) => frame as f64 * step,
        }
    }
}

/// The value of the last digit of a number: 0.001 for "0.033" and for "3.3e-2".
fn last_digit(number: &str) -> f64 {
    let (digits, exponent) = number.split_once(['e', 'E']).unwrap_or((number, "0"));
    let decimals = digits.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    let exponent: i32 = exponent.parse().unwrap_or(0);
    10_f64.powi(exponent.saturating_sub(i32::try_from(decimals).unwrap_or(i32::MAX)))
}
