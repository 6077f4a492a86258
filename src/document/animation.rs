use glam::Vec3;

use super::channel::Channel;
use super::document::Document;
use super::rig_kind::RigKind;
use crate::kinematics::angle;
use crate::rig::{FollowPath, PathKind, SkeletonRig, Target};

/// Changes over time.
impl Document {
    /// True if a chain follows a path at any time: a ring, a target, or the keys of its head.
    pub fn follows_path(&self) -> bool {
        self.skeleton_rig.follow_paths.iter().any(|path| match path.kind {
            PathKind::Ring(_) => true,
            PathKind::Head => self.keys.has(Channel::Offset(path.root)),
            PathKind::Target => self.skeleton_rig.target(path.root).is_some(),
        })
    }

    /// True if something of the picture may change over time: there are keys, or a target or the
    /// shown skeleton moves without keys.
    pub fn is_moving(&self) -> bool {
        let moves = self.rig == RigKind::Skeleton && self.skeleton_rig.is_moving();
        moves || !self.keys.is_empty()
    }

    /// True if the pose of the shown rig changes over time.
    pub fn is_animated(&self) -> bool {
        let SkeletonRig { follow_paths, targets, .. } = &self.skeleton_rig;
        let is_ring = |path: &FollowPath| matches!(path.kind, PathKind::Ring(_));
        let moves = self.rig == RigKind::Skeleton
            && (follow_paths.iter().any(is_ring)
                || targets.iter().any(|it| it.is_moving() && self.can_pose(it)));
        moves || self.keys.tracks().any(|(channel, _)| self.poses(channel))
    }

    /// True if keys of the channel pose the shown rig.
    fn poses(&self, channel: Channel) -> bool {
        let target = channel.target().and_then(|joint| self.skeleton_rig.target(joint));
        let can_pose = target.is_none_or(|index| self.can_pose(&self.skeleton_rig.targets[index]));
        channel.rig() == Some(self.rig) && can_pose
    }

    /// True if a target poses the skeleton at some time.
    fn can_pose(&self, target: &Target) -> bool {
        let track = |channel| self.keys.track(channel);
        let is_ever = |channel, value: f32| {
            let keyed = track(channel).map(|keys| keys.knots().iter().any(|it| it.value.x > 0.0));
            keyed.unwrap_or(value > 0.0)
        };
        let Target { joint, influence, enabled, .. } = *target;
        let leads = self.skeleton_rig.leads_path(target);
        (leads || is_ever(Channel::TargetInfluence(joint), influence))
            && is_ever(Channel::Enabled(joint), f32::from(u8::from(enabled)))
    }

    /// Adds a key with the present value of a channel at a time in seconds, with an automatic
    /// curve; a key that is there keeps its curve. A twist is first unwrapped to be nearest to the
    /// value that its existing keys have at that time. The hand is first keyed where the last plant
    /// before that time begins, so that it arrives there as before. Does nothing if the channel has
    /// no value.
    pub fn key(&mut self, channel: Channel, time: f64) {
        let Some(mut value) = channel.value(self) else {
            return;
        };
        if channel == Channel::Twist
            && let Some(Vec3 { x: near, .. }) = self.keys.value(channel, time)
        {
            value.x = angle::nearest(value.x, near);
        }
        if channel == Channel::Hand {
            self.key_hand_at_plant(time);
        }
        self.keys.insert_auto(channel, time, value);
    }
}
