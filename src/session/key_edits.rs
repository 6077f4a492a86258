use std::collections::BTreeSet;

use glam::Vec3;

use super::effect::Effect;
use super::key::Key;
use super::selection::Clipboard;
use super::session::Session;
use crate::document::{Channel, Document, Keys, Quantity, RigKind, Timeline};
use crate::kinematics::skeleton::JointRemap;
use crate::kinematics::spline::{Interpolation, Knot, Slopes};

/// Keys of the timeline.
impl Session {
    /// Channels that are selected in the timeline.
    pub fn selected_channels(&self) -> &BTreeSet<Channel> {
        self.selection.channels()
    }

    /// Keys that are selected in the timeline.
    pub fn selected_keys(&self) -> &[Key] {
        self.selection.keys()
    }

    /// Whether there are copied keys to paste.
    pub fn can_paste(&self) -> bool {
        !self.selection.clipboard().is_empty()
    }

    /// Channels that the shortcut K keys: those selected in the timeline, if any. Otherwise, for
    /// the arm, the channels that pose it and those with unkeyed edits; for the skeleton, the
    /// channels of the selected joints, or all channels if no joint is selected.
    pub fn channels_to_key(&self) -> Vec<Channel> {
        let is_there = |channel: &Channel| channel.value(self.shown()).is_some();
        if !self.selection.channels().is_empty() {
            return self.selection.channels().iter().copied().filter(is_there).collect();
        }
        match self.rig() {
            RigKind::Arm => {
                let overridden = self.editing.overrides().keys().copied().filter(is_there);
                let all: BTreeSet<_> =
                    self.posing_channels().into_iter().chain(overridden).collect();
                all.into_iter().collect()
            }
            RigKind::Skeleton if self.selection.joints().is_empty() => self.all_channels(),
            RigKind::Skeleton => {
                let rig = self.skeleton_rig();
                let ends = self.selection.joints().iter().filter_map(|it| rig.target_of_end(*it));
                let targeted: Vec<_> = ends.map(|index| rig.targets[index].joint).collect();
                let is_selected = |channel: &Channel| match channel.target() {
                    Some(joint) => targeted.contains(&joint),
                    None => channel.joint().is_some_and(|it| self.selection.joints().contains(&it)),
                };
                Channel::of_rig(self.shown()).into_iter().filter(is_selected).collect()
            }
        }
    }

    /// Channels that pose the arm: those of IK if its influence is above 0, and those of FK if that
    /// influence is below 1. The switch of the pin is among them if it is on or has keys.
    fn posing_channels(&self) -> Vec<Channel> {
        let (arm, keys) = (self.arm(), &self.shown().keys);
        let hand = Channel::IK.into_iter().filter(|_| arm.uses_ik());
        let poses = |channel: &Channel| {
            channel.shapes(arm) || *channel == Channel::Pinned && keys.has(Channel::Pinned)
        };
        hand.chain(Channel::FK).filter(poses).collect()
    }

    /// Channels that affect the pose of the shown rig, and those of [`Self::keyed_channels`].
    pub fn all_channels(&self) -> Vec<Channel> {
        let of_rig = Channel::of_rig(self.shown()).into_iter();
        let all: BTreeSet<Channel> = of_rig.chain(self.keyed_channels()).collect();
        all.into_iter().collect()
    }

    /// All channels with keys, except the point of the arm's Cursor that is not in use.
    pub fn keyed_channels(&self) -> impl Iterator<Item = Channel> {
        let keyed = self.shown().keys.tracks().map(|(channel, _)| channel);
        keyed.filter(|channel| !channel.is_idle(self.arm()))
    }

    /// Keys channels at the playhead with their shown values.
    pub(super) fn key(&mut self, channels: &[Channel]) {
        let time = self.time();
        let overrides = self.editing.overrides().len();
        for channel in channels {
            self.editing.forget_override(*channel);
        }
        let (are_keyed, keys) =
            (self.editing.overrides().len() < overrides, self.document().keys.clone());
        self.edit_keys(|document| channels.iter().for_each(|channel| document.key(*channel, time)));
        if are_keyed && keys == self.document().keys {
            // The keys had these values already: nothing was committed.
            self.refresh();
        }
        self.say(match channels {
            [] => "There is nothing to key".to_owned(),
            _ if self.is_auto_key_news() => {
                format!("Keyed at {time:.2} s. Auto-key is on: every edit sets keys")
            }
            _ => format!("Keyed at {time:.2} s"),
        });
    }

    pub(super) fn delete_keys(&mut self, keys: &[Key]) {
        self.edit_keys(|document| document.keys.remove_all(keys));
    }

    /// Renumbers the joints of selected and copied keys after joints were removed or renumbered.
    /// `keys` and `channels` are the selection from before.
    pub(super) fn remap_keys(
        &mut self,
        moved: &JointRemap,
        (keys, channels): (Vec<Key>, BTreeSet<Channel>),
    ) {
        self.selection.remap(moved, keys, channels);
        self.retain_keys();
    }

    pub(super) fn selected_in_timeline(&self) -> (Vec<Key>, BTreeSet<Channel>) {
        (self.selection.keys().to_vec(), self.selection.channels().clone())
    }

    pub(super) fn clear_channels(&mut self, channels: &[Channel]) {
        self.edit_keys(|document| {
            for channel in channels {
                document.keys.clear(*channel);
            }
        });
    }

    /// Moves `keys`, given with their times before the transaction, by `by` seconds, and adds `raise`
    /// to their values. Replaces other keys at the new times.
    pub(super) fn move_keys(&mut self, keys: &[Key], by: f64, raise: Vec3) {
        let farthest = Timeline::MAX_TIME;
        let by = if by.is_finite() { by.clamp(-farthest, farthest) } else { 0.0 };
        let raise = if raise.is_finite() { raise } else { Vec3::ZERO };
        let before = self.editing.shown_before().keys.clone();
        let moved: Clipboard = keys
            .iter()
            .filter_map(|(channel, time)| {
                let key = before.key(*channel, *time)?;
                let (time, value) = (self.moved_to(*time, by), raised(*channel, key.value, raise));
                Some((*channel, Knot { time, value, ..key }))
            })
            .collect();
        self.selection.set_keys(moved.iter().map(|(channel, key)| (*channel, key.time)).collect());
        let mut after = before.clone();
        after.remove_all(keys);
        insert(&mut after, &moved);
        self.edit_keys(|document| document.keys = after);
        // The next move of this drag starts from the same keys.
        self.editing.restart_keys_from(before);
    }

    /// Sets the curve from each of `keys` to the next key of its channel.
    pub(super) fn set_interpolation(&mut self, keys: &[Key], interpolation: Interpolation) {
        self.change_keys(keys, |_, key| Knot { interpolation, ..key });
    }

    /// Sets the slopes of `keys`, per second; `None` for those that the neighbours give.
    pub(super) fn set_slopes(&mut self, keys: &[Key], slopes: Option<Slopes<Vec3>>) {
        self.change_keys(keys, |channel, key| {
            let slopes = slopes.map(|Slopes { arriving, leaving }| Slopes {
                arriving: of_width(channel, arriving),
                leaving: of_width(channel, leaving),
            });
            Knot { slopes, ..key }
        });
    }

    fn change_keys(&mut self, keys: &[Key], change: impl Fn(Channel, Knot<Vec3>) -> Knot<Vec3>) {
        self.edit_keys(|document| {
            for (channel, time) in keys {
                if let Some(key) = document.keys.key(*channel, *time) {
                    document.keys.insert_key(*channel, change(*channel, key));
                }
            }
        });
    }

    /// The time of a key after a move by `by`, in seconds. A move from one frame to another ends
    /// exactly on the frame.
    fn moved_to(&self, time: f64, by: f64) -> f64 {
        let timeline = self.document().timeline;
        let (from, to) = (timeline.snapped(time), timeline.snapped(time + by));
        let is_on_frame = |time: f64, frame: f64| (time - frame).abs() < 1e-9;
        if is_on_frame(time, from) && is_on_frame(time + by, to) { to } else { time + by }
    }

    /// Copies the selected keys, also as text to the system's clipboard, which sends paste events
    /// only for text. Returns `None` if no keys are selected.
    pub(super) fn copy_keys(&mut self) -> Option<Effect> {
        let copied =
            |(channel, time): &Key| Some((*channel, self.document().keys.key(*channel, *time)?));
        let mut copies: Clipboard = self.selection.keys().iter().filter_map(copied).collect();
        let first = copies.iter().map(|(_, key)| key.time).fold(f64::INFINITY, f64::min);
        copies.iter_mut().for_each(|(_, key)| key.time -= first);
        self.say(match copies.len() {
            0 => "Select keys to copy them".to_owned(),
            1 => "1 key copied".to_owned(),
            count => format!("{count} keys copied"),
        });
        if copies.is_empty() {
            return None;
        }
        let line = |(channel, Knot { time, value, .. }): &(Channel, Knot<Vec3>)| {
            format!("{channel:?} {time} {} {} {}\n", value.x, value.y, value.z)
        };
        let text = copies.iter().map(line).collect();
        self.selection.set_clipboard(copies);
        Some(Effect::CopyText(text))
    }

    /// Pastes the copied keys at the playhead, except those of missing joints.
    pub(super) fn paste_keys(&mut self) {
        let pasted: Clipboard = self
            .selection
            .clipboard()
            .iter()
            .filter(|(channel, _)| channel.value(self.shown()).is_some())
            .map(|(channel, key)| {
                (*channel, Knot { time: self.moved_to(self.time(), key.time), ..*key })
            })
            .collect();
        self.selection.set_keys(pasted.iter().map(|(channel, key)| (*channel, key.time)).collect());
        self.edit_keys(|document| insert(&mut document.keys, &pasted));
    }

    pub(super) fn set_timeline(&mut self, timeline: Timeline) {
        if !timeline.is_valid() {
            self.fail(format!(
                "A timeline must start before it ends, within a day of 0, and have {} to {} frames \
                 per second",
                Timeline::MIN_FRAME_RATE,
                Timeline::MAX_FRAME_RATE
            ));
            return;
        }
        self.edit_keys(|document| document.timeline = timeline);
    }

    pub(super) fn set_metres(&mut self, metres: Option<f32>) {
        if metres.is_some_and(|metres| !(metres.is_finite() && metres > 0.0)) {
            self.fail("The length of a unit must be finite and above 0 m");
            return;
        }
        self.edit_keys(|document| document.metres_per_unit = metres);
    }

    pub(super) fn edit_keys(&mut self, change: impl FnOnce(&mut Document)) {
        let never = |document: &mut _| -> Result<(), core::convert::Infallible> {
            change(document);
            Ok(())
        };
        self.edit_document(never);
    }
}

fn insert(keys: &mut Keys, all: &Clipboard) {
    for (channel, key) in all {
        keys.insert_key(*channel, *key);
    }
}

/// The sum of a key's value and `by`, within the values that the channel can have.
fn raised(channel: Channel, value: Vec3, by: Vec3) -> Vec3 {
    /// Smallest part of a length that a move of its key leaves.
    const LEAST: f32 = 1e-3;
    let sum = (value + of_width(channel, by)).clamp(Vec3::MIN, Vec3::MAX);
    match channel.quantity() {
        Quantity::Switch => value,
        Quantity::Fraction => sum.clamp(Vec3::ZERO, Vec3::X),
        Quantity::Length => sum.max(value * LEAST),
        Quantity::Point | Quantity::Angle | Quantity::Angles | Quantity::Rotation => sum,
    }
}

/// The vector without the components that values of the channel do not have.
fn of_width(channel: Channel, vector: Vec3) -> Vec3 {
    let mut components = vector.to_array();
    components.iter_mut().skip(channel.quantity().width()).for_each(|it| *it = 0.0);
    Vec3::from_array(components)
}
