use glam::Vec3;

use super::arm::Arm;
use super::channel::{Access, Channel, is_on, switch};
use super::document::Document;
use super::rig_kind::RigKind;
use crate::rig::SkeletonRig;

/// Channels in a document.
impl Channel {
    /// The channel of the point that the Cursor of `arm` has: in the world if it is pinned, else in
    /// Root space.
    pub fn of_cursor(arm: &Arm) -> Self {
        if arm.is_pinned() { Self::Pin } else { Self::Hand }
    }

    /// True if the channel is the point that the Cursor of `arm` does not have at present.
    pub fn is_idle(self, arm: &Arm) -> bool {
        matches!(self, Self::Hand | Self::Pin) && self != Self::of_cursor(arm)
    }

    /// Channels that affect the pose of the shown rig. For a skeleton: its translation, the offsets
    /// of its roots, the rotations of its joints and its targets; a target's influence only below
    /// 1, and a twist of 0 not at all.
    pub fn of_rig(document: &Document) -> Vec<Self> {
        if document.rig == RigKind::Arm {
            let shapes = |channel: &Self| channel.shapes(&document.arm);
            return Self::ARM.into_iter().filter(shapes).collect();
        }
        let SkeletonRig { skeleton, targets, .. } = &document.skeleton_rig;
        let joints = skeleton.iter();
        let roots = joints.clone().filter(|(_, joint)| joint.parent.is_none());
        let mut channels = vec![Self::Translation];
        channels.extend(roots.map(|(joint, _)| Self::Offset(joint)));
        channels.extend(joints.map(|(joint, _)| Self::Rotation(joint)));
        let of_targets = targets.iter().flat_map(|target| Self::of_target(target.joint));
        channels.extend(of_targets.filter(|channel| channel.shapes_by_target(document)));
        channels
    }

    /// True if this channel of a target affects the pose with its present value.
    fn shapes_by_target(self, document: &Document) -> bool {
        let value = self.value(document);
        matches!(self.access(), Access::Target { shapes, .. } if value.is_some_and(shapes))
    }

    /// The channel's value in a document; `None` for a joint or target that the document does not
    /// have.
    pub fn value(self, document: &Document) -> Option<Vec3> {
        let Document { arm, skeleton_rig: rig, display, .. } = document;
        match self.access() {
            Access::Arm { get, .. } => Some(get(arm)),
            Access::Skeleton { get, .. } => Some(get(&rig.skeleton)),
            Access::Joint { joint, get, .. } => rig.skeleton.joint(joint).map(get),
            Access::Target { joint, get, .. } => get(&rig.targets[rig.target(joint)?]),
            Access::Overlay(overlay) => Some(switch(display.shows(overlay))),
        }
    }

    /// Sets the channel's value in a document, clamped to the channel's range. Changes nothing if
    /// `value` contains NaN or is an invalid length of a limb, or if [`Self::value`] is `None`.
    pub fn set(self, document: &mut Document, value: Vec3) {
        let Document { arm, skeleton_rig: rig, display, .. } = document;
        let value = value.clamp(Vec3::MIN, Vec3::MAX);
        if value.is_nan() {
            return;
        }
        match self.access() {
            Access::Arm { set, .. } => set(arm, value),
            Access::Skeleton { set, .. } => set(rig, value),
            Access::Joint { joint, set, .. } => set(rig, joint, value),
            Access::Target { joint, set, .. } => {
                if let Some(index) = rig.target(joint) {
                    set(&mut rig.targets[index], value);
                }
            }
            Access::Overlay(overlay) => *display = display.with(overlay, is_on(value)),
        }
    }
}
