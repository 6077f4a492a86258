use glam::Vec3;

use super::crowd::Crowding;
use super::drag::DragKind;
use super::{
    Action, Constraint, Dialog, Drag, Effect, Glide, Grip, Session, Transaction, TransportPath,
    ViewDrag, naming,
};
use crate::document::{Arm, Camera, Cursor, Display, Document, Ray, RigKind, SkeletonRig};
use crate::io::Example;

impl Session {
    /// Does it; what is not possible changes nothing and is said in [`Session::message`]. What would
    /// lose changes that are not saved is asked about first.
    pub fn apply(&mut self, action: Action) -> Option<Effect> {
        if action == Action::Quit && self.is_exporting() {
            self.dialog = Some(Dialog::Exporting);
            return None;
        }
        if self.is_unsaved() && (action.leaves_document() || self.came_late(&action)) {
            self.dialog = Some(Dialog::Unsaved { then: Box::new(action) });
            return None;
        }
        self.apply_unasked(action)
    }

    pub(super) fn apply_unasked(&mut self, action: Action) -> Option<Effect> {
        let effect = match naming::of(&action) {
            Some(name) => self.step_by(name, |session| session.act(action)),
            None => self.act(action),
        };
        self.choosing |= matches!(effect, Some(Effect::ChoosePath(_)));
        effect
    }

    fn act(&mut self, action: Action) -> Option<Effect> {
        match action {
            Action::SetHand(hand) => self.set_point("hand", hand, Arm::set_cursor),
            Action::SetRoot(root) => self.set_point("shoulder", root, |arm, root| arm.root = root),
            Action::SetTwist(spin) => self.set_twist(spin),
            Action::SetPin(pin) => {
                self.set_point("hand", pin, |arm, pin| arm.goal = Cursor::World(pin));
            }
            Action::PinHand(pinned) => self.replace_arm(self.arm().pinned(pinned)),
            Action::SetTwistReference(twist_reference) => self.set_twist_reference(twist_reference),
            Action::SetPole(pole) => self.set_pole(pole),
            Action::SetSoftReach(soft_reach) => {
                self.replace_arm(Arm { soft_reach, ..*self.arm() });
            }
            Action::SetInfluence(weight) => self.set_weight(weight),
            Action::SwitchTo(lead) => self.switch_to(lead),
            Action::SetShoulder(angles) => self.set_shoulder(angles),
            Action::SetBend(bend) => self.set_bend(bend),
            Action::SetWrist(angles) => {
                self.set_point("hand angles", angles, |arm, angles| arm.wrist.angles = angles);
            }
            Action::SetWristSpace(space) => {
                self.message = None;
                self.commit(self.shown.with_wrist_in(space));
            }
            Action::ResetTransport => self.transport_path = TransportPath::new(self.arm()),
            Action::SetUpper(upper) => self.set_lengths(upper, self.arm().bones.lower()),
            Action::SetLower(lower) => self.set_lengths(self.arm().bones.upper(), lower),
            Action::ResetPose => match self.rig() {
                RigKind::Arm => self.replace_arm(Arm::default()),
                RigKind::Skeleton => self.bind_pose(),
            },
            Action::ResetAll => self.reset_all(),
            Action::Show(layer, shown) => {
                let display = self.shown.display.with(layer, shown);
                self.commit(Document { display, ..self.shown.clone() });
            }
            Action::ShowRig(rig) => self.show_rig(rig),

            Action::Select(joints) => self.select(joints),
            Action::Point(joint) => self.point(joint),
            Action::AddChild { parent, tip } => self.add_joint(Some(parent), tip),
            Action::AddJoint { tip } => self.add_next_joint(tip),
            Action::AddRoot => self.add_joint(None, None),
            Action::Delete(joints) => {
                self.dialog = None;
                self.delete_joints(&joints, Document::delete);
            }
            Action::Dissolve(joints) => {
                self.dialog = None;
                self.delete_joints(&joints, Document::dissolve);
            }
            Action::Rename { joint, name } => {
                self.dialog = None;
                self.edit_skeleton(|rig| rig.skeleton_mut().rename(joint, name.trim()));
            }
            Action::Reparent { joint, parent } => self.reparent(joint, parent),
            Action::SetRotation { joint, rotation } => {
                self.edit_skeleton(|rig| rig.skeleton_mut().set_rotation(joint, rotation));
            }
            Action::SetAxis { joint, axis } => {
                self.edit_skeleton(|rig| rig.skeleton_mut().set_axis(joint, axis));
            }
            Action::SetLimit { joint, axis, limit } => self.set_limit(joint, axis, limit),
            Action::SetLocked { joint, locked } => {
                self.change_joint(joint, |joint| joint.locked = locked);
            }
            Action::SetTranslation(to) => self.set_translation(to),
            Action::SetFollowPath(follow_path) => self.set_follow_path(follow_path),

            Action::AddTarget(joint) => self.add_target(joint),
            Action::RemoveTarget(joint) => self.remove_target(joint),
            Action::SetTarget(target) => self.set_target(target),
            Action::SetSolver(solver) => self.set_solver(solver),
            Action::SetIterationsPerFrame(iterations) => {
                self.edit_skeleton(|rig| {
                    rig.iterations_per_frame =
                        iterations.clamp(1, SkeletonRig::MOST_ITERATIONS_PER_FRAME);
                    Ok(())
                });
            }
            Action::SetFollow(follow) => self.preferences.follow = follow,
            Action::Run(running) => self.run(running),
            Action::CancelRun => self.cancel_run(),
            Action::Step => self.step(),
            Action::ResetSolver => self.reset_solver(),
            Action::Comparison(true) => self.start_comparison(),
            Action::Comparison(false) => self.comparison = None,
            Action::Play(playing) => self.play(playing),
            Action::SetTime(time) => self.set_time(time),
            Action::SetLooping(looping) => self.playback.looping = looping,
            Action::SetSpeed(speed) => {
                let (slowest, fastest) = Self::SPEEDS;
                if speed.is_finite() {
                    self.playback.speed = speed.clamp(slowest, fastest);
                }
            }

            Action::Key(channels) => self.key(&channels),
            Action::DeleteKeys(keys) => self.delete_keys(&keys),
            Action::ClearChannels(channels) => self.clear_channels(&channels),
            Action::MoveKeys { keys, by } => self.move_keys(&keys, by),
            Action::CopyKeys => return self.copy_keys(),
            Action::PasteKeys => self.paste_keys(),
            Action::SelectKeys(keys) => {
                self.selected_keys = keys;
                self.retain_keys();
            }
            Action::SelectChannels(channels) => {
                self.selected_channels = channels.into_iter().collect();
                self.retain_keys();
            }
            Action::SetAutoKey(auto_key) => self.auto_key = auto_key,
            Action::SetTimeline(timeline) => self.set_timeline(timeline),
            Action::SetMetres(metres) => self.set_metres(metres),

            Action::BeginEdit => self.begin_edit(None),
            Action::CommitEdit => self.commit_edit(),
            Action::Undo => self.undo(),
            Action::Redo => self.redo(),
            Action::CancelEdit => self.cancel_edit(),
            Action::Grab { grip, ray, forward } => self.grab(grip, ray, forward),
            Action::Drag(input) => self.drag_by(|drag| drag.set_input(input)),
            Action::ConstrainDrag(constraint) if constraint.is_none_or(Constraint::is_possible) => {
                self.drag_by(|drag| drag.set_constraint(constraint));
            }
            Action::ConstrainDrag(_) => {}
            Action::TypeOffset(typed) => self.drag_by(|drag| drag.set_typed(typed)),

            Action::SetCamera(camera) => {
                self.glide = None;
                self.set_camera(camera);
            }
            Action::GlideTo(camera) if camera.is_valid() => {
                self.glide = Some(Glide::new(self.document.camera, camera));
            }
            Action::GlideTo(_) => {}
            Action::Advance(seconds) => self.advance(seconds),
            Action::GrabView(motion, at) => {
                self.glide = None;
                self.view_drag = Some(ViewDrag::new(motion, self.document.camera, at));
            }
            Action::DragView { to, aspect } => {
                if let Some(drag) = &self.view_drag {
                    self.set_camera(drag.camera(to, aspect));
                }
            }
            Action::DropView => self.view_drag = None,
            Action::CancelView => {
                if let Some(drag) = self.view_drag.take() {
                    self.set_camera(drag.before);
                }
            }

            Action::SetTheme(theme) => self.preferences.theme = theme,
            Action::SetNavigation(navigation) => self.preferences.navigation = navigation,
            Action::ShowExplain(shown) => self.preferences.explain = shown,
            Action::ShowCrowd(shown) => self.show_crowd(shown),
            Action::SetCrowd(arms) => self.set_crowd(arms),
            Action::SolveCrowd(solved_by) => self.solve_crowd(solved_by),
            Action::MoveCrowd(moving) => self.move_crowd(moving),
            Action::ShowTimeline(shown) => self.preferences.timeline = shown,
            Action::ShowCurves(shown) => self.preferences.curves = shown,
            Action::OpenDialog(dialog) => self.open_dialog(dialog),
            Action::CloseDialog => self.close_dialog(),
            Action::Report(message) => self.say(message),
            Action::Fail(why) => self.fail(why),

            Action::CopyPose => {
                self.say("Pose copied as a line for ik-arm solve");
                return Some(Effect::CopyText(super::pose_line::of(self.arm())));
            }
            Action::SavePicture(path) => {
                (self.dialog, self.choosing) = (None, false);
                self.remember_export_folder(path.as_ref());
                self.say(format!("Saving {path} …"));
                return Some(Effect::SavePicture(path));
            }
            Action::Export(export) => return self.export(export),
            Action::Exporting(job) => self.job = Some(job),
            Action::CancelExport => self.cancel_export(),
            Action::StopExportAndQuit => return self.stop_export_and_quit(),
            Action::Exported(how) => {
                self.job = None;
                if self.dialog == Some(Dialog::Exporting) {
                    self.dialog = None;
                }
                match how {
                    Ok(done) => self.say(done),
                    Err(why) => self.fail(why),
                }
            }
            Action::Ask(dialog) => {
                self.then = None;
                return Some(Effect::ChoosePath(dialog));
            }
            Action::ChoosePath => return self.dialog.clone().map(Effect::ChoosePath),
            Action::ChoseNothing => {
                (self.then, self.choosing) = (None, false);
                self.say("No file was chosen");
            }
            Action::NoSystemDialog(dialog) => self.ask_ourselves(dialog),
            Action::Open { path, skeleton } => {
                self.choosing = false;
                if !matches!(self.dialog, Some(Dialog::Open { .. })) {
                    self.dialog = None;
                }
                self.opening = Some(self.revision);
                return Some(Effect::Open { path, skeleton });
            }
            Action::Opened { document, file } => self.replace_document(*document, file),
            Action::NotOpened { path, why } => self.not_opened(&path, &why),
            Action::Save => {
                self.then = None;
                return Some(self.save());
            }
            Action::SaveAs(path) => {
                (self.dialog, self.choosing) = (None, false);
                self.end_glide();
                return Some(Effect::Save(path));
            }
            Action::Saved(path) => return self.saved(path),
            Action::NotSaved { path, why } => self.not_saved(&path, &why),
            Action::SaveAnd(then) => {
                self.dialog = None;
                self.then = Some(then);
                return Some(self.save());
            }
            Action::Discard(then) => {
                self.dialog = None;
                return self.apply_unasked(*then);
            }
            Action::Recover { document, file } => self.recover(*document, file),
            Action::ForgetRecovered => {
                self.dialog = None;
                self.recovery_settled = true;
            }
            Action::OpenExample(example) => self.open_example(example),
            Action::NewSkeleton => self.new_skeleton(),
            Action::LoseDevice => return Some(Effect::LoseDevice),
            Action::Quit => return Some(Effect::Quit),
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
        self.select(vec![0]);
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
        *name = Some(naming::of_drag(grip));
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
