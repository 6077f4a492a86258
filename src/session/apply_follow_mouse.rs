use glam::Vec3;

use super::follow_mouse::{FollowMouse, FollowingHead};
use super::session::Session;
use crate::document::{Channel, Document, Ray, RigKind, Timeline};
use crate::kinematics::skeleton::JointId;

/// The seconds in which a head covers most (1 − 1/e) of its way to the mouse.
const LAG: f64 = 0.3;

/// Farthest place to which heads swim, in distances of the camera from what it looks at.
const FARTHEST: f32 = 4.0;

/// Heads that follow the mouse.
impl Session {
    /// Whether targets move heads, which can follow the mouse.
    pub fn can_follow_mouse(&self) -> bool {
        let is_shown = self.rig() == RigKind::Skeleton && self.crowd().is_none();
        is_shown && !self.following_heads().is_empty()
    }

    /// Whether heads follow the mouse.
    pub fn follows_mouse(&self) -> bool {
        self.follow_mouse.is_some()
    }

    /// Opens a transaction in which the heads follow the mouse, and plays; or commits it.
    pub(super) fn follow_mouse(&mut self, follows: bool) {
        if !follows && self.follows_mouse() {
            return self.commit_edit();
        }
        if !follows || self.is_editing() || !self.can_follow_mouse() {
            return;
        }
        self.begin_edit(None);
        self.editing.label_transaction("Follow the mouse");
        let (heads, start) = (self.following_heads(), self.time());
        self.follow_mouse = Some(FollowMouse { at: None, heads, start });
        self.record_heads(start, 0.0);
        self.play(true);
        self.say("Move the mouse over the view; a click ends it, Esc undoes it");
    }

    /// Sets where the mouse is: the heads swim to the point of the ray on their level.
    pub(super) fn lead_heads(&mut self, ray: Ray) {
        let Some(level) = self.head_level() else { return };
        // A ray that is nearly level meets the level at the horizon.
        let farthest = FARTHEST * self.camera().distance;
        let at = ray.meets_plane(level, Vec3::Y).filter(|at| at.distance(level) <= farthest);
        if let Some(follow) = &mut self.follow_mouse {
            follow.at = at.or(follow.at);
        }
    }

    /// Plays on while heads follow the mouse: the timeline becomes longer instead of repeating. A dialog
    /// ends it.
    pub(super) fn advance_following(&mut self, passed: f64) {
        if self.dialog().is_some() {
            return self.commit_edit();
        }
        let before = self.time();
        let time = (before + passed * self.speed()).min(Timeline::MAX_TIME);
        self.set_time(time);
        self.record_heads(before, time - before);
    }

    /// Middle of the homes, in world space.
    fn head_level(&self) -> Option<Vec3> {
        let heads = &self.follow_mouse.as_ref()?.heads;
        let homes = heads.iter().filter_map(|head| self.home_in_world(head.joint));
        Some(homes.sum::<Vec3>() / heads.len() as f32)
    }

    fn home_in_world(&self, joint: JointId) -> Option<Vec3> {
        let rig = self.skeleton_rig();
        let target = &rig.targets[rig.target(joint)?];
        let to_world = target.space.to_world(&self.evaluated_skeleton().solved);
        Some(to_world.transform_point3(target.home))
    }

    fn following_heads(&self) -> Vec<FollowingHead> {
        let rig = self.skeleton_rig();
        let leaders = rig.targets.iter().filter(|it| it.enabled && rig.leads_path(it));
        let mut heads: Vec<_> = leaders
            .filter_map(|target| {
                let beside = self.home_in_world(target.joint)?;
                Some(FollowingHead { joint: target.joint, space: target.space, beside })
            })
            .collect();
        let middle = heads.iter().map(|it| it.beside).sum::<Vec3>() / heads.len().max(1) as f32;
        heads.iter_mut().for_each(|head| head.beside -= middle);
        heads
    }

    /// Keys the homes at the playhead, `passed` seconds after `before`, nearer to the mouse.
    fn record_heads(&mut self, before: f64, passed: f64) {
        let Some(FollowMouse { at, heads, start }) = self.follow_mouse.clone() else { return };
        let time = self.time();
        let way = (1.0 - (-passed / LAG).exp()) as f32;
        let mut after = self.shown().clone();
        for FollowingHead { joint, space, beside } in heads {
            let channel = Channel::Target(joint);
            let Some(home) = channel.value(&after) else { continue };
            let pose = &self.evaluated_skeleton().solved;
            let goal = at.map_or(home, |at| space.point_from_world(pose, at + beside));
            thin_out(&mut after, channel, start, before, time);
            after.keys.insert(channel, time, home.lerp(goal, way));
        }
        after.timeline.end = after.timeline.end.max(time.ceil()).min(Timeline::MAX_TIME);
        self.commit(after);
        // The user sees keys being set.
        self.playback.has_auto_keyed();
    }
}

/// Removes the keys of a channel that a recording from `before` to `time` replaces: those between, and
/// the latest recorded one if it is within a frame of the one before it.
fn thin_out(document: &mut Document, channel: Channel, start: f64, before: f64, time: f64) {
    let frame = 1.0 / document.timeline.frame_rate;
    let knots = document.keys.track(channel).map_or(&[][..], |track| track.knots());
    let times: Vec<f64> = knots.iter().map(|knot| knot.time).collect();
    let until = times.partition_point(|key| *key <= before);
    let is_dense = |key: &f64| *key > start && until >= 2 && key - times[until - 2] < 0.999 * frame;
    let latest = times[..until].last().copied().filter(is_dense);
    let between = times[until..].iter().copied().take_while(|key| *key < time);
    let replaced: Vec<_> = latest.into_iter().chain(between).map(|key| (channel, key)).collect();
    document.keys.remove_all(&replaced);
}
