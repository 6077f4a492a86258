//! Bake: keys the motion that targets and the followed path give a skeleton, so that it needs them
//! no longer.
//!
//! Every frame of a range is evaluated. The rotations that differ from those of the keys and
//! angles alone become keys at every frame, and so do the offsets that solvers move: those of free
//! roots and of stretched limbs. Euler angles are unwrapped: of all equivalent angles within a
//! joint's limits, a key has the ones nearest to the key before.
//!
//! Keys are then removed one by one, while every base and tip stays within a tolerance of its
//! evaluated position at every frame, until no key can be removed.
//!
//! # What breaks
//!
//! - Lengths of bones have no channel. The tip of a bone that a target stretches is not kept, but
//!   the joints at the tip are; see [`Baked::shortened`].
//! - Between frames a baked pose is interpolated from the keys, and may differ from the evaluated
//!   one by more than the tolerance.

mod motion;
mod reduction;

use core::ops::RangeInclusive;

use glam::Vec3;
use thiserror::Error;

use crate::document::{Document, Timeline, Track};
use motion::{BakedFrames, BakedTrack, Motion};
use reduction::Reduction;

pub use motion::ShortenedBone;

/// Settings of a bake.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bake {
    /// The range to bake, and its frames.
    pub frames: Timeline,
    /// Largest distance of a base or tip from its evaluated position at a frame, as a fraction of
    /// the rig's [reach](crate::rig::SkeletonRig::reach).
    pub tolerance: f32,
}

impl Bake {
    /// The tolerance of a bake unless another is given.
    pub const TOLERANCE: f32 = 1e-3;

    /// A bake of the document's whole timeline.
    pub fn of_timeline(document: &Document) -> Self {
        Self { frames: document.timeline, tolerance: Self::TOLERANCE }
    }

    /// Checks whether a document can be baked.
    ///
    /// # Errors
    ///
    /// See [`BakeError`]; [`BakeError::Nothing`] may also come from [`Bake::run`] only.
    pub fn check(&self, document: &Document) -> Result<(), BakeError> {
        let rig = &document.rig;
        if rig.targets.is_empty() && !document.follows_path() {
            return Err(BakeError::Nothing);
        }
        if !self.frames.is_valid() {
            return Err(BakeError::Range(self.frames));
        }
        if !BakeError::TOLERANCES.contains(&self.tolerance) {
            return Err(BakeError::Tolerance(self.tolerance));
        }
        let (frames, joints) = (self.frames.frames(), rig.skeleton.joints().len());
        if frames.saturating_mul(joints) > BakeError::MOST_POSES {
            return Err(BakeError::TooMuch { frames, joints });
        }
        Ok(())
    }

    /// Bakes a document. `step` is called often with the number of steps done and their total; the
    /// bake ends when it returns `false`.
    ///
    /// # Errors
    ///
    /// See [`BakeError`].
    pub async fn run(
        &self,
        document: &Document,
        mut step: impl AsyncFnMut(usize, usize) -> bool,
    ) -> Result<Baked, BakeError> {
        self.check(document)?;
        let evaluations = self.frames.frames();
        let total = 2 * evaluations;
        let mut go_on = async |done| {
            if step(done, total).await { Ok(()) } else { Err(BakeError::Cancelled) }
        };
        let track = Track::new(document);
        let motion = Motion::record(&track, &self.frames, &mut go_on).await?;
        if !motion.is_posed() {
            return Err(BakeError::Nothing);
        }
        let frames = BakedFrames::new(document.timeline, self.frames);
        let tracks = motion.tracks(&track, &frames);
        let tolerance = self.tolerance * motion.reach;
        let keys_at_frames = tracks.len() * evaluations;
        let mut reduction = Reduction::new(&motion, frames, tracks);
        reduction
            .run(tolerance, async |part| {
                go_on(evaluations + (part * evaluations as f32) as usize).await
            })
            .await?;
        Ok(Baked {
            keys_at_frames,
            keys: reduction.keys(),
            error: reduction.error(),
            shortened: motion.shortened(),
            document: baked(&track, &frames, &motion, &reduction.tracks),
        })
    }
}

/// A baked document, and what the bake cost.
#[derive(Clone, Debug, PartialEq)]
pub struct Baked {
    /// The document with the keys. Its targets have no influence in the range, and its skeleton
    /// follows no path.
    pub document: Document,
    /// Number of keys at every frame, before keys were removed.
    pub keys_at_frames: usize,
    /// Number of keys that are left.
    pub keys: usize,
    /// Largest distance of a base or tip from its evaluated position at a frame, in the world. Tips
    /// of shortened bones are compared at their own length.
    pub error: f32,
    /// Bones that targets stretch. They keep their own length in the baked document.
    pub shortened: Vec<ShortenedBone>,
}

/// The reason why a document is not baked.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum BakeError {
    /// No target and no path poses the skeleton in the range.
    #[error("nothing to bake: no target and no path poses the skeleton in this range")]
    Nothing,
    /// The range or its frame rate is not [valid](Timeline::is_valid).
    #[error(
        "a bake must start before it ends, within {max} s of time 0, at {least} to {rate} frames per \
         second, got {start} s to {end} s at {frame_rate}",
        max = Timeline::MAX_TIME, least = Timeline::MIN_FRAME_RATE,
        rate = Timeline::MAX_FRAME_RATE,
        start = .0.start, end = .0.end, frame_rate = .0.frame_rate
    )]
    Range(Timeline),
    /// The tolerance is not in [`BakeError::TOLERANCES`].
    #[error(
        "the tolerance must be from {least} to {most} of the reach, got {0}",
        least = Self::TOLERANCES.start(), most = Self::TOLERANCES.end()
    )]
    Tolerance(f32),
    /// The range has more than [`BakeError::MOST_POSES`] frames times joints.
    #[error(
        "frames times joints must be at most {max}, got {frames} frames of {joints} joints; bake a \
         shorter time or fewer frames per second",
        max = Self::MOST_POSES
    )]
    TooMuch {
        /// Number of frames.
        frames: usize,
        /// Number of joints.
        joints: usize,
    },
    /// The bake was cancelled.
    #[error("cancelled")]
    Cancelled,
}

impl BakeError {
    /// The tolerances that a bake can keep, as fractions of the reach. Smaller ones are near
    /// rounding.
    pub const TOLERANCES: RangeInclusive<f32> = 1e-5..=1.0;
    /// Maximum number of frames times joints. A bake of so many takes about half a gigabyte of
    /// memory.
    pub const MOST_POSES: usize = 2_000_000;
}

/// The document with baked tracks, without what posed the skeleton.
fn baked(track: &Track, frames: &BakedFrames, motion: &Motion, tracks: &[BakedTrack]) -> Document {
    let mut baked = track.document().clone();
    for baked_track in tracks {
        baked.keys.set_track(baked_track.channel, baked_track.spline.clone());
    }
    for channel in motion.influences.iter().copied() {
        let mut spline = frames.surroundings(track, channel);
        for frame in [0, frames.count() - 1] {
            spline.insert(frames.time(frame), Vec3::ZERO);
        }
        baked.keys.set_track(channel, spline);
    }
    baked.rig.follow_paths.clear();
    baked
}
