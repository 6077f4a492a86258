use std::path::PathBuf;

use glam::Vec3;

use super::drag::Way;
use super::{Action, Dialog, Drag, Edit, Effect, Glide, Grip, Session, ViewDrag};
use crate::document::{Arm, Camera, Display, Document, Ray, RigKind, SkeletonRig};
use crate::io::Example;

impl Session {
    /// Does it; what is not possible changes nothing and is said in [`Session::message`].
    pub fn apply(&mut self, action: Action) -> Option<Effect> {
        match action {
            Action::SetHand(hand) => self.set_point("hand", hand, |arm| &mut arm.cursor),
            Action::SetRoot(root) => self.set_point("shoulder", root, |arm| &mut arm.root),
            Action::SetElbowSpin(spin) => self.set_elbow_spin(spin),
            Action::SetUpper(upper) => self.set_lengths(upper, self.arm().bones.lower()),
            Action::SetLower(lower) => self.set_lengths(self.arm().bones.upper(), lower),
            Action::ResetPose => match self.rig() {
                RigKind::Arm => self.replace_arm(Arm::default()),
                RigKind::Skeleton => self.bind_pose(),
            },
            Action::ResetAll => self.reset_all(),
            Action::Show(layer, shown) => {
                self.document.display = self.document.display.with(layer, shown);
            }
            Action::ShowRig(rig) => self.show_rig(rig),

            Action::Select(joints) => {
                self.selection = joints;
                self.refresh_skeleton();
            }
            Action::Point(joint) => self.pointed = joint,
            Action::AddChild { parent, tip } => self.add_joint(Some(parent), tip),
            Action::AddRoot => self.add_joint(None, None),
            Action::Delete(joints) => self.remove_joints(&joints),
            Action::Rename { joint, name } => {
                self.dialog = None;
                self.edit_skeleton(|rig| rig.skeleton.rename(joint, name.trim()));
            }
            Action::Reparent { joint, parent } => self.reparent(joint, parent),
            Action::SetRotation { joint, rotation } => {
                self.edit_skeleton(|rig| rig.skeleton.set_rotation(joint, rotation));
            }
            Action::SetAxis { joint, axis } => {
                self.edit_skeleton(|rig| rig.skeleton.set_axis(joint, axis));
            }
            Action::SetLimit { joint, axis, limit } => {
                self.change_joint(joint, |joint| joint.limits[axis] = limit);
            }
            Action::SetLocked { joint, locked } => {
                self.change_joint(joint, |joint| joint.locked = locked);
            }
            Action::SetSlither(slither) => self.set_slither(slither),

            Action::AddTarget(joint) => self.add_target(joint),
            Action::RemoveTarget(joint) => {
                self.edit_skeleton(|rig| {
                    rig.targets.retain(|target| target.joint != joint);
                    Ok(())
                });
            }
            Action::SetTarget(target) => self.set_target(target),
            Action::SetSolver(solver) => self.set_solver(solver),
            Action::SetIterationsPerFrame(iterations) => {
                self.document.skeleton.iterations_per_frame =
                    iterations.clamp(1, SkeletonRig::MOST_ITERATIONS_PER_FRAME);
            }
            Action::SetFollow(follow) => self.preferences.follow = follow,
            Action::Run(running) => self.run(running),
            Action::CancelRun => self.cancel_run(),
            Action::Step => self.step(),
            Action::ResetSolver => self.reset_solver(),
            Action::Race(true) => self.start_race(),
            Action::Race(false) => self.race = None,
            Action::Play(playing) => {
                self.clock.playing = playing;
                self.clock.last = None;
            }
            Action::SetTime(time) => {
                self.clock.time = if time.is_finite() { time } else { 0.0 };
                self.refresh_skeleton();
            }

            Action::BeginEdit => self.begin_edit(None),
            Action::CommitEdit => self.edit = None,
            Action::CancelEdit => self.cancel_edit(),
            Action::Grab { grip, ray, forward } => self.grab(grip, ray, forward),
            Action::Drag(input) => self.drag_by(|drag| drag.set_input(input)),
            Action::ConstrainDrag(constraint) => {
                self.drag_by(|drag| drag.set_constraint(constraint));
            }
            Action::TypeOffset(typed) => self.drag_by(|drag| drag.set_typed(typed)),

            Action::SetCamera(camera) => {
                self.glide = None;
                self.document.camera = camera;
            }
            Action::GlideTo(camera) => self.glide = Some(Glide::new(self.document.camera, camera)),
            Action::Advance(seconds) => self.advance(seconds),
            Action::GrabView(motion, at) => {
                self.glide = None;
                self.view_drag = Some(ViewDrag::new(motion, self.document.camera, at));
            }
            Action::DragView { to, aspect } => {
                if let Some(drag) = &self.view_drag {
                    self.document.camera = drag.camera(to, aspect);
                }
            }
            Action::DropView => self.view_drag = None,
            Action::CancelView => {
                if let Some(drag) = self.view_drag.take() {
                    self.document.camera = drag.before;
                }
            }

            Action::SetTheme(theme) => self.preferences.theme = theme,
            Action::SetNavigation(navigation) => self.preferences.navigation = navigation,
            Action::ShowExplain(shown) => self.preferences.explain = shown,
            Action::OpenDialog(dialog) => self.dialog = Some(dialog),
            Action::CloseDialog => self.dialog = None,
            Action::Report(message) => self.message = Some(message),

            Action::CopyPose => {
                self.message = Some("Pose copied as a line for ik-arm solve".to_owned());
                return Some(Effect::CopyText(pose_line(self.arm())));
            }
            Action::SavePicture(path) => {
                self.dialog = None;
                self.message = Some(format!("Saving {path} …"));
                return Some(Effect::SavePicture(path));
            }
            Action::ChoosePath => return self.dialog.clone().map(Effect::ChoosePath),
            Action::Open { path, skeleton } => {
                self.dialog = None;
                return Some(Effect::Open { path, skeleton });
            }
            Action::Opened { document, file } => self.replace_document(*document, file),
            Action::Save => match self.file.clone() {
                Some(path) => return Some(Effect::Save(path)),
                None => self.dialog = Some(Dialog::SaveAs { path: "ik-arm.json".to_owned() }),
            },
            Action::SaveAs(path) => {
                self.dialog = None;
                return Some(Effect::Save(path));
            }
            Action::Saved(path) => {
                self.message = Some(format!("Saved {}", path.display()));
                self.file = Some(path);
            }
            Action::OpenExample(example) => self.open_example(example),
            Action::NewSkeleton => self.new_skeleton(),
            Action::Quit => return Some(Effect::Quit),
        }
        None
    }

    /// Where the view is or is going.
    pub fn settled_camera(&self) -> Camera {
        self.glide.map_or(self.document.camera, |glide| glide.target())
    }

    fn reset_all(&mut self) {
        self.document.display = Display::default();
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

    fn replace_document(&mut self, document: Document, file: Option<PathBuf>) {
        *self = Self { file, ..Self::with_document(self.preferences, document) };
    }

    fn open_example(&mut self, example: Example) {
        match example.open() {
            Ok(opened) => {
                self.replace_document(opened.document, None);
                self.message = Some(example.sentence.to_owned());
            }
            Err(error) => self.say_impossible(&error.to_string()),
        }
    }

    fn new_skeleton(&mut self) {
        let document = Document { rig: RigKind::Skeleton, ..Document::default() };
        self.replace_document(document, None);
        self.selection = vec![0];
        self.document.camera = self.framing_all();
        self.message =
            Some("Press A to hang a joint on the root, or Ctrl+click in the view".to_owned());
    }

    pub(super) fn begin_edit(&mut self, drag: Option<Drag>) {
        if self.edit.is_none() {
            let (arm, skeleton) = (*self.arm(), self.skeleton().clone());
            self.edit = Some(Edit { arm, skeleton, drag });
        }
    }

    fn cancel_edit(&mut self) {
        if let Some(edit) = self.edit.take() {
            self.replace_arm(edit.arm);
            self.document.skeleton = edit.skeleton;
            self.refresh_skeleton();
            self.message = Some("Taken back".to_owned());
        }
    }

    fn grab(&mut self, grip: Grip, ray: Ray, forward: Vec3) {
        self.glide = None;
        match grip {
            Grip::Hand(handle) => self.grab_hand(handle, ray, forward),
            Grip::Target(joint, _) => self.grab_target(grip, joint, ray, forward),
            Grip::Tip(joint, _) => self.grab_tip(grip, joint, ray, forward),
            Grip::Ring(joint, axis) => self.grab_ring(joint, axis, ray),
        }
    }

    fn drag_by(&mut self, change: impl FnOnce(&mut Drag)) {
        let Some(Edit { arm: before, drag: Some(drag), .. }) = &mut self.edit else {
            return;
        };
        change(drag);
        let grip = drag.grip;
        match (grip, &mut drag.way) {
            (Grip::Ring(joint, axis), Way::Turn(turn)) => {
                let angle = turn.angle();
                self.turn_joint(joint, axis, angle);
            }
            (Grip::Hand(_), Way::Point(point)) => {
                let held = point.point();
                let hand = if point.has_moved() { held } else { before.cursor };
                self.apply(Action::SetHand(hand));
            }
            (_, Way::Point(point)) => {
                let to = point.point();
                let moved = point.moved();
                if point.has_moved() {
                    self.drag_skeleton(grip, to, moved);
                }
            }
            (_, Way::Turn(_)) => {}
        }
    }

    fn advance(&mut self, seconds: f64) {
        if let Some(glide) = &mut self.glide {
            let (camera, arrived) = glide.at(seconds);
            self.document.camera = camera;
            if arrived {
                self.glide = None;
            }
        }
        self.advance_skeleton(seconds);
    }
}

/// A line that `ik-arm solve` reads.
fn pose_line(arm: &Arm) -> String {
    serde_json::json!({
        "hand": arm.cursor.to_array(),
        "upper": arm.bones.upper(),
        "lower": arm.bones.lower(),
        "root": arm.root.to_array(),
        "elbow_spin_deg": arm.elbow_spin.to_degrees(),
    })
    .to_string()
}
