use std::collections::VecDeque;

use super::snapshot::Snapshot;

/// Steps to undo and redo. The oldest steps are dropped beyond `MAX_STEPS` or `MAX_BYTES`.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct History {
    undo: VecDeque<UndoStep>,
    redo: Vec<UndoStep>,
}

/// A step to undo with the state before it, or a step to redo with the state after it.
#[derive(Clone, Debug, PartialEq)]
struct UndoStep {
    label: &'static str,
    state: Snapshot,
    /// Approximate number of bytes that the state does not share with the state of the step before.
    bytes: usize,
}

impl History {
    const MAX_STEPS: usize = 1000;
    const MAX_BYTES: usize = 256 << 20;

    /// Adds a step to undo, with the state before it, and drops the steps to redo.
    pub fn push(&mut self, label: &'static str, before: Snapshot) {
        self.redo.clear();
        self.push_undo(label, before);
        while self.undo.len() > Self::MAX_STEPS || self.bytes() > Self::MAX_BYTES {
            self.drop_oldest();
        }
    }

    fn push_undo(&mut self, label: &'static str, state: Snapshot) {
        let bytes = state.unshared_bytes(self.undo.back().map(|step| &step.state));
        self.undo.push_back(UndoStep { label, state, bytes });
    }

    /// Drops the oldest step. Memory that it shared with the next step then counts for the next
    /// step.
    fn drop_oldest(&mut self) {
        self.undo.pop_front();
        if let Some(oldest) = self.undo.front_mut() {
            oldest.bytes = oldest.state.unshared_bytes(None);
        }
    }

    /// Label of the step that [`Self::undo`] undoes.
    pub fn undo_label(&self) -> Option<&'static str> {
        self.undo.back().map(|step| step.label)
    }

    /// Label of the step that [`Self::redo`] redoes.
    pub fn redo_label(&self) -> Option<&'static str> {
        self.redo.last().map(|step| step.label)
    }

    /// Undoes a step and keeps the state `now` for redoing it; returns the step's label and the
    /// state before it. Skips steps that change nothing; `None` if no other step is left.
    pub fn undo(&mut self, now: Snapshot) -> Option<(&'static str, Snapshot)> {
        loop {
            let UndoStep { label, state, .. } = self.undo.pop_back()?;
            if !state.is_restored_in(&now) {
                self.redo.push(UndoStep { label, state: now, bytes: 0 });
                return Some((label, state));
            }
        }
    }

    /// Redoes a step and keeps the state `now` for undoing it; returns the step's label and the
    /// state after it. Skips steps that change nothing; `None` if no other step is left.
    pub fn redo(&mut self, now: Snapshot) -> Option<(&'static str, Snapshot)> {
        loop {
            let UndoStep { label, state, .. } = self.redo.pop()?;
            if !state.is_restored_in(&now) {
                self.push_undo(label, now);
                return Some((label, state));
            }
        }
    }

    fn bytes(&self) -> usize {
        self.undo.iter().map(|step| step.bytes).sum()
    }
}
