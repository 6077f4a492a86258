//! The document over time: its motion, keys of its present values, and the bounds of its motion.

use glam::Vec3;

use super::Document;
use super::camera::Camera;
use super::channel::Channel;
use super::display::Overlay;
use super::track::{Posed, Track};
use crate::kinematics::angle;
use crate::kinematics::skeleton::{JointId, SkeletonPose};
use crate::kinematics::spline::Knot;
use crate::kinematics::two_bone::TwoBone;
use crate::rig::{BalanceTarget, FollowPath, LimbFrames, LimbPart, PathKind, SkeletonRig, Target};

/// Motion.
impl Document {
    /// True if a chain follows a path at any time: a ring, a target, or the keys of its head.
    pub fn follows_path(&self) -> bool {
        self.rig.follow_paths.iter().any(|path| match path.kind {
            PathKind::Ring(_) => true,
            PathKind::Head => self.keys.has(Channel::Offset(path.root)),
            PathKind::Target => self.rig.target(path.root).is_some(),
        })
    }

    /// True if something of the picture may change over time: there are keys, or a target or the
    /// skeleton moves without keys.
    pub fn is_moving(&self) -> bool {
        self.rig.is_moving() || !self.keys.is_empty()
    }

    /// True if the pose changes over time.
    pub fn is_animated(&self) -> bool {
        let SkeletonRig { follow_paths, targets, .. } = &self.rig;
        let is_ring = |path: &FollowPath| matches!(path.kind, PathKind::Ring(_));
        let moves = follow_paths.iter().any(is_ring)
            || targets.iter().any(|it| it.is_moving() && self.can_pose(it));
        moves || self.keys.tracks().any(|(channel, _)| self.poses(channel))
    }

    /// True if anything moves the skeleton or its targets over time.
    pub(super) fn moves_rig(&self) -> bool {
        self.rig.is_moving() || self.keys.tracks().any(|(channel, _)| channel.is_of_rig())
    }

    /// True if the skeleton moves, and targets pose it at some time.
    pub fn is_posed_over_time(&self) -> bool {
        let targets = &self.rig.targets;
        self.is_animated() && targets.iter().any(|target| self.can_pose(target))
    }

    /// True if poses of the skeleton depend on the ones before them: see
    /// [`SkeletonRig::is_carried`].
    pub fn is_tracked(&self) -> bool {
        let rig = &self.rig;
        let carries = |target: &Target| rig.is_carried(target) && self.can_pose(target);
        rig.is_tracked && (self.can_balance() || rig.targets.iter().any(carries))
    }

    /// True if the balance poses the skeleton at some time.
    fn can_balance(&self) -> bool {
        let has_influence = |balance: BalanceTarget| {
            self.is_ever_above_zero(Channel::BalanceInfluence, balance.influence)
        };
        self.rig.solver.method.can_balance() && self.rig.balance.is_some_and(has_influence)
    }

    /// True if keys of the channel pose the rig.
    fn poses(&self, channel: Channel) -> bool {
        let target = channel.target().and_then(|joint| self.rig.target(joint));
        let can_pose = target.is_none_or(|index| self.can_pose(&self.rig.targets[index]));
        channel.is_of_rig() && can_pose
    }

    /// True if a target poses the skeleton at some time.
    fn can_pose(&self, target: &Target) -> bool {
        let Target { joint, influence, enabled, .. } = *target;
        let leads = self.rig.leads_path(target);
        (leads || self.is_ever_above_zero(Channel::TargetInfluence(joint), influence))
            && self.is_ever_above_zero(Channel::Enabled(joint), f32::from(u8::from(enabled)))
    }

    /// True if any key of a channel is above 0, or its present value if it has no keys.
    fn is_ever_above_zero(&self, channel: Channel, present: f32) -> bool {
        match self.keys.track(channel) {
            Some(keys) => keys.knots().iter().any(|it| it.value.x > 0.0),
            None => present > 0.0,
        }
    }
}

/// Keys of the present values.
impl Document {
    /// Adds a key with the present value of a channel at a time in seconds, with an automatic
    /// curve; a key that is there keeps its curve. A twist is first unwrapped to be nearest to the
    /// value that its existing keys have at that time. A target is first keyed where its last plant
    /// before that time begins, so that it arrives there as before. Does nothing if the channel has
    /// no value.
    pub fn key(&mut self, channel: Channel, time: f64) {
        let Some(mut value) = channel.value(self) else {
            return;
        };
        if matches!(channel, Channel::TargetTwist(_))
            && let Some(Vec3 { x: near, .. }) = self.keys.value(channel, time)
        {
            value.x = angle::nearest(value.x, near);
        }
        if let Channel::Target(joint) = channel {
            self.key_target_at_plant(joint, time);
        }
        self.keys.insert_auto(channel, time, value);
    }

    /// Keys the pin or a point of a target at the start of the timeline, with its value in `former`,
    /// if it has no keys and the pin has keys or another value than in `former`. So its first key
    /// at `time`, in seconds, does not change the pose before that time.
    pub(crate) fn key_before_switch(&mut self, channel: Channel, former: &Self, time: f64) {
        let (Channel::Target(joint) | Channel::Pin(joint) | Channel::Pinned(joint)) = channel
        else {
            return;
        };
        let switch = Channel::Pinned(joint);
        let is_switched = self.keys.has(switch) || switch.value(self) != switch.value(former);
        let start = self.timeline.start;
        if is_switched && start < time && !self.keys.has(channel) {
            let value = channel.value(former).unwrap_or_default();
            self.keys.insert_auto(channel, start, value);
        }
    }

    /// Keys a target where its last plant before `time`, in seconds, begins, unless it has no keys,
    /// or one from there until `time`. So a key at `time` does not change how the target arrives.
    fn key_target_at_plant(&mut self, joint: JointId, time: f64) {
        let channel = Channel::Target(joint);
        let start = self.keys.last_plant_start(joint, time);
        let Some((start, track)) = start.zip(self.keys.track(channel)) else { return };
        let is_since = |knot: &Knot<Vec3>| (start..=time).contains(&knot.time);
        if let Some(value) = self.keys.value(channel, start)
            && !track.knots().iter().any(is_since)
        {
            self.keys.insert_auto(channel, start, value);
        }
    }
}

/// Spheres around the rig, and cameras that frame it.
impl Document {
    /// Centre and radius of a bounding sphere of the rig over the timeline, in world space. At each
    /// time it contains [`Posed::bounds`].
    ///
    /// A long motion is sampled: at most 1,000 times, or 100 if targets pose the skeleton.
    pub fn motion_bounds(&self) -> (Vec3, f32) {
        self.motion_bounds_by(Posed::limb_bounds)
    }

    /// [`Document::motion_bounds`] with the shown guides of a
    /// [measured limb](Document::measured_limb): its Outer Limit, else its target.
    pub fn motion_bounds_with_guides(&self) -> (Vec3, f32) {
        self.motion_bounds_by(|posed| Some(posed.guide_bounds(&posed.measured_frames()?)))
    }

    /// [`Document::motion_bounds`] with another sphere for a measured limb.
    pub(crate) fn motion_bounds_by(
        &self,
        limb: impl Fn(&Posed) -> Option<(Vec3, f32)>,
    ) -> (Vec3, f32) {
        around(&self.spheres_by(limb))
    }

    /// True if the rig goes farther away from where it is at the start of the timeline than three
    /// times its size.
    pub fn goes_away(&self) -> bool {
        const FAR: f32 = 3.0;
        let spheres = self.spheres_by(Posed::limb_bounds);
        let Some((start, radius)) = spheres.first().copied() else { return false };
        let size = 2.0 * radius;
        spheres.iter().any(|(centre, _)| centre.distance(start) > FAR * size)
    }

    /// Bounding spheres of the rig in world space at times of the timeline, the start first.
    fn spheres_by(&self, limb: impl Fn(&Posed) -> Option<(Vec3, f32)>) -> Vec<(Vec3, f32)> {
        let track = Track::new(self);
        let mut pose = SkeletonPose::default();
        let reach = self.rig.reach();
        let sphere_at = |time| {
            let posed = track.at(time);
            limb(&posed).unwrap_or_else(|| {
                posed.skeleton().write_pose(&mut pose);
                posed.document().rig.bounds_with_reach(reach, &pose, time)
            })
        };
        self.bounds_times().map(sphere_at).collect()
    }

    /// A camera with the default direction that frames the rig at the start of the timeline.
    #[must_use]
    pub fn camera_at_start(&self) -> Camera {
        let (centre, radius) = self.at(self.timeline.start).bounds();
        Camera::default().framing(centre, radius, 1.0)
    }

    /// The times at which [`Document::motion_bounds`] looks at the rig: frames of the timeline at
    /// even distances, with the first and the last; the start alone if nothing moves.
    fn bounds_times(&self) -> impl Iterator<Item = f64> + use<> {
        const MOST: usize = 1000;
        const MOST_SOLVED: usize = 100;
        let is_solved = self.rig.targets.iter().any(Target::is_posing);
        let most = if is_solved { MOST_SOLVED } else { MOST };
        let timeline = self.timeline;
        let last = if self.is_moving() { timeline.frames() - 1 } else { 0 };
        let step = last.div_ceil(most - 1).max(1);
        (0..last).step_by(step).chain([last]).map(move |frame| timeline.time(frame))
    }

    /// A camera with the default direction that frames the rig over the timeline. A still arm with
    /// the default lengths is seen by the default camera.
    #[must_use]
    pub fn framing_camera(&self) -> Camera {
        let is_default = self.measured_limb().is_some_and(|target| {
            let lower = &self.rig.skeleton[target.joint];
            let lengths = [lower.offset, lower.axis].map(Vec3::length);
            TwoBone::new(lengths[0], lengths[1]) == Ok(TwoBone::default())
        });
        if is_default && !self.is_moving() {
            return Camera::default();
        }
        let (centre, radius) = self.motion_bounds();
        Camera::default().framing(centre, radius, 1.0)
    }
}

impl Posed {
    /// Centre and radius of a bounding sphere of the rig, in the world.
    pub fn bounds(&self) -> (Vec3, f32) {
        let rig = &self.document().rig;
        self.limb_bounds().unwrap_or_else(|| rig.bounds(&self.skeleton().pose(), self.time()))
    }

    /// [`Posed::bounds`] of a [measured limb](Document::measured_limb): around its base, elbow and
    /// hand. The radius is at least half the limb's length.
    fn limb_bounds(&self) -> Option<(Vec3, f32)> {
        self.measured_frames().map(|limb| bounds_of_limb(&limb))
    }

    /// A sphere around a limb and its Outer Limit if that is shown, otherwise its target if that is
    /// shown.
    fn guide_bounds(&self, limb: &LimbFrames) -> (Vec3, f32) {
        let (centre, radius) = bounds_of_limb(limb);
        let display = self.document().display;
        let root = limb.origin(LimbPart::Root);
        if display.shows(Overlay::OuterLimit) {
            (root, limb.limits.outer.max(root.distance(centre) + radius))
        } else if display.shows(Overlay::Cursor) {
            let cursor = limb.origin(LimbPart::Cursor);
            let excess = (centre.distance(cursor) - radius).max(0.0);
            (centre.move_towards(cursor, excess / 2.0), radius + excess / 2.0)
        } else {
            (centre, radius)
        }
    }

    /// The [measured limb](Document::measured_limb) in its frames.
    pub(crate) fn measured_frames(&self) -> Option<LimbFrames> {
        self.limb_frames(self.document().measured_limb()?.joint)
    }
}

fn bounds_of_limb(limb: &LimbFrames) -> (Vec3, f32) {
    let points = [Vec3::ZERO, limb.pose().elbow, limb.pose().hand];
    let low = points.into_iter().fold(Vec3::MAX, Vec3::min);
    let high = points.into_iter().fold(Vec3::MIN, Vec3::max);
    let centre = low * 0.5 + high * 0.5;
    let reach = points.into_iter().map(|point| point.distance(centre)).fold(0.0, f32::max);
    let radius = reach.max(limb.bones().outer_limit() * 0.5).min(f32::MAX);
    (limb.in_world(centre), radius)
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
