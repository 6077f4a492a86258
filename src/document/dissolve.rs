use glam::Vec3;

use super::channel::Channel;
use super::document::Document;
use super::keys::Keys;
use crate::kinematics::skeleton::{JointId, JointRemap, Skeleton, SkeletonError};

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
        let mut skeleton = self.skeleton_rig.skeleton.clone();
        let remap = skeleton.make_mut().dissolve(joints)?;
        after.release_targets(&remap);
        after.skeleton_rig.skeleton = skeleton;
        after.remap_joints(&remap);

        let orphans = orphans(self.skeleton(), joints);
        let rotation = |orphan: &Orphan| self.skeleton()[orphan.joint].rotation;
        let mut angles: Vec<Vec3> = orphans.iter().map(rotation).collect();
        let times = |(index, orphan): (usize, &Orphan)| {
            orphan.key_times(&self.keys).into_iter().map(move |time| (time, index))
        };
        let mut keyed: Vec<(f64, usize)> = orphans.iter().enumerate().flat_map(times).collect();
        keyed.sort_by(|a, b| a.0.total_cmp(&b.0));
        for at_time in keyed.chunk_by(|a, b| a.0 == b.0) {
            let (time, _) = at_time[0];
            let evaluated = self.evaluate(time);
            let pose = evaluated.skeleton().pose_in_skeleton();
            for (_, index) in at_time {
                let (orphan, angles) = (&orphans[*index], &mut angles[*index]);
                let Some(joint) = remap.get(orphan.joint) else { continue };
                let offset;
                (offset, *angles) = evaluated.skeleton().placed_under_in(
                    &pose,
                    orphan.joint,
                    orphan.parent,
                    *angles,
                );
                after.keys.insert(Channel::Rotation(joint), time, *angles);
                if orphan.needs_offset_keys(&self.keys) {
                    after.keys.insert(Channel::Offset(joint), time, offset);
                }
                after.skeleton_mut().change(joint, |joint| joint.widen_limits(*angles))?;
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

    /// Whether keys move the orphan's base relative to its new parent.
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
