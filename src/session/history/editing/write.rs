//! Changes of the document: what is keyed, what stays unkeyed until the time changes.

use std::collections::BTreeSet;

use super::Editing;
use crate::document::{Arm, Channel, Document, Keys, PathKind, Track, TwistReferenceKind};
use crate::session::history::steps::TreeChange;
use crate::session::playback::Playback;

/// Consequences of a change of the document.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::session) struct WriteOutcome {
    /// True if the change made unkeyed edits of keyed channels.
    pub has_overridden: bool,
    /// True if auto-key set keys.
    pub has_auto_keyed: bool,
}

impl Editing {
    /// Replaces the shown document. With auto-key, changed channels get keys; otherwise, changed
    /// channels with keys get unkeyed edits. Returns `None` if nothing has changed.
    pub(in crate::session) fn write(
        &mut self,
        mut after: Document,
        playback: &Playback,
    ) -> Option<WriteOutcome> {
        let resets_posture = std::mem::take(&mut self.resets_posture);
        if after == *self.shown() {
            return None;
        }
        let [joints_before, joints] = [self.shown(), &after].map(|it| it.skeleton().joints().len());
        let change = TreeChange::between(self.shown().skeleton(), after.skeleton());
        let is_rebuilt = change != TreeChange::Kept;
        let has_other_joints = is_rebuilt || joints != joints_before;
        let mut outcome = WriteOutcome::default();
        if is_rebuilt {
            self.overrides.clear();
        } else {
            outcome = self.key_or_override(&mut after, playback);
            self.keep_unkeyed_values(&mut after);
        }
        self.overrides.retain(|channel, _| {
            let is_transported = *channel == Channel::Twist && is_transported(&after);
            is_transported || after.keys.has(*channel)
        });
        after.skeleton_rig.head_tracks.clear();
        if !self.is_editing() {
            after.skeleton_rig.refresh_skin();
        }
        self.update_posture(&mut after, change, resets_posture);
        self.document = after;
        self.evaluate(playback.time());
        self.update_transaction(has_other_joints);
        Some(outcome)
    }

    /// Sets the posture of an edited document, so that its motion continues from the present one,
    /// and the time at which the motion begins.
    fn update_posture(&self, after: &mut Document, change: TreeChange, is_reset: bool) {
        let is_drag = self.is_editing();
        let is_same_tree = change == TreeChange::Kept
            && after.skeleton().joints().len() == self.document.skeleton().joints().len();
        let posture = after.skeleton_rig.posture.take();
        after.skeleton_rig.posture = if is_reset {
            None
        } else if !is_same_tree {
            posture.and_then(|posture| Track::posture_near(after, &posture))
        } else if !is_drag && posture != self.document.skeleton_rig.posture {
            // The edit has chosen it.
            posture
        } else {
            self.track.posture_after(after, !is_drag)
        };
        if after.track_start.is_none() && after.is_tracked() {
            let began = self.document.is_tracked();
            let of = if began { &self.document } else { &*after };
            after.track_start = Some(of.motion_start());
        }
    }

    /// Adapts the open transaction to a change of the document. The drag ends if joints were added,
    /// removed or attached to other parents; otherwise, the document from which it starts gets the
    /// changed keys.
    fn update_transaction(&mut self, has_other_joints: bool) {
        let Some(transaction) = &mut self.transaction else { return };
        if has_other_joints {
            transaction.drag = None;
            transaction.shown.clone_from(self.posed.document());
        } else if transaction.shown.keys != self.document.keys {
            transaction.shown.keys.clone_from(&self.document.keys);
        }
    }

    /// Sets the keys from which the next [`KeysEdit::MoveKeys`](crate::session::KeysEdit::MoveKeys)
    /// of the open transaction starts.
    pub(in crate::session) fn restart_keys_from(&mut self, keys: Keys) {
        if let Some(transaction) = &mut self.transaction {
            transaction.shown.keys = keys;
        }
    }

    /// Keys the channels that `after` changes, if auto-key is on; otherwise, records unkeyed edits
    /// of the changed channels that have keys.
    fn key_or_override(&mut self, after: &mut Document, playback: &Playback) -> WriteOutcome {
        let changed = |channel: &Channel| {
            let value = channel.value(after);
            value.is_some() && value != channel.value(self.shown())
        };
        let channels: Vec<Channel> = if playback.is_auto_key() {
            self.channels_to_auto_key(after)
        } else {
            after.keys.tracks().map(|(channel, _)| channel).filter(changed).collect()
        };
        if !playback.is_auto_key() && is_transported(after) {
            if after.arm.cursor_in_root() != self.shown().arm.cursor_in_root() {
                // The transported twist is an unkeyed edit, too, discarded together with that of
                // the hand.
                let twist = Channel::Twist.value(after).unwrap_or_default();
                self.overrides.insert(Channel::Twist, twist);
            } else if changed(&Channel::Twist) {
                self.overrides.remove(&Channel::Twist);
            }
        }
        let mut outcome = WriteOutcome::default();
        for channel in channels {
            if playback.is_auto_key() {
                after.key_before_switch(channel, self.shown(), playback.time());
                after.key(channel, playback.time());
                self.overrides.remove(&channel);
                outcome.has_auto_keyed = true;
            } else if let Some(value) = channel.value(after) {
                self.overrides.insert(channel, value);
                outcome.has_overridden = true;
            }
        }
        outcome
    }

    /// Channels that auto-key keys for a change of the shown document to `after`: changed channels
    /// that shape the rig before or after it, and changed switches that have keys. A switch between
    /// FK and IK keys the channels of both; a switch of the pin keys the point that comes into use.
    fn channels_to_auto_key(&self, after: &Document) -> Vec<Channel> {
        let changed = |channel: &Channel| channel.value(after) != channel.value(self.shown());
        let (has_mode, has_pinned) = (changed(&Channel::Influence), changed(&Channel::Pinned));
        let comes_into_use = |channel: &Channel| {
            let is_posing = Channel::IK.contains(channel) || Channel::FK.contains(channel);
            has_mode && is_posing || has_pinned && *channel == Channel::of_cursor(&after.arm)
        };
        let switches = after.keys.tracks().map(|(channel, _)| channel).filter(|it| it.is_switch());
        let all: BTreeSet<Channel> = [after, self.shown()]
            .into_iter()
            .flat_map(Channel::of_rig)
            .chain(switches)
            .filter(|channel| changed(channel) || comes_into_use(channel))
            .filter(|channel| !is_start_of_body(after, *channel))
            .collect();
        all.into_iter().collect()
    }

    /// Restores the document's own values of keyed channels in `after`, since their values at the
    /// playhead are not saved.
    fn keep_unkeyed_values(&self, after: &mut Document) {
        let is_keyed = |channel: &Channel| self.document.keys.has(*channel);
        let skeleton = &mut after.skeleton_rig.skeleton;
        let mut keyed_before = self.document.keys.tracks().map(|(channel, _)| channel);
        if skeleton.is_same(&self.shown().skeleton_rig.skeleton)
            && keyed_before.all(|channel| after.keys.has(channel))
        {
            *skeleton = self.document.skeleton_rig.skeleton.clone();
        }
        let keyed = after.keys.tracks().map(|(channel, _)| channel).filter(is_keyed);
        for channel in keyed.collect::<Vec<_>>() {
            if let Some(value) = channel.value(&self.document) {
                channel.set(after, value);
            }
            if matches!(channel, Channel::Hand | Channel::Pin) {
                after.arm.ik_state.pointer = self.document.arm.ik_state.pointer;
            }
        }
        let is_overridden = is_transported(after) && self.overrides.contains_key(&Channel::Twist);
        if is_overridden || is_keyed(&Channel::Twist) {
            let unkeyed = self.document.arm.with_twist_reference(after.arm.twist_reference);
            after.arm.twist = unkeyed.twist;
            after.arm.ik_state.transported = unkeyed.ik_state.transported;
        }
        if is_keyed(&Channel::HandOrientation) {
            let Arm { hand_orientation, .. } = self.document.arm;
            let space = after.arm.hand_orientation.space;
            after.arm.hand_orientation.angles =
                hand_orientation.in_space(space, &self.document.arm.pose()).angles;
        }
    }
}

/// True if the twist is transported along a keyed hand and has no keys of its own.
fn is_transported(document: &Document) -> bool {
    let Document { arm, keys, .. } = document;
    arm.twist_reference == TwistReferenceKind::Transport
        && keys.has(Channel::of_cursor(arm))
        && !keys.has(Channel::Twist)
}

/// True if a channel has an angle of the body that a head with keys has at its first key: such an
/// angle is not keyed automatically.
fn is_start_of_body(document: &Document, channel: Channel) -> bool {
    let rig = &document.skeleton_rig;
    let Channel::Rotation(joint) = channel else { return false };
    let heads = rig.follow_paths.iter().filter(|path| path.kind == PathKind::Head);
    !document.keys.has(channel)
        && heads.flat_map(|path| rig.path_joints(path.root)).any(|of_chain| of_chain == joint)
}
