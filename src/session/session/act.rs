use super::{ASPECT, Session};
use crate::document::{Document, RigKind};
use crate::kinematics::skeleton::JointId;
use crate::kinematics::two_bone::TwoBonePose;
use crate::session::arm::pops::CursorMove;
use crate::session::dialog::{Dialog, Message};
use crate::session::drag::grip::{Drag, Dragged, Grip};
use crate::session::files::action::{FileAction, PathDialog};
use crate::session::history::steps::{Snapshot, TreeChange};
use crate::session::outcome::{Consequence, Effect, Opening, Outcome};
use crate::session::parts::ArmJoint;
use crate::session::playback::PlaybackAction;
use crate::session::preferences::{PanelTab, Preferences};
use crate::session::selection::SelectAction;
use crate::session::solver::run::SolverInputs;
use crate::session::solver::solvers::SolverAction;
use crate::session::tour::state::TourState;
use crate::session::view::view::ViewAction;

/// Minimum distance between waypoints of a dragged head, in cells of the grid.
const WAYPOINT_SPACING: f32 = 0.02;

/// Actions that one part applies.
impl Session {
    pub(in crate::session) fn apply_selection(&mut self, action: SelectAction) -> Outcome {
        let joints = self.evaluated.skeleton_pose().len();
        self.selection.apply(action, self.editing.document(), joints)
    }

    pub(in crate::session) fn apply_view(&mut self, action: ViewAction) -> Outcome {
        self.view.apply(action, self.editing.document().camera, self.preferences)
    }

    pub(in crate::session) fn apply_playback(&mut self, action: PlaybackAction) -> Outcome {
        self.playback.apply(action, &self.editing.document().timeline)
    }

    pub(in crate::session) fn apply_solver(&mut self, action: SolverAction) -> Outcome {
        self.solvers.apply(action, self.editing.shown(), self.playback.time())
    }

    pub(in crate::session) fn apply_to_files(
        &mut self,
        action: FileAction,
    ) -> Result<Outcome, FileAction> {
        self.files.apply(action, self.shell.dialog())
    }

    /// Makes an undo step of a change, or a part of the open transaction.
    pub(in crate::session) fn step(&mut self, label: &'static str, change: impl FnOnce(&mut Self)) {
        if self.editing.label_transaction(label) {
            return change(self);
        }
        let before = self.editing.state(self.playback.time());
        change(self);
        if !self.editing.is_editing() {
            self.editing.remember(label, before, self.playback.time());
        }
    }

    /// Changes the open drag; returns the grip and where it is now, or `None` if nothing is dragged.
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
            Consequence::SayIfArmMoved(from) => self.say_if_arm_moved(&from),
            Consequence::OpenDialog(dialog) => self.open_dialog(*dialog),
            Consequence::ShowDialog(dialog) => self.shell.open_dialog(*dialog),
            Consequence::CloseDialog => self.close_dialog(),
            Consequence::TakeDialog => drop(self.shell.take_dialog()),
            Consequence::SetChoosing(choosing) => self.shell.set_choosing(choosing),
            Consequence::Prefer(preferences) => self.preferences = preferences,
            Consequence::ShowTab(tab) => self.show_tab(tab),

            Consequence::Write(after) => self.write(*after),
            Consequence::Refresh => self.refresh(),
            Consequence::DiscardUnkeyed => self.editing.clear_overrides(),
            Consequence::ForgetUnkeyed(channels) => {
                channels.into_iter().for_each(|channel| self.editing.forget_override(channel));
            }
            Consequence::ForgetTwistLikeKeys => self.forget_twist_like_keys(),
            Consequence::RestartKeysFrom(keys) => self.editing.restart_keys_from(*keys),
            Consequence::Begin(drag) => self.begin(drag.map(|drag| *drag)),
            Consequence::Commit => self.commit(),
            Consequence::Cancel => self.cancel(),
            Consequence::Undo => self.undo(),
            Consequence::Redo => self.redo(),
            Consequence::Press(grip) => self.press(grip),
            Consequence::FollowMouse(follows) => self.follow_mouse(follows),
            Consequence::Lead(ray) => self.lead_heads(ray),

            Consequence::Select(joints) => self.select(joints),
            Consequence::Hover(part) => {
                self.selection.hover(part, self.evaluated.skeleton_pose().len());
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
            Consequence::SettleCamera => {
                self.view.drop();
                self.end_glide();
            }
            Consequence::ResetCrowd => self.view.reset_crowd(),
            Consequence::ResetTransport => self.reset_transport(),
            Consequence::LookInside => return self.look_inside(),
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
        self.evaluated.update(self.editing.posed(), cause);
        self.selection.retain_joints(self.evaluated.skeleton_pose().len());
        self.update_solvers();
        self.selection.retain_keys(self.editing.document());
    }

    /// Makes the solver run and the comparison anew if what they solve has changed.
    fn update_solvers(&mut self) {
        if self.solvers.is_idle() {
            return;
        }
        let inputs = SolverInputs::of(self.shown(), self.playback.time()).ok();
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

    fn forget_twist_like_keys(&mut self) {
        if self.editing.forget_twist_like_keys(self.playback.time()) {
            self.shell.set_message(None);
            self.refresh();
        }
    }

    fn say_if_arm_moved(&mut self, from: &TwoBonePose) {
        const MOVED: f32 = 1e-3;
        let pose = self.pose();
        let moved = pose.elbow.distance(from.elbow).max(pose.hand.distance(from.hand));
        if moved > MOVED * self.arm().bones.outer_limit() {
            self.act(Outcome::say("The arm moved: its soft limits exclude the pose"));
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
        self.follow_mouse = None;
        self.editing.commit(self.playback.time());
    }

    fn cancel(&mut self) {
        self.follow_mouse = None;
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

    /// Replaces the open document; the history starts anew.
    fn open(&mut self, opening: Opening) {
        let Opening { document, file, contents, seems_z_up } = opening;
        let playback = self.playback.restarted(&document.timeline);
        *self = Self {
            files: self.files.replaced(file.clone()),
            editing: self.editing.replaced(document.clone()),
            playback,
            ..Self::with_document(self.preferences, document)
        };
        self.refresh();
        self.evaluated.reset_pops(self.editing.posed());
        self.evaluated.forget_trail();
        if let Some(file) = file {
            self.files.remember(file);
        }
        self.files.set_origin(contents, seems_z_up);
    }
}

/// Selection and dialogs.
impl Session {
    fn select(&mut self, joints: Vec<JointId>) {
        self.selection.select(joints, self.evaluated.skeleton_pose().len());
        self.evaluated.forget_trail();
    }

    fn press(&mut self, grip: Grip) {
        self.view.stop_glide();
        let is_hand = matches!(grip, Grip::Hand(_));
        let kept = self.selection.arm_joint().filter(|joint| is_hand && *joint == ArmJoint::Hand);
        self.selection.set_arm_joint(grip.arm_joint().or(kept));
    }

    fn open_dialog(&mut self, dialog: Dialog) {
        // Only the dialogs for saving keep the action that waits for the document to be saved.
        let is_saving = match &dialog {
            Dialog::Path(dialog) => matches!(dialog, PathDialog::SaveAs { .. }),
            Dialog::Replace { back, .. } => matches!(back, PathDialog::SaveAs { .. }),
            Dialog::FileChanged { .. } => true,
            _ => false,
        };
        if !is_saving {
            self.files.forget_after_save();
        }
        self.shell.set_choosing(false);
        self.shell.open_dialog(dialog);
    }

    fn close_dialog(&mut self) {
        self.shell.set_choosing(false);
        match self.shell.take_dialog() {
            Some(Dialog::Replace { back, .. }) => self.shell.open_dialog(back.into()),
            Some(Dialog::Bake { job: Some(job), .. }) => {
                job.progress.cancel();
                self.act(Outcome::say("Bake cancelled"));
            }
            _ => {
                self.files.forget_after_save();
                self.files.set_remark(None);
            }
        }
    }

    fn show_tab(&mut self, tab: PanelTab) {
        let rig = self.rig();
        if !PanelTab::of(rig).contains(&tab) {
            return;
        }
        match rig {
            RigKind::Arm => self.preferences.arm_tab = tab,
            RigKind::Skeleton => self.preferences.skeleton_tab = tab,
        }
    }

    /// Makes one iteration with the solver, and shows its first part.
    fn look_inside(&mut self) -> Option<Effect> {
        let stepped = self.apply_solver(SolverAction::Step);
        self.act(stepped);
        let shown = self.apply_solver(SolverAction::ShowPart { iteration: 1, part: Some(0) });
        self.act(shown)
    }

    fn reset_transport(&mut self) {
        self.evaluated.reset_transport(self.editing.posed());
    }
}

/// The tour.
impl Session {
    pub(in crate::session) fn change_tour(&mut self, change: impl FnOnce(&mut TourState)) {
        if let Some(tour) = &mut self.tour {
            change(tour);
        }
    }

    /// Shows a scene of the tour in place of the user's document, which is kept. `enter` makes the
    /// state of the tour from the shown scene and from which steps are done.
    pub(in crate::session) fn enter_scene(
        &mut self,
        document: Document,
        enter: impl FnOnce(Document, Vec<bool>) -> TourState,
    ) {
        let done = self.tour.take().map(TourState::done).unwrap_or_default();
        self.cancel_bake();
        let own = self.own.take().unwrap_or_else(|| Box::new(self.paused()));
        let preferences = Preferences { offers_tour: false, ..self.preferences };
        let playback = self.playback.restarted(&document.timeline);
        let files = std::mem::take(&mut self.files);
        *self = Self { files, playback, ..Self::with_document(preferences, document) };
        self.refresh();
        self.reset_transport();
        self.tour = Some(enter(self.shown().clone(), done));
        self.own = Some(own);
    }

    /// Ends all changes that are under way, and returns the session as it is then.
    fn paused(&mut self) -> Self {
        self.commit();
        self.end_glide();
        let paused = self.apply_playback(PlaybackAction::Play(false));
        self.act(paused);
        self.clone()
    }

    /// Puts the user's document back. Files and those preferences that the tour does not set are
    /// kept as they are now.
    pub(in crate::session) fn leave_tour(&mut self) {
        let Some(own) = self.own.take() else { return };
        self.cancel_bake();
        let Preferences { explain, arm_tab, skeleton_tab, timeline_open, curves, .. } =
            own.preferences;
        let preferences = Preferences {
            explain,
            arm_tab,
            skeleton_tab,
            timeline_open,
            curves,
            ..self.preferences
        };
        let files = std::mem::take(&mut self.files);
        *self = Self { files, preferences, ..*own };
    }

    /// Cancels a running bake and closes its dialog.
    fn cancel_bake(&mut self) {
        if matches!(self.shell.dialog(), Some(Dialog::Bake { .. })) {
            self.close_dialog();
        }
    }
}
