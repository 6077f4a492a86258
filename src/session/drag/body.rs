use glam::{Quat, Vec3, Vec3A};

use super::grip::Grip;
use super::point::PointHandle;
use super::turn::GripRing;
use crate::document::{Overlay, PathKind, Posed, Ray, SkeletonRig};
use crate::kinematics::limb_ik::Limb;
use crate::kinematics::skeleton::{JointId, RotationAxis, Skeleton};
use crate::rig::{EvaluatedSkeleton, LimbFrames, LimbPart, TaperedCylinder, Target};

/// Radius of the shape that the mouse hits around the fingers, for a limb of length 500.
const FINGERS: f32 = 24.0;

/// Drags of the parts of bodies.
impl Grip {
    /// The grip that a press on the bone or skin of a joint drags; `None` if it cannot be dragged.
    ///
    /// | part | drag |
    /// | --- | --- |
    /// | head of a chain on a path | the head, or the target that leads it |
    /// | root without a bone, such as a pelvis | the root |
    /// | end of a target with a place, such as a hand or foot | the target |
    /// | bone of a target's limb | the limb, about its Pointer; the target of a straight limb |
    /// | other bone | the pressed point, while all that targets hold stays |
    pub fn of_part(posed: &Posed, joint: JointId) -> Option<Self> {
        let (rig, free) = (&posed.document().rig, PointHandle::Free);
        if rig.is_joint_on_path(joint, posed.time()) {
            return match rig.path_kind(joint)? {
                PathKind::Head => Some(Self::Head(joint, free)),
                PathKind::Target => Some(Self::Target(joint, free)),
                PathKind::Ring(_) => None,
            };
        }
        if rig.skeleton.joint(joint)?.is_root_point() {
            return Some(Self::Tip(joint, free));
        }
        Some(match role_of(posed, joint)? {
            Role::End(target) | Role::Led(target) => Self::Target(target, free),
            Role::OfLimb | Role::Free => Self::Bone(joint),
            Role::WithoutBone(parent) => Self::of_part(posed, parent)?,
        })
    }

    /// The joint whose cylinder a ray meets first, if limbs are drawn as cylinders.
    pub fn joint_on_cylinders(posed: &Posed, ray: Ray) -> Option<JointId> {
        let (document, pose) = (posed.document(), posed.skeleton());
        if !document.display.shows(Overlay::Cylinders) {
            return None;
        }
        let rig = &document.rig;
        let hits = rig.targets.iter().filter_map(|target| {
            let limb = Limb::ending_at(pose, target.joint).ok()?;
            let frames = posed.limb_frames(target.joint)?;
            let ball = |radius: f32| [radius * frames.thickness(); 2];
            let [base, elbow, wrist] =
                [LimbPart::Root, LimbPart::Elbow, LimbPart::Hand].map(|part| frames.origin(part));
            let radii = |limb: TaperedCylinder| [limb.base_radius, limb.tip_radius];
            let has_hand = document.display.shows(Overlay::Hand);
            let hand = limb.hand.unwrap_or(limb.lower);
            let forwards = rig.hand_rotation(pose, target.joint)?.x_axis.as_vec3();
            let reach = if has_hand { LimbFrames::HAND - FINGERS } else { 0.0 };
            let fingers = wrist + forwards * reach * frames.thickness();
            let palm = if has_hand { FINGERS } else { LimbFrames::WRIST_BALL };
            let point = |joint: &JointId| pose[*joint].is_root_point();
            let root = pose[limb.upper].parent.filter(point).unwrap_or(limb.upper);
            let shapes = [
                (root, [base; 2], ball(LimbFrames::JOINT_BALL)),
                (limb.upper, [base, elbow], radii(frames.upper())),
                (limb.lower, [elbow; 2], ball(LimbFrames::JOINT_BALL)),
                (limb.lower, [elbow, wrist], radii(frames.lower())),
                (hand, [wrist, fingers], ball(palm)),
            ];
            let hits = shapes.into_iter().filter_map(|(joint, ends, radii)| {
                ray.enters_capsule(ends, radii).map(|distance| (distance, joint))
            });
            hits.min_by(|one, other| one.0.total_cmp(&other.0))
        });
        hits.min_by(|one, other| one.0.total_cmp(&other.0)).map(|(_, joint)| joint)
    }

    /// The heads that can be dragged and whose chains follow.
    pub fn draggable_heads(rig: &SkeletonRig) -> impl Iterator<Item = JointId> {
        let heads = rig.follow_paths.iter().filter(|path| path.kind == PathKind::Head);
        heads.map(|path| path.root)
    }

    /// True if a drag of the tip of `joint` changes the pose.
    pub fn can_drag_tip(posed: &Posed, joint: JointId) -> bool {
        let rig = &posed.document().rig;
        let Some(own) = rig.skeleton.joint(joint) else {
            return false;
        };
        if rig.is_joint_on_path(joint, posed.time()) {
            return false;
        }
        if own.axis == Vec3::ZERO {
            return own.parent.is_none();
        }
        let posing = rig.target_that_turns(joint).filter(|it| it.influence >= 1.0);
        let moves = |it: &Target| {
            let is_own = it.joint == joint && !it.has_free_place();
            is_own || is_elbow(&rig.skeleton, it, joint)
        };
        if posing.is_some_and(moves) {
            return true;
        }
        rig.can_drag(joint)
    }

    /// The target whose limb a drag of the bone of `joint` turns about its Pointer; `None` if the
    /// bone is of no limb that a target alone poses, or if the limb is straight.
    pub fn turned_limb(posed: &Posed, joint: JointId) -> Option<&Target> {
        // Distance of the elbow from the line to the tip, as a fraction of the limb's length.
        const LEAST: f32 = 0.02;
        let (rig, pose) = (&posed.document().rig, posed.skeleton());
        let target = rig.target_that_turns(joint).filter(|it| it.influence >= 1.0)?;
        let limb = target.limb_in(&rig.skeleton)?;
        let [base, elbow] = [limb.upper, limb.lower].map(|joint| pose.base(joint));
        let tip = pose.tip(limb.lower);
        let out = (elbow - base).reject_from((tip - base).normalize_or_zero()).length();
        let is_bent = out > LEAST * (base.distance(elbow) + elbow.distance(tip));
        is_bent.then_some(target)
    }

    /// True if a drag of the tip of `joint` turns the elbow of a limb that is bent.
    pub fn turns_elbow(posed: &Posed, joint: JointId) -> bool {
        let skeleton = &posed.document().rig.skeleton;
        Self::turned_limb(posed, joint).is_some_and(|target| is_elbow(skeleton, target, joint))
    }
}

/// The role of a joint for the targets of its skeleton.
#[derive(Clone, Copy, Debug)]
enum Role {
    /// The end of the target of a joint, such as a hand or foot.
    End(JointId),
    /// A bone of a bent limb that a target alone poses.
    OfLimb,
    /// A bone of a straight limb, turned by the target of a joint.
    Led(JointId),
    /// Can go where targets let it.
    Free,
    /// A joint without a bone, by its parent.
    WithoutBone(JointId),
}

fn role_of(posed: &Posed, joint: JointId) -> Option<Role> {
    let rig = &posed.document().rig;
    let own = rig.skeleton.joint(joint)?;
    let ends = |target: &&Target| {
        target.is_posing() && !target.has_free_place() && rig.end_of(target) == joint
    };
    if let Some(target) = rig.targets.iter().find(ends) {
        return Some(Role::End(target.joint));
    }
    if own.axis == Vec3::ZERO {
        return own.parent.map(Role::WithoutBone);
    }
    match rig.target_that_turns(joint) {
        Some(_) if Grip::turned_limb(posed, joint).is_some() => Some(Role::OfLimb),
        Some(target) if target.limb().is_some() => Some(Role::Led(target.joint)),
        _ => Grip::can_drag_tip(posed, joint).then_some(Role::Free),
    }
}

/// True if the tip of `joint` is the elbow of a target's limb.
pub(in crate::session) fn is_elbow(skeleton: &Skeleton, target: &Target, joint: JointId) -> bool {
    target.limb().is_some()
        && Limb::ending_at(skeleton, target.joint).is_ok_and(|limb| limb.upper == joint)
        && skeleton[target.joint].parent == Some(joint)
        && skeleton[target.joint].offset.distance(skeleton[joint].axis)
            <= 1e-4 * skeleton[joint].axis.length()
}

/// Rings of a pose.
impl GripRing {
    /// The ring of the twist of a limb, around the Pointer through the elbow, in world space;
    /// `None` where FK alone poses the limb or limits turn the elbow aside.
    pub fn of_twist(limb: &LimbFrames) -> Option<Self> {
        let is_on_circle = limb.uses_ik() && !limb.is_limited();
        Self::about_pointer(limb).filter(|_| is_on_circle)
    }

    /// The ring around the Pointer of a limb through a point, in world space; `None` for a limb
    /// without a direction.
    pub fn of_limb(limb: &LimbFrames, through: Vec3) -> Option<Self> {
        let Self { centre, axis } = Self::about_pointer(limb)?;
        Some(Self { centre: centre + axis * (through - centre).dot(axis), axis })
    }

    fn about_pointer(limb: &LimbFrames) -> Option<Self> {
        let pose = limb.pose();
        // A mirrored Root space reverses every rotation.
        let sign = limb.root.matrix3.determinant().signum();
        let axis = Vec3::from(limb.root.matrix3 * Vec3A::from(pose.pointer.direction)) * sign;
        let centre = limb.in_world(pose.pointer.direction * pose.along);
        Some(Self { centre, axis: axis.try_normalize()? })
    }

    /// The ring, in world space, of a joint's FK angle about x, y or z. `None` if a limit fixes the
    /// angle, if there is no such joint, or if a target alone poses the joint and the FK pose is
    /// hidden.
    pub fn of_joint(posed: &Posed, joint: JointId, axis: RotationAxis) -> Option<Self> {
        let rig = &posed.document().rig;
        let own = rig.skeleton.joint(joint)?;
        if own.limits.is_fixed(axis) {
            return None;
        }
        let EvaluatedSkeleton { fk, solved, .. } = posed.evaluated_skeleton();
        // A hand that follows the bone above it keeps its own angles.
        let is_following = |target: &Target| {
            let follows = target.limb().is_some() && target.orientation.is_none();
            follows && target.joint != joint && rig.end_of(target) == joint
        };
        let posing = rig.target_that_turns(joint).filter(|it| it.influence >= 1.0);
        let pose = if posing.is_none_or(is_following) {
            solved
        } else if posed.document().display.shows(Overlay::FkPose) {
            fk
        } else {
            return None;
        };
        let above = own.parent.map_or(pose.transform(), |parent| pose.full_transform(parent));
        let local = own.rotation_axis(axis);
        // A mirrored transform reverses every rotation.
        let sign = above.matrix3.determinant().signum();
        let axis = (Vec3::from(above.matrix3 * Vec3A::from(local)) * sign).try_normalize()?;
        Some(Self { centre: pose.base(joint), axis })
    }

    /// The ring, at the target of a joint and in world space, of the angle about x, y or z of the
    /// orientation that the target holds. `None` if it holds none, or for a limb without a hand.
    pub fn of_orientation(posed: &Posed, joint: JointId, axis: RotationAxis) -> Option<Self> {
        let rig = &posed.document().rig;
        let index = rig.target(joint)?;
        let angles = rig.targets[index].orientation?;
        rig.targets[index].oriented_joint(&rig.skeleton)?;
        let turn = Quat::from_rotation_z(angles.z);
        let local = match axis {
            RotationAxis::X => turn * (Quat::from_rotation_y(angles.y) * Vec3::X),
            RotationAxis::Y => turn * Vec3::Y,
            RotationAxis::Z => Vec3::Z,
        };
        let target = &rig.targets[index];
        let frame = target.orientation_frame(posed.skeleton());
        let axis = target.present_space().rotation(posed.skeleton()) * (frame * local);
        Some(Self { centre: posed.targets().get(index)?.position, axis })
    }
}
