use glam::{Vec2, Vec3};

use super::{
    Constraint, Dialog, DragInput, Edit, Glide, HandDrag, Handle, Motion, Navigation, Session,
    ViewDrag,
};
use crate::document::{Arm, Camera, Display, Layer, Ray, Theme};
use crate::kinematics::two_bone::TwoBone;

/// Everything that can happen. Values are absolute, so that an action said twice is harmless.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// The cursor, in Root space.
    SetHand(Vec3),
    /// ψ in radians; wraps around.
    SetElbowSpin(f32),
    SetRoot(Vec3),
    SetUpper(f32),
    SetLower(f32),
    /// The arm as at first; what is shown stays.
    ResetPose,
    ResetAll,
    Show(Layer, bool),

    /// Begins a change of several steps, such as a slider's drag.
    BeginEdit,
    CommitEdit,
    /// Takes back the change under way.
    CancelEdit,
    /// Takes hold of the hand; `forward` is the picture's normal.
    GrabHand {
        handle: Handle,
        ray: Ray,
        forward: Vec3,
    },
    DragHand(DragInput),
    ConstrainDrag(Option<Constraint>),
    TypeOffset(String),

    SetCamera(Camera),
    GlideTo(Camera),
    /// Lets a glide go on to a time, in seconds.
    Advance(f64),
    GrabView(Motion, Vec2),
    DragView {
        to: Vec2,
        aspect: f32,
    },
    DropView,
    /// Takes back the turn under way.
    CancelView,

    SetTheme(Theme),
    SetNavigation(Navigation),
    ShowExplain(bool),
    OpenDialog(Dialog),
    CloseDialog,
    /// Says what just happened.
    Report(String),

    CopyPose,
    SavePicture(String),
    ChoosePicturePath(String),
    Quit,
}

/// What the world outside the session is asked to do.
#[derive(Clone, Debug, PartialEq)]
pub enum Effect {
    CopyText(String),
    SavePicture(String),
    ChoosePicturePath(String),
    Quit,
}

impl Session {
    /// Does it; what is not possible changes nothing and is said in [`Session::message`].
    pub fn apply(&mut self, action: Action) -> Option<Effect> {
        match action {
            Action::SetHand(hand) => self.set_point("hand", hand, |arm| &mut arm.cursor),
            Action::SetRoot(root) => self.set_point("shoulder", root, |arm| &mut arm.root),
            Action::SetElbowSpin(spin) => self.set_elbow_spin(spin),
            Action::SetUpper(upper) => self.set_lengths(upper, self.arm().bones.lower()),
            Action::SetLower(lower) => self.set_lengths(self.arm().bones.upper(), lower),
            Action::ResetPose => self.replace_arm(Arm::default()),
            Action::ResetAll => self.reset_all(),
            Action::Show(layer, shown) => {
                self.document.display = self.document.display.with(layer, shown);
            }
            Action::BeginEdit => self.begin_edit(None),
            Action::CommitEdit => self.edit = None,
            Action::CancelEdit => self.cancel_edit(),
            Action::GrabHand { handle, ray, forward } => self.grab_hand(handle, ray, forward),
            Action::DragHand(input) => self.drag(|drag| drag.set_input(input)),
            Action::ConstrainDrag(constraint) => self.drag(|drag| drag.set_constraint(constraint)),
            Action::TypeOffset(typed) => self.drag(|drag| drag.set_typed(typed)),
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
            Action::ChoosePicturePath(path) => return Some(Effect::ChoosePicturePath(path)),
            Action::Quit => return Some(Effect::Quit),
        }
        None
    }

    /// Where the view is or is going.
    pub fn settled_camera(&self) -> Camera {
        self.glide.map_or(self.document.camera, |glide| glide.target())
    }

    fn set_point(&mut self, name: &str, point: Vec3, field: fn(&mut Arm) -> &mut Vec3) {
        if point.is_finite() {
            let mut arm = *self.arm();
            *field(&mut arm) = point;
            self.replace_arm(arm);
        } else {
            self.message = Some(format!("The {name} must be at finite numbers, not {point}"));
        }
    }

    fn set_elbow_spin(&mut self, spin: f32) {
        if spin.is_finite() {
            self.replace_arm(Arm {
                elbow_spin: spin.rem_euclid(core::f32::consts::TAU),
                ..*self.arm()
            });
        } else {
            self.message = Some(format!("The elbow spin must be a finite number, not {spin}"));
        }
    }

    fn set_lengths(&mut self, upper: f32, lower: f32) {
        match TwoBone::new(upper, lower) {
            Ok(bones) => self.replace_arm(Arm { bones, ..*self.arm() }),
            Err(error) => self.message = Some(format!("The {error}")),
        }
    }

    /// Every change of the arm comes through here: the pose follows, and where it faces is kept.
    fn replace_arm(&mut self, arm: Arm) {
        self.message = None;
        self.document.arm = arm;
        self.pose = arm.pose();
        self.document.arm.facing = self.pose.facing;
    }

    fn reset_all(&mut self) {
        self.document.display = Display::default();
        self.glide = Some(Glide::new(self.document.camera, Camera::default()));
        self.replace_arm(Arm::default());
    }

    fn begin_edit(&mut self, hand: Option<HandDrag>) {
        if self.edit.is_none() {
            self.edit = Some(Edit { before: *self.arm(), hand });
        }
    }

    fn cancel_edit(&mut self) {
        if let Some(edit) = self.edit.take() {
            self.replace_arm(edit.before);
            self.message = Some("Taken back".to_owned());
        }
    }

    /// The hand is taken where it is seen, or its cursor if that is out of reach and nearer to the
    /// pointer. A cursor out of reach comes to a hand that is taken, which leaves the pose as it is.
    fn grab_hand(&mut self, handle: Handle, ray: Ray, forward: Vec3) {
        self.glide = None;
        let (arm, hand) = (*self.arm(), self.pose.hand);
        let aside = |point: Vec3| (arm.root + point - ray.origin).cross(ray.direction).length();
        let is_at_hand = handle == Handle::Free && aside(hand) < aside(arm.cursor);
        let start = if is_at_hand { hand } else { arm.cursor };
        self.begin_edit(Some(HandDrag::new(handle, start, arm.root, forward, ray)));
    }

    fn drag(&mut self, change: impl FnOnce(&mut HandDrag)) {
        let Some(Edit { before, hand: Some(drag) }) = &mut self.edit else {
            return;
        };
        change(drag);
        let held = drag.hand();
        let hand = if drag.has_moved() { held } else { before.cursor };
        self.apply(Action::SetHand(hand));
    }

    fn advance(&mut self, seconds: f64) {
        if let Some(glide) = &mut self.glide {
            let (camera, arrived) = glide.at(seconds);
            self.document.camera = camera;
            if arrived {
                self.glide = None;
            }
        }
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
