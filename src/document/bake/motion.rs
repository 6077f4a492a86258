use glam::{Affine3A, Mat3A, Vec3};

use crate::document::{Channel, Posed, Timeline, Track};
use crate::kinematics::skeleton::{JointId, Skeleton};
use crate::kinematics::spline::Spline;

/// Rotation and offset of a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Placement {
    /// Euler angles in radians.
    pub rotation: Vec3,
    pub offset: Vec3,
}

/// Base and tip of a joint, in skeleton space.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ends {
    pub base: Vec3,
    pub tip: Vec3,
}

/// A skeleton at every frame of a range. Lists have the joints of the first frame, then those of
/// the second, and so on.
pub(super) struct Motion {
    /// The skeleton at the first frame, not posed by its targets.
    pub skeleton: Skeleton,
    /// Reach of the rig at the first frame, in the world.
    pub reach: f32,
    /// Placements by keys and angles alone.
    pub keyed: Vec<Placement>,
    /// Evaluated placements.
    pub solved: Vec<Placement>,
    /// Evaluated bases, and tips of bones of their own length.
    pub ends: Vec<Ends>,
    /// Largest distance in the world between each joint's evaluated tip and that in `ends`.
    lengthened: Vec<f32>,
    /// Channels of the influences of targets and of the balance that pose the skeleton at any frame.
    pub influences: Vec<Channel>,
    follows_path: bool,
}

/// A bone that cannot keep the length that a target gives it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShortenedBone {
    /// The bone's joint.
    pub joint: JointId,
    /// Largest distance of its tip from the evaluated position at a frame, in the world.
    pub error: f32,
}

impl Motion {
    /// Records a track at all frames. `go_on` is called before each with its number.
    pub async fn record<E>(
        track: &Track,
        frames: &Timeline,
        go_on: &mut impl AsyncFnMut(usize) -> Result<(), E>,
    ) -> Result<Self, E> {
        let first = track.at(frames.start);
        let rig = &first.document().rig;
        let joints = rig.skeleton.joints().len();
        let mut motion = Self {
            skeleton: Skeleton::clone(&rig.skeleton),
            reach: rig.reach(),
            keyed: Vec::with_capacity(frames.frames() * joints),
            solved: Vec::with_capacity(frames.frames() * joints),
            ends: Vec::with_capacity(frames.frames() * joints),
            lengthened: vec![0.0; joints],
            influences: Vec::new(),
            follows_path: track.document().follows_path(),
        };
        for frame in 0..frames.frames() {
            go_on(frame).await?;
            motion.add(&track.at(frames.time(frame)));
        }
        Ok(motion)
    }

    /// Appends a frame.
    fn add(&mut self, posed: &Posed) {
        let (rig, solved) = (&posed.document().rig, posed.skeleton());
        self.keyed.extend(placements(&rig.skeleton));
        self.solved.extend(placements(solved));
        let pose = solved.pose_in_skeleton();
        for (joint, own) in rig.skeleton.iter() {
            let full = pose.full(joint);
            let tip = full.transform_point3(own.axis);
            self.ends.push(Ends { base: pose.base(joint), tip });
            let lost = rig.skeleton.transform().matrix3 * (pose.tip(joint) - tip);
            let most = &mut self.lengthened[joint.index()];
            *most = most.max(lost.length());
        }
        let posing = rig.targets.iter().filter(|target| target.is_posing());
        let of_targets = posing.map(|target| Channel::TargetInfluence(target.joint));
        let of_balance = rig.active_balance().map(|_| Channel::BalanceInfluence);
        for channel in of_targets.chain(of_balance) {
            if !self.influences.contains(&channel) {
                self.influences.push(channel);
            }
        }
    }

    /// True if anything but keys and angles poses the skeleton.
    pub fn is_posed(&self) -> bool {
        self.follows_path || !self.influences.is_empty()
    }

    /// Bones that evaluation lengthens.
    pub fn shortened(&self) -> Vec<ShortenedBone> {
        let bones = self.skeleton.ids().zip(self.lengthened.iter().copied());
        let bones = bones.filter(|(_, error)| *error > 0.0);
        bones.map(|(joint, error)| ShortenedBone { joint, error }).collect()
    }

    /// Linear part of the transform from skeleton space to the world, the same at all frames.
    pub fn to_world(&self) -> Mat3A {
        self.skeleton.transform().matrix3
    }

    /// Tracks with a key at every frame, for the rotations and offsets that keys and angles alone
    /// do not give.
    pub fn tracks(&self, track: &Track, frames: &BakedFrames) -> Vec<BakedTrack> {
        let mut tracks = Vec::new();
        for joint in self.skeleton.ids() {
            let both = || self.of_joint(&self.keyed, joint).zip(self.of_joint(&self.solved, joint));
            let mut add = |channel, values: Vec<Vec3>| {
                let mut spline = frames.surroundings(track, channel);
                for (frame, value) in values.into_iter().enumerate() {
                    spline.insert(frames.time(frame), value);
                }
                let frames = (0..frames.count()).collect();
                tracks.push(BakedTrack { channel, joint, spline, frames });
            };
            if both().any(|(keyed, solved)| keyed.rotation != solved.rotation) {
                add(Channel::Rotation(joint), self.unwrapped(joint).collect());
            }
            if both().any(|(keyed, solved)| keyed.offset != solved.offset) {
                let solved = self.of_joint(&self.solved, joint);
                add(Channel::Offset(joint), solved.map(|placement| placement.offset).collect());
            }
        }
        tracks
    }

    /// The evaluated angles of a joint at all frames, each nearest to those at the frame before.
    fn unwrapped(&self, joint: JointId) -> impl Iterator<Item = Vec3> + '_ {
        let own = &self.skeleton[joint];
        self.of_joint(&self.solved, joint).scan(None, move |last, placement| {
            let near = last.unwrap_or(placement.rotation);
            Some(*last.insert(own.equivalent_angles(placement.rotation, near)))
        })
    }

    fn of_joint<'a>(
        &self,
        placements: &'a [Placement],
        joint: JointId,
    ) -> impl Iterator<Item = Placement> + 'a + use<'a> {
        placements.iter().skip(joint.index()).step_by(self.skeleton.joints().len()).copied()
    }
}

impl Placement {
    /// Transform of a joint to its parent's space.
    pub fn local(self, skeleton: &Skeleton, joint: JointId) -> Affine3A {
        Affine3A {
            matrix3: skeleton[joint].rotation_by(self.rotation),
            translation: self.offset.into(),
        }
    }
}

fn placements(skeleton: &Skeleton) -> impl Iterator<Item = Placement> + '_ {
    skeleton.iter().map(|(_, joint)| Placement { rotation: joint.rotation, offset: joint.offset })
}

/// Keys of a baked channel.
#[derive(Clone, Debug)]
pub(super) struct BakedTrack {
    /// [`Channel::Rotation`] or [`Channel::Offset`].
    pub channel: Channel,
    pub joint: JointId,
    /// All keys, those outside the range too.
    pub spline: Spline<Vec3>,
    /// The frames that have a key, ascending.
    pub frames: Vec<usize>,
}

/// The frames of a bake, and what is kept of the keys around them.
#[derive(Clone, Copy, Debug)]
pub(super) struct BakedFrames {
    timeline: Timeline,
    /// True if the document's timeline starts before the range.
    starts_late: bool,
    /// True if the document's timeline ends after the range.
    ends_early: bool,
}

impl BakedFrames {
    pub fn new(own: Timeline, timeline: Timeline) -> Self {
        let last = timeline.time(timeline.frames() - 1);
        Self { timeline, starts_late: own.start < timeline.start, ends_early: last < own.end }
    }

    pub fn count(&self) -> usize {
        self.timeline.frames()
    }

    /// Time of a frame in seconds.
    pub fn time(&self, frame: usize) -> f64 {
        self.timeline.time(frame)
    }

    /// The frames between two times, both excluded. Infinite times are allowed.
    pub fn between(&self, from: f64, to: f64) -> core::ops::Range<usize> {
        let position = |time: f64| (time - self.timeline.start) * self.timeline.frame_rate;
        // Conversion saturates. Frames next to the bounds may be included by rounding; their values
        // do not change.
        let first = position(from).floor() as usize;
        let last = position(to).ceil() as usize;
        first..last.saturating_add(1).min(self.count())
    }

    /// The keys of a channel outside the range. Where the document's timeline goes on beyond the
    /// range, the two frames beyond it have keys too, which keep the channel as it was there: two,
    /// because a key shapes the curve up to the second key away from it.
    pub fn surroundings(&self, track: &Track, channel: Channel) -> Spline<Vec3> {
        let (start, end) = (self.time(0), self.time(self.count() - 1));
        let is_outside = |time: f64| time < start || time > end;
        let knots = track.document().keys.track(channel).into_iter().flat_map(Spline::knots);
        let mut spline: Spline<Vec3> =
            knots.filter(|knot| is_outside(knot.time)).copied().collect();
        let frame = 1.0 / self.timeline.frame_rate;
        let before = [start - 2.0 * frame, start - frame].map(|time| (self.starts_late, time));
        let after = [end + frame, end + 2.0 * frame].map(|time| (self.ends_early, time));
        for (_, time) in before.into_iter().chain(after).filter(|(is_open, _)| *is_open) {
            if let Some(value) = channel.value(track.at(time).document()) {
                spline.insert(time, value);
            }
        }
        spline
    }
}
