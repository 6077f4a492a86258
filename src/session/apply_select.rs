use super::arm_figure::ArmFigure;
use super::arm_joint::ArmJoint;
use super::body_part::BodyPart;
use super::effect::Effect;
use super::select_action::SelectAction;
use super::session::Session;
use crate::kinematics::skeleton::JointId;

/// Selection of joints, keys and channels.
impl Session {
    /// Selected joints; the last of them is the active joint.
    pub fn selection(&self) -> &[JointId] {
        self.selection.joints()
    }

    /// The active joint, which is the last of the selected ones; `None` without a selection.
    pub fn selected(&self) -> Option<JointId> {
        self.selection().last().copied()
    }

    /// The joint under the mouse, in the viewport or in the outliner.
    pub fn hovered(&self) -> Option<JointId> {
        self.hovered_part()?.joint()
    }

    /// The part of a body under the mouse, which lights up.
    pub fn hovered_part(&self) -> Option<BodyPart> {
        self.selection.hovered()
    }

    /// The selected joint of the arm, whose handles are shown; `None` without one.
    pub fn selected_arm_joint(&self) -> Option<ArmJoint> {
        self.selection.arm_joint()
    }

    /// The line of the arm's figures under the mouse.
    pub fn figure(&self) -> Option<ArmFigure> {
        self.selection.figure()
    }

    pub(super) fn apply_selection(&mut self, action: SelectAction) -> Option<Effect> {
        match action {
            SelectAction::Joints(joints) => self.select(joints),
            SelectAction::Hover(part) => self.hover(part),
            SelectAction::Wiggle(wiggled) => self.set_wiggle(wiggled),
            SelectAction::ArmJoint(joint) => self.selection.set_arm_joint(joint),
            SelectAction::Figure(figure) => self.selection.set_figure(figure),
            SelectAction::Keys(keys) => {
                self.selection.set_keys(keys);
                self.retain_keys();
            }
            SelectAction::Channels(channels) => {
                self.selection.set_channels(channels);
                self.retain_keys();
            }
            SelectAction::CopyKeys => return self.copy_keys(),
        }
        None
    }

    pub(super) fn select(&mut self, joints: Vec<JointId>) {
        self.selection.set_joints(joints);
        self.selection.retain_joints(self.skeleton_pose().len());
        self.forget_trail();
    }

    pub(super) fn hover(&mut self, part: Option<BodyPart>) {
        self.selection.set_hovered(part);
        self.selection.retain_joints(self.skeleton_pose().len());
    }

    pub(super) fn retain_keys(&mut self) {
        self.selection.retain_keys(self.editing.document());
    }
}
