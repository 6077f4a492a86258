use std::fmt::Write as _;

use glam::DVec3;

use super::angles;
use super::note::BvhNote;
use super::rig::{BvhPose, BvhRig};
use super::transform::SkeletonTransform;
use super::unit::BvhUnit;
use crate::document::{Document, RigKind};
use crate::io::Progress;
use crate::io::frames::{ExportFrames, FrameEvaluator};
use crate::io::motion::{Exported, MotionError};

/// Exports the shown rig and its motion as a BVH file.
///
/// # Errors
///
/// Fails if the export is cancelled, `fps` is invalid, the skeleton has no joints, a position
/// overflows, or the rig or the timeline is too large.
pub fn to_bvh(
    document: &Document,
    fps: Option<u32>,
    unit: BvhUnit,
    progress: &Progress,
) -> Result<Exported, MotionError> {
    let frames = ExportFrames::of_pose(document, fps)?;
    let rig = BvhRig::new(document).ok_or(MotionError::NoJoints)?;
    MotionError::check_size(frames.count(), 3 + 3 * rig.names.len())?;
    let mut playback = FrameEvaluator::new(document);
    let mut lost = LostMotion::default();
    let mut writer = BvhWriter::new(&rig, unit.per_unit(document));
    let mut text = String::new();
    let mut first: Option<BvhPose> = None;
    for frame in 0..frames.count() {
        progress.step(frame, frames.count())?;
        let time = frames.time(frame);
        let posed = playback.at(time);
        let transform = SkeletonTransform::new(posed.skeleton().transform());
        let pose = rig.pose(posed, &transform, time);
        let first = match &first {
            Some(first) => first,
            None => {
                text = writer.hierarchy(&pose)?;
                motion_header(&mut text, &frames);
                lost = LostMotion::new(document, &transform, &pose);
                first.insert(pose.clone())
            }
        };
        lost.compare(first, &pose);
        writer.frame(&mut text, &pose)?;
    }
    progress.step(frames.count(), frames.count())?;
    Ok(Exported { bytes: text.into_bytes(), notes: lost.notes(&rig) })
}

fn motion_header(text: &mut String, frames: &ExportFrames) {
    let _ = writeln!(text, "MOTION\nFrames: {}", frames.count());
    let _ = writeln!(text, "Frame Time: {:.9}", f64::from(frames.rate()).recip());
}

/// Writes the hierarchy and the frames of a rig.
struct BvhWriter<'a> {
    rig: &'a BvhRig,
    /// Length of one unit of the scene, in units of the file.
    scale: f64,
    /// The joints' angles in the previous frame, in radians. The angles of the next frame are
    /// unwrapped to be nearest to them.
    angles: Vec<DVec3>,
}

impl<'a> BvhWriter<'a> {
    fn new(rig: &'a BvhRig, scale: f64) -> Self {
        Self { rig, scale, angles: vec![DVec3::ZERO; rig.names.len()] }
    }

    fn hierarchy(&self, pose: &BvhPose) -> Result<String, MotionError> {
        let mut text = "HIERARCHY\n".to_owned();
        let BvhRig { names, parents, .. } = self.rig;
        // The nodes whose blocks are not closed yet, from the root inwards.
        let mut open: Vec<usize> = Vec::new();
        for (node, (name, parent)) in names.iter().zip(parents).enumerate() {
            while open.last().copied() != *parent {
                open.pop();
                line(&mut text, open.len(), "}");
            }
            let depth = open.len();
            let kind = if parent.is_none() { "ROOT" } else { "JOINT" };
            line(&mut text, depth, &format!("{kind} {name}"));
            line(&mut text, depth, "{");
            let offset = if parent.is_none() { DVec3::ZERO } else { pose.offsets[node] };
            line(&mut text, depth + 1, &format!("OFFSET{}", self.vector(node, offset)?));
            let channels = match parent {
                None => "6 Xposition Yposition Zposition Zrotation Yrotation Xrotation",
                Some(_) => "3 Zrotation Yrotation Xrotation",
            };
            line(&mut text, depth + 1, &format!("CHANNELS {channels}"));
            if let Some(end) = pose.ends[node] {
                line(&mut text, depth + 1, "End Site");
                line(&mut text, depth + 1, "{");
                line(&mut text, depth + 2, &format!("OFFSET{}", self.vector(node, end)?));
                line(&mut text, depth + 1, "}");
            }
            open.push(node);
        }
        for depth in (0..open.len()).rev() {
            line(&mut text, depth, "}");
        }
        Ok(text)
    }

    fn frame(&mut self, text: &mut String, pose: &BvhPose) -> Result<(), MotionError> {
        let root = pose.offsets.first().copied().unwrap_or_default();
        let start = text.len();
        text.push_str(&self.vector(0, root)?);
        for (angles, rotation) in self.angles.iter_mut().zip(&pose.rotations) {
            *angles = angles::nearest(*rotation, *angles);
            for angle in [angles.z, angles.y, angles.x] {
                push_number(text, degrees(angle));
            }
        }
        // Removes the space in front of the first number.
        text.remove(start);
        text.push('\n');
        Ok(())
    }

    /// Formats the three numbers of a vector in units of the file, each after a space. Errors name
    /// the node.
    fn vector(&self, node: usize, vector: DVec3) -> Result<String, MotionError> {
        let vector = (vector * self.scale).as_vec3();
        if !vector.is_finite() {
            let joint = self.rig.names.get(node).cloned().unwrap_or_default();
            return Err(MotionError::TooFar { joint });
        }
        let mut text = String::new();
        for number in vector.to_array() {
            push_number(&mut text, number);
        }
        Ok(text)
    }
}

/// Converts an angle to degrees, rounded to f32 so that a right angle becomes exactly 90.
fn degrees(radians: f64) -> f32 {
    /// Angles below this, in degrees, are rounding errors and become 0.
    const ROUNDING: f32 = 1e-9;
    let degrees = radians.to_degrees() as f32;
    if degrees.abs() < ROUNDING { 0.0 } else { degrees }
}

/// Appends a space and the number, with the fewest digits that parse to the same f32. Writes −0 as
/// 0.
fn push_number(text: &mut String, number: f32) {
    let _ = write!(text, " {}", number + 0.0);
}

/// Appends an indented line. The indentation is bounded, because the text of a deep hierarchy would
/// otherwise be mostly tabs.
fn line(text: &mut String, depth: usize, line: &str) {
    const DEEPEST: usize = 32;
    text.extend(std::iter::repeat_n('\t', depth.min(DEEPEST)));
    text.push_str(line);
    text.push('\n');
}

/// Motion that the file cannot hold.
#[derive(Default)]
struct LostMotion {
    is_arm: bool,
    is_uneven: bool,
    offsets: Vec<bool>,
    ends: Vec<bool>,
}

impl LostMotion {
    fn new(document: &Document, transform: &SkeletonTransform, pose: &BvhPose) -> Self {
        let is_arm = document.rig == RigKind::Arm;
        Self {
            is_arm,
            is_uneven: !is_arm && !transform.is_even(),
            offsets: vec![false; pose.offsets.len()],
            ends: vec![false; pose.ends.len()],
        }
    }

    fn compare(&mut self, first: &BvhPose, now: &BvhPose) {
        // The first node is skipped: its offset may change, because it has position channels.
        for (node, moves) in self.offsets.iter_mut().enumerate().skip(1) {
            *moves |= first.offsets[node] != now.offsets[node];
        }
        for (node, moves) in self.ends.iter_mut().enumerate() {
            *moves |= first.ends[node] != now.ends[node];
        }
    }

    fn notes(&self, rig: &BvhRig) -> Vec<String> {
        let mut notes = Vec::new();
        if self.is_uneven {
            notes.push(BvhNote::Uneven.to_string());
        }
        let names = || rig.names.iter().map(String::as_str);
        let moving: Vec<&str> =
            names().zip(&self.offsets).filter(|(_, moves)| **moves).map(|(name, _)| name).collect();
        if self.is_arm {
            // The lower limb's offset is the upper limb's length; the lower limb's end is its own
            // length.
            let lengths = [(!moving.is_empty(), "upper"), (self.ends.contains(&true), "lower")];
            let changing = lengths.into_iter().filter(|(changes, _)| *changes);
            notes.extend(changing.map(|(_, limb)| BvhNote::Length(limb).to_string()));
        } else if !moving.is_empty() {
            notes.push(BvhNote::Offsets(&moving).to_string());
        }
        notes
    }
}
