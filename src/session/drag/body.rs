use glam::Vec3;

use super::grip::Grip;
use super::point::PointHandle;
use crate::document::{Overlay, PathKind, Ray};
use crate::kinematics::limb_ik::Limb;
use crate::kinematics::skeleton::JointId;
use crate::rig::{ArmPart, ArmRig, TaperedCylinder, Target};
use crate::session::parts::BodyPart;
use crate::session::session::Session;

/// The parts of bodies under the mouse, and what dragging them does.
impl Session {
    /// What a press on a part of a body drags; `None` if it cannot be dragged.
    ///
    /// | part | drag |
    /// | --- | --- |
    /// | shoulder of the arm | Root |
    /// | hand of the arm | Cursor; in FK the elbow's bend |
    /// | limb of the arm | Socket twist, or the Cursor of a straight arm; in FK shoulder or bend |
    /// | head of a chain on a path | the head, or the target that leads it |
    /// | root without a bone, such as a pelvis | the root |
    /// | end of a target, such as a hand or foot | the target |
    /// | bone of a target's limb | the elbow |
    /// | other bone that a target turns | the target |
    /// | other bone | the tip, by FK angles |
    pub fn grip_of(&self, part: BodyPart) -> Option<Grip> {
        let (free, is_led) = (PointHandle::Free, self.arm().uses_ik());
        Some(match part {
            BodyPart::Root => Grip::Root(free),
            BodyPart::Hand if is_led => Grip::Hand(free),
            BodyPart::UpperLimb | BodyPart::LowerLimb if is_led => match self.is_bent() {
                true => Grip::Limb,
                false => Grip::Hand(free),
            },
            BodyPart::UpperLimb => Grip::UpperLimb,
            BodyPart::LowerLimb | BodyPart::Hand => Grip::Bend,
            BodyPart::Joint(joint) if self.is_on_path(joint) => {
                match self.skeleton_rig().path_kind(joint)? {
                    PathKind::Head => Grip::Head(joint, free),
                    PathKind::Target => Grip::Target(joint, free),
                    PathKind::Ring(_) => return None,
                }
            }
            BodyPart::Joint(joint) if self.is_root_point(joint) => Grip::Tip(joint, free),
            BodyPart::Joint(joint) => match self.role_of(joint)? {
                Role::End(target) | Role::Led(target) => Grip::Target(target, free),
                Role::Elbow(upper) => Grip::Tip(upper, free),
                Role::Free => Grip::Tip(joint, free),
                Role::WithoutBone(parent) => self.grip_of(BodyPart::Joint(parent))?,
            },
        })
    }

    /// The part of the arm that a ray meets first; `None` if it meets none.
    pub fn arm_part_at(&self, ray: Ray) -> Option<BodyPart> {
        let (arm, pose) = (self.arm(), self.pose());
        let rig = arm.rig(pose);
        let thickness = ArmRig::thickness(arm.bones);
        let [root, elbow, wrist] =
            [ArmPart::Root, ArmPart::Elbow, ArmPart::Hand].map(|part| rig.origin(part));
        let limb = |limb: TaperedCylinder| [limb.base_radius, limb.tip_radius];
        let ball = |radius: f32| [radius * thickness; 2];
        let forwards = arm.hand_rotation(pose).x_axis.as_vec3();
        let has_hand = self.shown().display.shows(Overlay::Hand);
        let reach = if has_hand { BodyPart::HAND - BodyPart::FINGERS } else { 0.0 };
        let fingers = wrist + forwards * reach * thickness;
        let palm = if has_hand { BodyPart::FINGERS } else { BodyPart::WRIST_BALL };
        let shapes = [
            (BodyPart::Root, [root; 2], ball(BodyPart::JOINT_BALL)),
            (BodyPart::UpperLimb, [root, elbow], limb(rig.upper())),
            (BodyPart::LowerLimb, [elbow; 2], ball(BodyPart::JOINT_BALL)),
            (BodyPart::LowerLimb, [elbow, wrist], limb(rig.lower())),
            (BodyPart::Hand, [wrist, fingers], ball(palm)),
        ];
        let hits = shapes.into_iter().filter_map(|(part, ends, radii)| {
            ray.enters_capsule(ends, radii).map(|distance| (distance, part))
        });
        hits.min_by(|one, other| one.0.total_cmp(&other.0)).map(|(_, part)| part)
    }

    /// The heads that can be dragged and whose chains follow.
    pub fn draggable_heads(&self) -> impl Iterator<Item = JointId> {
        let paths = self.skeleton_rig().follow_paths.iter();
        paths.filter(|path| path.kind == PathKind::Head).map(|path| path.root)
    }

    /// True if a path poses a joint at the playhead.
    fn is_on_path(&self, joint: JointId) -> bool {
        self.skeleton_rig().is_joint_on_path(joint, self.time())
    }

    /// True if a joint is a root without a bone, such as a pelvis.
    pub fn is_root_point(&self, joint: JointId) -> bool {
        let joint = self.skeleton().joint(joint);
        joint.is_some_and(|joint| joint.parent.is_none() && joint.axis == Vec3::ZERO)
    }

    /// True if the elbow of the arm is so far from the Pointer that its circle can be seen.
    fn is_bent(&self) -> bool {
        const LEAST: f32 = 0.02;
        self.pose().out > LEAST * self.arm().bones.outer_limit()
    }

    fn role_of(&self, joint: JointId) -> Option<Role> {
        let rig = self.skeleton_rig();
        let own = rig.skeleton.joint(joint)?;
        let ends = |target: &&Target| target.is_posing() && rig.end_of(target) == joint;
        if let Some(target) = rig.targets.iter().find(ends) {
            return Some(Role::End(target.joint));
        }
        if own.axis == Vec3::ZERO {
            return own.parent.map(Role::WithoutBone);
        }
        match rig.target_that_turns(joint) {
            Some(target) => {
                let limb =
                    target.limb().and_then(|_| Limb::ending_at(&rig.skeleton, target.joint).ok());
                let upper = limb.map(|limb| limb.upper).filter(|upper| self.turns_elbow(*upper));
                Some(upper.map_or(Role::Led(target.joint), Role::Elbow))
            }
            None => self.can_drag_tip(joint).then_some(Role::Free),
        }
    }
}

/// What a joint is to the targets of its skeleton.
#[derive(Clone, Copy, Debug)]
enum Role {
    /// The end of the target of a joint, such as a hand or foot.
    End(JointId),
    /// A bone of a limb that a target alone poses, by the limb's upper joint.
    Elbow(JointId),
    /// Turned by the target of a joint.
    Led(JointId),
    /// Posed by its own angles.
    Free,
    /// A joint without a bone, by its parent.
    WithoutBone(JointId),
}
