use std::collections::{BTreeMap, VecDeque};

use glam::Vec3;

use crate::document::{Channel, Document};
use crate::kinematics::Shared;
use crate::kinematics::skeleton::{Joint, JointId, Skeleton};
use crate::rig::SkinSource;

/// Steps to undo and redo. The oldest steps are dropped beyond `MAX_STEPS` or `MAX_BYTES`.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::session) struct History {
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

/// Unkeyed edits: values of keyed channels that differ from their keys, until the time changes.
pub(in crate::session) type Overrides = BTreeMap<Channel, Vec3>;

/// All that undo restores: a document and its unkeyed edits. A snapshot shares memory with those
/// before and after it.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::session) struct Snapshot {
    document: Document,
    overrides: Overrides,
    /// The playhead, in seconds: the time at which the overrides were made.
    pub time: f64,
    /// Number of the document's state: equal numbers mean equal documents, except for their
    /// cameras.
    pub revision: u64,
    /// Number of the document's content: equal numbers mean documents that are equal except for
    /// their cameras and overlays.
    pub content: u64,
}

impl Snapshot {
    pub fn new(
        document: &Document,
        overrides: &Overrides,
        time: f64,
        revision: u64,
        content: u64,
    ) -> Self {
        let (document, overrides) = (document.clone(), overrides.clone());
        Self { document, overrides, time, revision, content }
    }

    /// The snapshot's document, with the camera of the `open` document.
    pub fn document(&self, open: &Document) -> Document {
        Document { camera: open.camera, ..self.document.clone() }
    }

    /// True if the snapshot's document differs from `document` in more than the camera.
    pub fn differs_from(&self, document: &Document) -> bool {
        self.document.display != document.display || self.differs_in_content_from(document)
    }

    /// True if the snapshot's document differs from `other` in more than camera and overlays.
    pub fn differs_in_content_from(&self, other: &Document) -> bool {
        let Document { rig, keys, timeline, track_start, metres_per_unit, .. } = &self.document;
        *rig != other.rig
            || *keys != other.keys
            || *timeline != other.timeline
            || *track_start != other.track_start
            || *metres_per_unit != other.metres_per_unit
    }

    /// True if the snapshot's document differs from `other` in nothing but the posture and the time
    /// with which a motion starts, and the camera.
    pub fn differs_in_motion_start_alone(&self, other: &Document) -> bool {
        let mut other = Document { track_start: self.document.track_start, ..other.clone() };
        other.rig.posture.clone_from(&self.document.rig.posture);
        !self.differs_from(&other)
    }

    pub fn overrides(&self) -> &Overrides {
        &self.overrides
    }

    /// True if restoring this state from `now` would change nothing.
    pub fn is_restored_in(&self, now: &Self) -> bool {
        let is_same_time = self.overrides.is_empty() || self.time == now.time;
        self.revision == now.revision && self.overrides == now.overrides && is_same_time
    }

    /// Approximate number of bytes that the snapshot does not share with `other`.
    pub fn unshared_bytes(&self, other: Option<&Self>) -> usize {
        let other = other.map(|other| &other.document);
        size_of::<Self>()
            + self.unshared_joint_bytes(other)
            + self.unshared_mesh_bytes(other)
            + size_of_val(&*self.document.rig.targets)
            + self.overrides.len() * size_of::<(Channel, Vec3)>()
            + self.document.keys.unshared_bytes(other.map(|other| &other.keys))
    }

    /// Bytes of the mesh of a skin from a file. That of a skin from bones is made again when it is
    /// needed.
    fn unshared_mesh_bytes(&self, other: Option<&Document>) -> usize {
        let mesh = |document: &Document| match &document.rig.skin.as_ref()?.source {
            SkinSource::Mesh(mesh) => mesh.unmorphed().ok().cloned(),
            SkinSource::Bones(_) => None,
        };
        let Some(own) = mesh(&self.document) else { return 0 };
        let is_shared = other.and_then(mesh).is_some_and(|theirs| own.is_same(&theirs));
        if is_shared { 0 } else { own.mesh.bytes() }
    }

    fn unshared_joint_bytes(&self, other: Option<&Document>) -> usize {
        let skeleton = &self.document.rig.skeleton;
        let theirs = other.map(|other| &other.rig.skeleton);
        if theirs.is_some_and(|theirs| skeleton.is_same(theirs)) {
            return 0;
        }
        let theirs = theirs.map_or(&[][..], |theirs| theirs.joints());
        let is_shared = |index: usize, joint: &Shared<Joint>| {
            theirs.get(index).is_some_and(|theirs| theirs.is_same(joint))
        };
        let joints = skeleton.joints();
        let own = joints.iter().enumerate().filter(|(index, joint)| !is_shared(*index, joint));
        let own = own.map(|(_, joint)| size_of::<Joint>() + joint.name.len());
        size_of_val(joints) + own.sum::<usize>()
    }
}

/// Change of a skeleton's tree of joints, as far as indices of joints depend on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::session) enum TreeChange {
    /// All joints have kept their indices; others may have been appended.
    Kept,
    /// The joints from an index on were removed; `parent` is that of the first of them.
    Shortened { parent: Option<JointId> },
    /// Joints were renumbered or attached to other parents.
    Rebuilt,
}

impl TreeChange {
    pub fn between(before: &Skeleton, after: &Skeleton) -> Self {
        let [before, after] = [before, after].map(Skeleton::joints);
        let keep_their_parents = before.iter().zip(after).all(|(a, b)| a.parent == b.parent);
        let keep_their_names = || before.iter().zip(after).all(|(a, b)| a.name == b.name);
        match before.get(after.len()) {
            None if keep_their_parents => Self::Kept,
            Some(removed) if keep_their_parents && keep_their_names() => {
                Self::Shortened { parent: removed.parent }
            }
            _ => Self::Rebuilt,
        }
    }
}
