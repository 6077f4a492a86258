//! Motion of a scene.
//!
//! ```text
//! animator.frame_rate             frames per second, 30 without it
//! animator.splines.NAME           channels of the skeleton NAME, or of anything else
//!     base_offset                 Vec3
//!     bone.ID.pose                Vec3, in degrees
//!     handle.ID.target            Vec3, in the skeleton's own space
//!     handle.ID.enabled           bool
//! animator.splines.*.CHANNEL.knots    [time, value, time, value, …], times in frames
//! ```
//!
//! ID is the `channel_id` of the bone or handle. Scotty3D interpolates numbers by the Catmull–Rom
//! splines of this program, angles one by one, and switches by steps.

use std::collections::HashMap;

use glam::{DAffine3, Vec3};
use serde_json::Value;

use super::file::{Js3dAnimator, Js3dSkeleton};
use crate::document::{Channel, Document, Timeline};
use crate::io::json::FieldWarnings;
use crate::io::json::JsonPath;
use crate::io::json::{JsonObject, Whole};
use crate::kinematics::skeleton::JointId;

/// Frames per second of a scene without a rate.
const FRAME_RATE: f64 = 30.0;

/// The skeleton of a file that became that of a document.
pub struct AnimatedSkeleton<'a> {
    name: &'a str,
    base: Vec3,
    /// From the skeleton's own space to the world.
    transform: DAffine3,
    /// The joints of bones by their channel IDs.
    bones: HashMap<u32, JointId>,
    /// The joints of those handles that became targets, by their channel IDs.
    targets: HashMap<u32, JointId>,
}

impl<'a> AnimatedSkeleton<'a> {
    /// `order` has the joint of each bone, `handles` the index of the handle of each target.
    pub fn new(
        name: &'a str,
        file: &Js3dSkeleton,
        order: &[JointId],
        handles: &[usize],
        transform: DAffine3,
    ) -> Self {
        let id = |own: Option<Whole>, index: usize| own.map_or(index as u32, |own| own.0);
        let bones = file.bones.iter().zip(order).enumerate();
        let bones =
            bones.map(|(index, (JsonObject(bone), joint))| (id(bone.channel_id, index), *joint));
        let all = file.handles.as_deref().unwrap_or_default();
        let target = |index: &usize| {
            let JsonObject(handle) = all.get(*index)?;
            Some((id(handle.channel_id, *index), *order.get(handle.bone.0 as usize)?))
        };
        let (bones, targets) = (bones.collect(), handles.iter().filter_map(target).collect());
        Self { name, base: file.base.0, transform, bones, targets }
    }
}

/// Gives the document the keys of the skeleton's channels, and a timeline to their last one. Counts
/// what is left out in a warning.
pub fn add_keys(
    document: &mut Document,
    animator: &Js3dAnimator,
    skeleton: &AnimatedSkeleton<'_>,
    warnings: &mut FieldWarnings,
) {
    let rate = animator.frame_rate.as_f64().filter(|rate| Timeline::is_frame_rate(*rate));
    let frame_rate = rate.unwrap_or(FRAME_RATE);
    let mut others = 0;
    let mut end = 0.0_f64;
    for (resource, channels) in animator.splines.as_object().into_iter().flatten() {
        let channels = channels.as_object().into_iter().flatten();
        if resource != skeleton.name {
            others += channels.count();
            continue;
        }
        for (name, spline) in channels {
            let Some(channel) = skeleton.channel(name) else {
                others += 1;
                continue;
            };
            let at = at_splines().key(resource).key(name).key("knots");
            let Some(knots) = spline.get("knots").and_then(Value::as_array) else {
                warnings.push(at, "must be a list of times and values; the channel is left out");
                continue;
            };
            for (index, knot) in knots.chunks(2).enumerate() {
                let time = knot[0].as_f64().map(|frame| frame / frame_rate);
                let time = time.filter(|time| time.abs() <= Timeline::MAX_TIME);
                let value = knot.get(1).and_then(|value| channel.value(value, skeleton));
                let (Some(time), Some(value)) = (time, value) else {
                    let reason = "must be a time in frames and a value; left out";
                    warnings.push(at.clone().index(2 * index), reason);
                    continue;
                };
                channel.add_key(document, time, value);
                end = end.max(time);
            }
        }
    }
    if !document.keys.is_empty() {
        let start = document.keys.times().first().map_or(0.0, |time| time.min(0.0));
        let timeline = Timeline { start, end, frame_rate };
        let timeline = if timeline.is_valid() {
            timeline
        } else {
            Timeline { frame_rate, ..Timeline::default() }
        };
        document.timeline = timeline;
    }
    if others > 0 {
        let channels = if others == 1 {
            "1 animated channel".to_owned()
        } else {
            format!("{others} animated channels")
        };
        warnings.push(at_splines(), format!("not read: {channels}"));
    }
}

fn at_splines() -> JsonPath {
    JsonPath::root().key("animator").key("splines")
}

/// A channel of the file.
#[derive(Clone, Copy)]
enum Js3dChannel {
    BaseOffset,
    Pose(JointId),
    Target(JointId),
    Enabled(JointId),
}

impl AnimatedSkeleton<'_> {
    /// The channel of this name; `None` if the skeleton does not have it.
    fn channel(&self, name: &str) -> Option<Js3dChannel> {
        if name == "base_offset" {
            return Some(Js3dChannel::BaseOffset);
        }
        let mut parts = name.split('.');
        let (kind, id, what) = (parts.next()?, parts.next()?.parse().ok()?, parts.next()?);
        let (joint, target) = (self.bones.get(&id).copied(), self.targets.get(&id).copied());
        match (kind, what, parts.next()) {
            ("bone", "pose", None) => Some(Js3dChannel::Pose(joint?)),
            ("handle", "target", None) => Some(Js3dChannel::Target(target?)),
            ("handle", "enabled", None) => Some(Js3dChannel::Enabled(target?)),
            _ => None,
        }
    }
}

impl Js3dChannel {
    /// A value of the file as that of the document's channel.
    fn value(self, value: &Value, skeleton: &AnimatedSkeleton<'_>) -> Option<Vec3> {
        let value = match self {
            Self::Enabled(_) => Vec3::new(f32::from(u8::from(value.as_bool()?)), 0.0, 0.0),
            Self::BaseOffset => skeleton.base + point(value)?,
            Self::Pose(_) => (point(value)?.as_dvec3() * core::f64::consts::PI / 180.0).as_vec3(),
            Self::Target(_) => {
                skeleton.transform.transform_point3(point(value)?.as_dvec3()).as_vec3()
            }
        };
        value.is_finite().then_some(value)
    }

    fn add_key(self, document: &mut Document, time: f64, value: Vec3) {
        match self {
            Self::BaseOffset => {
                let roots = document.skeleton().iter().filter(|(_, joint)| joint.parent.is_none());
                let roots: Vec<JointId> = roots.map(|(joint, _)| joint).collect();
                for root in roots {
                    document.keys.insert(Channel::Offset(root), time, value);
                }
            }
            Self::Pose(joint) => document.keys.insert(Channel::Rotation(joint), time, value),
            Self::Target(joint) => document.keys.insert(Channel::Target(joint), time, value),
            Self::Enabled(joint) => document.keys.insert(Channel::Enabled(joint), time, value),
        }
    }
}

/// A point from a list of three numbers.
fn point(value: &Value) -> Option<Vec3> {
    let [x, y, z] = value.as_array()?.as_slice() else { return None };
    let number = |value: &Value| value.as_f64().map(|number| number as f32);
    Some(Vec3::new(number(x)?, number(y)?, number(z)?))
}
