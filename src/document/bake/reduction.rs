use core::iter::once;

use glam::{Affine3A, Vec3};

use super::motion::{BakedFrames, BakedTrack, Ends, Motion, Placement};
use crate::document::Channel;
use crate::kinematics::skeleton::JointId;

/// Removal of keys from tracks.
pub(super) struct Reduction<'a> {
    motion: &'a Motion,
    frames: BakedFrames,
    pub tracks: Vec<BakedTrack>,
    /// Placements by the tracks, or else by keys and angles alone.
    placements: Vec<Placement>,
    /// Transforms of joints to their parents' spaces.
    locals: Vec<Affine3A>,
    /// Transforms of joints to skeleton space.
    fulls: Vec<Affine3A>,
    trial: Trial,
}

/// Poses of some frames without a key.
#[derive(Default)]
struct Trial {
    /// The track's joint and its descendants, parents first.
    subtree: Vec<JointId>,
    /// Index of each joint in the subtree; undefined for other joints.
    positions: Vec<usize>,
    frames: Vec<(usize, Placement, Affine3A)>,
    /// Transforms of the subtree to skeleton space: those of the first frame, and so on.
    fulls: Vec<Affine3A>,
}

impl<'a> Reduction<'a> {
    pub fn new(motion: &'a Motion, frames: BakedFrames, tracks: Vec<BakedTrack>) -> Self {
        let joints = motion.skeleton.joints().len();
        let mut placements = motion.keyed.clone();
        for track in &tracks {
            for (frame, knot) in (0..frames.count()).map(|frame| (frame, frames.time(frame))) {
                let value = track.spline.get(knot).unwrap_or_default();
                let placement = &mut placements[frame * joints + track.joint.index()];
                *placement = track.changed(*placement, value, motion);
            }
        }
        let ids = || motion.skeleton.ids().cycle();
        let local =
            |(placement, joint): (&Placement, JointId)| placement.local(&motion.skeleton, joint);
        let locals: Vec<Affine3A> = placements.iter().zip(ids()).map(local).collect();
        let mut fulls = Vec::with_capacity(locals.len());
        for (index, (local, joint)) in locals.iter().zip(ids()).enumerate() {
            let parent = motion.skeleton[joint].parent;
            let frame = index - joint.index();
            let above = parent.map_or(Affine3A::IDENTITY, |parent| fulls[frame + parent.index()]);
            fulls.push(above * *local);
        }
        let trial = Trial { positions: vec![0; joints], ..Trial::default() };
        Self { motion, frames, tracks, placements, locals, fulls, trial }
    }

    /// Removes keys while all bases and tips are within `tolerance`, in the world, until no key can
    /// be removed. `go_on` is called with the part of the work that is done, from 0 to 1.
    pub async fn run<E>(
        &mut self,
        tolerance: f32,
        mut go_on: impl AsyncFnMut(f32) -> Result<(), E>,
    ) -> Result<(), E> {
        // The rest of the tolerance is for the rounding of positions in the world.
        let most = 0.99 * tolerance;
        for round in 0.. {
            let before = self.keys();
            for track in 0..self.tracks.len() {
                // Each round removes less than the one before, and the number of rounds is unknown.
                let done = round as f32 + track as f32 / self.tracks.len() as f32;
                self.reduce(track, most, async || go_on(1.0 - (-done).exp2()).await).await?;
            }
            if self.keys() == before {
                break;
            }
        }
        Ok(())
    }

    /// Number of keys in the range.
    pub fn keys(&self) -> usize {
        self.tracks.iter().map(|track| track.frames.len()).sum()
    }

    /// Largest distance of a base or tip from its evaluated position at a frame, in the world.
    pub fn error(&self) -> f32 {
        let ids = self.motion.skeleton.ids().cycle();
        let fulls = self.fulls.iter().zip(&self.motion.ends).zip(ids);
        fulls.map(|((full, ends), joint)| self.distance(*full, *ends, joint)).fold(0.0, f32::max)
    }

    /// Removes keys of one track while all bases and tips are within `most`, in the world. At least
    /// one key is left. `go_on` is called for each key.
    async fn reduce<E>(
        &mut self,
        track: usize,
        most: f32,
        mut go_on: impl AsyncFnMut() -> Result<(), E>,
    ) -> Result<(), E> {
        self.trial.start(self.motion, self.tracks[track].joint);
        let before = std::mem::take(&mut self.tracks[track].frames);
        let mut left = Vec::with_capacity(before.len());
        for (index, frame) in before.iter().enumerate() {
            go_on().await?;
            let is_last = left.is_empty() && index + 1 == before.len();
            if is_last || !self.try_remove(track, *frame, most) {
                left.push(*frame);
            }
        }
        self.tracks[track].frames = left;
        Ok(())
    }

    /// Removes the key at a frame if all bases and tips stay within `most`, in the world. Returns
    /// whether it is removed.
    fn try_remove(&mut self, track: usize, frame: usize, most: f32) -> bool {
        let time = self.frames.time(frame);
        let Some(value) = self.tracks[track].spline.remove(time) else { return false };
        self.trial.clear();
        let others = self.affected(track, time).filter(|other| *other != frame);
        // The pose at the removed key changes most, and decides most often.
        let fits = once(frame).chain(others).all(|frame| self.try_pose(track, frame, most));
        if fits {
            self.accept();
        } else {
            self.tracks[track].spline.insert(time, value);
        }
        fits
    }

    /// The frames at which a key removed from a time shapes the curve: up to the second key on both
    /// sides.
    fn affected(&self, track: usize, time: f64) -> core::ops::Range<usize> {
        let knots = self.tracks[track].spline.knots();
        let after = knots.partition_point(|knot| knot.time < time);
        let from = after.checked_sub(2).map_or(f64::NEG_INFINITY, |knot| knots[knot].time);
        let to = knots.get(after + 1).map_or(f64::INFINITY, |knot| knot.time);
        self.frames.between(from, to)
    }

    /// Poses the subtree of a track at a frame by the track's present keys. Returns whether all its
    /// bases and tips are within `most`, in the world.
    fn try_pose(&mut self, track: usize, frame: usize, most: f32) -> bool {
        let track = &self.tracks[track];
        let start = frame * self.motion.skeleton.joints().len();
        let at = start + track.joint.index();
        let value = track.spline.at(self.frames.time(frame)).unwrap_or_default();
        let placement = track.changed(self.placements[at], value, self.motion);
        if placement == self.placements[at] {
            return true;
        }
        let moved = placement.local(&self.motion.skeleton, track.joint);
        let poses = self.trial.fulls.len();
        for index in 0..self.trial.subtree.len() {
            let joint = self.trial.subtree[index];
            let local = if index == 0 { moved } else { self.locals[start + joint.index()] };
            let above = match self.motion.skeleton[joint].parent {
                None => Affine3A::IDENTITY,
                Some(parent) if index == 0 => self.fulls[start + parent.index()],
                Some(parent) => self.trial.fulls[poses + self.trial.positions[parent.index()]],
            };
            let full = above * local;
            let ends = self.motion.ends[start + joint.index()];
            // A distance that is not a number does not fit.
            let fits = self.distance(full, ends, joint) <= most;
            if !fits {
                return false;
            }
            self.trial.fulls.push(full);
        }
        self.trial.frames.push((frame, placement, moved));
        true
    }

    /// Makes the poses of the trial the present ones.
    fn accept(&mut self) {
        let Trial { subtree, frames, fulls, .. } = &self.trial;
        let Some(top) = subtree.first() else { return };
        for ((frame, placement, local), fulls) in frames.iter().zip(fulls.chunks(subtree.len())) {
            let start = frame * self.motion.skeleton.joints().len();
            self.placements[start + top.index()] = *placement;
            self.locals[start + top.index()] = *local;
            for (joint, full) in subtree.iter().zip(fulls) {
                self.fulls[start + joint.index()] = *full;
            }
        }
    }

    /// Larger distance of a joint's base and tip from their evaluated positions, in the world.
    fn distance(&self, full: Affine3A, ends: Ends, joint: JointId) -> f32 {
        let axis = self.motion.skeleton[joint].axis;
        let to_world = self.motion.to_world();
        let base = to_world * (Vec3::from(full.translation) - ends.base);
        let tip = to_world * (full.transform_point3(axis) - ends.tip);
        let (base, tip) = (base.length(), tip.length());
        // Unlike `f32::max`, this keeps what is not a number.
        if base > tip { base } else { tip }
    }
}

impl Trial {
    /// Prepares trials of a joint's track.
    fn start(&mut self, motion: &Motion, joint: JointId) {
        self.subtree.clear();
        let below = (joint.index()..motion.skeleton.joints().len()).map(JointId::new);
        for below in below {
            let parent = motion.skeleton[below].parent;
            let is_below = parent.is_some_and(|parent| {
                self.subtree.get(self.positions[parent.index()]) == Some(&parent)
            });
            if below == joint || is_below {
                self.positions[below.index()] = self.subtree.len();
                self.subtree.push(below);
            }
        }
    }

    fn clear(&mut self) {
        self.frames.clear();
        self.fulls.clear();
    }
}

impl BakedTrack {
    /// The placement with the track's value, as [`Channel::set`] sets it.
    fn changed(&self, placement: Placement, value: Vec3, motion: &Motion) -> Placement {
        match self.channel {
            Channel::Offset(_) => Placement { offset: value, ..placement },
            _ => Placement {
                rotation: motion.skeleton[self.joint].limits.project(value),
                ..placement
            },
        }
    }
}
