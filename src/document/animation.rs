//! The document over time: its motion, keys of its present values, and the bounds of its motion.

use glam::Vec3;

use super::Document;
use super::arm::Arm;
use super::camera::Camera;
use super::channel::Channel;
use super::display::RigKind;
use super::track::{Posed, Track};
use crate::kinematics::angle;
use crate::kinematics::skeleton::SkeletonPose;
use crate::kinematics::spline::Knot;
use crate::rig::{FollowPath, PathKind, SkeletonRig, Target};

/// Motion.
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

    /// True if anything moves the skeleton or its targets over time, also while the arm is shown.
    pub(super) fn moves_skeleton(&self) -> bool {
        let is_of_skeleton = |channel: Channel| channel.rig() == Some(RigKind::Skeleton);
        self.skeleton_rig.is_moving() || self.keys.tracks().any(|(it, _)| is_of_skeleton(it))
    }

    /// True if the skeleton moves, and targets pose it at some time.
    pub fn is_posed_over_time(&self) -> bool {
        let targets = &self.skeleton_rig.targets;
        self.is_animated() && targets.iter().any(|target| self.can_pose(target))
    }

    /// True if poses of the skeleton depend on the ones before them: see
    /// [`SkeletonRig::is_carried`].
    pub fn is_tracked(&self) -> bool {
        let rig = &self.skeleton_rig;
        rig.is_tracked && rig.targets.iter().any(|it| rig.is_carried(it) && self.can_pose(it))
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
}

/// Keys of the present values.
impl Document {
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

    /// Keys the pin or a point of the Cursor at the start of the timeline, with its value in
    /// `former`, if it has no keys and the pin has keys or another value than in `former`. So its
    /// first key at `time`, in seconds, does not change the arm before that time.
    pub(crate) fn key_before_switch(&mut self, channel: Channel, former: &Self, time: f64) {
        let is_switched =
            self.keys.has(Channel::Pinned) || self.arm.is_pinned() != former.arm.is_pinned();
        let is_of_pin = matches!(channel, Channel::Hand | Channel::Pin | Channel::Pinned);
        let start = self.timeline.start;
        if is_of_pin && is_switched && start < time && !self.keys.has(channel) {
            let value = channel.value(former).unwrap_or_default();
            self.keys.insert_auto(channel, start, value);
        }
    }

    /// Keys the hand where the last plant before `time`, in seconds, begins, unless it has no keys,
    /// or one from there until `time`. So a key at `time` does not change how the hand arrives.
    fn key_hand_at_plant(&mut self, time: f64) {
        let start = self.keys.last_plant_start(time);
        let Some((start, hand)) = start.zip(self.keys.track(Channel::Hand)) else { return };
        let is_since = |knot: &Knot<Vec3>| (start..=time).contains(&knot.time);
        if let Some(value) = self.keys.value(Channel::Hand, start)
            && !hand.knots().iter().any(is_since)
        {
            self.keys.insert_auto(Channel::Hand, start, value);
        }
    }
}

/// Spheres around the shown rig, and cameras that frame it.
impl Document {
    /// Centre and radius of a bounding sphere of the shown rig over the timeline, in world space.
    /// At each time it contains [`SkeletonRig::bounds`](super::SkeletonRig::bounds) or
    /// [`Arm::bounds`].
    ///
    /// A long motion is sampled: at most 1,000 times, or 100 if targets pose the skeleton.
    pub fn motion_bounds(&self) -> (Vec3, f32) {
        self.motion_bounds_by(|posed| posed.arm().bounds(posed.arm_pose()))
    }

    /// [`Document::motion_bounds`] with another sphere for the posed arm.
    pub(crate) fn motion_bounds_by(&self, arm: impl Fn(&Posed) -> (Vec3, f32)) -> (Vec3, f32) {
        let track = Track::new(self);
        let mut pose = SkeletonPose::default();
        let reach = self.skeleton_rig.reach();
        let sphere_at = |time| {
            let posed = track.at(time);
            match self.rig {
                RigKind::Arm => arm(&posed),
                RigKind::Skeleton => {
                    posed.skeleton().write_pose(&mut pose);
                    posed.document().skeleton_rig.bounds_with_reach(reach, &pose, time)
                }
            }
        };
        around(&self.bounds_times().map(sphere_at).collect::<Vec<_>>())
    }

    /// The times at which [`Document::motion_bounds`] looks at the rig: frames of the timeline at
    /// even distances, with the first and the last; the start alone if nothing moves.
    fn bounds_times(&self) -> impl Iterator<Item = f64> + use<> {
        const MOST: usize = 1000;
        const MOST_SOLVED: usize = 100;
        let is_solved = self.rig == RigKind::Skeleton
            && self.skeleton_rig.targets.iter().any(Target::is_posing);
        let most = if is_solved { MOST_SOLVED } else { MOST };
        let timeline = self.timeline;
        let last = if self.is_moving() { timeline.frames() - 1 } else { 0 };
        let step = last.div_ceil(most - 1).max(1);
        (0..last).step_by(step).chain([last]).map(move |frame| timeline.time(frame))
    }

    /// A camera with the default direction that frames the shown rig over the timeline. A still arm
    /// with the default lengths is seen by the default camera.
    #[must_use]
    pub fn framing_camera(&self) -> Camera {
        let is_default = self.rig == RigKind::Arm && self.arm.bones == Arm::default().bones;
        if is_default && !self.is_moving() {
            return Camera::default();
        }
        let (centre, radius) = self.motion_bounds();
        Camera::default().framing(centre, radius, 1.0)
    }
}

/// Centre and radius of a sphere that contains `spheres`: around the middle of the box around their
/// centres.
fn around(spheres: &[(Vec3, f32)]) -> (Vec3, f32) {
    let centres = || spheres.iter().map(|(centre, _)| *centre);
    let Some(low) = centres().reduce(Vec3::min) else { return Default::default() };
    let high = centres().fold(low, Vec3::max);
    // Halved first, so that the sum does not overflow.
    let middle = low * 0.5 + high * 0.5;
    let farthest = |(centre, radius): &(Vec3, f32)| centre.distance(middle) + radius;
    (middle, spheres.iter().map(farthest).fold(0.0, f32::max).min(f32::MAX))
}
