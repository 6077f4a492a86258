use std::collections::BTreeSet;

use glam::Vec3;

use super::arm_figure::ArmFigure;
use super::arm_joint::ArmJoint;
use super::body_part::BodyPart;
use super::key::Key;
use crate::document::{Channel, Document};
use crate::kinematics::skeleton::{JointId, JointRemap};
use crate::kinematics::spline::Knot;

/// Copied keys with their channels. Their times are those after the first key, in seconds.
pub(super) type Clipboard = Vec<(Channel, Knot<Vec3>)>;

/// Selected joints, keys and channels, and the copied keys.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Selection {
    /// Selected joints; the last of them is the active joint.
    joints: Vec<JointId>,
    hovered: Option<BodyPart>,
    arm_joint: Option<ArmJoint>,
    figure: Option<ArmFigure>,
    keys: Vec<Key>,
    channels: BTreeSet<Channel>,
    clipboard: Clipboard,
}

impl Selection {
    pub fn joints(&self) -> &[JointId] {
        &self.joints
    }

    pub fn hovered(&self) -> Option<BodyPart> {
        self.hovered
    }

    pub fn arm_joint(&self) -> Option<ArmJoint> {
        self.arm_joint
    }

    pub fn figure(&self) -> Option<ArmFigure> {
        self.figure
    }

    pub fn keys(&self) -> &[Key] {
        &self.keys
    }

    pub fn channels(&self) -> &BTreeSet<Channel> {
        &self.channels
    }

    pub fn clipboard(&self) -> &Clipboard {
        &self.clipboard
    }

    pub fn set_joints(&mut self, joints: Vec<JointId>) {
        self.joints = joints;
    }

    pub fn set_hovered(&mut self, part: Option<BodyPart>) {
        self.hovered = part;
    }

    pub fn set_arm_joint(&mut self, joint: Option<ArmJoint>) {
        self.arm_joint = joint;
    }

    pub fn set_figure(&mut self, figure: Option<ArmFigure>) {
        self.figure = figure;
    }

    pub fn set_keys(&mut self, keys: Vec<Key>) {
        self.keys = keys;
    }

    pub fn set_channels(&mut self, channels: impl IntoIterator<Item = Channel>) {
        self.channels = channels.into_iter().collect();
    }

    pub fn set_clipboard(&mut self, clipboard: Clipboard) {
        self.clipboard = clipboard;
    }

    /// Drops selected and hovered joints whose index is `count` or more.
    pub fn retain_joints(&mut self, count: usize) {
        self.joints.retain(|joint| joint.index() < count);
        let is_there = |joint: JointId| joint.index() < count;
        self.hovered = self.hovered.filter(|part| part.joint().is_none_or(is_there));
    }

    /// Deselects keys and channels that the document does not have.
    pub fn retain_keys(&mut self, document: &Document) {
        self.keys.retain(|(channel, time)| {
            document.keys.track(*channel).is_some_and(|track| track.get(*time).is_some())
        });
        self.channels.retain(|channel| channel.value(document).is_some());
    }

    /// Renumbers the joints of selected keys, selected channels and copied keys after joints were
    /// removed or renumbered. `keys` and `channels` are the selection from before.
    pub fn remap(&mut self, moved: &JointRemap, keys: Vec<Key>, channels: BTreeSet<Channel>) {
        let keys = keys.into_iter();
        self.keys =
            keys.filter_map(|(channel, time)| Some((channel.remapped(moved)?, time))).collect();
        self.set_channels(channels.into_iter().filter_map(|channel| channel.remapped(moved)));
        let copies = std::mem::take(&mut self.clipboard).into_iter();
        let copies = copies.filter_map(|(channel, key)| Some((channel.remapped(moved)?, key)));
        self.clipboard = copies.collect();
    }

    /// Deselects the joints from the index `count` on; if no joint is left, selects `parent`.
    pub fn shorten(&mut self, count: usize, parent: Option<JointId>) {
        let had_joints = !self.joints.is_empty();
        self.retain_joints(count);
        if had_joints && self.joints.is_empty() {
            self.joints.extend(parent);
        }
        let is_there = |joint: JointId| joint.index() < count;
        self.clipboard.retain(|(channel, ..)| channel.joint().is_none_or(is_there));
    }

    /// Clears the selection and removes the copied keys of joints, because their joint indices are
    /// no longer valid.
    pub fn forget_joints(&mut self) {
        self.joints.clear();
        self.keys.clear();
        self.channels.clear();
        self.clipboard.retain(|(channel, ..)| channel.joint().is_none());
    }
}
