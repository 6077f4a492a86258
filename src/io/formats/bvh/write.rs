use std::fmt;
use std::fmt::Write as _;

use glam::DVec3;

use super::rig::{BvhPose, BvhRig, SkeletonTransform};
use crate::document::{Document, Track};
use crate::io::exported::{BvhUnit, ExportFrames, Exported, MotionError, Progress};
use crate::kinematics::skeleton::{SkinStretch, exact_angles};

/// Numbers of a node in a frame: its offset, and its angles about x, y and z.
const WIDTH: usize = 6;

/// Exports the shown rig and its motion as a BVH file. A joint whose offset changes has position
/// channels, all others have rotation channels only.
///
/// # Errors
///
/// Fails if the export is cancelled, `fps` is invalid, the skeleton has no joints, a position
/// overflows, or the rig or the timeline is too large.
pub async fn to_bvh(
    document: &Document,
    fps: Option<f64>,
    unit: BvhUnit,
    progress: &Progress,
) -> Result<Exported, MotionError> {
    let frames = ExportFrames::of_pose(document, fps)?;
    let rig = BvhRig::new(document).ok_or(MotionError::NoJoints)?;
    MotionError::check_size(frames.count(), WIDTH * rig.names.len())?;
    let track = Track::new(document);
    let mut motion = BvhMotion::new(&rig, unit.per_unit(document));
    for frame in 0..frames.count() {
        progress.step(frame, frames.count()).await?;
        let posed = track.at(frames.time(frame));
        let transform = SkeletonTransform::new(posed.document().skeleton().transform());
        motion.is_uneven |= !transform.is_even();
        let mut joints = posed.skeleton().joints().iter();
        motion.stretches_skin |= joints.any(|joint| joint.skin != SkinStretch::NONE);
        motion.add(rig.pose(&posed, &transform))?;
    }
    let text = motion.text(&frames)?;
    progress.step(frames.count(), frames.count()).await?;
    Ok(Exported { bytes: text.into_bytes(), notes: motion.notes() })
}

/// The motion of a rig, frame by frame.
struct BvhMotion<'a> {
    rig: &'a BvhRig,
    /// Length of one unit of the scene, in units of the file.
    scale: f64,
    /// The pose in the first frame.
    first: Option<BvhPose>,
    /// Offsets and ends that move by less than this count as constant, in units of the scene.
    least: f64,
    /// For each node, whether its offset moves.
    offsets: Vec<bool>,
    /// For each node, whether the tip of its bone moves.
    ends: Vec<bool>,
    is_uneven: bool,
    stretches_skin: bool,
    /// The joints' angles in the last frame, in radians. The angles of the next frame are unwrapped
    /// to be nearest to them.
    angles: Vec<DVec3>,
    /// The numbers of all frames: for each node, [`WIDTH`] in units of the file and degrees.
    rows: Vec<f32>,
}

impl<'a> BvhMotion<'a> {
    fn new(rig: &'a BvhRig, scale: f64) -> Self {
        let nodes = rig.names.len();
        Self {
            rig,
            scale,
            first: None,
            least: 0.0,
            offsets: vec![false; nodes],
            ends: vec![false; nodes],
            is_uneven: false,
            stretches_skin: false,
            angles: vec![DVec3::ZERO; nodes],
            rows: Vec::new(),
        }
    }

    fn add(&mut self, pose: BvhPose) -> Result<(), MotionError> {
        /// Fraction of the reach by which what counts as constant may move.
        const CONSTANT: f64 = 1e-5;
        if self.first.is_none() {
            self.least = CONSTANT * self.rig.reach(&pose);
        }
        for node in 0..pose.offsets.len() {
            self.angles[node] = exact_angles::nearest(pose.rotations[node], self.angles[node]);
            self.rows.extend(self.in_file(node, pose.offsets[node])?);
            self.rows.extend(self.angles[node].to_array().map(degrees));
        }
        let first = self.first.get_or_insert_with(|| pose.clone());
        for (node, moves) in self.offsets.iter_mut().enumerate() {
            *moves |= pose.offsets[node].distance(first.offsets[node]) > self.least;
        }
        for (node, moves) in self.ends.iter_mut().enumerate() {
            let ends = pose.ends[node].zip(first.ends[node]);
            *moves |= ends.is_some_and(|(now, first)| now.distance(first) > self.least);
        }
        Ok(())
    }

    /// A vector in units of the file. Errors name the node.
    fn in_file(&self, node: usize, vector: DVec3) -> Result<[f32; 3], MotionError> {
        let vector = (vector * self.scale).as_vec3();
        if !vector.is_finite() {
            let joint = self.rig.names.get(node).cloned().unwrap_or_default();
            return Err(MotionError::TooFar { joint });
        }
        Ok(vector.to_array())
    }

    /// Returns whether a node has position channels. The first one always does.
    fn has_position(&self, node: usize) -> bool {
        node == 0 || self.offsets[node]
    }

    fn text(&self, frames: &ExportFrames) -> Result<String, MotionError> {
        let mut text = self.hierarchy()?;
        let _ = writeln!(text, "MOTION\nFrames: {}", frames.count());
        let _ = writeln!(text, "Frame Time: {}", frame_time(frames.rate()));
        for row in self.rows.chunks_exact(WIDTH * self.rig.names.len()) {
            self.frame(&mut text, row);
        }
        Ok(text)
    }

    fn hierarchy(&self) -> Result<String, MotionError> {
        let mut text = "HIERARCHY\n".to_owned();
        let Some(pose) = &self.first else { return Ok(text) };
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
            let channels = if self.has_position(node) {
                "6 Xposition Yposition Zposition Zrotation Yrotation Xrotation"
            } else {
                "3 Zrotation Yrotation Xrotation"
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

    fn frame(&self, text: &mut String, row: &[f32]) {
        let start = text.len();
        for (node, numbers) in row.chunks_exact(WIDTH).enumerate() {
            let &[px, py, pz, ax, ay, az] = numbers else { continue };
            if self.has_position(node) {
                [px, py, pz].into_iter().for_each(|number| push_number(text, number));
            }
            [az, ay, ax].into_iter().for_each(|number| push_number(text, number));
        }
        // Removes the space in front of the first number.
        text.remove(start);
        text.push('\n');
    }

    /// The three numbers of a vector in units of the file, each after a space. Errors name the
    /// node.
    fn vector(&self, node: usize, vector: DVec3) -> Result<String, MotionError> {
        let mut text = String::new();
        for number in self.in_file(node, vector)? {
            push_number(&mut text, number);
        }
        Ok(text)
    }

    /// Descriptions of motion that the file cannot hold.
    fn notes(&self) -> Vec<String> {
        let names = self.rig.names.iter().map(String::as_str).zip(&self.ends);
        let moving: Vec<&str> = names.filter(|(_, moves)| **moves).map(|(name, _)| name).collect();
        let mut notes = Vec::new();
        if self.is_uneven {
            notes.push(BvhNote::Uneven.to_string());
        }
        if self.stretches_skin {
            notes.push(BvhNote::StretchedSkin.to_string());
        }
        if !moving.is_empty() {
            notes.push(BvhNote::Ends(&moving).to_string());
        }
        notes
    }
}

/// The time of a frame in seconds, with so many digits that a reader finds the same frame rate.
fn frame_time(rate: f64) -> String {
    let step = rate.recip();
    if rate.fract() == 0.0 { format!("{step:.9}") } else { step.to_string() }
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

/// Motion that BVH cannot hold.
pub enum BvhNote<'a> {
    /// The skeleton's transform has uneven scale, shear or zero scale.
    Uneven,
    /// Joints scale or shear the skin.
    StretchedSkin,
    /// The bones without children with these names change their length or direction.
    Ends(&'a [&'a str]),
}

impl fmt::Display for BvhNote<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Uneven => f.write_str(
                "the skeleton is scaled unevenly, sheared or flattened, and BVH has rotations \
                 only: the nearest rotations are written; the joints' positions are exact",
            ),
            Self::StretchedSkin => f.write_str(
                "joints scale the skin, and BVH has neither skins nor scales: only the motion of the \
                 joints is written",
            ),
            Self::Ends(names) => {
                /// Maximum number of names that are listed. Further bones are only counted.
                const MOST: usize = 10;
                let named: Vec<_> =
                    names.iter().take(MOST).map(|name| format!("{name:?}")).collect();
                write!(f, "the last bone of {}", named.join(", "))?;
                if let Some(more) = names.len().checked_sub(MOST).filter(|more| *more > 0) {
                    write!(f, " and {more} more joints")?;
                }
                f.write_str(
                    " changes in time, but BVH has constant end sites: that of the first frame is \
                     written",
                )
            }
        }
    }
}
