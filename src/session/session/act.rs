use super::{ASPECT, Session};
use crate::document::{Channel, Document};
use crate::kinematics::skeleton::JointId;
use crate::rig::LimbFrames;
use crate::session::dialog::Message;
use crate::session::drag::grip::{Drag, Dragged, Grip};
use crate::session::history::steps::{Snapshot, TreeChange};
use crate::session::limb::ShownLimb;
use crate::session::outcome::{Consequence, Effect, Outcome};
use crate::session::pops::CursorMove;
use crate::session::preferences::PanelTab;
use crate::session::solver::run::SolverInputs;
use crate::session::solver::solvers::SolverAction;
use crate::session::{Action, Edit};

/// Minimum distance between waypoints of a dragged head, in cells of the grid.
const WAYPOINT_SPACING: f32 = 0.02;

impl Session {
    /// Applies an action and returns the effect that the program must carry out, if any. An invalid
    /// action changes nothing and is reported by
    /// [`Shell::message`](crate::session::Shell::message); an action that would lose unsaved
    /// changes opens a dialog first.
    pub fn apply(&mut self, action: impl Into<Action>) -> Option<Effect> {
        let compared = self.shown().compares_skinning();
        let effect = self.apply_to_part(action.into());
        if self.shown().compares_skinning() && !compared {
            self.act(Consequence::ShowTab(PanelTab::Skin));
        }
        self.watch_tour();
        effect
    }

    fn apply_to_part(&mut self, action: Action) -> Option<Effect> {
        let document = self.editing.document();
        let outcome = match action {
            Action::Edit(edit) => {
                self.edit(edit);
                return None;
            }
            Action::File(action) => return self.apply_file(action),
            Action::Bake(action) => action.apply(self),
            Action::Inspect(action) => {
                self.editing.use_threads();
                self.inspections.apply(action)
            }
            Action::Reach(action) => self.reach_regions.apply(action),
            Action::Tour(action) => {
                self.apply_tour(action);
                return None;
            }
            Action::Transaction(action) => action.apply(self),
            Action::Select(action) => {
                let joints = self.evaluated.skeleton_pose().len();
                self.selection.apply(action, document, joints)
            }
            Action::View(action) => self.view.apply(action, document.camera, self.preferences),
            Action::Playback(action) => self.playback.apply(action, &document.timeline),
            Action::Solver(action) => self.apply_to_solvers(action),
            Action::Shell(action) => action.apply(self.evaluated.limb(), self.preferences),
        };
        self.act(outcome)
    }

    fn apply_to_solvers(&mut self, action: SolverAction) -> Outcome {
        self.solvers.apply(action, self.editing.posed(), self.preferences.runs_from_fk)
    }

    /// Applies an edit as an undo step of its own, or as part of the open transaction.
    pub(in crate::session) fn edit(&mut self, edit: impl Into<Edit>) {
        let edit = edit.into();
        let label = edit.label(self);
        let is_part = self.editing.label_transaction(label);
        let before = (!is_part).then(|| self.editing.state(self.playback.time()));
        let outcome = edit.apply(self);
        self.act(outcome);
        if let Some(before) = before.filter(|_| !self.editing.is_editing()) {
            self.editing.remember(label, before, self.playback.time());
        }
    }

    /// Changes the open drag; returns the grip and where it is now, or `None` if nothing is
    /// dragged.
    pub(in crate::session) fn change_drag(
        &mut self,
        change: impl FnOnce(&mut Drag),
    ) -> Option<(Grip, Dragged)> {
        let spacing = self.shown().grid_cell() * WAYPOINT_SPACING;
        let drag = self.editing.drag_mut()?;
        change(drag);
        Some((drag.grip(), drag.dragged(spacing)))
    }
}

/// Consequences of actions.
impl Session {
    /// Acts on an outcome; returns the effect that the program must carry out, if any.
    pub(in crate::session) fn act(&mut self, outcome: impl Into<Outcome>) -> Option<Effect> {
        let mut effect = None;
        for one in outcome.into() {
            effect = self.act_on(one).or(effect);
        }
        effect
    }

    fn act_on(&mut self, one: Consequence) -> Option<Effect> {
        match one {
            Consequence::Program(effect) => return Some(effect),
            Consequence::File(action) => return self.apply_file(*action),
            Consequence::ConfirmedFile(action) => return self.apply_confirmed_file(*action),
            Consequence::Open(opening) => self.open(*opening),
            Consequence::MarkSaved(true) => self.editing.mark_saved(),
            Consequence::MarkSaved(false) => self.editing.mark_unsaved(),
            Consequence::TakeZAsUp => self.files.take_z_as_up(),

            Consequence::Message(message) => self.shell.set_message(message),
            Consequence::SayIfLimbMoved(joint, from) => self.say_if_limb_moved(joint, &from),
            Consequence::OpenDialog(dialog) => self.open_dialog(*dialog),
            Consequence::ShowDialog(dialog) => self.shell.open_dialog(*dialog),
            Consequence::CloseDialog => self.close_dialog(),
            Consequence::TakeDialog => drop(self.shell.take_dialog()),
            Consequence::SetChoosing(choosing) => self.shell.set_choosing(choosing),
            Consequence::Prefer(preferences) => self.preferences = preferences,
            Consequence::ShowTab(tab) => self.preferences.tab = tab,

            Consequence::Write(after) => self.write(*after),
            Consequence::ResetPosture => self.editing.reset_posture(),
            Consequence::ChoosePosture(posture) => self.editing.choose_posture(posture),
            Consequence::LimitDrag(limit) => self.editing.limit_drag(*limit),
            Consequence::Refresh => self.refresh(),
            Consequence::DiscardUnkeyed => self.editing.clear_overrides(),
            Consequence::ForgetUnkeyed(channels) => {
                channels.into_iter().for_each(|channel| self.editing.forget_override(channel));
            }
            Consequence::ForgetLikeKeys(channel) => self.forget_like_keys(channel),
            Consequence::RestartKeysFrom(keys) => self.editing.restart_keys_from(*keys),
            Consequence::Begin(drag) => self.begin(drag.map(|drag| *drag)),
            Consequence::Commit => self.commit(),
            Consequence::Cancel => self.cancel(),
            Consequence::Undo => self.undo(),
            Consequence::Redo => self.redo(),
            Consequence::Press => self.view.stop_glide(),
            Consequence::FollowMouse(follows) => self.follow_mouse(follows),
            Consequence::Lead(ray) => self.editing.lead_heads(ray),

            Consequence::Select(joints) => self.select(joints),
            Consequence::Hover(joint) => {
                self.selection.hover(joint, self.evaluated.skeleton_pose().len());
            }
            Consequence::SelectKeys(keys) => self.selection.set_keys(keys),
            Consequence::RemapKeys(moved, before) => {
                self.selection.remap(&moved, before);
                self.selection.retain_keys(self.editing.document());
            }
            Consequence::Wiggle(wiggled) => self.view.set_wiggle(wiggled),

            Consequence::SetTime(time) => self.set_time(time),
            Consequence::SetPlaying(playing) => self.playback.start(playing),
            Consequence::Play => return self.play(),
            Consequence::Advance(seconds) => self.advance(seconds),
            Consequence::ForgetPause if self.playback.is_playing() => {}
            Consequence::ForgetPause => self.playback.forget_last_frame(),

            Consequence::SetCamera(camera) => self.set_camera(camera),
            Consequence::GlideTo(camera) => self.glide_to(camera),
            Consequence::FrameAll => self.glide_to(self.framing_all()),
            Consequence::Frame(centre, radius) => {
                self.set_camera(self.settled_camera().framing(centre, radius, ASPECT));
            }
            Consequence::KeepInView => self.keep_in_view(),
            Consequence::CentreFollowed => self.centre_followed(),
            Consequence::EndGlide => self.end_glide(),
            Consequence::ResetCrowd => self.view.reset_crowd(),
            Consequence::ResetTransport => self.evaluated.reset_transport(),
            Consequence::LookInside => {
                let look = SolverAction::ShowPart { iteration: 1, part: Some(0) };
                for action in [SolverAction::Step, look] {
                    let outcome = self.apply_to_solvers(action);
                    self.act(outcome);
                }
            }
            Consequence::EndSolvers => self.solvers.end(),
        }
        None
    }
}

/// Changes of the document.
impl Session {
    /// Evaluates the document at the playhead and updates all that depends on it.
    pub(super) fn refresh(&mut self) {
        self.editing.evaluate(self.playback.time());
        self.follow_document();
    }

    /// Updates all that depends on the evaluated document.
    fn follow_document(&mut self) {
        let cause = match self.editing.revision_before() {
            Some(revision) => CursorMove::Dragged(revision),
            None if self.playback.is_playing() => CursorMove::Played,
            None => CursorMove::Set,
        };
        self.evaluated.update(self.editing.posed());
        self.selection.retain_joints(self.evaluated.skeleton_pose().len());
        self.follow_limb(cause);
        self.update_solvers();
        self.selection.retain_keys(self.editing.document());
    }

    /// Updates the limb that pages and guides are about.
    fn follow_limb(&mut self, cause: CursorMove) {
        let limb = ShownLimb::new(self.editing.posed(), self.selection.active());
        self.evaluated.follow_limb(limb, cause, self.editing.posed().time());
    }

    /// Makes the solver run and the comparison anew if what they solve has changed.
    fn update_solvers(&mut self) {
        if self.solvers.is_idle() {
            return;
        }
        let inputs = SolverInputs::of(self.posed(), self.preferences.runs_from_fk).ok();
        if let Err(error) = self.solvers.follow(inputs) {
            self.act(Outcome::fail(error.to_string()));
        }
    }

    /// Replaces the shown document and updates all that depends on it.
    pub(super) fn write(&mut self, after: Document) {
        let had_keys = !self.document().keys.is_empty();
        let Some(change) = self.editing.write(after, &self.playback) else { return };
        self.playback.follow_keys(had_keys, !self.document().keys.is_empty());
        if change.has_auto_keyed {
            self.playback.has_auto_keyed();
        }
        if change.has_overridden {
            let text = "Unkeyed change: press K or it is lost when the time changes";
            self.shell.set_message(Some(Message::of_moment(text)));
        }
        self.follow_document();
        self.evaluated.forget_trail();
    }

    fn forget_like_keys(&mut self, channel: Channel) {
        if self.editing.forget_like_keys(channel, self.playback.time()) {
            self.shell.set_message(None);
            self.refresh();
        }
    }

    fn say_if_limb_moved(&mut self, joint: JointId, from: &LimbFrames) {
        const MOVED: f32 = 1e-3;
        let Some(limb) = self.posed().limb_frames(joint) else { return };
        let (pose, before) = (limb.pose(), from.pose());
        let moved = pose.elbow.distance(before.elbow).max(pose.hand.distance(before.hand));
        if moved > MOVED * limb.bones().outer_limit() {
            self.act(Outcome::say("The limb moved: its soft limits exclude the pose"));
        }
    }

    /// Restores a state. The playhead moves only to where unkeyed edits come back or go.
    fn restore(&mut self, state: &Snapshot) {
        let has_overrides = !state.overrides().is_empty() || self.editing.has_overrides();
        if has_overrides && self.playback.set_time(state.time) {
            self.playback.start(false);
        }
        let had_keys = !self.document().keys.is_empty();
        let change = self.editing.restore(state);
        self.playback.follow_keys(had_keys, !self.document().keys.is_empty());
        match change {
            TreeChange::Kept => {}
            TreeChange::Shortened { parent } => {
                let count = self.editing.document().skeleton().joints().len();
                self.selection.shorten(count, parent);
            }
            TreeChange::Rebuilt => self.selection.forget_joints(),
        }
        self.refresh();
        self.evaluated.forget_trail();
    }

    pub(super) fn begin(&mut self, drag: Option<Drag>) {
        if !self.editing.is_editing() {
            self.editing.begin(drag, self.playback.time());
        }
    }

    pub(super) fn commit(&mut self) {
        self.editing.commit(self.playback.time());
    }

    fn cancel(&mut self) {
        if let Some(before) = self.editing.take_transaction() {
            // Playback goes on unless the transaction discarded earlier unkeyed edits.
            self.editing.clear_overrides();
            self.restore(&before);
            self.act(Outcome::say("Cancelled"));
        }
    }

    /// Undoes a step; if a transaction is open, cancels it instead.
    fn undo(&mut self) {
        if self.editing.is_editing() {
            return self.cancel();
        }
        let undone = self.editing.undo(self.playback.time());
        self.restore_step("Undid", "There is nothing to undo", undone);
    }

    fn redo(&mut self) {
        self.commit();
        let redone = self.editing.redo(self.playback.time());
        self.restore_step("Redid", "There is nothing to redo", redone);
    }

    fn restore_step(&mut self, done: &str, none: &str, step: Option<(&'static str, Snapshot)>) {
        let said = match step {
            Some((label, state)) => {
                self.restore(&state);
                format!("{done} {label}")
            }
            None => none.to_owned(),
        };
        self.act(Outcome::say(said));
    }
}

/// Selection.
impl Session {
    fn select(&mut self, joints: Vec<JointId>) {
        self.selection.select(joints, self.evaluated.skeleton_pose().len());
        self.follow_limb(CursorMove::Set);
        self.evaluated.forget_trail();
    }
}
