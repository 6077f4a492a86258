use super::edit_action::EditAction;
use super::session::Session;
use crate::document::{Arm, Camera, Cursor, Display, Document, RigKind, SkeletonRig};

/// Edits of the document.
impl Session {
    /// Applies an edit as an undo step of its own, or as part of the open transaction.
    pub(super) fn apply_edit(&mut self, action: EditAction) {
        let label = action.label();
        if self.editing.label_transaction(label) {
            return self.edit(action);
        }
        let before = self.editing.state(self.time());
        self.edit(action);
        if !self.is_editing() {
            self.editing.remember(label, before, self.time());
        }
    }

    fn edit(&mut self, action: EditAction) {
        match action {
            EditAction::SetHand(hand) => self.set_point("hand", hand, Arm::set_cursor),
            EditAction::SetRoot(root) => self.set_root(root),
            EditAction::SetTwist(twist) => self.set_twist(twist),
            EditAction::SetPin(pin) => {
                self.set_point("hand", pin, |arm, pin| {
                    arm.cursor = Cursor { in_world: pin, is_pinned: true, ..arm.cursor };
                });
            }
            EditAction::PinHand(pinned) => self.replace_arm(self.arm().with_pinned(pinned)),
            EditAction::SetTwistReference(reference) => self.set_twist_reference(reference),
            EditAction::SetPole(pole) => self.set_pole(pole),
            EditAction::SetSoftReach(soft_reach) => {
                self.replace_arm(Arm { soft_reach, ..*self.arm() });
            }
            EditAction::SetInfluence(influence) => self.set_influence(influence),
            EditAction::SwitchPoseMode(mode) => self.switch_pose_mode(mode),
            EditAction::SetShoulder(angles) => self.set_shoulder(angles),
            EditAction::SetBend(bend) => self.set_bend(bend),
            EditAction::SetHandOrientation(angles) => self.set_hand_orientation(angles),
            EditAction::SetHandSpace(space) => {
                self.shell.clear_message();
                self.commit(self.shown().with_hand_space(space));
            }
            EditAction::SetUpper(upper) => self.set_lengths(upper, self.arm().bones.lower()),
            EditAction::SetLower(lower) => self.set_lengths(self.arm().bones.upper(), lower),
            EditAction::ResetPose => match self.rig() {
                RigKind::Arm => self.replace_arm(Arm::default()),
                RigKind::Skeleton => self.bind_pose(),
            },
            EditAction::ResetAll => self.reset_all(),
            EditAction::ShowOverlay(overlay, shown) => {
                let display = self.shown().display.with(overlay, shown);
                self.commit(Document { display, ..self.shown().clone() });
            }
            EditAction::ShowRig(rig) => self.show_rig(rig),

            EditAction::AddChild { parent, tip } => self.add_joint(Some(parent), tip),
            EditAction::AddJoint { tip } => self.add_next_joint(tip),
            EditAction::AddRoot => self.add_joint(None, None),
            EditAction::DeleteJoints(joints) => {
                self.shell.take_dialog();
                self.delete_joints(&joints, Document::delete);
            }
            EditAction::DissolveJoints(joints) => {
                self.shell.take_dialog();
                self.delete_joints(&joints, Document::dissolve);
            }
            EditAction::RenameJoint { joint, name } => {
                self.shell.take_dialog();
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
            EditAction::AddSkin => self.add_skin(),
            EditAction::ShowSkin { skin, bones } => self.show_skin(skin, bones),
            EditAction::PackSkin => self.pack_skin(),
            EditAction::SetSkin(skin) => self.set_skin(skin),
            EditAction::SetTranslation(to) => self.set_translation(to),
            EditAction::TurnYUp => self.turn_y_up(),
            EditAction::SetFollowPath { root, kind } => self.set_follow_path(root, kind),
            EditAction::SetHead { root, to } => self.set_head(root, to),

            EditAction::AddTarget(joint) => self.add_target(joint),
            EditAction::RemoveTarget(joint) => self.remove_target(joint),
            EditAction::SetTarget(target) => self.set_target(target),
            EditAction::MatchTargetToFk(joint) => {
                self.match_target(joint, SkeletonRig::match_target_to_fk);
            }
            EditAction::MatchFkToPose(joint) => {
                self.match_target(joint, SkeletonRig::match_fk_to_pose);
            }
            EditAction::SetTargetSpace { joint, space } => {
                self.convert_target(|document, time| document.set_target_space(joint, space, time));
            }
            EditAction::SetPoleSpace { joint, space } => {
                self.convert_target(|document, time| document.set_pole_space(joint, space, time));
            }
            EditAction::ApplyRemedy { target, remedy } => self.apply_remedy(target, &remedy),
            EditAction::SetSolver(solver) => self.set_solver(solver),
            EditAction::SetIterationsPerFrame(iterations) => {
                self.edit_skeleton(|rig| {
                    rig.iterations_per_frame =
                        iterations.clamp(1, SkeletonRig::MAX_ITERATIONS_PER_FRAME);
                    Ok(())
                });
            }
            EditAction::ApplyPose => self.apply_pose(),

            EditAction::Key(channels) => self.key(&channels),
            EditAction::DeleteKeys(keys) => self.delete_keys(&keys),
            EditAction::ClearChannels(channels) => self.clear_channels(&channels),
            EditAction::MoveKeys { keys, by, raise } => self.move_keys(&keys, by, raise),
            EditAction::SetInterpolation(keys, interpolation) => {
                self.set_interpolation(&keys, interpolation);
            }
            EditAction::SetSlopes(keys, slopes) => self.set_slopes(&keys, slopes),
            EditAction::PasteKeys => self.paste_keys(),
            EditAction::Bake(baked) => self.replace_by_bake(&baked),
            EditAction::SetTimeline(timeline) => self.set_timeline(timeline),
            EditAction::SetMetres(metres) => self.set_metres(metres),
        }
    }

    fn reset_all(&mut self) {
        self.view.reset_crowd();
        self.commit(Document { display: Display::default(), ..self.shown().clone() });
        match self.rig() {
            RigKind::Arm => {
                self.glide_to(Camera::default());
                self.replace_arm(Arm::default());
            }
            RigKind::Skeleton => {
                self.glide_to(self.framing_all());
                self.bind_pose();
            }
        }
    }
}
