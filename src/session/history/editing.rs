mod write;

use super::steps::{History, Overrides, Snapshot, TreeChange};
use crate::document::{Camera, Channel, Document, Posed, Ray, Track};
use crate::kinematics::Shared;
use crate::kinematics::angle::wrapped;
use crate::rig::Posture;
use crate::session::drag::follow_mouse::FollowMouse;
use crate::session::drag::grip::{Drag, DragLimit};
use crate::session::drag::point::PointDrag;

/// Label of a transaction without edits.
const CHANGE: &str = "Change";
/// Label of the undo step by which a move of the playhead discards unkeyed edits.
const DISCARD: &str = "Discard unkeyed change";

/// The document, its values at the playhead, the open transaction and the history.
#[derive(Clone, Debug, PartialEq)]
pub struct Editing {
    document: Document,
    track: Track,
    /// The track with unkeyed edits as keys at the playhead.
    shown_track: Track,
    /// True if threads compute motions, so that a pose may be provisional until its own is known.
    has_threads: bool,
    /// The last track whose pose at the playhead was known.
    known_track: Track,
    /// The document posed at the playhead, with unkeyed edits.
    posed: Posed,
    /// The posture of the next change of the document.
    next_posture: NextPosture,
    /// Unkeyed edits, discarded when the time changes.
    overrides: Overrides,
    transaction: Option<Transaction>,
    history: History,
    /// Revision of the document: documents with the same revision differ at most in their cameras.
    revision: u64,
    newest_revision: u64,
    /// The revision with which the document was opened.
    first_revision: u64,
    /// Revision of the document's content: documents with the same one differ at most in their
    /// cameras and overlays.
    content: u64,
    saved_content: u64,
}

/// The posture with which the motion begins after a change of the document.
#[derive(Clone, Debug, Default, PartialEq)]
enum NextPosture {
    /// One with which the motion continues from the present pose.
    #[default]
    Continued,
    /// None: the motion begins with the FK pose.
    Reset,
    /// This one.
    Chosen(Option<Shared<Posture>>),
}

/// Edits between press and release that become one undo step.
#[derive(Clone, Debug, PartialEq)]
struct Transaction {
    /// The state that cancelling restores.
    before: Snapshot,
    /// The document from which drags start: as shown before the transaction, with later changes
    /// that a drag does not revert.
    shown: Document,
    /// The pose before the transaction.
    posed: Posed,
    /// The label of the latest edit; `None` before the first edit.
    label: Option<&'static str>,
    drag: Option<Drag>,
    /// Heads that follow the mouse.
    follow_mouse: Option<FollowMouse>,
}

impl Editing {
    pub(in crate::session) fn new(document: Document) -> Self {
        let track = Track::new(&document);
        Self {
            posed: track.pose(document.clone(), 0.0),
            shown_track: track.clone(),
            has_threads: false,
            known_track: track.clone(),
            track,
            next_posture: NextPosture::default(),
            document,
            overrides: Overrides::default(),
            transaction: None,
            history: History::default(),
            revision: 0,
            newest_revision: 0,
            first_revision: 0,
            content: 0,
            saved_content: 0,
        }
    }

    /// Editing of another document, with an empty history and a new revision.
    pub(in crate::session) fn replaced(&self, document: Document) -> Self {
        let revision = self.newest_revision + 1;
        Self {
            revision,
            newest_revision: revision,
            first_revision: revision,
            content: revision,
            saved_content: revision,
            has_threads: self.has_threads,
            ..Self::new(document)
        }
    }

    pub(in crate::session) fn document(&self) -> &Document {
        &self.document
    }

    pub(in crate::session) fn track(&self) -> &Track {
        &self.track
    }

    pub(in crate::session) fn posed(&self) -> &Posed {
        &self.posed
    }

    pub(in crate::session) fn shown(&self) -> &Document {
        self.posed.document()
    }

    /// True if the channel has an unkeyed edit.
    pub fn is_overridden(&self, channel: Channel) -> bool {
        self.overrides.contains_key(&channel)
    }

    pub(in crate::session) fn has_overrides(&self) -> bool {
        !self.overrides.is_empty()
    }

    /// Channels with unkeyed edits.
    pub(in crate::session) fn overridden_channels(&self) -> impl Iterator<Item = Channel> {
        self.overrides.keys().copied()
    }

    /// Number of the document's state: equal numbers mean equal documents, except for their
    /// cameras.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// The revision with which the document was opened: another number for each opened document.
    pub fn first_revision(&self) -> u64 {
        self.first_revision
    }

    /// True if a transaction is open.
    pub fn is_editing(&self) -> bool {
        self.transaction.is_some()
    }

    /// The revision before the open transaction; `None` if none is open.
    pub(in crate::session) fn revision_before(&self) -> Option<u64> {
        Some(self.transaction.as_ref()?.before.revision)
    }

    /// The document as shown before the open transaction, or as shown now if none is open.
    pub(in crate::session) fn shown_before(&self) -> &Document {
        self.transaction.as_ref().map_or(self.shown(), |transaction| &transaction.shown)
    }

    /// Unit of sliders of lengths, a hundredth of a cell of the grid, frozen during a drag so that
    /// ranges do not move under the mouse.
    pub fn unit(&self) -> f32 {
        self.shown_before().grid_cell() * 0.01
    }

    /// The pose from which a drag starts: as shown before the open transaction, or as shown now if
    /// none is open.
    pub(in crate::session) fn posed_before(&self) -> Posed {
        match &self.transaction {
            Some(transaction) => {
                self.shown_track.pose(transaction.shown.clone(), self.posed.time())
            }
            None => self.posed.clone(),
        }
    }

    /// The pose at the press, as shown before the open transaction; as shown now if none is open.
    pub(in crate::session) fn pressed_pose(&self) -> &Posed {
        self.transaction.as_ref().map_or(&self.posed, |transaction| &transaction.posed)
    }

    /// The drag in the viewport; `None` if nothing is dragged.
    pub fn drag(&self) -> Option<&Drag> {
        self.transaction.as_ref()?.drag.as_ref()
    }

    /// The drag of a point in the viewport; `None` if no point is dragged.
    pub fn point_drag(&self) -> Option<&PointDrag> {
        self.drag()?.point()
    }

    /// Labels the open transaction by its drag and returns that; `None` if nothing is dragged.
    pub(in crate::session) fn drag_mut(&mut self) -> Option<&mut Drag> {
        let transaction = self.transaction.as_mut()?;
        let drag = transaction.drag.as_mut()?;
        transaction.label = Some(drag.grip().label());
        Some(drag)
    }

    /// True if heads follow the mouse.
    pub fn follows_mouse(&self) -> bool {
        self.following().is_some()
    }

    fn following(&self) -> Option<&FollowMouse> {
        self.transaction.as_ref()?.follow_mouse.as_ref()
    }

    /// Lets the heads follow the mouse that targets move, in the open transaction.
    pub(in crate::session) fn follow_mouse(&mut self) {
        if let Some(transaction) = &mut self.transaction {
            transaction.label = Some(FollowMouse::LABEL);
            transaction.follow_mouse = FollowMouse::new(&self.posed);
        }
    }

    /// Moves the mouse that heads follow to a ray in world space.
    pub(in crate::session) fn lead_heads(&mut self, ray: Ray) {
        let transaction = self.transaction.as_mut();
        if let Some(follow) = transaction.and_then(|it| it.follow_mouse.as_mut()) {
            follow.lead(ray, &self.posed);
        }
    }

    /// The shown document with keys of the heads that follow the mouse, `passed` seconds after
    /// `before`; `None` if none do.
    pub(in crate::session) fn recorded(&self, before: f64, passed: f64) -> Option<Document> {
        Some(self.following()?.recorded(&self.posed, before, passed))
    }

    /// Label of the step that Undo undoes; `None` if there is none.
    pub fn undo_label(&self) -> Option<&'static str> {
        match &self.transaction {
            Some(transaction) => Some(transaction.label.unwrap_or(CHANGE)),
            None => self.history.undo_label(),
        }
    }

    /// Label of the step that Redo redoes; `None` if there is none.
    pub fn redo_label(&self) -> Option<&'static str> {
        self.history.redo_label()
    }

    /// True if the document differs from the saved one in more than camera and overlays.
    pub fn is_unsaved(&self) -> bool {
        let before = self.transaction.as_ref().map(|transaction| &transaction.before);
        self.content != self.saved_content
            || before.is_some_and(|before| before.differs_in_content_from(&self.document))
    }

    pub(in crate::session) fn mark_saved(&mut self) {
        self.saved_content = self.content;
    }

    pub(in crate::session) fn mark_unsaved(&mut self) {
        self.saved_content = self.content - 1;
    }

    pub(in crate::session) fn set_camera(&mut self, camera: Camera) {
        self.document.camera = camera;
        self.posed.set_camera(camera);
    }

    /// Removes a channel's unkeyed edit.
    pub(in crate::session) fn forget_override(&mut self, channel: Channel) {
        self.overrides.remove(&channel);
    }

    /// Removes an angle's unkeyed edit if its keys give the same angle at `time`, in seconds;
    /// returns whether they do.
    pub(in crate::session) fn forget_like_keys(&mut self, channel: Channel, time: f64) -> bool {
        const SAME: f32 = 1e-4;
        let angle = |document: &Document| channel.value(document).unwrap_or_default().x;
        let apart = wrapped(angle(self.document.at(time).document()) - angle(self.shown()) + SAME);
        let is_same = apart < 2.0 * SAME && self.document.keys.has(channel);
        if is_same {
            self.forget_override(channel);
        }
        is_same
    }

    pub(in crate::session) fn clear_overrides(&mut self) {
        self.overrides.clear();
    }

    /// Discards unkeyed edits that were made at `time`, in seconds, because the playhead moves to
    /// `now`; adds an undo step unless a transaction is open. Returns whether there were any.
    pub(in crate::session) fn discard_overrides(&mut self, time: f64, now: f64) -> bool {
        if self.overrides.is_empty() {
            return false;
        }
        let before = self.state(time);
        self.overrides.clear();
        if !self.is_editing() {
            self.remember(DISCARD, before, now);
        }
        true
    }

    /// Poses the document at `time`, in seconds, with the unkeyed edits.
    pub(in crate::session) fn evaluate(&mut self, time: f64) {
        self.track = self.track.updated(&self.document);
        self.shown_track = if self.overrides.is_empty() {
            self.track.clone()
        } else {
            self.shown_track.updated(&self.with_keyed_overrides(time))
        };
        let mut shown = self.track.at(time).into_document();
        for (channel, value) in &self.overrides {
            channel.set(&mut shown, *value);
        }
        self.posed = if !self.has_threads || self.shown_track.is_quick_at(time) {
            self.known_track = self.shown_track.clone();
            self.shown_track.pose(shown, time)
        } else {
            self.shown_track.pose_provisionally(shown, time, &self.known_track)
        };
    }

    /// Lets poses be provisional whose motion takes long to compute, since threads compute it.
    pub(in crate::session) fn use_threads(&mut self) {
        self.has_threads = true;
    }

    /// The document with the unkeyed edits as keys at `time`, in seconds.
    fn with_keyed_overrides(&self, time: f64) -> Document {
        let mut document = self.document.clone();
        for (channel, value) in &self.overrides {
            document.keys.insert_auto(*channel, time, *value);
        }
        document
    }

    /// Lets the motion begin with the FK pose after the next change of the document.
    pub(in crate::session) fn reset_posture(&mut self) {
        self.next_posture = NextPosture::Reset;
    }

    /// Lets the motion begin with this posture after the next change of the document.
    pub(in crate::session) fn choose_posture(&mut self, posture: Option<Shared<Posture>>) {
        self.next_posture = NextPosture::Chosen(posture);
    }

    /// Notes how the targets of the body limit the open drag.
    pub(in crate::session) fn limit_drag(&mut self, limit: DragLimit) {
        if let Some(drag) = self.transaction.as_mut().and_then(|it| it.drag.as_mut()) {
            drag.set_limit(limit);
        }
    }

    /// The present state, for undo; `time` is the playhead in seconds.
    pub(in crate::session) fn state(&self, time: f64) -> Snapshot {
        Snapshot::new(&self.document, &self.overrides, time, self.revision, self.content)
    }

    /// Adds an undo step if the document or the unkeyed edits have changed since `before`.
    pub(in crate::session) fn remember(
        &mut self,
        label: &'static str,
        before: Snapshot,
        time: f64,
    ) {
        if before.differs_from(&self.document) {
            self.newest_revision += 1;
            self.revision = self.newest_revision;
            if before.differs_in_content_from(&self.document) {
                self.content = self.newest_revision;
            }
        } else {
            // Signs of zeros may have changed, but documents with equal revisions are equal bit for
            // bit.
            self.document = before.document(&self.document);
            if before.is_restored_in(&self.state(time)) {
                return;
            }
        }
        self.history.push(label, before);
    }

    /// Restores a state; returns how the tree of joints has changed.
    pub(in crate::session) fn restore(&mut self, state: &Snapshot) -> TreeChange {
        let document = state.document(&self.document);
        let change = TreeChange::between(self.document.skeleton(), document.skeleton());
        self.document = document;
        self.overrides = state.overrides().clone();
        self.revision = state.revision;
        self.content = state.content;
        change
    }

    /// Labels the open transaction; returns whether one is open.
    pub(in crate::session) fn label_transaction(&mut self, label: &'static str) -> bool {
        let Some(transaction) = &mut self.transaction else { return false };
        transaction.label = Some(label);
        true
    }

    pub(in crate::session) fn begin(&mut self, drag: Option<Drag>, time: f64) {
        self.transaction = Some(Transaction {
            before: self.state(time),
            shown: self.shown().clone(),
            posed: self.posed.clone(),
            label: None,
            drag,
            follow_mouse: None,
        });
    }

    /// Closes the transaction, if one is open, with an undo step.
    pub(in crate::session) fn commit(&mut self, time: f64) {
        if let Some(transaction) = self.transaction.take() {
            let chooses_posture = transaction.drag.as_ref().is_some_and(|it| it.limit().is_some());
            if !chooses_posture && transaction.before.differs_in_motion_start_alone(&self.document)
            {
                // A drag that has returned leaves no posture.
                self.document = transaction.before.document(&self.document);
                self.evaluate(time);
            }
            // Not during a drag, which would stop for the time that it takes.
            self.document.rig.refresh_skin();
            self.track = self.track.updated(&self.document);
            self.posed.set_skin(self.document.rig.skin.clone());
            self.remember(transaction.label.unwrap_or(CHANGE), transaction.before, time);
        }
    }

    /// Closes the transaction and returns the state before it; `None` if none is open.
    pub(in crate::session) fn take_transaction(&mut self) -> Option<Snapshot> {
        Some(self.transaction.take()?.before)
    }

    /// Undoes a step; returns its label and the state before it, or `None` if there is nothing to
    /// undo.
    pub(in crate::session) fn undo(&mut self, time: f64) -> Option<(&'static str, Snapshot)> {
        self.history.undo(self.state(time))
    }

    /// Redoes a step; returns its label and the state after it, or `None` if there is nothing to
    /// redo.
    pub(in crate::session) fn redo(&mut self, time: f64) -> Option<(&'static str, Snapshot)> {
        self.history.redo(self.state(time))
    }
}
