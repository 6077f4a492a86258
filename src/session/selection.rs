use std::collections::BTreeSet;

use super::outcome::{Consequence, Effect, Outcome};
use super::parts::{Clipboard, Key, LimbFigure, SelectedKeys};
use glam::Vec3;

use crate::document::{Channel, Document};
use crate::kinematics::skeleton::{JointId, JointRemap, RotationAxis};
use crate::kinematics::spline::Knot;

/// Changes the selection or the copied keys.
#[derive(Clone, Debug, PartialEq)]
pub enum SelectAction {
    /// Selects these joints and no others; the last of them becomes the active joint.
    Joints(Vec<JointId>),
    /// Sets the joint whose bone or skin is under the mouse; `None` if there is none.
    Hover(Option<JointId>),
    /// Lets an angle of a joint swing in the view; `None` stops it.
    Wiggle(Option<(JointId, RotationAxis)>),
    /// Lights up a line of the limb's figures in the view; `None` stops it.
    Figure(Option<LimbFigure>),
    /// Selects these keys and no others.
    Keys(Vec<Key>),
    /// Selects these channels and no others.
    Channels(Vec<Channel>),
    /// Copies the selected keys.
    CopyKeys,
}

/// Selected joints, keys and channels, and the copied keys.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Selection {
    /// Selected joints; the last of them is the active joint.
    joints: Vec<JointId>,
    hovered: Option<JointId>,
    figure: Option<LimbFigure>,
    keys: Vec<Key>,
    channels: BTreeSet<Channel>,
    clipboard: Clipboard,
}

impl Selection {
    /// Applies an action; `document` is the open one, which has `joints` joints.
    pub(super) fn apply(
        &mut self,
        action: SelectAction,
        document: &Document,
        joints: usize,
    ) -> Outcome {
        match action {
            SelectAction::Joints(selected) => return Consequence::Select(selected).into(),
            SelectAction::Hover(joint) => self.hover(joint, joints),
            SelectAction::Wiggle(wiggled) => return Consequence::Wiggle(wiggled).into(),
            SelectAction::Figure(figure) => self.figure = figure,
            SelectAction::Keys(keys) => {
                self.keys = keys;
                self.retain_keys(document);
            }
            SelectAction::Channels(channels) => {
                self.set_channels(channels);
                self.retain_keys(document);
            }
            SelectAction::CopyKeys => return self.copy_keys(document),
        }
        Outcome::default()
    }

    /// Selects joints, except those whose index is `count` or more.
    pub(super) fn select(&mut self, joints: Vec<JointId>, count: usize) {
        self.joints = joints;
        self.retain_joints(count);
    }

    pub(super) fn hover(&mut self, joint: Option<JointId>, count: usize) {
        self.hovered = joint;
        self.retain_joints(count);
    }

    /// Copies the selected keys, also as text to the system's clipboard, which sends paste events
    /// only for text.
    fn copy_keys(&mut self, document: &Document) -> Outcome {
        let copied = |(channel, time): &Key| Some((*channel, document.keys.key(*channel, *time)?));
        let mut copies: Clipboard = self.keys.iter().filter_map(copied).collect();
        let first = copies.iter().map(|(_, key)| key.time).fold(f64::INFINITY, f64::min);
        copies.iter_mut().for_each(|(_, key)| key.time -= first);
        let said = Outcome::say(match copies.len() {
            0 => "Select keys to copy them".to_owned(),
            1 => "1 key copied".to_owned(),
            count => format!("{count} keys copied"),
        });
        if copies.is_empty() {
            return said;
        }
        let line = |(channel, Knot { time, value, .. }): &(Channel, Knot<Vec3>)| {
            format!("{channel:?} {time} {} {} {}\n", value.x, value.y, value.z)
        };
        let text = copies.iter().map(line).collect();
        self.clipboard = copies;
        said.and(Effect::CopyText(text))
    }

    /// The selected joints; the last of them is the active joint.
    pub fn joints(&self) -> &[JointId] {
        &self.joints
    }

    /// The active joint, which is the last of the selected ones; `None` without a selection.
    pub fn active(&self) -> Option<JointId> {
        self.joints.last().copied()
    }

    /// The joint under the mouse, in the viewport or in the outliner.
    pub fn hovered(&self) -> Option<JointId> {
        self.hovered
    }

    /// The line of the limb's figures under the mouse.
    pub fn figure(&self) -> Option<LimbFigure> {
        self.figure
    }

    /// Keys that are selected in the timeline.
    pub fn keys(&self) -> &[Key] {
        &self.keys
    }

    /// Channels that are selected in the timeline.
    pub fn channels(&self) -> &BTreeSet<Channel> {
        &self.channels
    }

    /// The selected keys and channels, for [`Self::remap`].
    pub(super) fn in_timeline(&self) -> SelectedKeys {
        SelectedKeys { keys: self.keys.clone(), channels: self.channels.clone() }
    }

    /// True if there are copied keys to paste.
    pub fn can_paste(&self) -> bool {
        !self.clipboard.is_empty()
    }

    pub(super) fn clipboard(&self) -> &Clipboard {
        &self.clipboard
    }

    pub(super) fn set_keys(&mut self, keys: Vec<Key>) {
        self.keys = keys;
    }

    pub(super) fn set_channels(&mut self, channels: impl IntoIterator<Item = Channel>) {
        self.channels = channels.into_iter().collect();
    }

    /// Drops selected and hovered joints whose index is `count` or more.
    pub(super) fn retain_joints(&mut self, count: usize) {
        self.joints.retain(|joint| joint.index() < count);
        self.hovered = self.hovered.filter(|joint| joint.index() < count);
    }

    /// Deselects keys and channels that the document does not have.
    pub(super) fn retain_keys(&mut self, document: &Document) {
        self.keys.retain(|(channel, time)| {
            document.keys.track(*channel).is_some_and(|track| track.get(*time).is_some())
        });
        self.channels.retain(|channel| channel.value(document).is_some());
    }

    /// Renumbers the joints of selected keys, selected channels and copied keys after joints were
    /// removed or renumbered. `before` is the selection from before.
    pub(super) fn remap(&mut self, moved: &JointRemap, before: SelectedKeys) {
        let keys = before.keys.into_iter();
        self.keys =
            keys.filter_map(|(channel, time)| Some((channel.remapped(moved)?, time))).collect();
        self.set_channels(before.channels.into_iter().filter_map(|it| it.remapped(moved)));
        let copies = std::mem::take(&mut self.clipboard).into_iter();
        let copies = copies.filter_map(|(channel, key)| Some((channel.remapped(moved)?, key)));
        self.clipboard = copies.collect();
    }

    /// Deselects the joints from the index `count` on; if no joint is left, selects `parent`.
    pub(super) fn shorten(&mut self, count: usize, parent: Option<JointId>) {
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
    pub(super) fn forget_joints(&mut self) {
        self.joints.clear();
        self.keys.clear();
        self.channels.clear();
        self.clipboard.retain(|(channel, ..)| channel.joint().is_none());
    }
}
