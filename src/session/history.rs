use std::collections::{BTreeMap, VecDeque};
use std::sync::Arc;

use glam::Vec3;

use crate::document::{Arm, Channel, Display, Document, Keys, RigKind, SkeletonRig, Timeline};
use crate::kinematics::skeleton::Joint;
use crate::kinematics::spline::Knot;

/// Values that keyed channels have against their keys, until the time changes.
pub(super) type Overrides = BTreeMap<Channel, Vec3>;

/// All of a session that an undo brings back: the document without the view, and what is shown
/// against its keys. States beside each other in a history share what is the same.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct State {
    rig: RigKind,
    arm: Arm,
    skeleton: Arc<SkeletonRig>,
    keys: Arc<Keys>,
    timeline: Timeline,
    display: Display,
    metres: Option<f32>,
    overrides: Overrides,
    /// When the overrides were made.
    time: f64,
    /// Which document it is: the same number, the same document.
    pub revision: u64,
    /// The same number, the same document but for how it is looked at.
    pub content: u64,
}

impl State {
    pub fn new(
        document: &Document,
        overrides: &Overrides,
        time: f64,
        revision: u64,
        content: u64,
    ) -> Self {
        let Document { rig, arm, skeleton, keys, timeline, display, metres, .. } = document;
        Self {
            rig: *rig,
            arm: *arm,
            skeleton: Arc::new(skeleton.clone()),
            keys: Arc::new(keys.clone()),
            timeline: *timeline,
            display: *display,
            metres: *metres,
            overrides: overrides.clone(),
            time,
            revision,
            content,
        }
    }

    /// Its document, with the cameras of the one that is open.
    pub fn document(&self, open: &Document) -> Document {
        let mut document = Document {
            rig: open.rig,
            arm: self.arm,
            skeleton: SkeletonRig::clone(&self.skeleton),
            keys: Keys::clone(&self.keys),
            timeline: self.timeline,
            camera: open.camera,
            other_camera: open.other_camera,
            display: self.display,
            metres: self.metres,
        };
        document.show(self.rig);
        document
    }

    /// Whether its document is another one.
    pub fn differs_from(&self, document: &Document) -> bool {
        self.rig != document.rig
            || self.display != document.display
            || self.differs_in_content_from(document)
    }

    /// Whether its document is another one in more than how it is looked at.
    pub fn differs_in_content_from(&self, document: &Document) -> bool {
        let Document { arm, skeleton, keys, timeline, metres, .. } = document;
        self.arm != *arm
            || *self.skeleton != *skeleton
            || *self.keys != *keys
            || self.timeline != *timeline
            || self.metres != *metres
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

    fn share_with(&mut self, other: &Self) {
        if self.skeleton.is_identical(&other.skeleton) {
            self.skeleton = Arc::clone(&other.skeleton);
        }
        if self.keys.is_identical(&other.keys) {
            self.keys = Arc::clone(&other.keys);
        }
    }

    /// About how many bytes it takes that `other` does not take already.
    fn bytes_beside(&self, other: Option<&Self>) -> usize {
        let shares = |same: fn(&Self, &Self) -> bool| other.is_some_and(|other| same(self, other));
        let mut bytes = size_of::<Self>();
        if !shares(|a, b| Arc::ptr_eq(&a.skeleton, &b.skeleton)) {
            let names = |joint: &Joint| joint.name.len();
            let joints = self.skeleton.skeleton.joints();
            bytes += joints.iter().map(names).sum::<usize>() + size_of_val(joints);
        }
        if !shares(|a, b| Arc::ptr_eq(&a.keys, &b.keys)) {
            bytes += self.keys.count() * size_of::<Knot<Vec3>>();
        }
        bytes
    }
}

/// What can be undone and done again. The oldest steps are forgotten when there are too many.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct History {
    undo: VecDeque<Step>,
    redo: Vec<Step>,
}

/// A change, and how everything was on its other side.
#[derive(Clone, Debug, PartialEq)]
struct Step {
    name: &'static str,
    state: State,
}

impl History {
    const MOST_STEPS: usize = 1000;
    const MOST_BYTES: usize = 256 << 20;

    /// Notes how everything was before a change.
    pub fn push(&mut self, name: &'static str, mut before: State) {
        self.redo.clear();
        if let Some(last) = self.undo.back() {
            before.share_with(&last.state);
        }
        self.undo.push_back(Step { name, state: before });
        while self.undo.len() > Self::MOST_STEPS || self.bytes() > Self::MOST_BYTES {
            self.undo.pop_front();
        }
    }

    /// What Undo would take back.
    pub fn undo_name(&self) -> Option<&'static str> {
        self.undo.back().map(|step| step.name)
    }

    /// What Redo would do again.
    pub fn redo_name(&self) -> Option<&'static str> {
        self.redo.last().map(|step| step.name)
    }

    /// Goes a step back from `now`: its name, and how everything was.
    pub fn undo(&mut self, mut now: State) -> Option<(&'static str, State)> {
        loop {
            let Step { name, state } = self.undo.pop_back()?;
            if !state.looks_like(&now) {
                now.share_with(&state);
                self.redo.push(Step { name, state: now });
                return Some((name, state));
            }
        }
    }

    /// Goes a step forward from `now`.
    pub fn redo(&mut self, mut now: State) -> Option<(&'static str, State)> {
        loop {
            let Step { name, state } = self.redo.pop()?;
            if !state.looks_like(&now) {
                now.share_with(&state);
                self.undo.push_back(Step { name, state: now });
                return Some((name, state));
            }
        }
    }

    fn bytes(&self) -> usize {
        let before = std::iter::once(None).chain(self.undo.iter().map(Some));
        self.undo
            .iter()
            .zip(before)
            .map(|(step, before)| step.state.bytes_beside(before.map(|step| &step.state)))
            .sum()
    }
}
