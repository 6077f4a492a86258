//! Changes of the document: what is keyed, what stays unkeyed until the time changes.

use std::collections::BTreeSet;

use super::{Editing, NextPosture};
use crate::document::{Channel, Document, Keys, PathKind, Track};
use crate::rig::Target;
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
        let next_posture = std::mem::take(&mut self.next_posture);
        let present = &self.document.rig.posture;
        let moves = matches!(&next_posture, NextPosture::Chosen(chosen) if chosen != present);
        if after == *self.shown() && !moves {
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
        self.overrides.retain(|channel, _| after.keys.has(*channel));
        after.rig.head_tracks.clear();
        if !self.is_editing() {
            after.rig.refresh_skin();
        }
        self.update_posture(&mut after, change, next_posture);
        self.document = after;
        self.evaluate(playback.time());
        self.update_transaction(has_other_joints);
        Some(outcome)
    }

    /// Sets the posture of an edited document, so that its motion continues from the present one,
    /// and the time at which the motion begins.
    fn update_posture(&self, after: &mut Document, change: TreeChange, next: NextPosture) {
        let before = &self.document;
        let is_reset = next == NextPosture::Reset;
        if next == NextPosture::Continued
            && after.rig == before.rig
            && after.keys == before.keys
            && after.timeline == before.timeline
        {
            // Overlays and units have no motion.
            return;
        }
        let is_drag = self.is_editing();
        let is_same_tree = change == TreeChange::Kept
            && after.skeleton().joints().len() == self.document.skeleton().joints().len();
        let posture = after.rig.posture.take();
        after.rig.posture = if is_reset {
            None
        } else if let NextPosture::Chosen(chosen) = next {
            chosen
        } else if !is_same_tree {
            posture.and_then(|posture| Track::posture_near(after, &posture))
        } else if !is_drag && posture != self.document.rig.posture {
            // The edit has chosen it.
            posture
        } else {
            self.track.posture_after(after, !is_drag)
        };
        if after.track_start.is_none() && after.is_tracked() && !is_reset {
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
    /// that shape the rig before or after it, and changed switches that have keys. A change of a
    /// limb's influence keys the channels of FK and IK; a switch of the pin keys the point that
    /// comes into use.
    fn channels_to_auto_key(&self, after: &Document) -> Vec<Channel> {
        let changed = |channel: &Channel| channel.value(after) != channel.value(self.shown());
        let come_into_use = |target: &Target| {
            let joint = target.joint;
            let has_mode = target.limb().is_some() && changed(&Channel::TargetInfluence(joint));
            let of_ik = Channel::of_ik(target).into_iter().filter(|it| it.shapes(target));
            let of_both = of_ik.chain(Channel::of_fk(&after.rig, target)).filter(|_| has_mode);
            let point = changed(&Channel::Pinned(joint)).then(|| Channel::of_point(target));
            of_both.chain(point).collect::<Vec<_>>()
        };
        let switched = after.rig.targets.iter().flat_map(come_into_use);
        let switches = after.keys.tracks().map(|(channel, _)| channel).filter(|it| it.is_switch());
        let all: BTreeSet<Channel> = [after, self.shown()]
            .into_iter()
            .flat_map(|document| {
                Channel::of_rig(document).into_iter().chain(Channel::lengths(document))
            })
            .chain(switches)
            .filter(changed)
            .filter(|channel| !is_start_of_body(after, *channel))
            .chain(switched)
            .filter(|channel| channel.value(after).is_some())
            .collect();
        all.into_iter().collect()
    }

    /// Restores the document's own values of keyed channels in `after`, since their values at the
    /// playhead are not saved.
    fn keep_unkeyed_values(&self, after: &mut Document) {
        let is_keyed = |channel: &Channel| self.document.keys.has(*channel);
        let skeleton = &mut after.rig.skeleton;
        let mut keyed_before = self.document.keys.tracks().map(|(channel, _)| channel);
        if skeleton.is_same(&self.shown().rig.skeleton)
            && keyed_before.all(|channel| after.keys.has(channel))
        {
            *skeleton = self.document.rig.skeleton.clone();
        }
        let keyed = after.keys.tracks().map(|(channel, _)| channel).filter(is_keyed);
        for channel in keyed.collect::<Vec<_>>() {
            if let Channel::Length(joint) = channel
                && let Some(axis) = self.document.skeleton().joint(joint).map(|joint| joint.axis)
            {
                // Bit for bit, which a length alone does not give.
                let _ = after.skeleton_mut().set_axis(joint, axis);
            } else if let Some(value) = channel.value(&self.document) {
                channel.set(after, value);
            }
        }
    }
}

/// True if a channel has an angle of the body that a head with keys has at its first key: such an
/// angle is not keyed automatically.
fn is_start_of_body(document: &Document, channel: Channel) -> bool {
    let rig = &document.rig;
    let Channel::Rotation(joint) = channel else { return false };
    let heads = rig.follow_paths.iter().filter(|path| path.kind == PathKind::Head);
    !document.keys.has(channel)
        && heads.flat_map(|path| rig.path_joints(path.root)).any(|of_chain| of_chain == joint)
}
