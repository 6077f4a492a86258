use glam::Vec3;

use super::baked_track::{BakedFrames, BakedTrack};
use super::motion::Motion;
use super::outcome::{BakeError, Baked};
use super::reduction::Reduction;
use crate::document::{Channel, Document, RigKind, Timeline, Track};

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
        let rig = &document.skeleton_rig;
        if document.rig == RigKind::Arm {
            return Err(BakeError::Arm);
        }
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
    pub fn run(
        &self,
        document: &Document,
        mut step: impl FnMut(usize, usize) -> bool,
    ) -> Result<Baked, BakeError> {
        self.check(document)?;
        let evaluations = self.frames.frames();
        let total = 2 * evaluations;
        let mut go_on = |done| if step(done, total) { Ok(()) } else { Err(BakeError::Cancelled) };
        let track = Track::new(document);
        let motion = Motion::record(&track, &self.frames, &mut go_on)?;
        if !motion.is_posed() {
            return Err(BakeError::Nothing);
        }
        let frames = BakedFrames::new(document.timeline, self.frames);
        let tracks = motion.tracks(&track, &frames);
        let tolerance = self.tolerance * motion.reach;
        let keys_at_frames = tracks.len() * evaluations;
        let mut reduction = Reduction::new(&motion, frames, tracks);
        reduction
            .run(tolerance, |part| go_on(evaluations + (part * evaluations as f32) as usize))?;
        Ok(Baked {
            keys_at_frames,
            keys: reduction.keys(),
            error: reduction.error(),
            shortened: motion.shortened(),
            document: baked(&track, &frames, &motion, &reduction.tracks),
        })
    }
}

/// The document with baked tracks, without what posed the skeleton.
fn baked(track: &Track, frames: &BakedFrames, motion: &Motion, tracks: &[BakedTrack]) -> Document {
    let mut baked = track.document().clone();
    for baked_track in tracks {
        baked.keys.set_track(baked_track.channel, baked_track.spline.clone());
    }
    for target in motion.posed_targets() {
        let channel = Channel::TargetInfluence(target);
        let mut spline = frames.surroundings(track, channel);
        for frame in [0, frames.count() - 1] {
            spline.insert(frames.time(frame), Vec3::ZERO);
        }
        baked.keys.set_track(channel, spline);
    }
    baked.skeleton_rig.follow_paths.clear();
    baked
}
