use glam::Vec3;

use crate::document::{Document, Overlay, RigKind};
use crate::kinematics::skeleton::JointId;

/// Whether a document has a trail to show.
pub(super) fn has_trail(document: &Document, shown: &Document) -> bool {
    document.is_animated() && shown.display.shows(Overlay::Trail)
}

/// Where the hand, or a joint's tip, is at every frame; of a long motion not every frame.
pub(super) fn walk(document: &Document, joint: Option<JointId>) -> Vec<Vec3> {
    const MOST_POINTS: usize = 2000;
    /// Joints times points: what a large skeleton may cost.
    const MOST_POSES: usize = 100_000;
    let timeline = document.timeline;
    let joints = match (document.rig, joint) {
        (RigKind::Arm, _) => 1,
        (RigKind::Skeleton, Some(_)) => document.skeleton().joints().len(),
        (RigKind::Skeleton, None) => return Vec::new(),
    };
    let frames = timeline.frames();
    let stride = frames.div_ceil((MOST_POSES / joints.max(1)).clamp(1, MOST_POINTS));
    let mut posed = document.clone();
    let point = |frame| {
        let time = timeline.time(frame);
        posed.apply_keys(time);
        match document.rig {
            RigKind::Arm => Some(posed.arm.root + posed.arm.pose().hand),
            RigKind::Skeleton => Some(posed.skeleton_rig.skeleton_at(time).tip(joint?)),
        }
    };
    (0..frames).step_by(stride).filter_map(point).collect()
}
