use core::fmt::Display;

use glam::Vec3;

use super::arm_drag::aimed;
use super::arm_joint::ArmJoint;
use super::drag::{Drag, DragKind, Grip};
use super::message::Message;
use super::point_drag::{Constraint, PointDrag};
use super::session::Session;
use super::snapshot::Snapshot;
use super::transaction_action::TransactionAction;
use super::tree_change::TreeChange;
use crate::document::{Arm, Channel, Document, Ray};

/// Minimum distance between waypoints of a dragged head, in cells of the grid.
const WAYPOINT_SPACING: f32 = 0.02;

/// Transactions and undo steps.
impl Session {
    /// Whether a transaction is open.
    pub fn is_editing(&self) -> bool {
        self.editing.is_open()
    }

    /// Whether the document differs from the saved one in more than cameras, shown rig and
    /// overlays.
    pub fn is_unsaved(&self) -> bool {
        self.editing.is_unsaved()
    }

    /// Number of the document's state: equal numbers mean equal documents, except for their
    /// cameras.
    pub fn revision(&self) -> u64 {
        self.editing.revision()
    }

    /// The revision with which the document was opened: another number for each opened document.
    pub fn first_revision(&self) -> u64 {
        self.editing.first_revision()
    }

    /// Label of the step that Undo undoes; `None` if there is none.
    pub fn undo_label(&self) -> Option<&'static str> {
        self.editing.undo_label()
    }

    /// Label of the step that Redo redoes; `None` if there is none.
    pub fn redo_label(&self) -> Option<&'static str> {
        self.editing.redo_label()
    }

    /// Whether the channel has an unkeyed edit.
    pub fn is_overridden(&self, channel: Channel) -> bool {
        self.editing.overrides().contains_key(&channel)
    }

    /// Slider unit of the arm, frozen during a drag so that ranges do not move under the mouse.
    pub fn arm_unit(&self) -> f32 {
        self.editing.shown_before().arm.grid_cell() * 0.01
    }

    /// The drag in the viewport; `None` if nothing is dragged.
    pub fn drag(&self) -> Option<&Drag> {
        self.editing.drag()
    }

    /// The drag of a point in the viewport; `None` if no point is dragged.
    pub fn point_drag(&self) -> Option<&PointDrag> {
        self.drag()?.point()
    }

    pub(super) fn apply_transaction(&mut self, action: TransactionAction) {
        match action {
            TransactionAction::Begin => self.begin_edit(None),
            TransactionAction::Commit => {
                self.preferences.has_dragged_hand |= self.drag().is_some_and(moves_hand);
                self.commit_edit();
            }
            TransactionAction::Cancel => self.cancel_edit(),
            TransactionAction::Undo => self.undo(),
            TransactionAction::Redo => self.redo(),
            TransactionAction::Grab { grip, ray, forward } => self.grab(grip, ray, forward),
            TransactionAction::Drag(input) => self.drag_by(|drag| drag.set_input(input)),
            TransactionAction::Constrain(constraint) => {
                if constraint.is_none_or(Constraint::has_valid_axis) {
                    self.drag_by(|drag| drag.set_constraint(constraint));
                }
            }
            TransactionAction::FollowMouse(follows) => self.follow_mouse(follows),
            TransactionAction::Lead(ray) => self.lead_heads(ray),
            TransactionAction::TypeOffset(typed) => self.drag_by(|drag| drag.set_typed(typed)),
        }
    }

    /// Changes a copy of the shown document and commits it. After an error, reports it and returns
    /// `None`. An edit after which a target could not be evaluated is an error.
    pub(super) fn edit_document<T, E: Display>(
        &mut self,
        change: impl FnOnce(&mut Document) -> Result<T, E>,
    ) -> Option<T> {
        let mut after = self.shown().clone();
        let change = change(&mut after).map_err(|error| error.to_string());
        let change = change.and_then(|value| {
            let checked = after.skeleton_rig.check_target_spaces();
            checked.map(|()| value).map_err(|error| error.to_string())
        });
        match change {
            Ok(value) => {
                self.shell.clear_message();
                self.commit(after);
                Some(value)
            }
            Err(error) => {
                self.fail(error);
                None
            }
        }
    }

    /// Replaces the shown document and updates all that depends on it.
    pub(super) fn commit(&mut self, after: Document) {
        let had_keys = !self.document().keys.is_empty();
        let Some(change) = self.editing.write(after, &self.playback) else { return };
        self.playback.follow_keys(had_keys, !self.document().keys.is_empty());
        if change.has_auto_keyed {
            self.playback.has_auto_keyed();
        }
        if change.has_overridden {
            let text = "Unkeyed change: press K or it is lost when the time changes";
            self.shell.set_message(Message::of_moment(text));
        }
        self.follow_document();
        self.forget_trail();
    }

    pub(super) fn discard_unkeyed_edits(&mut self) {
        self.editing.clear_overrides();
    }

    /// Restores a state. The playhead moves only to where unkeyed edits come back or go.
    fn restore(&mut self, state: &Snapshot) {
        if !(state.overrides().is_empty() && self.editing.overrides().is_empty()) {
            self.pause_at(state.time);
        }
        let had_keys = !self.document().keys.is_empty();
        let change = self.editing.restore(state);
        self.playback.follow_keys(had_keys, !self.document().keys.is_empty());
        match change {
            TreeChange::Kept => {}
            TreeChange::Shortened { parent } => {
                self.selection.shorten(self.document().skeleton().joints().len(), parent);
            }
            TreeChange::Rebuilt => self.selection.forget_joints(),
        }
        self.refresh();
        self.forget_trail();
    }

    pub(super) fn begin_edit(&mut self, drag: Option<Drag>) {
        if !self.is_editing() {
            self.editing.begin(drag, self.time());
        }
    }

    pub(super) fn commit_edit(&mut self) {
        self.follow_mouse = None;
        self.editing.commit(self.time());
    }

    fn cancel_edit(&mut self) {
        self.follow_mouse = None;
        if let Some(before) = self.editing.take_transaction() {
            // Playback goes on unless the transaction discarded earlier unkeyed edits.
            self.editing.clear_overrides();
            self.restore(&before);
            self.say("Cancelled");
        }
    }

    /// Undoes a step; if a transaction is open, cancels it instead.
    fn undo(&mut self) {
        if self.is_editing() {
            return self.cancel_edit();
        }
        match self.editing.undo(self.time()) {
            Some((label, state)) => {
                self.restore(&state);
                self.say(format!("Undid {label}"));
            }
            None => self.say("There is nothing to undo"),
        }
    }

    fn redo(&mut self) {
        self.commit_edit();
        match self.editing.redo(self.time()) {
            Some((label, state)) => {
                self.restore(&state);
                self.say(format!("Redid {label}"));
            }
            None => self.say("There is nothing to redo"),
        }
    }

    fn grab(&mut self, grip: Grip, ray: Ray, forward: Vec3) {
        if !grip.has_valid_axis() {
            return;
        }
        self.view.stop_glide();
        let is_hand = matches!(grip, Grip::Hand(_));
        let kept = self.selected_arm_joint().filter(|joint| is_hand && *joint == ArmJoint::Hand);
        self.selection.set_arm_joint(grip.arm_joint().or(kept));
        match grip {
            Grip::Hand(handle) => self.grab_hand(handle, ray, forward),
            Grip::Target(joint, handle) => self.grab_target(joint, handle, ray, forward),
            Grip::LimbPole(joint, handle) => self.grab_limb_pole(joint, handle, ray, forward),
            Grip::Head(joint, handle) => self.grab_head(joint, handle, ray, forward),
            Grip::Tip(joint, handle) => self.grab_tip(joint, handle, ray, forward),
            Grip::Ring(joint, axis) => self.grab_ring(joint, axis, ray),
            Grip::Pole(handle) => self.grab_pole(handle, ray, forward),
            Grip::Root(handle) => self.grab_root(handle, ray, forward),
            Grip::Limb => self.grab_limb(ray),
            Grip::UpperLimb => self.grab_upper_limb(ray, forward),
            Grip::Orientation(joint, axis) => self.grab_orientation(joint, axis, ray),
            Grip::Twist | Grip::Shoulder(_) | Grip::Bend | Grip::HandRing(_) => {
                self.grab_arm_ring(grip, ray);
            }
        }
    }

    fn drag_by(&mut self, change: impl FnOnce(&mut Drag)) {
        let spacing = self.shown().grid_cell() * WAYPOINT_SPACING;
        let Some((drag, shown)) = self.editing.drag_mut() else { return };
        change(drag);
        let grip = drag.grip;
        let Arm { cursor, pole, root, fk, hand_orientation, .. } = shown.arm;
        let mut angles = fk.shoulder;
        match (grip, &mut drag.kind) {
            (Grip::Ring(joint, axis), DragKind::Turn(turn)) => {
                let angle = turn.angle();
                self.turn_joint(joint, axis, angle);
            }
            (Grip::Hand(_), DragKind::Point(point)) => {
                let dragged = point.point();
                if point.has_moved() {
                    self.set_point("hand", dragged, Arm::set_cursor);
                } else {
                    self.replace_arm(Arm { cursor, ..*self.arm() });
                }
            }
            (Grip::Shoulder(axis), DragKind::Turn(turn)) => {
                angles[axis.index()] = turn.angle();
                self.set_shoulder(angles);
            }
            (Grip::Bend, DragKind::Turn(turn)) => {
                let bend = turn.angle();
                self.set_bend(bend);
            }
            (Grip::Pole(_), DragKind::Point(point)) => {
                let dragged = point.point();
                let pole = if point.has_moved() { dragged } else { pole };
                self.set_pole(pole);
            }
            (Grip::Root(_), DragKind::Point(point)) => {
                let dragged = point.point();
                let root = if point.has_moved() { dragged } else { root };
                self.set_root(root);
            }
            (Grip::Twist | Grip::Limb, DragKind::Turn(turn)) => {
                let twist = turn.angle();
                self.set_twist(twist);
            }
            (Grip::UpperLimb, DragKind::Point(point)) => {
                let dragged = point.point();
                let is_turned = point.has_moved();
                self.set_shoulder(if is_turned { aimed(angles, dragged) } else { angles });
            }
            (Grip::HandRing(axis), DragKind::Turn(turn)) => {
                let mut angles = hand_orientation.angles;
                angles[axis.index()] = turn.angle();
                self.set_hand_orientation(angles);
            }
            (Grip::Orientation(joint, axis), DragKind::Turn(turn)) => {
                let angle = turn.angle();
                self.turn_target(joint, axis, angle);
            }
            (Grip::Head(root, _), DragKind::Point(_)) => {
                drag.add_waypoint(spacing);
                let waypoints = drag.waypoints.clone();
                self.drag_head(root, &waypoints);
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
}

/// Whether a drag has moved the hand of the arm.
fn moves_hand(drag: &Drag) -> bool {
    let is_hand = matches!(drag.grip(), Grip::Hand(_));
    is_hand && drag.point().is_some_and(|point| point.moved() != Vec3::ZERO)
}
