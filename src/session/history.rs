use std::collections::{BTreeMap, VecDeque};

use glam::Vec3;

use crate::document::{Channel, Document};
use crate::kinematics::Shared;
use crate::kinematics::skeleton::Joint;

/// Values that keyed channels have against their keys, until the time changes.
pub(super) type Overrides = BTreeMap<Channel, Vec3>;

/// All that an undo restores: a document and its unkeyed edits. It shares with the documents before and
/// after it what they have in common.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Snapshot {
    document: Document,
    overrides: Overrides,
    /// When the overrides were made.
    time: f64,
    /// Which document it is: the same number, the same document.
    pub revision: u64,
    /// The same number, the same document but for how it is looked at.
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

    /// Its document, with the cameras of the one that is open.
    pub fn document(&self, open: &Document) -> Document {
        let mut document = Document {
            rig: open.rig,
            camera: open.camera,
            other_rig_camera: open.other_rig_camera,
            ..self.document.clone()
        };
        document.show(self.document.rig);
        document
    }

    /// Whether its document is another one, cameras aside.
    pub fn differs_from(&self, document: &Document) -> bool {
        self.document.rig != document.rig
            || self.document.display != document.display
            || self.differs_in_content_from(document)
    }

    /// Whether its document is another one in more than how it is looked at.
    pub fn differs_in_content_from(&self, other: &Document) -> bool {
        let Document { arm, skeleton_rig, keys, timeline, metres_per_unit, .. } = &self.document;
        *arm != other.arm
            || *skeleton_rig != other.skeleton_rig
            || *keys != other.keys
            || *timeline != other.timeline
            || *metres_per_unit != other.metres_per_unit
    }

    /// The overrides that are left at a time: at another one than theirs none.
    pub fn overrides_at(&self, time: f64) -> Overrides {
        if self.time == time { self.overrides.clone() } else { Overrides::default() }
    }

    /// Whether it looks as another one does at that one's time: what was only seen at another time is
    /// gone.
    fn looks_like(&self, now: &Self) -> bool {
        self.revision == now.revision && self.overrides_at(now.time) == now.overrides
    }

    /// About how many bytes it takes that `other` does not share.
    fn unshared_bytes(&self, other: Option<&Self>) -> usize {
        let Document { skeleton_rig, keys, .. } = &self.document;
        let other = other.map(|other| &other.document);
        let skeleton = &skeleton_rig.skeleton;
        let is_shared = other.is_some_and(|other| skeleton.is_same(&other.skeleton_rig.skeleton));
        let joints = if is_shared { &[] } else { skeleton.joints() };
        let theirs = other.map_or(&[][..], |other| other.skeleton().joints());
        let is_own = |(index, joint): &(usize, &Shared<Joint>)| {
            !theirs.get(*index).is_some_and(|theirs| theirs.is_same(joint))
        };
        let own = joints.iter().enumerate().filter(is_own);
        let own_joints = own.map(|(_, joint)| size_of::<Joint>() + joint.name.len()).sum::<usize>();
        size_of::<Self>()
            + size_of_val(joints)
            + own_joints
            + size_of_val(&*skeleton_rig.targets)
            + self.overrides.len() * size_of::<(Channel, Vec3)>()
            + keys.unshared_bytes(other.map(|other| &other.keys))
    }
}

/// What can be undone and done again. The oldest steps are forgotten when there are too many.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct History {
    undo: VecDeque<UndoStep>,
    redo: Vec<UndoStep>,
}

/// A change, and how everything was on its other side.
#[derive(Clone, Debug, PartialEq)]
struct UndoStep {
    name: &'static str,
    state: Snapshot,
    /// What it takes beside the step before it.
    bytes: usize,
}

impl History {
    const MOST_STEPS: usize = 1000;
    const MOST_BYTES: usize = 256 << 20;

    /// Notes how everything was before a change.
    pub fn push(&mut self, name: &'static str, before: Snapshot) {
        self.redo.clear();
        self.push_undo(name, before);
        while self.undo.len() > Self::MOST_STEPS || self.bytes() > Self::MOST_BYTES {
            self.forget_oldest();
        }
    }

    fn push_undo(&mut self, name: &'static str, state: Snapshot) {
        let bytes = state.unshared_bytes(self.undo.back().map(|step| &step.state));
        self.undo.push_back(UndoStep { name, state, bytes });
    }

    /// What the oldest step shared with the next one is the next one's alone.
    fn forget_oldest(&mut self) {
        self.undo.pop_front();
        if let Some(oldest) = self.undo.front_mut() {
            oldest.bytes = oldest.state.unshared_bytes(None);
        }
    }

    /// What Undo would take back.
    pub fn undo_label(&self) -> Option<&'static str> {
        self.undo.back().map(|step| step.name)
    }

    /// What Redo would do again.
    pub fn redo_label(&self) -> Option<&'static str> {
        self.redo.last().map(|step| step.name)
    }

    /// Goes a step back from `now`: its name, and how everything was.
    pub fn undo(&mut self, now: Snapshot) -> Option<(&'static str, Snapshot)> {
        loop {
            let UndoStep { name, state, .. } = self.undo.pop_back()?;
            if !state.looks_like(&now) {
                self.redo.push(UndoStep { name, state: now, bytes: 0 });
                return Some((name, state));
            }
        }
    }

    /// Goes a step forward from `now`.
    pub fn redo(&mut self, now: Snapshot) -> Option<(&'static str, Snapshot)> {
        loop {
            let UndoStep { name, state, .. } = self.redo.pop()?;
            if !state.looks_like(&now) {
                self.push_undo(name, now);
                return Some((name, state));
            }
        }
    }

    fn bytes(&self) -> usize {
        self.undo.iter().map(|step| step.bytes).sum()
    }
}
