use glam::Vec3;

use crate::document::{Channel, Document, Posed, Ray, SkeletonRig, Timeline};
use crate::kinematics::skeleton::{JointId, Skeleton};
use crate::rig::TargetSpace;

/// The seconds in which a head covers most (1 − 1/e) of its way to the mouse.
const LAG: f64 = 0.3;

/// Farthest place to which heads swim, in distances of the camera from what it looks at.
const FARTHEST: f32 = 4.0;

/// Heads that follow the mouse: a drag without a button. While time passes, the targets of the
/// heads swim after the mouse, and keys record their way, so that the tails follow it by the
/// document alone.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::session) struct FollowMouse {
    /// The mouse on the level of the heads, in world space; `None` until it is in the view.
    at: Option<Vec3>,
    heads: Vec<FollowingHead>,
    /// Time at which the recording began, in seconds.
    start: f64,
}

/// A head with its target's home.
#[derive(Clone, Copy, Debug, PartialEq)]
struct FollowingHead {
    joint: JointId,
    space: TargetSpace,
    /// The home relative to the middle of all homes, in world space.
    beside: Vec3,
}

impl FollowMouse {
    /// Label of the undo step.
    pub const LABEL: &'static str = "Follow the mouse";

    /// Lets the heads of a pose follow the mouse from its time on; `None` if targets move no heads.
    pub fn new(posed: &Posed) -> Option<Self> {
        let (rig, solved) = (&posed.document().rig, posed.skeleton());
        let leaders = rig.targets.iter().filter(|it| it.enabled && rig.leads_path(it));
        let mut heads: Vec<_> = leaders
            .filter_map(|target| {
                let beside = home_in_world(rig, solved, target.joint)?;
                Some(FollowingHead { joint: target.joint, space: target.present_space(), beside })
            })
            .collect();
        let middle = heads.iter().map(|it| it.beside).sum::<Vec3>() / heads.len().max(1) as f32;
        heads.iter_mut().for_each(|head| head.beside -= middle);
        (!heads.is_empty()).then_some(Self { at: None, heads, start: posed.time() })
    }

    /// Sets where the mouse is: the heads swim to the point of the ray on their level.
    pub fn lead(&mut self, ray: Ray, posed: &Posed) {
        let (rig, solved) = (&posed.document().rig, posed.skeleton());
        let homes = self.heads.iter().filter_map(|head| home_in_world(rig, solved, head.joint));
        let level = homes.sum::<Vec3>() / self.heads.len() as f32;
        // A ray that is nearly level meets the level at the horizon.
        let farthest = FARTHEST * posed.document().camera.distance;
        let at = ray.meets_plane(level, Vec3::Y).filter(|at| at.distance(level) <= farthest);
        self.at = at.or(self.at);
    }

    /// The document of a pose with keys of the homes at its time, `passed` seconds after `before`,
    /// nearer to the mouse. The timeline becomes longer instead of repeating.
    pub fn recorded(&self, posed: &Posed, before: f64, passed: f64) -> Document {
        let (time, solved) = (posed.time(), posed.skeleton());
        let way = (1.0 - (-passed / LAG).exp()) as f32;
        let mut after = posed.document().clone();
        for FollowingHead { joint, space, beside } in &self.heads {
            let channel = Channel::Target(*joint);
            let Some(home) = channel.value(&after) else {
                continue;
            };
            let goal = self.at.map_or(home, |at| space.point_from_world(solved, at + *beside));
            thin_out(&mut after, channel, self.start, before, time);
            after.keys.insert(channel, time, home.lerp(goal, way));
        }
        after.timeline.end = after.timeline.end.max(time.ceil()).min(Timeline::MAX_TIME);
        after
    }
}

fn home_in_world(rig: &SkeletonRig, solved: &Skeleton, joint: JointId) -> Option<Vec3> {
    let target = &rig.targets[rig.target(joint)?];
    Some(target.present_space().to_world(solved).transform_point3(target.present_home()))
}

/// Removes the keys of a channel that a recording from `before` to `time` replaces: those between,
/// and the latest recorded one if it is within a frame of the one before it.
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
