use glam::Vec3;

use super::Document;
use super::channel::Channel;
use super::keys::Keys;
use super::track::Track;
use crate::kinematics::skeleton::{JointId, JointRemap, Skeleton, SkeletonError};
use crate::kinematics::spline::{Interpolation, Knot, Spline};

/// A joint that stays while its parent is dissolved.
struct Orphan {
    joint: JointId,
    /// New parent of the joint; `None` if the joint becomes a root.
    parent: Option<JointId>,
    /// Dissolved joints between the joint and its new parent, the former parent first.
    dissolved: Vec<JointId>,
}

impl Document {
    /// Dissolves joints: deletes them and reparents their children to the nearest ancestor that is
    /// left. A child without one becomes a root. The children keep their positions in the world,
    /// now and at the time of every key of their own or of a dissolved joint above them. Limits
    /// that exclude a child's new angles are widened.
    ///
    /// # Errors
    ///
    /// [`SkeletonError::NoJoint`]; [`SkeletonError::NotFinite`] if a child's new offset or angles
    /// overflow.
    pub fn dissolve(&mut self, joints: &[JointId]) -> Result<JointRemap, SkeletonError> {
        let mut after = self.clone();
        let mut skeleton = self.rig.skeleton.clone();
        let remap = skeleton.make_mut().dissolve(joints)?;
        after.release_targets(&remap);
        after.rig.skeleton = skeleton;
        after.remap_joints(&remap);

        let orphans = orphans(self.skeleton(), joints);
        let rotation = |orphan: &Orphan| self.skeleton()[orphan.joint].rotation;
        let mut angles: Vec<Vec3> = orphans.iter().map(rotation).collect();
        let times = |(index, orphan): (usize, &Orphan)| {
            orphan.key_times(&self.keys).into_iter().map(move |time| (time, index))
        };
        let mut key_times: Vec<(f64, usize)> = orphans.iter().enumerate().flat_map(times).collect();
        key_times.sort_by(|a, b| a.0.total_cmp(&b.0));
        let track = Track::new(self);
        for at_time in key_times.chunk_by(|a, b| a.0 == b.0) {
            let (time, _) = at_time[0];
            let keyed = track.at(time).into_document();
            let pose = keyed.skeleton().pose_in_skeleton();
            for (_, index) in at_time {
                let (orphan, angles) = (&orphans[*index], &mut angles[*index]);
                let Some(joint) = remap.get(orphan.joint) else { continue };
                let offset;
                (offset, *angles) =
                    keyed.skeleton().placed_under_in(&pose, orphan.joint, orphan.parent, *angles);
                let mut key = |channel: fn(JointId) -> Channel, value| {
                    let key = orphan.key(&self.keys, channel, time);
                    after.keys.insert_key(channel(joint), Knot { time, value, ..key });
                };
                key(Channel::Rotation, *angles);
                if orphan.needs_offset_keys(&self.keys) {
                    key(Channel::Offset, offset);
                }
                after.skeleton_mut().change(joint, |joint| joint.limits.widen(*angles))?;
            }
        }
        *self = after;
        Ok(remap)
    }
}

impl Orphan {
    /// Rotation and offset channels of the dissolved joints above the orphan.
    fn channels_above(&self) -> impl Iterator<Item = Channel> + '_ {
        let both = |joint: &JointId| [Channel::Rotation(*joint), Channel::Offset(*joint)];
        self.dissolved.iter().flat_map(both)
    }

    /// Times of all keys that move the orphan relative to its new parent, ascending and without
    /// duplicates.
    fn key_times(&self, keys: &Keys) -> Vec<f64> {
        let own = [Channel::Rotation(self.joint), Channel::Offset(self.joint)];
        let mut times: Vec<f64> = self
            .channels_above()
            .chain(own)
            .filter_map(|channel| keys.track(channel))
            .flat_map(|track| track.knots().iter().map(|knot| knot.time))
            .collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        times
    }

    /// The orphan's own key at a time; or else a key with the curve that is in force there, of the
    /// orphan or of the nearest dissolved joint with keys.
    fn key(&self, keys: &Keys, channel: fn(JointId) -> Channel, time: f64) -> Knot<Vec3> {
        let joints = [self.joint].into_iter().chain(self.dissolved.iter().copied());
        let mut tracks = joints.filter_map(|joint| keys.track(channel(joint)));
        let before = |track: &Spline<Vec3>| {
            let after = track.knots().partition_point(|knot| knot.time <= time);
            track.knots().get(after.saturating_sub(1)).map(|knot| knot.interpolation)
        };
        keys.key(channel(self.joint), time).unwrap_or_else(|| {
            let interpolation = tracks.find_map(before).unwrap_or(Interpolation::Auto);
            Knot { interpolation, ..Knot::new(time, Vec3::ZERO) }
        })
    }

    /// True if keys move the orphan's base relative to its new parent.
    fn needs_offset_keys(&self, keys: &Keys) -> bool {
        self.channels_above().any(|channel| keys.has(channel))
            || keys.has(Channel::Offset(self.joint))
    }
}

fn orphans(skeleton: &Skeleton, dissolved: &[JointId]) -> Vec<Orphan> {
    let orphan = |joint: JointId| {
        let mut above = skeleton.ancestors(joint).skip(1).peekable();
        let mut between = Vec::new();
        while let Some(joint) = above.next_if(|joint| dissolved.contains(joint)) {
            between.push(joint);
        }
        let is_orphan = !between.is_empty() && !dissolved.contains(&joint);
        is_orphan.then(|| Orphan { joint, parent: above.next(), dissolved: between })
    };
    skeleton.ids().filter_map(orphan).collect()
}
