mod grid;
mod motion;

use std::cell::OnceCell;
use std::collections::BTreeMap;
use std::sync::Arc;

use super::Document;
use super::camera::Camera;
use super::channel::Channel;
use crate::kinematics::Shared;
use crate::kinematics::chain_ik::ChainSolver;
use crate::kinematics::skeleton::{JointId, Skeleton};
use crate::rig::{Carried, EvaluatedSkeleton, LimbFrames, PathKind, Posture, Skin, TargetReport};
use motion::Motion;

/// The motion of a document: its pose at any time.
///
/// Small motions of targets must give small motions of joints. No pose that follows from the
/// targets of one frame alone is continuous everywhere, so a motion goes in steps, each from the
/// state that the one before has left; between two steps, a pose is one step from the first of
/// them. All this is a function of the document. The states of steps are kept, and clones of a
/// track share them.
#[derive(Clone, Debug)]
pub struct Track {
    motion: Arc<Motion>,
}

/// A document posed at a time. The rig is solved when its pose is first read, and only once.
#[derive(Clone, Debug)]
pub struct Posed {
    /// Every keyed channel has its value at `time`.
    document: Document,
    time: f64,
    motion: Arc<Motion>,
    /// The state of another motion from which the pose continues until its own is known.
    provisional: Option<Arc<Carried>>,
    skeleton: OnceCell<EvaluatedSkeleton>,
    by_itself: OnceCell<Shared<Skeleton>>,
}

impl Document {
    /// The document posed at a time in seconds. A [`Track`] poses it at several times.
    #[must_use]
    pub fn at(&self, time: f64) -> Posed {
        Track::new(self).at(time)
    }
}

impl Track {
    /// The track of a document, whose large parts it shares.
    pub fn new(document: &Document) -> Self {
        Self { motion: Arc::new(Motion::new(document)) }
    }

    /// The track of another document, with the states of this one for all steps before the first
    /// whose inputs differ.
    #[must_use]
    pub fn updated(&self, document: &Document) -> Self {
        if document == self.document() {
            return self.clone();
        }
        Self { motion: Arc::new(self.motion.updated(document)) }
    }

    /// The document of the track.
    pub fn document(&self) -> &Document {
        self.motion.document()
    }

    /// The document posed at a time in seconds: every keyed channel has its interpolated value, and
    /// with [`PathKind::Head`] the rig has the head's keys.
    #[must_use]
    pub fn at(&self, time: f64) -> Posed {
        let mut document = self.document().clone();
        document.apply_keys(time);
        self.pose(document, time)
    }

    /// Poses an edited copy of the document that [`Track::at`] has at `time`, in seconds: channels
    /// keep the values that they have in the copy. The pose continues from the state that the track
    /// has before that time.
    #[must_use]
    pub fn pose(&self, document: Document, time: f64) -> Posed {
        let motion = self.motion.clone();
        Posed {
            document,
            time,
            motion,
            provisional: None,
            skeleton: OnceCell::new(),
            by_itself: OnceCell::new(),
        }
    }

    /// True if the pose at a time in seconds is known, or computed in some hundredths of a second.
    pub fn is_quick_at(&self, time: f64) -> bool {
        const QUICK: u64 = 1 << 17;
        self.motion.missing_work(time) <= QUICK
    }

    /// [`Track::pose`] without the steps until then: continues from the state that `other`, the
    /// motion before an edit, has before that time.
    #[must_use]
    pub fn pose_provisionally(&self, document: Document, time: f64, other: &Self) -> Posed {
        let known = if other.is_quick_at(time) {
            other.motion.state_before(time)
        } else {
            other.motion.known_before(time)
        };
        Posed { provisional: Some(known.unwrap_or_default()), ..self.pose(document, time) }
    }

    /// The document posed at a time in seconds as if it were the only one: solved from the FK pose.
    #[must_use]
    pub fn by_itself(&self, time: f64) -> Posed {
        let mut document = self.document().clone();
        document.apply_keys(time);
        document.rig.is_tracked = false;
        self.pose(document, time)
    }

    /// The posture with which an edited document begins, so that its motion continues from the
    /// present one; `None` if it begins with the FK pose. With `may_start_afresh`, it also does so
    /// where only a solve from there reaches all targets.
    pub fn posture_after(
        &self,
        edited: &Document,
        may_start_afresh: bool,
    ) -> Option<Shared<Posture>> {
        self.motion.posture_after(edited, may_start_afresh)
    }

    /// The posture of an edited document, whose joints may be others, that begins near a posture of
    /// its joints.
    pub fn posture_near(edited: &Document, posture: &Shared<Posture>) -> Option<Shared<Posture>> {
        Motion::posture_near(edited, posture)
    }

    /// The posture with which the motion would reach the targets that a solve of the pose at a time
    /// in seconds by itself reaches: the motion is tracked backwards from there.
    pub fn posture_reaching(&self, time: f64) -> Option<Shared<Posture>> {
        self.motion.posture_reaching(time)
    }
}

impl PartialEq for Track {
    /// Compares documents, of which the poses are a function.
    fn eq(&self, other: &Self) -> bool {
        self.document() == other.document()
    }
}

impl Track {
    /// Maximum work of [`Track::sample`], beyond the pose that exceeds it.
    const SAMPLED_WORK: u64 = ChainSolver::POSE_WORK;

    /// Poses the document at `count` times or, where that is too much work, at every second, fourth
    /// … of them. Returns the results of `take` in the order of the times.
    pub fn sample<T>(
        &self,
        count: usize,
        time: impl Fn(usize) -> f64,
        take: impl Fn(&Posed) -> T,
    ) -> Vec<T> {
        coarse_to_fine(count, Self::SAMPLED_WORK, |index| {
            let posed = self.at(time(index));
            (take(&posed), posed.work())
        })
    }
}

/// Values of `take` at all indices below `count`, or at multiples of the least power of two for
/// which no value is taken after the work, which `take` returns, has exceeded `most_work`.
fn coarse_to_fine<T>(count: usize, most_work: u64, take: impl Fn(usize) -> (T, u64)) -> Vec<T> {
    let mut taken: BTreeMap<usize, T> = BTreeMap::new();
    let (mut stride, mut work) = (count.next_power_of_two(), 0);
    loop {
        for index in (0..count).step_by(stride) {
            if taken.contains_key(&index) {
                continue;
            }
            if work > most_work {
                taken.retain(|index, _| index % (2 * stride) == 0);
                return taken.into_values().collect();
            }
            let (value, of_value) = take(index);
            taken.insert(index, value);
            work += of_value;
        }
        if stride == 1 {
            return taken.into_values().collect();
        }
        stride /= 2;
    }
}

impl Posed {
    /// The document with the values that its channels have at the time.
    pub fn document(&self) -> &Document {
        &self.document
    }

    /// [`Posed::document`] without the poses.
    pub fn into_document(self) -> Document {
        self.document
    }

    /// The time in seconds.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// The limb of a joint's target in its frames; `None` if it has none: see
    /// [`SkeletonRig::limb_frames`](crate::rig::SkeletonRig::limb_frames).
    pub fn limb_frames(&self, joint: JointId) -> Option<LimbFrames> {
        let rig = &self.document.rig;
        rig.limb_frames(self.evaluated_skeleton(), rig.target(joint)?)
    }

    /// The skeleton posed by its targets.
    pub fn skeleton(&self) -> &Shared<Skeleton> {
        &self.evaluated_skeleton().solved
    }

    /// Results for the rig's targets, in their order.
    pub fn targets(&self) -> &[TargetReport] {
        &self.evaluated_skeleton().targets
    }

    /// The report of a joint's target; `None` if the joint has none.
    pub fn target_report(&self, joint: JointId) -> Option<&TargetReport> {
        self.targets().get(self.document.rig.target(joint)?)
    }

    /// The skeleton posed by FK and by its targets, with a report for each target.
    pub fn evaluated_skeleton(&self) -> &EvaluatedSkeleton {
        self.skeleton.get_or_init(|| {
            let rig = &self.document.rig;
            match self.carried() {
                Some(before) => rig.step(self.time, &before).0,
                None => rig.evaluate(self.time),
            }
        })
    }

    /// The pose of the document's own motion: computes what a provisional pose has left out.
    #[must_use]
    pub fn into_known(self) -> Self {
        if self.provisional.is_none() {
            return self;
        }
        Self { provisional: None, skeleton: OnceCell::new(), ..self }
    }

    /// True if the pose continues from the motion before an edit, since its own is not known yet.
    pub fn is_provisional(&self) -> bool {
        self.provisional.is_some()
    }

    /// The state from which the skeleton's pose continues; `None` if it continues from none.
    pub fn carried(&self) -> Option<Arc<Carried>> {
        if let Some(provisional) = &self.provisional {
            return Some(provisional.clone());
        }
        self.motion.state_before(self.time).filter(|_| self.document.rig.is_tracked)
    }

    /// The skeleton as its rig at this time alone would pose it: solved from the FK pose.
    pub fn skeleton_by_itself(&self) -> &Shared<Skeleton> {
        self.by_itself.get_or_init(|| self.document.rig.skeleton_at(self.time))
    }

    /// Work of the skeleton's pose, in the unit of [`ChainSolver::bounded`]; 0 until it is read.
    pub fn work(&self) -> u64 {
        self.skeleton.get().map_or(0, EvaluatedSkeleton::work)
    }

    /// Sets the camera, on which no pose depends.
    pub fn set_camera(&mut self, camera: Camera) {
        self.document.camera = camera;
    }

    /// Sets the skin, on which no pose depends.
    pub(crate) fn set_skin(&mut self, skin: Option<Skin>) {
        self.document.rig.skin = skin;
    }
}

impl PartialEq for Posed {
    /// Compares document and time, of which the poses are a function.
    fn eq(&self, other: &Self) -> bool {
        self.time == other.time && self.document == other.document
    }
}

impl Document {
    /// Sets every keyed channel to its interpolated value at a time in seconds.
    pub(super) fn apply_keys(&mut self, time: f64) {
        let keys = self.keys.clone();
        for (channel, _) in keys.tracks() {
            if let Some(value) = keys.value(channel, time) {
                channel.set(self, value);
            }
        }
        self.apply_head_keys();
    }

    /// Gives the rig the keys of the heads that chains follow.
    fn apply_head_keys(&mut self) {
        let rig = &mut self.rig;
        rig.head_tracks.clear();
        for path in &rig.follow_paths {
            let channel = match path.kind {
                PathKind::Ring(_) => continue,
                PathKind::Head => Channel::Offset(path.root),
                PathKind::Target => Channel::Target(path.root),
            };
            let track = self.keys.shared_track(channel);
            rig.head_tracks.extend(track.map(|track| (path.root, track)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rig_is_solved_once() {
        let posed = Document::default().at(0.0);
        assert!(posed.skeleton.get().is_none());
        assert!(core::ptr::eq(posed.evaluated_skeleton(), posed.evaluated_skeleton()));
        let moved = posed.clone();
        assert!(moved.skeleton.get().is_some(), "copies are solved");
    }

    #[test]
    fn fewer_poses_are_sampled_where_each_is_much_work() {
        let indices = |count, work| coarse_to_fine(count, 1000, |index| (index, work));
        assert_eq!(indices(20, 50), (0..20).collect::<Vec<_>>());
        assert_eq!(indices(20, 51), (0..20).collect::<Vec<_>>(), "the last pose exceeds it");
        assert_eq!(indices(20, 100), (0..20).step_by(2).collect::<Vec<_>>());
        assert_eq!(indices(20, 300), [0, 8, 16]);
        assert_eq!(indices(20, 1001), [0]);
        assert_eq!(indices(0, 1), [0; 0]);
    }
}
