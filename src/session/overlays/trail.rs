use glam::Vec3;

use crate::document::{Document, Overlay, Posed, RigKind, Track};
use crate::kinematics::skeleton::JointId;

/// True if a document is animated and shows its motion trail.
pub(in crate::session) fn has_trail(document: &Document, shown: &Document) -> bool {
    document.is_animated() && shown.display.shows(Overlay::Trail)
}

/// Samples the world positions of the arm's hand, or of a joint's tip: in every frame, or in fewer
/// frames for a long timeline, a large skeleton or poses that take much work. Empty for a skeleton
/// without a `joint`.
pub(in crate::session) fn sample_trail(track: &Track, joint: Option<JointId>) -> Vec<Vec3> {
    const MOST_POINTS: usize = 2000;
    /// Maximum of the number of joints times the number of points.
    const MOST_POSES: usize = 100_000;
    let document = track.document();
    let timeline = document.timeline;
    let joints = match (document.rig, joint) {
        (RigKind::Arm, _) => 1,
        (RigKind::Skeleton, Some(_)) => document.skeleton().joints().len(),
        (RigKind::Skeleton, None) => return Vec::new(),
    };
    let frames = timeline.frames();
    let stride = frames.div_ceil((MOST_POSES / joints.max(1)).clamp(1, MOST_POINTS));
    let point = |posed: &Posed| match document.rig {
        RigKind::Arm => Some(posed.arm().root + posed.arm_pose().hand),
        RigKind::Skeleton => Some(posed.skeleton().tip(joint?)),
    };
    let time = |index| timeline.time(index * stride);
    track.sample(frames.div_ceil(stride), time, point).into_iter().flatten().collect()
}
