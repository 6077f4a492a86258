use std::fmt::Write as _;

use glam::DVec3;

use super::angles;
use super::figure::{Figure, Stance};
use super::place::Place;
use super::{BvhUnit, Note};
use crate::document::{Document, RigKind};
use crate::io::Progress;
use crate::io::frames::{Frames, Playback};
use crate::io::motion::{Exported, MotionError};

/// The shown rig and its motion as BVH: see the module.
///
/// # Errors
///
/// If it is to stop, or the rig or the time is more than such a file holds.
pub fn to_bvh(
    document: &Document,
    fps: Option<u32>,
    unit: BvhUnit,
    progress: &Progress,
) -> Result<Exported, MotionError> {
    let frames = Frames::of_pose(document, fps)?;
    let figure = Figure::new(document).ok_or(MotionError::NoJoints)?;
    MotionError::if_too_much(frames.count(), 3 + 3 * figure.names.len())?;
    let mut playback = Playback::new(document);
    let mut moving = Moving::default();
    let mut motion = Motion::new(&figure, unit.per_unit(document));
    let mut text = String::new();
    let mut first: Option<Stance> = None;
    for frame in 0..frames.count() {
        progress.step(frame, frames.count())?;
        let time = frames.time(frame);
        let posed = playback.at(time);
        let place = Place::new(posed.skeleton().transform());
        let stance = figure.stance(posed, &place, time);
        let first = match &first {
            Some(first) => first,
            None => {
                text = motion.hierarchy(&stance)?;
                motion_header(&mut text, &frames);
                moving = Moving::new(document, &place, &stance);
                first.insert(stance.clone())
            }
        };
        moving.compare(first, &stance);
        motion.frame(&mut text, &stance)?;
    }
    progress.step(frames.count(), frames.count())?;
    Ok(Exported { bytes: text.into_bytes(), notes: moving.notes(&figure) })
}

fn motion_header(text: &mut String, frames: &Frames) {
    let _ = writeln!(text, "MOTION\nFrames: {}", frames.count());
    let _ = writeln!(text, "Frame Time: {:.9}", f64::from(frames.rate()).recip());
}

/// Writes a figure's places and turns.
struct Motion<'a> {
    figure: &'a Figure,
    /// How many of the file's units a unit of the scene is.
    scale: f64,
    /// What the joints' angles were last, in radians, so that they go on from there.
    angles: Vec<DVec3>,
}

impl<'a> Motion<'a> {
    fn new(figure: &'a Figure, scale: f64) -> Self {
        Self { figure, scale, angles: vec![DVec3::ZERO; figure.names.len()] }
    }

    fn hierarchy(&self, stance: &Stance) -> Result<String, MotionError> {
        let mut text = "HIERARCHY\n".to_owned();
        let Figure { names, parents, .. } = self.figure;
        // The nodes that are open, from the first one inwards.
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
            let offset = if parent.is_none() { DVec3::ZERO } else { stance.offsets[node] };
            line(&mut text, depth + 1, &format!("OFFSET{}", self.place(node, offset)?));
            let channels = match parent {
                None => "6 Xposition Yposition Zposition Zrotation Yrotation Xrotation",
                Some(_) => "3 Zrotation Yrotation Xrotation",
            };
            line(&mut text, depth + 1, &format!("CHANNELS {channels}"));
            if let Some(end) = stance.ends[node] {
                line(&mut text, depth + 1, "End Site");
                line(&mut text, depth + 1, "{");
                line(&mut text, depth + 2, &format!("OFFSET{}", self.place(node, end)?));
                line(&mut text, depth + 1, "}");
            }
            open.push(node);
        }
        for depth in (0..open.len()).rev() {
            line(&mut text, depth, "}");
        }
        Ok(text)
    }

    fn frame(&mut self, text: &mut String, stance: &Stance) -> Result<(), MotionError> {
        let root = stance.offsets.first().copied().unwrap_or_default();
        let start = text.len();
        text.push_str(&self.place(0, root)?);
        for (angles, turn) in self.angles.iter_mut().zip(&stance.turns) {
            *angles = angles::nearest(*turn, *angles);
            for angle in [angles.z, angles.y, angles.x] {
                push(text, degrees(angle));
            }
        }
        // Each number has a space before it.
        text.remove(start);
        text.push('\n');
        Ok(())
    }

    /// Three numbers, each with a space before it.
    fn place(&self, node: usize, place: DVec3) -> Result<String, MotionError> {
        let place = (place * self.scale).as_vec3();
        if !place.is_finite() {
            let joint = self.figure.names.get(node).cloned().unwrap_or_default();
            return Err(MotionError::TooFar { joint });
        }
        let mut text = String::new();
        for number in place.to_array() {
            push(&mut text, number);
        }
        Ok(text)
    }
}

/// In f32, the precision of what is turned: 90 is 90 again.
fn degrees(radians: f64) -> f32 {
    /// What is nearer to 0 is a rounding.
    const ROUNDING: f32 = 1e-9;
    let degrees = radians.to_degrees() as f32;
    if degrees.abs() < ROUNDING { 0.0 } else { degrees }
}

/// As few digits as make the same f32 again; never −0.
fn push(text: &mut String, number: f32) {
    let _ = write!(text, " {}", number + 0.0);
}

/// Deep hierarchies would be nothing but tabs.
fn line(text: &mut String, depth: usize, line: &str) {
    const DEEPEST: usize = 32;
    text.extend(std::iter::repeat_n('\t', depth.min(DEEPEST)));
    text.push_str(line);
    text.push('\n');
}

/// What of the motion is not in the file.
#[derive(Default)]
struct Moving {
    is_arm: bool,
    is_uneven: bool,
    offsets: Vec<bool>,
    ends: Vec<bool>,
}

impl Moving {
    fn new(document: &Document, place: &Place, stance: &Stance) -> Self {
        let is_arm = document.rig == RigKind::Arm;
        Self {
            is_arm,
            is_uneven: !is_arm && !place.is_even(),
            offsets: vec![false; stance.offsets.len()],
            ends: vec![false; stance.ends.len()],
        }
    }

    fn compare(&mut self, first: &Stance, now: &Stance) {
        // The first one's is in its channels.
        for (node, moves) in self.offsets.iter_mut().enumerate().skip(1) {
            *moves |= first.offsets[node] != now.offsets[node];
        }
        for (node, moves) in self.ends.iter_mut().enumerate() {
            *moves |= first.ends[node] != now.ends[node];
        }
    }

    fn notes(&self, figure: &Figure) -> Vec<String> {
        let mut notes = Vec::new();
        if self.is_uneven {
            notes.push(Note::Uneven.to_string());
        }
        let names = || figure.names.iter().map(String::as_str);
        let moving: Vec<&str> =
            names().zip(&self.offsets).filter(|(_, moves)| **moves).map(|(name, _)| name).collect();
        if self.is_arm {
            // A limb's length is the offset of what hangs from it.
            let lengths = [(!moving.is_empty(), "upper"), (self.ends.contains(&true), "lower")];
            let changing = lengths.into_iter().filter(|(changes, _)| *changes);
            notes.extend(changing.map(|(_, limb)| Note::Length(limb).to_string()));
        } else if !moving.is_empty() {
            notes.push(Note::Offsets(&moving).to_string());
        }
        notes
    }
}
