use glam::Vec3;

use super::crowd::Crowding;
use super::drag::DragKind;
use super::{
    Action, Constraint, Dialog, Drag, EditAction, Effect, FileAction, Glide, Grip, PlaybackAction,
    SelectAction, Session, ShellAction, SolverAction, Transaction, TransactionAction,
    TransportPath, ViewAction, ViewDrag,
};
use crate::document::{Arm, Camera, Cursor, Display, Document, Ray, RigKind, SkeletonRig};
use crate::io::Example;
use crate::kinematics::skeleton::JointId;

impl Session {
    /// Applies an action. What is not possible changes nothing and is reported by
    /// [`Session::message`]; what would lose unsaved changes is asked about first.
    pub fn apply(&mut self, action: impl Into<Action>) -> Option<Effect> {
        match action.into() {
            Action::Edit(action) => self.apply_edit(action),
            Action::Transaction(action) => self.apply_transaction(action),
            Action::Select(action) => return self.apply_selection(action),
            Action::View(action) => self.apply_view(action),
            Action::Playback(action) => self.apply_playback(action),
            Action::Solver(action) => self.apply_solver(action),
            Action::File(action) => return self.apply_file(action),
            Action::Shell(action) => return self.apply_shell(action),
        }
        None
    }

    pub(super) fn apply_edit(&mut self, action: EditAction) {
        self.step_by(action.label(), |session| session.edit_by(action));
    }

    fn edit_by(&mut self, action: EditAction) {
        match action {
            EditAction::SetHand(hand) => self.set_point("hand", hand, Arm::set_cursor),
            EditAction::SetRoot(root) => {
                self.set_point("shoulder", root, |arm, root| arm.root = root);
            }
            EditAction::SetTwist(twist) => self.set_twist(twist),
            EditAction::SetPin(pin) => {
                self.set_point("hand", pin, |arm, pin| arm.goal = Cursor::World(pin));
            }
            EditAction::PinHand(pinned) => self.replace_arm(self.arm().pinned(pinned)),
            EditAction::SetTwistReference(reference) => self.set_twist_reference(reference),
            EditAction::SetPole(pole) => self.set_pole(pole),
            EditAction::SetSoftReach(soft_reach) => {
                self.replace_arm(Arm { soft_reach, ..*self.arm() });
            }
            EditAction::SetInfluence(influence) => self.set_influence(influence),
            EditAction::SwitchPoseMode(mode) => self.switch_to(mode),
            EditAction::SetShoulder(angles) => self.set_shoulder(angles),
            EditAction::SetBend(bend) => self.set_bend(bend),
            EditAction::SetWrist(angles) => {
                self.set_point("hand angles", angles, |arm, angles| arm.wrist.angles = angles);
            }
            EditAction::SetWristSpace(space) => {
                self.message = None;
                self.commit(self.shown.with_wrist_in(space));
            }
            EditAction::SetUpper(upper) => self.set_lengths(upper, self.arm().bones.lower()),
            EditAction::SetLower(lower) => self.set_lengths(self.arm().bones.upper(), lower),
            EditAction::ResetPose => match self.rig() {
                RigKind::Arm => self.replace_arm(Arm::default()),
                RigKind::Skeleton => self.bind_pose(),
            },
            EditAction::ResetAll => self.reset_all(),
            EditAction::ShowOverlay(overlay, shown) => {
                let display = self.shown.display.with(overlay, shown);
                self.commit(Document { display, ..self.shown.clone() });
            }
            EditAction::ShowRig(rig) => self.show_rig(rig),

            EditAction::AddChild { parent, tip } => self.add_joint(Some(parent), tip),
            EditAction::AddJoint { tip } => self.add_next_joint(tip),
            EditAction::AddRoot => self.add_joint(None, None),
            EditAction::DeleteJoints(joints) => {
                self.dialog = None;
                self.delete_joints(&joints, Document::delete);
            }
            EditAction::DissolveJoints(joints) => {
                self.dialog = None;
                self.delete_joints(&joints, Document::dissolve);
            }
            EditAction::RenameJoint { joint, name } => {
                self.dialog = None;
                self.edit_skeleton(|rig| rig.skeleton_mut().rename(joint, name.trim()));
            }
            EditAction::ReparentJoint { joint, parent } => self.reparent(joint, parent),
            EditAction::SetRotation { joint, rotation } => {
                self.edit_skeleton(|rig| rig.skeleton_mut().set_rotation(joint, rotation));
            }
            EditAction::SetAxis { joint, axis } => {
                self.edit_skeleton(|rig| rig.skeleton_mut().set_axis(joint, axis));
            }
            EditAction::SetLimit { joint, axis, limit } => self.set_limit(joint, axis, limit),
            EditAction::SetLocked { joint, locked } => {
                self.change_joint(joint, |joint| joint.locked = locked);
            }
            EditAction::SetTranslation(to) => self.set_translation(to),
            EditAction::SetFollowPath(follow_path) => self.set_follow_path(follow_path),

            EditAction::AddTarget(joint) => self.add_target(joint),
            EditAction::RemoveTarget(joint) => self.remove_target(joint),
            EditAction::SetTarget(target) => self.set_target(target),
            EditAction::SetSolver(solver) => self.set_solver(solver),
            EditAction::SetIterationsPerFrame(iterations) => {
                self.edit_skeleton(|rig| {
                    rig.iterations_per_frame =
                        iterations.clamp(1, SkeletonRig::MOST_ITERATIONS_PER_FRAME);
                    Ok(())
                });
            }
            EditAction::StepSolver => self.step(),
            EditAction::ResetSolver => self.reset_solver(),

            EditAction::Key(channels) => self.key(&channels),
            EditAction::DeleteKeys(keys) => self.delete_keys(&keys),
            EditAction::ClearChannels(channels) => self.clear_channels(&channels),
            EditAction::MoveKeys { keys, by } => self.move_keys(&keys, by),
            EditAction::PasteKeys => self.paste_keys(),
            EditAction::SetTimeline(timeline) => self.set_timeline(timeline),
            EditAction::SetMetres(metres) => self.set_metres(metres),
        }
    }

    fn apply_transaction(&mut self, action: TransactionAction) {
        match action {
            TransactionAction::Begin => self.begin_edit(None),
            TransactionAction::Commit => self.commit_edit(),
            TransactionAction::Cancel => self.cancel_edit(),
            TransactionAction::Undo => self.undo(),
            TransactionAction::Redo => self.redo(),
            TransactionAction::Grab { grip, ray, forward } => self.grab(grip, ray, forward),
            TransactionAction::Drag(input) => self.drag_by(|drag| drag.set_input(input)),
            TransactionAction::Constrain(constraint) => {
                if constraint.is_none_or(Constraint::is_possible) {
                    self.drag_by(|drag| drag.set_constraint(constraint));
                }
            }
            TransactionAction::TypeOffset(typed) => self.drag_by(|drag| drag.set_typed(typed)),
        }
    }

    fn apply_selection(&mut self, action: SelectAction) -> Option<Effect> {
        match action {
            SelectAction::Joints(joints) => self.select(joints),
            SelectAction::Hover(joint) => self.point(joint),
            SelectAction::Keys(keys) => {
                self.selected_keys = keys;
                self.retain_keys();
            }
            SelectAction::Channels(channels) => {
                self.selected_channels = channels.into_iter().collect();
                self.retain_keys();
            }
            SelectAction::CopyKeys => return self.copy_keys(),
        }
        None
    }

    fn apply_view(&mut self, action: ViewAction) {
        match action {
            ViewAction::SetCamera(camera) => {
                self.glide = None;
                self.set_camera(camera);
            }
            ViewAction::GlideTo(camera) => {
                if camera.is_valid() {
                    self.glide = Some(Glide::new(self.document.camera, camera));
                }
            }
            ViewAction::Grab(motion, at) => {
                self.glide = None;
                self.view_drag = Some(ViewDrag::new(motion, self.document.camera, at));
            }
            ViewAction::Drag { to, aspect } => {
                if let Some(drag) = &self.view_drag {
                    self.set_camera(drag.camera(to, aspect));
                }
            }
            ViewAction::Drop => self.view_drag = None,
            ViewAction::Cancel => {
                if let Some(drag) = self.view_drag.take() {
                    self.set_camera(drag.before);
                }
            }
            ViewAction::ShowCrowd(shown) => self.show_crowd(shown),
            ViewAction::SetCrowdSize(arms) => self.set_crowd(arms),
            ViewAction::SetCrowdSolver(solved_by) => self.solve_crowd(solved_by),
            ViewAction::AnimateCrowd(moving) => self.move_crowd(moving),
            ViewAction::ResetTransport => self.transport_path = TransportPath::new(self.arm()),
            ViewAction::ShowExplain(shown) => self.preferences.explain = shown,
            ViewAction::ShowTimeline(shown) => self.preferences.timeline = shown,
            ViewAction::ShowGraphEditor(shown) => self.preferences.curves = shown,
        }
    }

    fn apply_playback(&mut self, action: PlaybackAction) {
        match action {
            PlaybackAction::Play(playing) => self.play(playing),
            PlaybackAction::SetTime(time) => self.set_time(time),
            PlaybackAction::SetLooping(looping) => self.playback.looping = looping,
            PlaybackAction::SetSpeed(speed) => {
                let (slowest, fastest) = Self::SPEEDS;
                if speed.is_finite() {
                    self.playback.speed = speed.clamp(slowest, fastest);
                }
            }
            PlaybackAction::SetAutoKey(auto_key) => self.auto_key = auto_key,
            PlaybackAction::Advance(seconds) => self.advance(seconds),
        }
    }

    fn apply_solver(&mut self, action: SolverAction) {
        match action {
            SolverAction::Run(running) => self.run(running),
            SolverAction::Cancel => self.cancel_run(),
            SolverAction::Compare(true) => self.start_comparison(),
            SolverAction::Compare(false) => self.comparison = None,
            SolverAction::SetFollow(follow) => self.preferences.follow = follow,
        }
    }

    /// Asks first if the action would lose unsaved changes or end an export.
    pub(super) fn apply_file(&mut self, action: FileAction) -> Option<Effect> {
        if action == FileAction::Quit && self.is_exporting() {
            self.dialog = Some(Dialog::Exporting);
            return None;
        }
        if self.is_unsaved() && (action.leaves_document() || self.came_late(&action)) {
            self.dialog = Some(Dialog::Unsaved { then: Box::new(action) });
            return None;
        }
        self.apply_file_unasked(action)
    }

    fn apply_file_unasked(&mut self, action: FileAction) -> Option<Effect> {
        let effect = self.file_effect(action);
        self.choosing |= matches!(effect, Some(Effect::ChoosePath(_)));
        effect
    }

    fn file_effect(&mut self, action: FileAction) -> Option<Effect> {
        match action {
            FileAction::SavePicture(path) => {
                (self.dialog, self.choosing) = (None, false);
                self.remember_export_folder(path.as_ref());
                self.say(format!("Saving {path} …"));
                return Some(Effect::SavePicture(path));
            }
            FileAction::Export(export) => return self.export(export),
            FileAction::ExportStarted(job) => self.job = Some(job),
            FileAction::CancelExport => self.cancel_export(),
            FileAction::StopExportAndQuit => return self.stop_export_and_quit(),
            FileAction::ExportEnded(how) => {
                self.job = None;
                if self.dialog == Some(Dialog::Exporting) {
                    self.dialog = None;
                }
                match how {
                    Ok(done) => self.say(done),
                    Err(why) => self.fail(why),
                }
            }
            FileAction::AskPath(dialog) => {
                self.then = None;
                return Some(Effect::ChoosePath(dialog));
            }
            FileAction::ChoosePath => return self.dialog.clone().map(Effect::ChoosePath),
            FileAction::ChoseNothing => {
                (self.then, self.choosing) = (None, false);
                self.say("No file was chosen");
            }
            FileAction::NoSystemDialog(dialog) => self.ask_ourselves(dialog),
            FileAction::Open { path, skeleton } => {
                self.choosing = false;
                if !matches!(self.dialog, Some(Dialog::Open { .. })) {
                    self.dialog = None;
                }
                self.opening = Some(self.revision);
                return Some(Effect::Open { path, skeleton });
            }
            FileAction::Opened { document, file } => self.replace_document(*document, file),
            FileAction::NotOpened { path, why } => self.not_opened(&path, &why),
            FileAction::Save => {
                self.then = None;
                return Some(self.save());
            }
            FileAction::SaveAs(path) => {
                (self.dialog, self.choosing) = (None, false);
                self.end_glide();
                return Some(Effect::Save(path));
            }
            FileAction::Saved(path) => return self.saved(path),
            FileAction::NotSaved { path, why } => self.not_saved(&path, &why),
            FileAction::SaveAnd(then) => {
                self.dialog = None;
                self.then = Some(then);
                return Some(self.save());
            }
            FileAction::Discard(then) => {
                self.dialog = None;
                return self.apply_file_unasked(*then);
            }
            FileAction::Recover { document, file } => self.recover(*document, file),
            FileAction::DeclineRecovery => {
                self.dialog = None;
                self.recovery_settled = true;
            }
            FileAction::OpenExample(example) => self.open_example(example),
            FileAction::NewSkeleton => self.new_skeleton(),
            FileAction::Quit => return Some(Effect::Quit),
        }
        None
    }

    fn apply_shell(&mut self, action: ShellAction) -> Option<Effect> {
        match action {
            ShellAction::OpenDialog(dialog) => self.open_dialog(dialog),
            ShellAction::CloseDialog => self.close_dialog(),
            ShellAction::Report(message) => self.say(message),
            ShellAction::Fail(why) => self.fail(why),
            ShellAction::CopyPose => {
                self.say("Pose copied as a line for ik-arm solve");
                return Some(Effect::CopyText(super::pose_line::of(self.arm())));
            }
            ShellAction::SetTheme(theme) => self.preferences.theme = theme,
            ShellAction::SetNavigation(navigation) => self.preferences.navigation = navigation,
        }
        None
    }

    /// Where the view is or is going.
    pub fn settled_camera(&self) -> Camera {
        self.glide.map_or(self.document.camera, |glide| glide.target())
    }

    /// Brings the view to where it is going.
    pub(super) fn end_glide(&mut self) {
        if let Some(glide) = self.glide.take() {
            self.set_camera(glide.target());
        }
    }

    fn reset_all(&mut self) {
        self.crowding = Crowding::default();
        self.commit(Document { display: Display::default(), ..self.shown.clone() });
        match self.rig() {
            RigKind::Arm => {
                self.glide = Some(Glide::new(self.document.camera, Camera::default()));
                self.replace_arm(Arm::default());
            }
            RigKind::Skeleton => {
                let camera = self.framing_all();
                self.glide = Some(Glide::new(self.document.camera, camera));
                self.bind_pose();
            }
        }
    }

    fn open_example(&mut self, example: Example) {
        match example.open() {
            Ok(opened) => {
                self.replace_document(opened.document, None);
                self.say(example.sentence);
            }
            Err(error) => self.fail(error.to_string()),
        }
    }

    fn new_skeleton(&mut self) {
        let document = Document { rig: RigKind::Skeleton, ..Document::default() };
        self.replace_document(document, None);
        self.select(vec![JointId::new(0)]);
        // As far away as a rig of a unit or two needs.
        self.set_camera(self.settled_camera().framing(Vec3::Y * 0.5, 1.0, super::ASPECT));
    }

    fn grab(&mut self, grip: Grip, ray: Ray, forward: Vec3) {
        if !grip.is_possible() {
            return;
        }
        self.glide = None;
        match grip {
            Grip::Hand(handle) => self.grab_hand(handle, ray, forward),
            Grip::Target(joint, handle) => self.grab_target(joint, handle, ray, forward),
            Grip::Tip(joint, handle) => self.grab_tip(joint, handle, ray, forward),
            Grip::Ring(joint, axis) => self.grab_ring(joint, axis, ray),
            Grip::Pole(handle) => self.grab_pole(handle, ray, forward),
            Grip::Shoulder(_) | Grip::Bend => self.grab_arm_ring(grip, ray),
        }
    }

    fn drag_by(&mut self, change: impl FnOnce(&mut Drag)) {
        let Some(Transaction { shown, drag: Some(drag), name, .. }) = &mut self.edit else {
            return;
        };
        change(drag);
        let grip = drag.grip;
        let Arm { goal, pole, fk, .. } = shown.arm;
        let mut angles = fk.shoulder;
        *name = Some(grip.label());
        match (grip, &mut drag.way) {
            (Grip::Ring(joint, axis), DragKind::Turn(turn)) => {
                let angle = turn.angle();
                self.turn_joint(joint, axis, angle);
            }
            (Grip::Hand(_), DragKind::Point(point)) => {
                let held = point.point();
                if point.has_moved() {
                    self.set_point("hand", held, Arm::set_cursor);
                } else {
                    self.replace_arm(Arm { goal, ..*self.arm() });
                }
            }
            (Grip::Shoulder(axis), DragKind::Turn(turn)) => {
                angles[axis] = turn.angle();
                self.set_shoulder(angles);
            }
            (Grip::Bend, DragKind::Turn(turn)) => {
                let bend = turn.angle();
                self.set_bend(bend);
            }
            (Grip::Pole(_), DragKind::Point(point)) => {
                let held = point.point();
                let pole = if point.has_moved() { held } else { pole };
                self.set_pole(pole);
            }
            (_, DragKind::Point(point)) => {
                let to = point.point();
                let moved = point.moved();
                if point.has_moved() {
                    self.drag_skeleton(grip, to, moved);
                }
            }
            (_, DragKind::Turn(_)) => {}
        }
    }

    fn advance(&mut self, seconds: f64) {
        if !seconds.is_finite() {
            return;
        }
        if let Some(glide) = &mut self.glide {
            let (camera, arrived) = glide.at(seconds);
            if arrived {
                self.glide = None;
            }
            self.set_camera(camera);
        }
        if self.playback.last != Some(seconds) {
            self.advance_clock(seconds);
            self.advance_solvers();
        }
    }
}
