use glam::{Affine3A, Mat3A, Vec3};

use super::baked_track::{BakedFrames, BakedTrack};
use super::outcome::{BakeError, ShortenedBone};
use crate::document::{Channel, Posed, Timeline, Track};
use crate::kinematics::skeleton::{JointId, Skeleton};
use crate::rig::Target;

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
    /// Joints of the targets that pose the skeleton at any frame.
    posed: Vec<JointId>,
    follows_path: bool,
}

impl Motion {
    /// Records a track at all frames. `go_on` is called before each with its number.
    pub fn record(
        track: &Track,
        frames: &Timeline,
        go_on: &mut impl FnMut(usize) -> Result<(), BakeError>,
    ) -> Result<Self, BakeError> {
        let first = track.at(frames.start);
        let rig = &first.document().skeleton_rig;
        let joints = rig.skeleton.joints().len();
        let mut motion = Self {
            skeleton: Skeleton::clone(&rig.skeleton),
            reach: rig.reach(),
            keyed: Vec::with_capacity(frames.frames() * joints),
            solved: Vec::with_capacity(frames.frames() * joints),
            ends: Vec::with_capacity(frames.frames() * joints),
            lengthened: vec![0.0; joints],
            posed: Vec::new(),
            follows_path: track.document().follows_path(),
        };
        for frame in 0..frames.frames() {
            go_on(frame)?;
            motion.add(&track.at(frames.time(frame)));
        }
        Ok(motion)
    }

    /// Appends a frame.
    fn add(&mut self, posed: &Posed) {
        let (rig, solved) = (&posed.document().skeleton_rig, posed.skeleton());
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
        for Target { joint, .. } in posing {
            if !self.posed.contains(joint) {
                self.posed.push(*joint);
            }
        }
    }

    /// True if anything but keys and angles poses the skeleton.
    pub fn is_posed(&self) -> bool {
        self.follows_path || !self.posed.is_empty()
    }

    /// Joints of the targets that pose the skeleton at any frame.
    pub fn posed_targets(&self) -> impl Iterator<Item = JointId> + '_ {
        self.posed.iter().copied()
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
            if both().any(|(keyed, solved)| keyed.rotation != solved.rotation) {
                let values = self.unwrapped(joint);
                tracks.push(baked_track(track, frames, Channel::Rotation(joint), joint, values));
            }
            if both().any(|(keyed, solved)| keyed.offset != solved.offset) {
                let values = self.of_joint(&self.solved, joint).map(|placement| placement.offset);
                tracks.push(baked_track(track, frames, Channel::Offset(joint), joint, values));
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

fn baked_track(
    track: &Track,
    frames: &BakedFrames,
    channel: Channel,
    joint: JointId,
    values: impl Iterator<Item = Vec3>,
) -> BakedTrack {
    let mut spline = frames.surroundings(track, channel);
    for (frame, value) in values.enumerate() {
        spline.insert(frames.time(frame), value);
    }
    BakedTrack { channel, joint, spline, frames: (0..frames.count()).collect() }
}
