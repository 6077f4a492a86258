use core::fmt::Display;
use std::collections::BTreeSet;

use super::history::State;
use super::{Drag, Session, edit_label};
use crate::document::{Arm, Channel, Document, TwistReferenceKind};
use crate::kinematics::skeleton::Skeleton;

/// A change that is not finished: it can still be taken back.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Transaction {
    pub before: State,
    /// The document as it was shown before, with what has been changed of it otherwise since.
    pub shown: Document,
    /// What has been done, once something has.
    pub name: Option<&'static str>,
    pub drag: Option<Drag>,
}

/// Changes of the document.
impl Session {
    /// Every change comes through here: what is not possible is said and changes nothing, and all
    /// that is shown follows.
    pub(super) fn edit_document<T, E: Display>(
        &mut self,
        change: impl FnOnce(&mut Document) -> Result<T, E>,
    ) -> Option<T> {
        let mut after = self.shown.clone();
        match change(&mut after) {
            Ok(value) => {
                self.message = None;
                self.commit(after);
                Some(value)
            }
            Err(error) => {
                self.fail(error.to_string());
                None
            }
        }
    }

    /// What was shown has become this. What has keys and has changed gets one, or is shown as it is
    /// until the time changes.
    pub(super) fn commit(&mut self, mut after: Document) {
        if after == self.shown {
            return;
        }
        let [joints_before, joints] = [&self.shown, &after].map(|it| it.skeleton().joints().len());
        let is_rebuilt = is_rebuilt(self.shown.skeleton(), after.skeleton());
        let has_other_joints = is_rebuilt || joints != joints_before;
        if is_rebuilt {
            self.overrides.clear();
            self.solver_run = None;
        } else {
            self.hold_changes(&mut after);
            self.keep_rest(&mut after);
        }
        self.overrides.retain(|channel, _| {
            let goes_along = *channel == Channel::Twist && is_transported(&after);
            goes_along || after.keys.has(*channel)
        });
        self.document = after;
        self.refresh();
        self.forget_trail();
        self.go_on_with_edit(has_other_joints);
    }

    /// What goes back to how everything was when the edit began does not go back beyond what has been
    /// changed meanwhile by other means: to keys, or to joints that are no longer the same.
    fn go_on_with_edit(&mut self, has_other_joints: bool) {
        let Some(edit) = &mut self.edit else { return };
        if has_other_joints {
            // What is held may be another one now.
            edit.drag = None;
            edit.shown.clone_from(&self.shown);
        } else if edit.shown.keys != self.document.keys {
            edit.shown.keys.clone_from(&self.document.keys);
        }
    }

    fn hold_changes(&mut self, after: &mut Document) {
        let changed = |channel: &Channel| {
            let value = channel.value(after);
            value.is_some() && value != channel.value(&self.shown)
        };
        let channels: Vec<Channel> = if self.auto_key {
            // What is shown or not gets keys only where it has some.
            let switches =
                after.keys.tracks().map(|(channel, _)| channel).filter(|it| it.is_switch());
            // A switch between hand and angles is a pose of both.
            let switched = changed(&Channel::Influence);
            let leads = |channel: &Channel| {
                let is_leading =
                    Channel::OF_HAND.contains(channel) || Channel::OF_JOINTS.contains(channel);
                switched && is_leading
            };
            // What has begun to shape the rig, and what no longer does.
            let all: BTreeSet<Channel> = [&*after, &self.shown]
                .into_iter()
                .flat_map(Channel::of_rig)
                .chain(switches)
                .filter(|channel| changed(channel) || leads(channel))
                .collect();
            all.into_iter().collect()
        } else {
            after.keys.tracks().map(|(channel, _)| channel).filter(changed).collect()
        };
        if !self.auto_key && is_transported(after) {
            if after.arm.cursor() != self.shown.arm.cursor() {
                // The elbow has gone along, and comes back with the hand.
                let spin = Channel::Twist.value(after).unwrap_or_default();
                self.overrides.insert(Channel::Twist, spin);
            } else if changed(&Channel::Twist) {
                self.overrides.remove(&Channel::Twist);
            }
        }
        for channel in channels {
            if self.auto_key {
                after.key(channel, self.playback.time);
                self.overrides.remove(&channel);
            } else if let Some(value) = channel.value(after) {
                self.overrides.insert(channel, value);
                self.say("Shown until the time changes: press K to keep it");
            }
        }
    }

    /// What a keyed channel has beneath its keys stays as it was: what it has at this time is no
    /// change of the document.
    fn keep_rest(&self, after: &mut Document) {
        let is_keyed = |channel: &Channel| self.document.keys.has(*channel);
        let skeleton = &mut after.skeleton_rig.skeleton;
        let mut keyed_before = self.document.keys.tracks().map(|(channel, _)| channel);
        if skeleton.is_same(&self.shown.skeleton_rig.skeleton)
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
                after.arm.facing = self.document.arm.facing;
            }
        }
        let goes_along = is_transported(after) && self.overrides.contains_key(&Channel::Twist);
        if goes_along || is_keyed(&Channel::Twist) {
            let rest = self.document.arm.measured_from(after.arm.twist_reference);
            after.arm.twist = rest.twist;
            after.arm.transported = rest.transported;
        }
        if is_keyed(&Channel::Wrist) {
            let Arm { wrist, .. } = self.document.arm;
            let space = after.arm.wrist.space;
            after.arm.wrist.angles = wrist.measured_in(space, &self.document.arm.pose()).angles;
        }
    }

    pub(super) fn state(&self) -> State {
        let Self { document, overrides, playback, revision, content, .. } = self;
        State::new(document, overrides, playback.time, *revision, *content)
    }

    /// Makes a step of what has changed since, if anything has.
    pub(super) fn remember(&mut self, name: &'static str, before: State) {
        if before.differs_from(&self.document) {
            self.newest_revision += 1;
            self.revision = self.newest_revision;
            if before.differs_in_content_from(&self.document) {
                self.content = self.newest_revision;
            }
        } else {
            // Zeros may have changed their signs: the same revision is the same to the last bit.
            self.document = before.document(&self.document);
            if before.overrides_at(self.playback.time) == self.overrides {
                return;
            }
        }
        self.history.push(name, before);
    }

    pub(super) fn restore(&mut self, state: &State) {
        let document = state.document(&self.document);
        if is_rebuilt(self.document.skeleton(), document.skeleton()) {
            // They name joints by their places.
            self.selection.clear();
            self.forget_selected_keys();
            self.solver_run = None;
        }
        self.document = document;
        self.overrides = state.overrides_at(self.playback.time);
        self.revision = state.revision;
        self.content = state.content;
        self.refresh();
        self.forget_trail();
    }

    /// Does something that makes a step, unless it is part of a larger one.
    pub(super) fn step_by<T>(&mut self, name: &'static str, act: impl FnOnce(&mut Self) -> T) -> T {
        if let Some(edit) = &mut self.edit {
            edit.name = Some(name);
            return act(self);
        }
        self.end_run();
        let before = self.state();
        let value = act(self);
        if self.edit.is_none() {
            self.remember(name, before);
            self.begin_run();
        }
        value
    }

    pub(super) fn begin_edit(&mut self, drag: Option<Drag>) {
        if self.edit.is_none() {
            self.end_run();
            let (before, shown) = (self.state(), self.shown.clone());
            self.edit = Some(Transaction { before, shown, name: None, drag });
        }
    }

    pub(super) fn commit_edit(&mut self) {
        if let Some(edit) = self.edit.take() {
            self.remember(edit.name.unwrap_or(edit_label::CHANGE), edit.before);
            self.begin_run();
        }
    }

    pub(super) fn cancel_edit(&mut self) {
        if let Some(edit) = self.edit.take() {
            self.restore(&edit.before);
            self.begin_run();
            self.say("Cancelled");
        }
    }

    /// A change that is not finished is taken back first.
    pub(super) fn undo(&mut self) {
        if self.edit.is_some() {
            return self.cancel_edit();
        }
        if self.run_before.is_some() {
            return self.cancel_run();
        }
        let now = self.state();
        match self.history.undo(now) {
            Some((name, state)) => {
                self.restore(&state);
                self.say(format!("Undid {name}"));
            }
            None => self.say("There is nothing to undo"),
        }
    }

    pub(super) fn redo(&mut self) {
        self.commit_edit();
        self.stop_run();
        let now = self.state();
        match self.history.redo(now) {
            Some((name, state)) => {
                self.restore(&state);
                self.say(format!("Redid {name}"));
            }
            None => self.say("There is nothing to redo"),
        }
    }

    /// What Undo would take back, as in "Undo move hand".
    pub fn undo_name(&self) -> Option<&'static str> {
        match (&self.edit, &self.run_before) {
            (Some(edit), _) => Some(edit.name.unwrap_or(edit_label::CHANGE)),
            (None, Some(_)) => Some(edit_label::SOLVE),
            (None, None) => self.history.undo_name(),
        }
    }

    /// What Redo would do again.
    pub fn redo_name(&self) -> Option<&'static str> {
        self.history.redo_name()
    }

    /// Whether a change is under way, a user's or a solver's.
    pub fn is_changing(&self) -> bool {
        self.edit.is_some() || self.run_before.is_some()
    }

    /// Whether the document differs from what was saved last, or opened, in more than how it is
    /// looked at: which rig and which layers are shown.
    pub fn is_unsaved(&self) -> bool {
        let changing = self.edit.as_ref().map(|edit| &edit.before).or(self.run_before.as_ref());
        self.content != self.saved_content
            || changing.is_some_and(|before| before.differs_in_content_from(&self.document))
    }
}

/// Whether the arm's elbow is carried along by a hand that has keys, and has none itself.
fn is_transported(document: &Document) -> bool {
    let Document { arm, keys, .. } = document;
    let leads = if arm.is_pinned() { Channel::Pin } else { Channel::Hand };
    arm.twist_reference == TwistReferenceKind::Transport
        && keys.has(leads)
        && !keys.has(Channel::Twist)
}

/// Whether joints have gone, been hung from others or changed their places.
fn is_rebuilt(before: &Skeleton, after: &Skeleton) -> bool {
    let [before, after] = [before, after].map(Skeleton::joints);
    let keep_their_parents = before.iter().zip(after).all(|(a, b)| a.parent == b.parent);
    !keep_their_parents || after.len() < before.len()
}
