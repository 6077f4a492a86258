//! Motion trails.

use glam::Vec3;

use crate::document::{Channel, Document, Overlay, Posed, Track};
use crate::kinematics::skeleton::JointId;

/// The motion of a point.
#[derive(Debug, Default, PartialEq)]
pub struct Trail {
    /// Time in seconds and world position in each frame.
    pub points: Vec<(f64, Vec3)>,
    /// The same at each key of the point's joint.
    pub keys: Vec<(f64, Vec3)>,
}

impl Clone for Trail {
    fn clone(&self) -> Self {
        Self { points: self.points.clone(), keys: self.keys.clone() }
    }

    /// Reuses the memory of both lists, which the derived method would not.
    fn clone_from(&mut self, source: &Self) {
        self.points.clone_from(&source.points);
        self.keys.clone_from(&source.keys);
    }
}

impl Trail {
    /// True if a document is animated and `shown`, as it is now, has its motion trail on.
    pub(in crate::session) fn is_shown(document: &Document, shown: &Document) -> bool {
        document.is_animated() && shown.display.shows(Overlay::Trail)
    }

    /// Samples the motion of a joint's tip, or without a `joint` of the hand of a rig that is one
    /// limb: in every frame, or in fewer frames for a long timeline, a large skeleton or poses that
    /// take much work. Empty for another rig without a `joint`.
    pub(in crate::session) fn new(track: &Track, joint: Option<JointId>) -> Self {
        const MOST_POINTS: usize = 2000;
        /// Maximum of the number of joints times the number of points.
        const MOST_POSES: usize = 100_000;
        let document = track.document();
        let timeline = document.timeline;
        let hand = document.rig.sole_limb().map(|target| target.joint);
        let Some(shown) = joint.or(hand) else { return Self::default() };
        let joints = document.skeleton().joints().len();
        let most = (MOST_POSES / joints.max(1)).clamp(1, MOST_POINTS);
        let frames = timeline.frames();
        let stride = frames.div_ceil(most);
        let point = |posed: &Posed| (posed.time(), posed.skeleton().tip(shown));
        let time = |index| timeline.time(index * stride);
        let points = track.sample(frames.div_ceil(stride), time, point);
        let keys = key_times(document, joint);
        let keys = track.sample(keys.len().min(most), |index| keys[index], point);
        Self { points, keys }
    }
}

/// Times of the keys of a joint and its target, ascending and within the timeline; without a joint,
/// of all keys of the rig.
fn key_times(document: &Document, joint: Option<JointId>) -> Vec<f64> {
    let is_shown = |channel: Channel| match joint {
        Some(joint) => [channel.joint(), document.joint_of(channel)].contains(&Some(joint)),
        None => channel.is_of_rig(),
    };
    let timeline = document.timeline;
    let tracks = document.keys.tracks().filter(|(channel, _)| is_shown(*channel));
    let all = tracks.flat_map(|(_, track)| track.knots().iter().map(|knot| knot.time));
    let mut times: Vec<f64> =
        all.filter(|time| (timeline.start..=timeline.end).contains(time)).collect();
    times.sort_unstable_by(f64::total_cmp);
    times.dedup();
    times
}
