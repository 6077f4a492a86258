use glam::Vec3;

use crate::document::{PathKind, SkeletonRig};
use crate::kinematics::skeleton::{Joint, JointId};
use crate::session::outcome::Outcome;
use crate::session::session::Session;

/// A change of the path that a chain follows.
#[derive(Clone, Debug, PartialEq)]
pub enum PathEdit {
    /// Sets the path that the chain of a root follows; `None` for no path.
    SetFollowPath {
        /// The root.
        root: JointId,
        /// What moves it.
        kind: Option<PathKind>,
    },
    /// Moves a root to a point of skeleton space. With
    /// [`PathKind::Head`](crate::document::PathKind::Head), the chain below it follows.
    SetHead {
        /// The root.
        root: JointId,
        /// Its new place.
        to: Vec3,
    },
}

impl PathEdit {
    /// Label of the edit's undo step.
    pub fn label(&self) -> &'static str {
        match self {
            Self::SetFollowPath { .. } => "Change path",
            Self::SetHead { .. } => "Move head",
        }
    }

    pub(in crate::session) fn apply(self, session: &Session) -> Outcome {
        let rig = session.skeleton_rig();
        match self {
            Self::SetFollowPath { root, .. } if rig.root_of(root) != Some(root) => {
                Outcome::fail(format!("The joint of a path must be a root, got joint {root}"))
            }
            Self::SetFollowPath { root, kind } if kind.as_ref().is_none_or(PathKind::is_valid) => {
                Outcome::edit_rig(session.shown(), |rig| {
                    rig.follow_paths = rig.with_path(root, kind);
                    Ok(())
                })
            }
            Self::SetFollowPath { .. } => {
                Outcome::fail("The path to follow must have a period above 0 and finite lengths")
            }
            Self::SetHead { root, to } if rig.root_of(root) == Some(root) => {
                move_head(session, root, rig.clone(), &[to])
            }
            Self::SetHead { root, .. } => {
                Outcome::fail(format!("A head must be a root, got joint {root}"))
            }
        }
    }
}

/// Moves the head of a chain of `before` through points of skeleton space, and writes the joints
/// that follow a path to the shown skeleton.
pub(in crate::session) fn move_head(
    session: &Session,
    root: JointId,
    mut before: SkeletonRig,
    points: &[Vec3],
) -> Outcome {
    if let Some(wrong) = points.iter().find(|point| !point.is_finite()) {
        return Outcome::fail(format!("The position of the head must be finite, got {wrong}"));
    }
    let has_keys = before.head_tracks.contains_key(&root);
    before.pull_head(root, points);
    let moved = before.path_joints(root).take(if has_keys { 1 } else { usize::MAX });
    Outcome::edit_rig(session.shown(), |rig| {
        let count = rig.skeleton.joints().len();
        for joint in moved.filter(|joint| joint.index() < count) {
            let Joint { offset, rotation, .. } = before.skeleton[joint];
            rig.skeleton_mut().write_local(joint, |joint| {
                (joint.offset, joint.rotation) = (offset, rotation);
            });
        }
        Ok(())
    })
}
